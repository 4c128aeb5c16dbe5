//! Named scenes: how a cloth starts and which particles are pinned.

use std::fmt;
use std::str::FromStr;

use taut::{Cloth, Error, Vector3};

/// A named scene. Gravity is along -y; the sheet starts upright in the plane z = 0 with a bump of at most about 1 % of its
/// side, without which a flat sheet would never fold.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Scene {
    /// Both top corners pinned.
    Hang2,
    /// The whole top row pinned.
    Edge,
    /// One corner pinned, the sheet turned by 45 degrees so that it hangs below it.
    Hang1,
}

impl Scene {
    /// All scenes.
    pub const ALL: [Scene; 3] = [Scene::Hang2, Scene::Edge, Scene::Hang1];

    /// The name in the program and in reports.
    pub fn name(self) -> &'static str {
        match self {
            Scene::Hang2 => "hang2",
            Scene::Edge => "edge",
            Scene::Hang1 => "hang1",
        }
    }

    /// The pinned particles of a rows x columns grid.
    pub fn pins(self, columns: usize) -> Vec<usize> {
        match self {
            Scene::Hang2 => vec![0, columns - 1],
            Scene::Edge => (0..columns).collect(),
            Scene::Hang1 => vec![0],
        }
    }

    /// Most pins that the scene needs.
    pub fn max_pins(self, columns: usize) -> u32 {
        self.pins(columns).len() as u32
    }

    /// Where the particle at the shares (u, v) of its sheet starts, in m.
    pub fn start(self, u: f32, v: f32, width_m: f32, height_m: f32) -> [f32; 3] {
        use std::f32::consts::PI;
        let side = width_m.max(height_m);
        let mut z = (3.0 * PI * u).sin() + 0.6 * (5.0 * PI * u + 1.0).cos() + 0.4 * (2.0 * PI * u + 3.0 * v).sin();
        z *= v;
        if self != Scene::Edge {
            z += (PI * u).sin() * (0.3 + v);
        }
        let (a, b) = (u * width_m, v * height_m);
        let (x, y) = match self {
            Scene::Hang1 => {
                let h = std::f32::consts::FRAC_1_SQRT_2;
                ((a - b) * h, -(a + b) * h)
            }
            _ => (a, -b),
        };
        [x, y, 0.004 * side * z]
    }

    /// Puts a cloth at the start of the scene and pins it.
    pub fn set_up(self, cloth: &mut Cloth<'_>) -> Result<(), Error> {
        let g = *cloth.grid();
        cloth.reset();
        let (m, n) = (g.rows(), g.columns());
        for row in 0..m {
            for column in 0..n {
                let (u, v) = (column as f32 / (n - 1) as f32, row as f32 / (m - 1) as f32);
                let p = self.start(u, v, g.def().width_m, g.def().height_m);
                cloth.set_position(row * n + column, Vector3::from(p))?;
            }
        }
        for p in self.pins(n) {
            cloth.pin(p)?;
        }
        Ok(())
    }
}

impl fmt::Display for Scene {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Scene {
    type Err = String;

    fn from_str(s: &str) -> Result<Scene, String> {
        Scene::ALL
            .into_iter()
            .find(|scene| scene.name() == s)
            .ok_or_else(|| format!("unknown scene `{s}`: choose hang2, edge or hang1"))
    }
}
