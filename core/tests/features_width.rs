//! Every vector width steps colliders, targets, air, hinges and the implicit solvers to the bits of single numbers, and those
//! are the bits that they had before they were worked on in vectors.

mod common;

use common::{Random, bits, cloth, grid, snapshot, vector_widths};
use taut::{
    Air, Cloth, ClothDef, ColliderDef, ColliderId, Families, Features, Pose, Shape, Solver, StepFlags, Target,
    TargetLimit, Vector3, Width,
};

/// Columns on both sides of each vector length and of the blocks of 16; thin sheets; more rows than any band of them.
const SIZES: [(u32, u32); 15] = [
    (2, 2),
    (2, 3),
    (3, 2),
    (2, 40),
    (5, 4),
    (4, 5),
    (6, 9),
    (8, 15),
    (9, 16),
    (10, 17),
    (18, 18),
    (17, 31),
    (32, 33),
    (3, 97),
    (97, 3),
];

/// What a sheet carries.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    Colliders,
    OneCollider,
    Targets,
    Air,
    Hinge,
    Euler,
    Bdf2,
    All,
}

impl Kind {
    const ALL: [Kind; 8] =
        [Kind::Colliders, Kind::OneCollider, Kind::Targets, Kind::Air, Kind::Hinge, Kind::Euler, Kind::Bdf2, Kind::All];

    fn features(self) -> Features {
        match self {
            Kind::Colliders | Kind::OneCollider => Features::COLLIDERS,
            Kind::Targets => Features::TARGETS,
            Kind::Air => Features::AIR,
            Kind::Hinge => Features::HINGE,
            Kind::Euler | Kind::Bdf2 => Features::IMPLICIT,
            Kind::All => Features(
                Features::COLLIDERS.0
                    | Features::TARGETS.0
                    | Features::AIR.0
                    | Features::HINGE.0
                    | Features::STRAIN_LIMIT.0,
            ),
        }
    }

    fn has(self, feature: Features) -> bool {
        self.features().contains(feature)
    }
}

fn pose(r: &mut Random, place: Vector3<f64>, turn: f32) -> Pose {
    let t = r.vector(turn);
    let long = (t.dot(&t) + 1.0).sqrt();
    Pose { position_m: place, rotation: [t.x / long, t.y / long, t.z / long, 1.0 / long] }
}

fn shape(r: &mut Random, kind: usize, size: f32) -> Shape {
    match kind % 5 {
        0 => Shape::Sphere { radius_m: size * r.within(0.2, 0.5) },
        1 => {
            let (a, b) = (r.vector(0.4 * size), r.vector(0.4 * size));
            let radii_m = [size * r.within(0.05, 0.2), size * r.within(0.05, 0.3)];
            Shape::Capsule { ends_m: [[a.x, a.y, a.z], [b.x, b.y, b.z]], radii_m }
        }
        2 => Shape::Plane { normal: [0.1 * r.unit(), 0.1 * r.unit(), 1.0] },
        3 => Shape::Box { half_m: [size * r.within(0.1, 0.4), size * r.within(0.1, 0.4), size * 0.1] },
        // one ball within the other, and an axis without a length
        _ => Shape::Capsule { ends_m: [[0.0; 3]; 2], radii_m: [size * 0.3, size * 0.2] },
    }
}

/// A sheet, its colliders, and where its particles were put.
struct Made {
    cloth: Cloth<'static>,
    colliders: Vec<ColliderId>,
    start: Vec<Vector3<f32>>,
    seed: u64,
    size: f32,
}

/// A crumpled sheet in motion with random pins and holes.
fn sheet(seed: u64, (rows, columns): (u32, u32), kind: Kind) -> Made {
    let mut r = Random::new(seed);
    let masked = if seed % 3 == 0 { Features::MASK } else { Features::NONE };
    let def = ClothDef {
        features: Features(kind.features().0 | Features::PULL.0 | masked.0),
        solver: match kind {
            Kind::Euler => Solver::ImplicitEuler,
            Kind::Bdf2 => Solver::Bdf2,
            _ => Solver::SymplecticEuler,
        },
        cg_iterations: 3,
        substeps: if kind.has(Features::IMPLICIT) { 1 } else { 4 },
        hinge_rigidity_n_m: 1e-4,
        gravity_m_s2: [0.3, -0.0, -9.81],
        ..ClothDef::default()
    };
    let families = if kind == Kind::Hinge { Families(3) } else { Families([7, 7, 1, 3, 5][seed as usize % 5]) };
    let grid = grid(rows, columns, (columns - 1) as f32 * 0.05, (rows - 1) as f32 * 0.04, families);
    let size = (grid.rest_u() * (columns - 1) as f32).max(grid.rest_v() * (rows - 1) as f32);
    let mut c = cloth(&grid, &def);
    c.set_stiffness_uniform([500.0, 300.0, 80.0, 2.0]).unwrap();
    let n = grid.particles();
    if masked == Features::MASK {
        let mask: Vec<u8> = (0..n).map(|_| u8::from(r.below(7) != 0)).collect();
        c.set_mask(&mask).unwrap();
    }
    for _ in 0..[0, 1, 2, 5][seed as usize % 4] {
        let _ = c.pin(r.below(n));
    }
    let start: Vec<_> = (0..n).map(|i| c.position(i).unwrap() * r.within(1.0, 1.01) + r.vector(0.006)).collect();
    for (i, p) in start.iter().enumerate() {
        c.set_position(i, *p).unwrap();
        // absent particles have none
        let _ = c.set_velocity(i, r.vector(if seed % 2 == 0 { 0.3 } else { 3.0 }));
    }
    let mut colliders = Vec::new();
    if kind.has(Features::COLLIDERS) {
        let middle = start[n / 2].cast::<f64>();
        for i in 0..if kind == Kind::OneCollider { 1 } else { 7 } {
            let shape = shape(&mut r, i + seed as usize, size);
            let one = kind == Kind::OneCollider;
            let away = if one { 0.02 } else { [0.3, 3.0][i / 5] };
            let below = if one { 0.02 } else { 0.2 };
            let place = middle + (r.vector(away * size) - Vector3::new(0.0, 0.0, below * size)).cast();
            let pose = pose(&mut r, place, if i % 2 == 0 { 0.0 } else { 0.4 });
            let friction = [0.0, 0.3, 2.0][i % 3];
            let def = ColliderDef { shape, pose, friction, thickness_m: [0.0, 0.01][i % 2] };
            colliders.push(c.add_collider(&def).unwrap());
        }
    }
    if kind.has(Features::AIR) {
        let wind_m_s = [4.0, -2.0, [0.0, 30.0][seed as usize % 2]];
        c.set_air(&Air { wind_m_s, gust: 0.5, lift: [0.0, 0.7, 3.0][seed as usize % 3], ..Air::default() }).unwrap();
    }
    if kind.has(Features::TARGETS) {
        let limit = |i: usize| TargetLimit {
            max_distance_m: [0.0, 0.003, 0.02, f32::INFINITY][(i / 3 + seed as usize) % 4],
            backstop_radius_m: [0.0, 0.125, 1.0][i % 3],
            backstop_distance_m: [0.0, 0.002][i % 2],
        };
        c.set_target_limits(limit).unwrap();
    }
    Made { cloth: c, colliders, start, seed, size }
}

impl Made {
    /// What the caller does before a frame.
    fn stir(&mut self, frame: u64) {
        let (mut r, c) = (Random::new(1000 * self.seed + frame), &mut self.cloth);
        c.add_force(0, r.vector(0.01)).unwrap_or_default();
        for (i, id) in self.colliders.iter().enumerate() {
            let at = c.collider(*id).unwrap().pose.position_m;
            // standing, moving, moving and turning
            let (way, turn) = ([0.0, 0.02, 0.1][i % 3], [0.0, 0.0, 0.3][i % 3]);
            if way > 0.0 {
                let way = r.vector(way * self.size);
                let to = pose(&mut r, at + way.cast(), turn);
                c.move_collider(*id, &to).unwrap();
            }
        }
        if c.def().features.contains(Features::TARGETS) {
            let shift = r.vector(0.003);
            let start = &self.start;
            let skin = |i: usize| {
                let normal = Vector3::new(shift.x * 50.0, (i % 3) as f32 * 0.3, 1.0);
                Target { position_m: start[i] + shift, normal }
            };
            c.move_targets(Vector3::zeros(), skin).unwrap();
        }
    }

    fn frames(&mut self) -> Vec<Vec<u32>> {
        let frame = |i: u64| {
            self.stir(i);
            assert_eq!(self.cloth.step().unwrap(), StepFlags(0));
            bits(&self.cloth)
        };
        (0..2).map(frame).collect()
    }
}

/// FNV-1a (Fowler, Noll, Vo) of words.
fn hash_on(hash: u64, words: &[u32]) -> u64 {
    words.iter().fold(hash, |hash, word| (hash ^ u64::from(*word)).wrapping_mul(0x100_0000_01b3))
}

/// Of each [`Kind`], over all sheets of single numbers; printed by the code before any of this was done in vectors.
const GOLDEN: [u64; 8] = [
    0x0fca_bde2_b1a2_cfb6,
    0x2664_ceae_8473_a9a9,
    0xa0fa_fdc4_af12_8866,
    0x7d22_171e_b7cf_30a1,
    0x1a62_0798_e26d_db99,
    0x6ce2_6912_5cde_1351,
    0xd455_7dd5_af39_f8cd,
    0xb949_4baa_af03_7db0,
];

/// A sheet of every size and kind, three times: the same bits after every frame. And the feature was at work, or nothing
/// would have been compared.
#[test]
fn every_width_steps_features_to_the_same_bits() {
    let widths = vector_widths();
    let (mut seed, mut compared, mut hashes, mut at_work) = (0, 0, Vec::new(), Vec::new());
    for kind in Kind::ALL {
        let (mut hash, mut worked) = (0xcbf2_9ce4_8422_2325, 0);
        for size in SIZES {
            for _ in 0..3 {
                seed += 1;
                let mut made = sheet(seed, size, kind);
                let start = snapshot(&mut made.cloth);
                made.cloth.set_width(Width::Scalar).unwrap();
                let wanted = made.frames();
                hash = wanted.iter().fold(hash, |hash, words| hash_on(hash, words));
                let mut plain = sheet(seed, size, kind);
                let _ = plain.cloth.set_target_limits(|_| TargetLimit::default());
                let _ = plain.cloth.set_air(&Air { density_kg_m3: 0.0, ..Air::default() });
                for id in plain.colliders.drain(..) {
                    plain.cloth.remove_collider(id).unwrap();
                }
                worked += u32::from(plain.frames() != wanted);
                for width in &widths {
                    made.cloth.set_width(*width).unwrap();
                    made.cloth.restore(&start).unwrap();
                    for (frame, (is, wanted)) in made.frames().iter().zip(&wanted).enumerate() {
                        assert!(is == wanted, "{width:?} {size:?} {kind:?} seed {seed} frame {frame}");
                        compared += 1;
                    }
                }
            }
        }
        hashes.push(hash);
        at_work.push(worked);
    }
    assert_eq!(compared, Kind::ALL.len() * SIZES.len() * 3 * widths.len() * 2);
    println!("at work in {at_work:?} of {}", SIZES.len() * 3);
    assert!(at_work[..4].iter().chain(&at_work[7..]).all(|n| *n > 30), "{at_work:?} of {}", SIZES.len() * 3);
    assert!(hashes == GOLDEN, "now {hashes:#x?}");
}
