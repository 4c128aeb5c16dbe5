//! The scenes that are stepped here without std, on every target, and in `core/tests/scenes.rs` with it: the last state of
//! each must have the same bits everywhere.

use taut::field::FieldView;
use taut::{Budget, Cloth, ClothDef, Error, Families, Features, Grid, GridDef, Vector3};

/// Particles of a side.
pub const SIDE: u32 = 16;
/// f32 numbers of memory that a scene may use.
pub const NUMBERS: usize = 20_480;
/// Frames after which every target is compared.
pub const SHORT: u32 = 1_000;
/// Frames after which fast targets are compared.
pub const LONG: u32 = 10_000;

/// A scene with the hashes that it must give.
pub struct Scene {
    /// What it is called.
    pub name: &'static str,
    /// Hash of the state after [`SHORT`] and after [`LONG`] frames.
    pub golden: [u64; 2],
    what: What,
}

#[derive(Clone, Copy, PartialEq)]
enum What {
    Hang2,
    Edge,
    Hang1,
    Inertia,
    Pull,
    Curtain,
}

const fn scene(name: &'static str, what: What, golden: [u64; 2]) -> Scene {
    Scene { name, what, golden }
}

/// All scenes. The hashes were printed once on x86_64.
pub const SCENES: [Scene; 6] = [
    // all families, a graded field, the default budget and clamps
    scene("hang2", What::Hang2, [0x7a44_9fca_3728_29fa, 0x62c1_5e2a_b4eb_f2ec]),
    // the structural springs alone, nothing clamped, hardly damped
    scene("edge", What::Edge, [0xd053_d72c_387b_eb0e, 0x49c9_9660_1adb_1cc1]),
    // oblong cells, structural and shear, no axis is up
    scene("hang1", What::Hang1, [0x8f79_8f6e_94ce_9f8b, 0x2634_ef15_1134_7c45]),
    // all families with the inertia field, which moves with the pins: one is freed on the way
    scene("inertia", What::Inertia, [0xb7c5_370d_4c9c_2438, 0x6c67_584c_9f69_d5db]),
    // structural and bend, with forces on single particles
    scene("pull", What::Pull, [0xf322_9391_0e52_8c41, 0xc772_24e5_029b_d813]),
    // all families, the pins of the upper row move up and down and sideways
    scene("curtain", What::Curtain, [0x0721_6d5d_0960_57b0, 0xc2e4_cf4e_552d_a218]),
];

impl Scene {
    fn grid(&self) -> GridDef {
        let families = match self.what {
            What::Edge => Families::STRUCTURAL,
            What::Hang1 => Families(Families::STRUCTURAL.0 | Families::SHEAR.0),
            What::Pull => Families(Families::STRUCTURAL.0 | Families::BEND.0),
            _ => Families::ALL,
        };
        let (width_m, height_m) = if self.what == What::Hang1 { (1.3, 0.7) } else { (1.0, 1.0) };
        GridDef { rows: SIDE, columns: SIDE, width_m, height_m, families }
    }

    fn def(&self) -> ClothDef {
        // level, so that the sheet swings and the state is far from rest
        let def =
            ClothDef { rate_hz: 240.0, substeps: 1, max_pins: SIDE, v_axis: [0.0, 0.0, 1.0], ..ClothDef::default() };
        match self.what {
            What::Edge => ClothDef {
                budget: Budget::Certified,
                damping_per_s: 0.1,
                speed_limit: 0.0,
                compression_limit: false,
                ..def
            },
            What::Hang1 => ClothDef { gravity_m_s2: [3.0, -8.0, 1.0], v_axis: [0.3, -0.2, 0.9], rate_hz: 300.0, ..def },
            What::Inertia => ClothDef { inertia_radius_m: 0.3, ..def },
            What::Curtain => ClothDef { rate_hz: 120.0, substeps: 2, ..def },
            What::Pull => ClothDef { features: Features::PULL, ..def },
            _ => def,
        }
    }

    /// Steps the scene and calls `seen` with the hash after [`SHORT`] frames and, if `long`, after [`LONG`] frames.
    ///
    /// Errors: [`Error::BlockTooSmall`] when `block` is shorter than the cloth needs; [`Error::NotFinite`] when a frame was
    /// taken back.
    pub fn run(&self, block: &mut [f32], long: bool, mut seen: impl FnMut(usize, u64)) -> Result<(), Error> {
        let grid = Grid::new(&self.grid())?;
        let mut cloth = Cloth::create(&grid, &self.def(), block)?;
        let mut field = [0.0; 4 * 5 * 7];
        for (i, k) in field.iter_mut().enumerate() {
            let channel = [200.0, 120.0, 40.0, 3.0].get(i / 35).copied().unwrap_or(0.0);
            *k = channel * (1.0 + (i % 35) as f32 / 16.0);
        }
        cloth.set_stiffness_field(&FieldView::new(4, 5, 7, &field)?);
        self.pin(&mut cloth)?;
        for frame in 0..if long { LONG } else { SHORT } {
            self.before(frame, &mut cloth)?;
            if cloth.step()?.0 != 0 {
                return Err(Error::NotFinite);
            }
            if frame + 1 == SHORT {
                seen(0, cloth.state_hash());
            } else if frame + 1 == LONG {
                seen(1, cloth.state_hash());
            }
        }
        Ok(())
    }

    fn pin(&self, cloth: &mut Cloth<'_>) -> Result<(), Error> {
        let side = SIDE as usize;
        match self.what {
            What::Edge | What::Curtain => (0..side).try_for_each(|p| cloth.pin(p)),
            What::Hang1 => cloth.pin(0),
            _ => cloth.pin(0).and_then(|()| cloth.pin(side - 1)),
        }
    }

    /// What happens before a frame.
    fn before(&self, frame: u32, cloth: &mut Cloth<'_>) -> Result<(), Error> {
        // to and fro; periods are powers of two and so are all factors below: exact in every rounding
        let swing = |period: u32| {
            let at = frame % period;
            (at.min(period - at) as f32) / period as f32
        };
        match self.what {
            What::Inertia if frame == SHORT / 2 => cloth.unpin(0),
            What::Pull if frame % 3 == 0 => {
                let particle = (frame as usize * 37) % (SIDE * SIDE) as usize;
                cloth.add_force(particle, Vector3::new(0.0625 * swing(64), 0.015625, -0.03125))
            }
            What::Curtain => (0..SIDE).try_for_each(|i| {
                let to = [i as f32 * 0.0625 * (1.0 - 0.5 * swing(256)), 0.25 * swing(64), 0.5 * swing(128)];
                cloth.move_pin(i as usize, Vector3::from(to).cast())
            }),
            _ => Ok(()),
        }
    }
}
