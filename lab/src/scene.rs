//! Named scenes: how a cloth starts, what it meets, which particles are pinned and where they go.

use std::f32::consts::{FRAC_1_SQRT_2, PI};
use std::fmt;
use std::str::FromStr;

use taut::{Air, Cloth, ClothDef, ColliderDef, Error, Features, Pose, Shape, Vector3, noise};

/// Radius of the sphere of `drape` as a share of the sheet's width, and how far above it the sheet starts: the scene of ARCSim.
const SPHERE: f32 = 0.3;
const ABOVE: f32 = 0.02;

/// Radius of the pedestal of `cusick` as a share of the disc's (BS 5058: 9 cm below a disc of 15 cm).
pub const PEDESTAL: f32 = 0.6;

/// How far and how often the pins of `curtain` go to and fro.
const CURTAIN_M: f64 = 0.2;
const CURTAIN_HZ: f64 = 1.0;

/// Wind of `flag` in m/s and its gusts.
const WIND_M_S: f32 = 6.0;
const GUST: f32 = 0.3;

/// A named scene. Gravity is along -y. The sheet starts flat but for a bump of at most about 1 % of its side, without which
/// a flat sheet would never fold: upright in the plane z = 0, or level in the plane y = 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Scene {
    /// Both top corners pinned.
    Hang2,
    /// The whole top row pinned.
    Edge,
    /// One corner pinned, the sheet turned by 45 degrees so that it hangs below it.
    Hang1,
    /// Level, one edge pinned, no damping: it swings down.
    Swing,
    /// Hung at every fourth particle of the top row, which goes to and fro by 0.2 m once a second.
    Curtain,
    /// Level, 2 cm above a sphere of 0.3 of its width, held by nothing.
    Drape,
    /// Hung at the column u = 0, in a gusty wind of 6 m/s along +x.
    Flag,
    /// A disc on a pedestal of 0.6 of its radius, to which it is clamped: the test of Cusick (1968). Everything outside the
    /// disc is absent.
    Cusick,
}

impl Scene {
    /// All scenes.
    pub const ALL: [Scene; 8] = [
        Scene::Hang2,
        Scene::Edge,
        Scene::Hang1,
        Scene::Swing,
        Scene::Curtain,
        Scene::Drape,
        Scene::Flag,
        Scene::Cusick,
    ];

    /// The name in the program and in reports.
    pub fn name(self) -> &'static str {
        match self {
            Scene::Hang2 => "hang2",
            Scene::Edge => "edge",
            Scene::Hang1 => "hang1",
            Scene::Swing => "swing",
            Scene::Curtain => "curtain",
            Scene::Drape => "drape",
            Scene::Flag => "flag",
            Scene::Cusick => "cusick",
        }
    }

    /// What it is, in a few words.
    pub fn about(self) -> &'static str {
        match self {
            Scene::Hang2 => "two corners pinned",
            Scene::Edge => "top row pinned",
            Scene::Hang1 => "one corner pinned",
            Scene::Swing => "swings down from one edge",
            Scene::Curtain => "its hooks go to and fro",
            Scene::Drape => "falls on a sphere",
            Scene::Flag => "in a gusty wind",
            Scene::Cusick => "a disc on a pedestal",
        }
    }

    /// The pinned particles of a grid.
    pub fn pins(self, rows: usize, columns: usize) -> Vec<usize> {
        match self {
            Scene::Hang2 => vec![0, columns - 1],
            Scene::Edge | Scene::Swing => (0..columns).collect(),
            Scene::Hang1 => vec![0],
            Scene::Curtain => {
                let hooks = (0..columns - 1).step_by(4);
                hooks.chain([columns - 1]).collect()
            }
            Scene::Drape => vec![],
            Scene::Flag => (0..rows).map(|row| row * columns).collect(),
            // Hinges are clamped halfway between the last particles that are held and those before, so half a cell more is
            // held all round: then the overhang begins at the pedestal's edge.
            Scene::Cusick => (0..rows * columns)
                .filter(|i| from_middle(i / columns, i % columns, rows, columns) <= clamped(rows, columns))
                .collect(),
        }
    }

    /// What the scene cannot do without.
    pub fn features(self) -> Features {
        match self {
            Scene::Drape => Features(Features::COLLIDERS.0 | Features::HINGE.0),
            Scene::Flag => Features(Features::AIR.0 | Features::HINGE.0),
            Scene::Cusick => Features(Features::MASK.0 | Features::COLLIDERS.0 | Features::HINGE.0),
            _ => Features::NONE,
        }
    }

    /// Whether the sheet starts in the plane y = 0.
    pub fn is_level(self) -> bool {
        matches!(self, Scene::Swing | Scene::Drape | Scene::Cusick)
    }

    /// Whether it comes to rest.
    pub fn rests(self) -> bool {
        !matches!(self, Scene::Swing | Scene::Curtain | Scene::Flag)
    }

    /// A definition made fit for the scene on a grid: its features, pins, axes and damping.
    pub fn fit(self, def: &ClothDef, rows: usize, columns: usize) -> ClothDef {
        ClothDef {
            features: Features(def.features.0 | self.features().0),
            max_pins: self.pins(rows, columns).len().max(1) as u32,
            u_axis: [1.0, 0.0, 0.0],
            v_axis: if self.is_level() { [0.0, 0.0, 1.0] } else { [0.0, -1.0, 0.0] },
            damping_per_s: if self == Scene::Swing { 0.0 } else { def.damping_per_s },
            ..*def
        }
    }

    /// Where the particle at the shares (u, v) of its sheet starts, in m. Another seed is another bump; 0 is that of the
    /// pictures in the docs.
    pub fn start(self, u: f32, v: f32, width_m: f32, height_m: f32, seed: u64) -> [f32; 3] {
        let side = width_m.max(height_m);
        let phase = |i: u32| if seed == 0 { 0.0 } else { 2.0 * PI * noise::uniform(seed, i) };
        let mut bump = (3.0 * PI * u + phase(0)).sin()
            + 0.6 * (5.0 * PI * u + 1.0 + phase(1)).cos()
            + 0.4 * (2.0 * PI * u + 3.0 * v + phase(2)).sin();
        bump *= v;
        if !matches!(self, Scene::Edge | Scene::Swing) {
            bump += (PI * u).sin() * (0.3 + v);
        }
        let bump = 0.004 * side * bump;
        let (a, b) = (u * width_m, v * height_m);
        match self {
            Scene::Hang1 => [(a - b) * FRAC_1_SQRT_2, -(a + b) * FRAC_1_SQRT_2, bump],
            Scene::Swing | Scene::Drape => [a, bump, b],
            // what is clamped lies flat
            Scene::Cusick => [a, bump * (2.0 * (u - 0.5).hypot(v - 0.5) - PEDESTAL).max(0.0), b],
            _ => [a, -b, bump],
        }
    }

    /// Whether a particle of a grid is part of the sheet.
    pub fn has(self, particle: usize, rows: usize, columns: usize) -> bool {
        self != Scene::Cusick || from_middle(particle / columns, particle % columns, rows, columns) <= 1.0
    }

    /// What a sheet of a width (along u) and height lies on, if anything.
    pub fn solid(self, width_m: f32, height_m: f32) -> Option<Solid> {
        let middle = |y: f32| [0.5 * width_m, y, 0.5 * height_m];
        match self {
            Scene::Drape => {
                let radius_m = SPHERE * width_m;
                Some(Solid::Sphere { middle_m: middle(-radius_m - ABOVE * width_m), radius_m })
            }
            Scene::Cusick => Some(Solid::Pedestal { top_m: middle(0.0), radius_m: 0.5 * PEDESTAL * width_m }),
            _ => None,
        }
    }

    /// Puts a cloth that was made from [`Scene::fit`] at the start of the scene, with its pins, mask, colliders and wind.
    pub fn set_up(self, cloth: &mut Cloth<'_>, seed: u64) -> Result<(), Error> {
        let g = *cloth.grid();
        let (m, n) = (g.rows(), g.columns());
        cloth.reset();
        if self == Scene::Cusick {
            let there = |i: usize| u8::from(self.has(i, m, n));
            cloth.set_mask(&(0..m * n).map(there).collect::<Vec<u8>>())?;
        }
        for i in 0..m * n {
            cloth.set_position(i, Vector3::from(self.start_of(&g, i, seed)))?;
        }
        for p in self.pins(m, n) {
            cloth.pin(p)?;
        }
        let (width, height) = (g.def().width_m, g.def().height_m);
        let place = |local: [f32; 3]| {
            Vector3::from_iterator(cloth.def().origin_m.iter().zip(local).map(|(o, x)| o + f64::from(x)))
        };
        match self.solid(width, height) {
            Some(Solid::Sphere { middle_m, radius_m }) => {
                let sphere = ColliderDef::new(Shape::Sphere { radius_m }, Pose::at(place(middle_m)));
                cloth.add_collider(&ColliderDef { friction: 0.6, ..sphere })?;
            }
            Some(Solid::Pedestal { top_m, radius_m }) => {
                // the pedestal is a cylinder; a capsule is one from its radius on downwards
                let ends_m = [[0.0, -radius_m, 0.0], [0.0, -4.0 * width, 0.0]];
                let pedestal =
                    ColliderDef::new(Shape::Capsule { ends_m, radii_m: [radius_m; 2] }, Pose::at(place(top_m)));
                cloth.add_collider(&ColliderDef { thickness_m: 0.0, ..pedestal })?;
            }
            None => {}
        }
        if self == Scene::Flag {
            cloth.set_air(&Air { wind_m_s: [WIND_M_S, 0.0, 0.0], gust: GUST, ..Air::default() })?;
        }
        Ok(())
    }

    /// Moves what moves by itself to where it is at a time in s. Call it before the step that ends at that time.
    pub fn drive(self, cloth: &mut Cloth<'_>, time_s: f64, seed: u64) -> Result<(), Error> {
        if self != Scene::Curtain {
            return Ok(());
        }
        let g = *cloth.grid();
        let origin = Vector3::from(cloth.def().origin_m);
        let way = CURTAIN_M * (std::f64::consts::TAU * CURTAIN_HZ * time_s).sin();
        for p in self.pins(g.rows(), g.columns()) {
            let start = self.start_of(&g, p, seed).map(f64::from);
            cloth.move_pin(p, origin + Vector3::from(start) + Vector3::new(way, 0.0, 0.0))?;
        }
        Ok(())
    }

    fn start_of(self, g: &taut::Grid, particle: usize, seed: u64) -> [f32; 3] {
        let (m, n) = (g.rows(), g.columns());
        let (u, v) = ((particle % n) as f32 / (n - 1) as f32, (particle / n) as f32 / (m - 1) as f32);
        self.start(u, v, g.def().width_m, g.def().height_m, seed)
    }
}

/// What a sheet lies on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Solid {
    /// A ball.
    Sphere {
        /// Its middle in m.
        middle_m: [f32; 3],
        /// Its radius in m.
        radius_m: f32,
    },
    /// An upright cylinder, endless downwards.
    Pedestal {
        /// The middle of its top in m.
        top_m: [f32; 3],
        /// Its radius in m.
        radius_m: f32,
    },
}

/// Distance from the middle up to which the particles of [`Scene::Cusick`] are held, as a share of half its side.
fn clamped(rows: usize, columns: usize) -> f32 {
    PEDESTAL + 1.0 / (rows.min(columns) - 1) as f32
}

/// Distance of a particle from the middle of the sheet as a share of half its side.
fn from_middle(row: usize, column: usize, rows: usize, columns: usize) -> f32 {
    let share = |i: usize, n: usize| 2.0 * i as f32 / (n - 1) as f32 - 1.0;
    // a particle on the circle belongs to it
    share(column, columns).hypot(share(row, rows)) - 1e-6
}

impl fmt::Display for Scene {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Scene {
    type Err = String;

    fn from_str(s: &str) -> Result<Scene, String> {
        Scene::ALL.into_iter().find(|scene| scene.name() == s).ok_or_else(|| {
            let names = Scene::ALL.map(Scene::name);
            let [first @ .., last] = &names;
            format!("unknown scene `{s}`: choose {} or {last}", first.join(", "))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use taut::{Grid, GridDef, StepFlags};

    /// Runs a scene and hands every frame to `look`.
    fn play(scene: Scene, side: u32, frames: u32, mut look: impl FnMut(&Cloth<'_>, u32)) {
        let grid = Grid::new(&GridDef { rows: side, columns: side, ..GridDef::default() }).unwrap();
        let def = scene.fit(&ClothDef::default(), side as usize, side as usize);
        let mut block = vec![0.0; Cloth::memory(&grid, &def).unwrap()];
        let mut cloth = Cloth::create(&grid, &def, &mut block).unwrap();
        cloth.set_stiffness_uniform([1e6, 1e6, 1e6, 1.0]).unwrap();
        scene.set_up(&mut cloth, 0).unwrap();
        for frame in 1..=frames {
            scene.drive(&mut cloth, f64::from(frame) / 60.0, 0).unwrap();
            assert_eq!(cloth.step().unwrap(), StepFlags(0), "{scene}, frame {frame}");
            look(&cloth, frame);
        }
    }

    #[test]
    fn every_scene_runs_from_its_pins() {
        for scene in Scene::ALL {
            let pins = scene.pins(12, 12);
            assert!(pins.iter().all(|p| *p < 144));
            play(scene, 12, 90, |cloth, frame| {
                assert_eq!(cloth.pinned().collect::<Vec<_>>(), pins, "{scene}");
                assert!(cloth.strain().largest < 2.0, "{scene}, frame {frame}: {}", cloth.strain().largest);
            });
        }
    }

    #[test]
    fn hooks_are_where_the_curtain_rod_says() {
        play(Scene::Curtain, 9, 75, |cloth, frame| {
            let way = 0.2 * (std::f64::consts::TAU * f64::from(frame) / 60.0).sin();
            let hook = cloth.world_position(4).unwrap();
            assert!((hook.x - (0.5 + way)).abs() < 1e-6, "frame {frame}: {hook}");
        });
    }

    #[test]
    fn a_sheet_drapes_over_the_sphere() {
        let mut lowest = 0.0f32;
        play(Scene::Drape, 24, 180, |cloth, _| {
            let centre = Vector3::new(0.5, -0.32, 0.5);
            for i in 0..24 * 24 {
                let p = cloth.position(i).unwrap();
                assert!((p - centre).norm() > 0.3, "{p} is inside");
                lowest = lowest.min(p.y);
            }
        });
        assert!(lowest < -0.3, "the corners hang down to {lowest}");
    }

    #[test]
    fn a_flag_flies_with_the_wind() {
        let mut x = 0.0;
        play(Scene::Flag, 12, 240, |cloth, frame| {
            if frame > 120 {
                x += cloth.position(12 * 6 + 11).unwrap().x / 120.0;
            }
        });
        assert!(x > 0.3, "its free edge is {x} m down the wind");
    }

    #[test]
    fn names_are_read_back() {
        for scene in Scene::ALL {
            assert_eq!(scene.to_string().parse(), Ok(scene));
        }
        let text = "moon".parse::<Scene>().unwrap_err();
        assert!(text.contains("hang2, edge, hang1") && text.ends_with("or cusick"), "{text}");
    }
}
