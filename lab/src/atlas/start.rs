//! How a cloth of the atlas starts: flat, or in one of the shapes that break solvers.

use taut::{Grid, noise};

/// Where the particles are at the start. Shares are of the longer side.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Start {
    /// Hung in its plane, with the bump of 1 % of [`crate::scene::Scene::start`].
    Flat,
    /// 30 % too long along both ways.
    Stretched,
    /// Every free particle moved by up to 0.05 along each axis.
    Noise5,
    /// Every free particle moved by up to 0.3 along each axis.
    Noise30,
    /// Every free particle somewhere in a cube of 0.1 around the middle.
    Crumpled,
    /// Every second column on the one before it: springs of length zero beside springs of twice their length.
    Pairs,
    /// All free particles in one point.
    Heap,
    /// All particles in one point, pins too: no spring has a direction.
    Point,
    /// Mirrored left to right while the pins stay where they are.
    Mirrored,
    /// Upside down: it stands on its pins.
    Inverted,
    /// Off the plane by at most 1e-40 m, with speeds of at most 1e-40 m/s: f32 has no normal numbers there.
    Denormal,
}

impl Start {
    /// All starts.
    pub const ALL: [Start; 11] = [
        Start::Flat,
        Start::Denormal,
        Start::Stretched,
        Start::Noise5,
        Start::Noise30,
        Start::Crumpled,
        Start::Pairs,
        Start::Heap,
        Start::Point,
        Start::Mirrored,
        Start::Inverted,
    ];

    /// The name on the map.
    pub fn name(self) -> &'static str {
        match self {
            Start::Flat => "flat",
            Start::Stretched => "stretched 30 %",
            Start::Noise5 => "noise 0.05",
            Start::Noise30 => "noise 0.3",
            Start::Crumpled => "crumpled",
            Start::Pairs => "columns in pairs",
            Start::Heap => "heap",
            Start::Point => "point",
            Start::Mirrored => "mirrored",
            Start::Inverted => "inverted",
            Start::Denormal => "denormal",
        }
    }

    /// Where a particle starts in m, the cloth's upper left corner in the origin, and how fast in m/s.
    pub fn of(self, g: &Grid, particle: usize, is_pinned: bool, seed: u64) -> [[f32; 3]; 2] {
        let (columns, d) = (g.columns(), g.def());
        let (row, column) = (particle / columns, particle % columns);
        let (u, v) = (column as f32 / (columns - 1) as f32, row as f32 / (g.rows() - 1) as f32);
        let side = d.width_m.max(d.height_m);
        // -1 to 1
        let random = |axis: u32| 2.0 * noise::uniform(seed, 3 * particle as u32 + axis) - 1.0;
        let flat = crate::scene::Scene::Hang2.start(u, v, d.width_m, d.height_m, 0);
        let middle = [0.5 * d.width_m, -0.5 * d.height_m, 0.0];
        let moved = |from: [f32; 3], by: f32| [0, 1, 2].map(|a| from[a] + by * random(a as u32));
        let rest = [0.0; 3];
        if self == Start::Point {
            return [[0.0; 3], rest];
        }
        if is_pinned {
            return [flat, rest];
        }
        match self {
            Start::Flat | Start::Point => [flat, rest],
            Start::Stretched => [flat.map(|x| 1.3 * x), rest],
            Start::Noise5 => [moved(flat, 0.05 * side), rest],
            Start::Noise30 => [moved(flat, 0.3 * side), rest],
            Start::Crumpled => [moved(middle, 0.1 * side), rest],
            Start::Pairs => {
                let u = (column / 2 * 2) as f32 / (columns - 1) as f32;
                [[u * d.width_m, flat[1], 0.0], rest]
            }
            Start::Heap => [middle, rest],
            Start::Mirrored => [[d.width_m - flat[0], flat[1], flat[2]], rest],
            Start::Inverted => [[flat[0], -flat[1], flat[2]], rest],
            Start::Denormal => {
                let tiny = moved([0.0; 3], 1e-40);
                [[flat[0], flat[1], tiny[2]], tiny]
            }
        }
    }
}
