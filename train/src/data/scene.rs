use serde::{Deserialize, Serialize};
use taut::noise;
use taut_lab::scene;

/// How the cloth of a picture hangs or lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Scene {
    /// Both top corners pinned.
    Hang2,
    /// The whole top row pinned.
    Edge,
    /// Some particles of the top row pinned, another choice for every piece of cloth.
    Pins,
    /// One corner pinned: the cloth hangs in folds.
    Hang1,
    /// Over a ball, in folds.
    Drape,
}

impl Scene {
    /// All of them.
    pub const ALL: [Scene; 5] = [Scene::Hang2, Scene::Edge, Scene::Pins, Scene::Hang1, Scene::Drape];

    /// Its name in files.
    pub fn name(self) -> &'static str {
        match self {
            Scene::Hang2 => "hang2",
            Scene::Edge => "edge",
            Scene::Pins => "pins",
            Scene::Hang1 => "hang1",
            Scene::Drape => "drape",
        }
    }

    /// The scene of the lab that starts the same way; its pins are those of [`Scene::pins`] but for [`Scene::Pins`].
    pub fn lab(self) -> scene::Scene {
        match self {
            Scene::Hang2 | Scene::Pins => scene::Scene::Hang2,
            Scene::Edge => scene::Scene::Edge,
            Scene::Hang1 => scene::Scene::Hang1,
            Scene::Drape => scene::Scene::Drape,
        }
    }

    /// Whether the folds bifurcate, so that pictures can be compared but positions cannot.
    pub fn folds(self) -> bool {
        matches!(self, Scene::Hang1 | Scene::Drape)
    }

    /// The pinned particles of a square grid with `side` along each side, row 0 at the top. Those of [`Scene::Pins`] follow
    /// from `draw`, at the same shares of the row on every grid: 2 to 5 particles, the outermost at most a fifth of the side
    /// from the corners, or what falls over beside them would bifurcate.
    pub fn pins(self, side: usize, draw: u64) -> Vec<usize> {
        if self != Scene::Pins {
            return self.lab().pins(side, side);
        }
        let share = |i: u32| f64::from(noise::uniform(draw, i));
        let inner = (noise::bits(draw, 0) % 4) as u32;
        let all =
            [0.2 * share(1), 1.0 - 0.2 * share(2)].into_iter().chain((0..inner).map(|i| 0.25 + 0.5 * share(3 + i)));
        let mut pins: Vec<usize> = all.map(|at| (at * (side - 1) as f64).round() as usize).collect();
        pins.sort_unstable();
        pins.dedup();
        pins
    }

    /// How its pictures are taken.
    pub fn view(self) -> View {
        match self {
            // it hangs by the corner that is at x = 0, to 1.4 m below and more
            Scene::Hang1 => View { scale: 0.75, shift_m: [0.5, 0.0, 0.0] },
            _ => View { scale: 1.0, shift_m: [0.0; 3] },
        }
    }
}

impl std::fmt::Display for Scene {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}

/// Where a cloth is put in front of the camera, which is the same for all.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Factor on the positions.
    pub scale: f32,
    /// What is added after that, in m.
    pub shift_m: [f32; 3],
}

impl View {
    /// Positions `[particle][3]` in m as the camera has them.
    pub fn of(&self, positions: &[f32]) -> Vec<f32> {
        positions.iter().enumerate().map(|(i, x)| self.scale * x + self.shift_m[i % 3]).collect()
    }
}
