//! Fabrics that no net has seen, and how they hang.

use std::path::Path;
use std::sync::Arc;

use burn::Tensor;
use burn::tensor::{Device, TensorData};
use taut_lab::compare::{self, Case, Setting};
use taut_lab::fabric::{self, Fabric, KINDS};
use taut_lab::scene::Scene;

use super::EvaluateError;
use super::net::Net;
use super::score::Scores;
use crate::cloth::{Springs, equilibrium};
use crate::data::{self, Sample, Split};
use crate::gan::{TrainConfig, hanging};
use crate::image::Renderer;
use crate::nets::init::SplitMix64;
use crate::nets::{CHANNELS, GRID};

/// Seed of the test fabrics; training and evaluation draw by others.
const SEED: u64 = 0x7465_7374;

/// Scenes whose folds do not bifurcate.
pub const SCENES: [Scene; 2] = [Scene::Hang2, Scene::Edge];

/// Seconds after which a cloth is at rest.
pub const SECONDS: f32 = 5.0;

/// A fabric with its words.
#[derive(Clone, Debug, PartialEq)]
pub struct Held {
    /// Its constants.
    pub fabric: Fabric,
    /// What it is described as.
    pub words: String,
}

/// The first `count` test fabrics: every kind once, then every kind once more and so on.
pub fn fabrics(count: usize) -> Vec<Held> {
    let mut rounds = vec![0usize; KINDS.len()];
    let mut out = Vec::new();
    for (fabric, words) in (0..).map(|i| fabric::sample(SEED, i)) {
        if out.len() == count {
            break;
        }
        let kind = KINDS.iter().position(|k| k.name == fabric.kind).unwrap_or(0);
        if rounds[kind] <= out.len() / KINDS.len() {
            rounds[kind] += 1;
            out.push(Held { fabric, words });
        }
    }
    out
}

/// A case of a held fabric.
pub fn case(scene: Scene, fabric: &Fabric, side: usize, substeps: u32) -> Case {
    Case::square(scene, fabric, side as u32, substeps, SECONDS)
}

/// A picture that a net is asked for.
pub struct Item {
    /// What hangs.
    pub held: Held,
    /// Pinned particles of the cloth.
    pins: Vec<usize>,
    /// The clean picture of the reference.
    pub picture: Vec<f32>,
    /// The reference at rest, `[particle][axis]` in m.
    positions: Vec<f32>,
}

/// Test pictures of the size of cloth that nets are trained on.
pub struct TestSet {
    /// The pictures.
    pub items: Vec<Item>,
    renderer: Arc<Renderer>,
    grid: usize,
    substeps: u32,
}

impl TestSet {
    /// The first `count` fabrics, each in both scenes, on the grid and the step of a configuration.
    pub fn new(config: &TrainConfig, renderer: Arc<Renderer>, count: usize) -> Result<TestSet, EvaluateError> {
        let grid = config.grid;
        // the middle of the substeps: a game's step
        let substeps = config.substeps[config.substeps.len() / 2];
        let mut items = Vec::new();
        for held in fabrics(count) {
            for scene in SCENES {
                let setting = Setting::Reference(held.fabric.clone());
                let outcome = compare::run(&case(scene, &held.fabric, grid, substeps), &setting, |_| ());
                let positions = outcome.map_err(EvaluateError::part)?.positions.into_flattened();
                let picture = renderer.render(&positions).map_err(EvaluateError::part)?;
                items.push(Item { held: held.clone(), pins: scene.pins(grid, grid), picture, positions });
            }
        }
        Ok(TestSet { items, renderer, grid, substeps })
    }

    /// `count` pictures of the test split of a data set, drawn from those at rest in scenes whose folds do not bifurcate. The
    /// grid of a configuration must be that of the data.
    pub fn load(
        folder: &Path,
        config: &TrainConfig,
        renderer: Arc<Renderer>,
        count: usize,
    ) -> Result<TestSet, EvaluateError> {
        if config.grid != data::GRID {
            return Err(EvaluateError::Part(format!("the data are of {0} x {0} particles", data::GRID)));
        }
        let all = data::load(folder, Split::Test).map_err(EvaluateError::part)?;
        let mut fit: Vec<Sample> = all.into_iter().filter(|s| s.at_rest && !s.scene.folds()).collect();
        if fit.len() < count {
            let folder = folder.display();
            return Err(EvaluateError::Part(format!("{folder}: {} test pictures at rest, not {count}", fit.len())));
        }
        let mut stream = SplitMix64::new(SEED);
        for i in 0..count {
            let other = i + (stream.next_u64() % (fit.len() - i) as u64) as usize;
            fit.swap(i, other);
        }
        let item = |s: Sample| Item {
            picture: s.picture(&config.picture),
            held: Held { fabric: s.fabric, words: s.words },
            pins: s.pins,
            positions: s.positions,
        };
        let items = fit.into_iter().take(count).map(item).collect();
        let substeps = config.substeps[config.substeps.len() / 2];
        Ok(TestSet { items, renderer, grid: config.grid, substeps })
    }

    /// Scores of what a net makes of the words of each picture.
    pub fn scores(&self, net: &Net, inertia: bool) -> Result<Vec<Scores>, EvaluateError> {
        self.scores_of(inertia, |i, item| {
            // the same places on the net's own grid
            let place = |i: usize| ((i * (GRID - 1)) as f64 / (self.grid - 1) as f64).round() as usize;
            let pin = |p: &usize| place(p / self.grid) * GRID + place(p % self.grid);
            // a row that is pinned whole is pinned whole there
            let pins: Vec<usize> = match item.pins.len() {
                n if n == self.grid => (0..GRID).collect(),
                _ => item.pins.iter().map(pin).collect(),
            };
            Ok(net.tell(&item.held.words, &pins, i as u64)?.on(self.grid, self.grid))
        })
    }

    /// Scores of a cloth as stiff as the step allows.
    pub fn uniform(&self, inertia: bool) -> Result<Vec<Scores>, EvaluateError> {
        self.scores_of(inertia, |_, _| Ok(vec![compare::BEYOND; CHANNELS * self.grid * self.grid]))
    }

    /// Scores of the shapes at rest of fields in N/m.
    fn scores_of(
        &self,
        inertia: bool,
        field: impl Fn(usize, &Item) -> Result<Vec<f32>, EvaluateError>,
    ) -> Result<Vec<Scores>, EvaluateError> {
        let g = self.grid;
        let springs = Arc::new(Springs::new(g, g, 1.0, 1.0).map_err(EvaluateError::part)?);
        let one = |(i, item): (usize, &Item)| {
            let cloth = hanging(&springs, &item.held.fabric, (self.substeps, inertia), &item.pins, &item.positions);
            let mut cloth = cloth.map_err(EvaluateError::part)?;
            let field = TensorData::new(field(i, item)?, [1, CHANNELS, g, g]);
            let x = equilibrium(Tensor::from_data(field, &Device::flex()), std::slice::from_mut(&mut cloth));
            let x = x.map_err(EvaluateError::part)?.into_data().try_into_vec::<f32>();
            let x = x.map_err(|e| EvaluateError::Part(format!("{e:?}")))?;
            Scores::of(&item.picture, &self.renderer.render(&x).map_err(EvaluateError::part)?)
        };
        self.items.iter().enumerate().map(one).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gan::renderer;
    use std::collections::BTreeSet;

    #[test]
    fn test_fabrics_are_of_every_kind_and_of_no_other_set() {
        let all = fabrics(20);
        let kinds: BTreeSet<&str> = all[..KINDS.len()].iter().map(|h| h.fabric.kind).collect();
        assert_eq!((all.len(), kinds.len()), (20, KINDS.len()));
        assert_eq!(fabrics(5), all[..5]);
        // the seeds of a run: its own, that of its evaluation set, that of the stream of its first stage
        for seed in [1, 1 ^ 0x6576_616c, 1 ^ 0x7374_7265] {
            let seen: Vec<Fabric> = (0..5000).map(|i| fabric::sample(seed, i).0).collect();
            assert!(all.iter().all(|h| !seen.contains(&h.fabric)));
        }
    }

    #[test]
    fn pictures_of_a_data_set_need_the_data() {
        let home = tempfile::tempdir().unwrap();
        let load = |grid| {
            let config = TrainConfig { grid, ..TrainConfig::quick() };
            let error = TestSet::load(home.path(), &config, Arc::new(renderer(&config).unwrap()), 4).err();
            error.expect("no data").to_string()
        };
        assert!(load(8).contains("16 x 16"));
        assert!(load(16).contains("data.json"));
    }

    #[test]
    fn a_cloth_as_stiff_as_allowed_does_not_hang_like_a_jersey() {
        let config = TrainConfig { grid: 8, ..TrainConfig::quick() };
        let renderer = Arc::new(renderer(&config).unwrap());
        let mut set = TestSet::new(&config, renderer, 4).unwrap();
        assert_eq!(set.items.len(), 8);
        // a knit in hang2, whose own springs fit the step of this coarse grid
        set.items.retain(|i| i.held.fabric.kind == "rib knit" && i.pins.len() == 2);
        let uniform = set.uniform(true).unwrap();
        let own = set.scores_of(true, |_, i| Ok(i.held.fabric.stiffness.iter().flat_map(|k| [*k; 64]).collect()));
        let own = own.unwrap();
        assert_eq!((uniform.len(), own.len()), (1, 1));
        assert!(own[0].nmse < 0.1 * uniform[0].nmse && uniform[0].nmse < 0.5, "{own:?} {uniform:?}");
    }
}
