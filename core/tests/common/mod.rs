//! What several tests of core share: short ways to make cloths, seeded random numbers, reading and placing particles.
#![allow(dead_code)] // every test program uses its own part

pub mod contact;
pub mod lattice;
pub mod twin;

use taut::{Cloth, ClothDef, Families, Grid, GridDef, Vector3, Width, noise};

/// The widths that this machine has; it says which ones it lacks.
pub fn widths() -> Vec<Width> {
    for lacking in Width::ALL.into_iter().filter(|w| !w.is_supported()) {
        println!("SKIPPED: this machine has no {}", lacking.name());
    }
    Width::ALL.into_iter().filter(|w| w.is_supported()).collect()
}

/// [`widths`] beside the single numbers.
pub fn vector_widths() -> Vec<Width> {
    widths().into_iter().filter(|w| *w != Width::Scalar).collect()
}

/// A grid of square or other cells.
pub fn grid(rows: u32, columns: u32, width_m: f32, height_m: f32, families: Families) -> Grid {
    let def = GridDef { rows, columns, width_m, height_m, families };
    Grid::new(&def).expect("a valid grid")
}

/// A grid whose cells are squares of side `cell_m`.
pub fn squares(rows: u32, columns: u32, cell_m: f32, families: Families) -> Grid {
    let (width, height) = ((columns - 1) as f32 * cell_m, (rows - 1) as f32 * cell_m);
    grid(rows, columns, width, height, families)
}

/// Nothing but springs: no gravity, damping, speed limit or compression limit; one substep of 1/960 s is a frame.
pub fn bare() -> ClothDef {
    ClothDef {
        rate_hz: 960.0,
        substeps: 1,
        gravity_m_s2: [0.0; 3],
        damping_per_s: 0.0,
        speed_limit: 0.0,
        compression_limit: false,
        ..ClothDef::default()
    }
}

/// A cloth in memory that is never given back and that held rubbish before.
pub fn cloth(grid: &Grid, def: &ClothDef) -> Cloth<'static> {
    let block = vec![f32::NAN; Cloth::memory(grid, def).expect("a valid definition")].leak();
    Cloth::create(grid, def, block).expect("the block is large enough")
}

/// Seeded random numbers.
pub struct Random {
    seed: u64,
    count: u32,
}

impl Random {
    pub fn new(seed: u64) -> Random {
        Random { seed, count: 0 }
    }

    /// In [0, 1).
    pub fn unit(&mut self) -> f32 {
        self.count += 1;
        noise::uniform(self.seed, self.count)
    }

    pub fn within(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.unit()
    }

    /// Uniform in the logarithm.
    pub fn log(&mut self, low: f32, high: f32) -> f32 {
        (low.ln() + (high / low).ln() * self.unit()).exp()
    }

    pub fn below(&mut self, n: usize) -> usize {
        ((self.unit() * n as f32) as usize).min(n - 1)
    }

    /// Three Gaussian numbers of deviation `s`.
    pub fn vector(&mut self, s: f32) -> Vector3<f32> {
        self.count += 3;
        let g = |i: u32| s * noise::gaussian(self.seed, self.count - i);
        Vector3::new(g(0), g(1), g(2))
    }
}

/// The named scenes: what is pinned on a rows x columns grid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Scene {
    Hang2,
    Edge,
    Hang1,
}

impl Scene {
    pub const ALL: [Scene; 3] = [Scene::Hang2, Scene::Edge, Scene::Hang1];

    pub fn pin(self, cloth: &mut Cloth<'_>) {
        let n = cloth.grid().columns();
        let pins: Vec<usize> = match self {
            Scene::Hang2 => vec![0, n - 1],
            Scene::Edge => (0..n).collect(),
            Scene::Hang1 => vec![0],
        };
        for p in pins {
            cloth.pin(p).expect("room for the pins");
        }
    }
}

pub fn positions(cloth: &Cloth<'_>) -> Vec<Vector3<f32>> {
    let of = |i| cloth.position(i).expect("a particle");
    (0..cloth.grid().particles()).map(of).collect()
}

pub fn velocities(cloth: &Cloth<'_>) -> Vec<Vector3<f32>> {
    let of = |i| cloth.velocity(i).expect("a particle");
    (0..cloth.grid().particles()).map(of).collect()
}

/// Puts every particle somewhere, at rest.
pub fn put(cloth: &mut Cloth<'_>, places: &[Vector3<f32>]) {
    for (i, p) in places.iter().enumerate() {
        cloth.set_position(i, *p).expect("within reach");
    }
}

/// Gives every particle a random velocity.
pub fn stir(cloth: &mut Cloth<'_>, random: &mut Random, speed_m_s: f32) {
    for i in 0..cloth.grid().particles() {
        cloth.set_velocity(i, random.vector(speed_m_s)).expect("a velocity within reach");
    }
}

/// Steps some frames; every one must stay finite.
pub fn steps(cloth: &mut Cloth<'_>, frames: usize) {
    for _ in 0..frames {
        assert_eq!(cloth.step().expect("a stiffness was set").0, 0);
    }
}

/// The bits of positions and velocities.
pub fn bits(cloth: &Cloth<'_>) -> Vec<u32> {
    let (x, v) = (positions(cloth), velocities(cloth));
    x.iter().chain(&v).flat_map(|p| p.iter().map(|n| n.to_bits()).collect::<Vec<_>>()).collect()
}

pub fn snapshot(cloth: &mut Cloth<'_>) -> Vec<u8> {
    let mut bytes = vec![0; cloth.snapshot_size_max()];
    let n = cloth.snapshot(&mut bytes).expect("room");
    bytes.truncate(n);
    bytes
}

/// a is b within the relative `tolerance`.
#[track_caller]
pub fn near(a: f64, b: f64, tolerance: f64, what: &str) {
    assert!((a - b).abs() <= tolerance * b.abs(), "{what}: {a} instead of {b}, off by {:.2e}", (a / b - 1.0).abs());
}
