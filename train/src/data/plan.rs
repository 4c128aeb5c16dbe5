use serde::{Deserialize, Serialize};
use taut::{Hash64, noise};
use taut_lab::fabric::{Fabric, MODIFIERS, words_of};

use super::{GRID, Scene, fabric};

/// Pictures of one trajectory: the last is at rest.
const FRAMES: usize = 8;

/// How long a cloth moves, in s: until the first swing is over; and in a quick set.
const MOTION_S: f64 = 1.5;
const QUICK_MOTION_S: f64 = 0.3;

/// Trajectories of a part: four fabrics in five scenes.
const PART: usize = 20;

/// What the pictures are for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Split {
    /// To learn from: 4615.
    Training,
    /// To choose the weights by: 1680.
    Evaluation,
    /// To judge by: 1023.
    Test,
    /// To look at, all at rest: 20.
    Comparison,
}

impl Split {
    /// All of them.
    pub const ALL: [Split; 4] = [Split::Training, Split::Evaluation, Split::Test, Split::Comparison];

    /// Its name in files.
    pub fn name(self) -> &'static str {
        match self {
            Split::Training => "training",
            Split::Evaluation => "evaluation",
            Split::Test => "test",
            Split::Comparison => "comparison",
        }
    }

    /// The split that a fabric belongs to, whatever the seed. It follows from the kind and the modifying words alone: all heavy
    /// denims belong to one split, so that neither a piece nor its kind of description is in two.
    pub fn of(fabric: &Fabric, words: &str) -> Split {
        let mut modifying: Vec<String> =
            words_of(words).into_iter().filter(|w| MODIFIERS.iter().any(|m| m.0 == w)).collect();
        modifying.sort_unstable();
        let mut hash = Hash64::new();
        hash.bytes(fabric.kind.as_bytes());
        modifying.iter().for_each(|w| hash.bytes(w.as_bytes()));
        match noise::bits(hash.finish(), 0) % 100 {
            0..60 => Split::Training,
            60..80 => Split::Evaluation,
            80..94 => Split::Test,
            _ => Split::Comparison,
        }
    }

    fn frames(self) -> usize {
        if self == Split::Comparison { 1 } else { FRAMES }
    }
}

/// One cloth in motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Trajectory {
    /// What its pictures are for.
    pub split: Split,
    /// Its number in the split.
    pub number: usize,
    /// What the cloth is made of.
    pub fabric: Fabric,
    /// What it is described as.
    pub words: String,
    /// How it hangs or lies.
    pub scene: Scene,
    /// Seed of its start and pins.
    pub seed: u64,
    /// How long it moves, in s.
    pub motion_s: f64,
    /// How many pictures are taken; the last is at rest.
    pub frames: usize,
}

impl Trajectory {
    /// The pinned particles of the grid of the pictures.
    pub fn pins(&self) -> Vec<usize> {
        self.scene.pins(GRID, self.seed)
    }
}

/// What a set consists of: it follows from the seed alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Plan {
    /// Seed of every choice.
    pub seed: u64,
    /// A set that is made in seconds, for tests and a first look.
    pub quick: bool,
}

impl Plan {
    /// Pictures of a split.
    pub fn images(&self, split: Split) -> usize {
        let [whole, quick] = match split {
            Split::Training => [4615, 40],
            Split::Evaluation => [1680, 9],
            Split::Test => [1023, 9],
            Split::Comparison => [20, 5],
        };
        if self.quick { quick } else { whole }
    }

    /// The trajectories of a split, in order: each fabric in every scene.
    pub fn trajectories(&self, split: Split) -> Vec<Trajectory> {
        let (images, frames) = (self.images(split), split.frames());
        let count = images.div_ceil(frames);
        let fabrics = (0u32..).map(|i| fabric::sample(self.seed, i)).filter(|(f, w)| Split::of(f, w) == split);
        let all = fabrics.flat_map(|(fabric, words)| Scene::ALL.map(|scene| (fabric.clone(), words.clone(), scene)));
        all.take(count)
            .enumerate()
            .map(|(number, (fabric, words, scene))| Trajectory {
                split,
                number,
                fabric,
                words,
                scene,
                seed: noise::bits(self.seed ^ ((split as u64 + 1) << 32), number as u32),
                motion_s: if self.quick { QUICK_MOTION_S } else { MOTION_S },
                frames: frames.min(images - number * frames),
            })
            .collect()
    }

    /// The parts that a split is made and kept in.
    pub fn parts(&self, split: Split) -> Vec<Vec<Trajectory>> {
        self.trajectories(split).chunks(PART).map(<[Trajectory]>::to_vec).collect()
    }
}
