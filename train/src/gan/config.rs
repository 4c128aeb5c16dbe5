use serde::{Deserialize, Serialize};

use super::{AdversarialLoss, Stage, TrainError};
use crate::data::Scene;
use crate::export::ExportMeta;
use crate::image::Channel;
use crate::nets::GeneratorConfig;
use crate::own::OwnFabric;

/// Stiffness of warp, weft, shear and bend where one matrix stands for all: the paper has one number for every spring of a
/// particle. Bend springs have as much as the budget leaves them.
pub const ONE_MATRIX: [f64; 4] = [1.0, 1.0, 1.0, taut::BEND_SHARE as f64];

/// Which cloth is real.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Reference {
    /// The engine itself at the physical stiffness, with as many substeps as that needs.
    Core,
    /// The continuum cloth of [`crate::reference`].
    Continuum,
    /// Each for every other fabric. Springs have one stiffness at every strain, and a knit has not: the core says what the game's
    /// own sheet does with the stiffness that the words mean, the continuum what the fabric does.
    Both,
}

impl Reference {
    /// The cloth that is real for fabric number `index`: the core or the continuum.
    pub fn of(self, index: usize) -> Reference {
        match self {
            Reference::Both if index % 2 == 0 => Reference::Core,
            Reference::Both => Reference::Continuum,
            one => one,
        }
    }
}

/// Steps of each stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StageSteps {
    /// Steps of regression on the field.
    pub matching: usize,
    /// Steps of regression on positions and stretch.
    pub positions: usize,
    /// Steps of the adversarial game.
    pub adversarial: usize,
}

impl StageSteps {
    /// All steps.
    pub fn total(&self) -> usize {
        self.matching + self.positions + self.adversarial
    }

    /// The last stage that has steps.
    pub fn last(&self) -> Stage {
        match (self.positions, self.adversarial) {
            (0, 0) => Stage::Matching,
            (_, 0) => Stage::Positions,
            _ => Stage::Adversarial,
        }
    }
}

/// Everything that a training run depends on beside the word table; saved beside the weights, its digest goes into the
/// generator file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct TrainConfig {
    /// Seed of every random choice.
    pub seed: u64,
    /// Base width of the generator (16: 3.8 million weights).
    pub generator_width: usize,
    /// Whether the words set the level of each family directly (off in the paper).
    pub levels: bool,
    /// Whether one matrix stands for all families, in the ratios [`ONE_MATRIX`], as in the paper; goes without `levels`.
    pub one_matrix: bool,
    /// Whether the generator hears the distance to the pins (off in the paper).
    pub pins: bool,
    /// Whether the cloth has the inertia field, which the budget follows (off in the paper).
    pub inertia: bool,
    /// Base width of the discriminator.
    pub discriminator_width: usize,
    /// Whether the discriminator sees the description (off in the paper).
    pub conditional: bool,
    /// Channels of the pictures.
    pub picture: Vec<Channel>,
    /// Particles along each side of the cloth in training.
    pub grid: usize,
    /// The cloth that is learned from.
    pub reference: Reference,
    /// Scenes that each fabric hangs in. One whose folds bifurcate takes part with its pictures only. The core has hang2, edge
    /// and hang1, the continuum cloth pins too.
    pub scenes: Vec<Scene>,
    /// Whether fabrics that `taut-train data` keeps for evaluation and test are kept out of training ([`crate::data::Split`]).
    pub held_out: bool,
    /// Fabrics of one's own (`taut-train fabric`): a quarter of what the first stage hears, and in the training set of the others.
    pub own: Vec<OwnFabric>,
    /// Fabrics of the training set; each hangs in every scene.
    pub fabrics: usize,
    /// Fabrics of the evaluation set, drawn apart.
    pub evaluation_fabrics: usize,
    /// Batch size; the paper's is 32.
    pub batch: usize,
    /// Steps of the stages.
    pub steps: StageSteps,
    /// Adam's step size at the start of the first stage; it falls geometrically to `matching_end` of it.
    pub matching_rate: f64,
    /// Share of the first stage's step size that is left at its end.
    pub matching_end: f64,
    /// Adam's step size of the others; the paper's is 1e-4.
    pub learning_rate: f64,
    /// Adam's first momentum; the paper's is 0.9.
    pub beta1: f32,
    /// An epoch is this many pictures: the size of the paper's training set.
    pub epoch_pictures: usize,
    /// The step size is halved after this many epochs; the paper's is 3.
    pub halve_every_epochs: usize,
    /// The adversarial loss; the paper's is least squares.
    pub adversarial_loss: AdversarialLoss,
    /// Codes (a, b, c) of least squares (eq. 10 and 11): of real pictures, of generated ones, and what the generator wants them to
    /// be taken for. The paper's eq. 15 and 16 have (1, 0, 1); the condition of eq. 14, a - c = 1 and a - b = 2, has (1, -1, 0).
    pub labels: [f64; 3],
    /// Weight of the adversarial loss (alpha of eq. 21).
    pub alpha: f64,
    /// Weight of the L2 loss (beta of eq. 21).
    pub beta: f64,
    /// phi of eq. 18, which the paper does not give.
    pub phi: f64,
    /// Weight of the paired picture loss; 0 in the paper.
    pub paired: f64,
    /// Weight of the prior that keeps the field near what the words mean, so the ratios of its channels; 0 in the paper.
    pub prior: f64,
    /// Weight of the smoothness beside the field in that prior and in the first stage: of the mean square of what ln(K)
    /// differs more between neighbours than the words say. A spring carries what its neighbour hands on, so one soft
    /// particle in a stiff field is where the cloth stretches. Grows from 0 over the first stage. 0 turns it off.
    pub smoothness: f64,
    /// Weight of the positions in the second stage, per m^2.
    pub position_weight: f64,
    /// Weight of the stretch in the second stage.
    pub stretch_weight: f64,
    /// Share of those two weights that acts in the game; 0 in the paper.
    pub shape: f64,
    /// How much the noise varies ln(K) over a piece of fabric.
    pub variation: f64,
    /// White Gaussian noise on the real pictures as a share of the range, at least and at most: the paper's 1 to 5 %.
    pub picture_noise: [f64; 2],
    /// Substeps of a 60 Hz frame that the cloth is trained at; the last does not clamp most fabrics.
    pub substeps: Vec<u32>,
    /// Largest norm of the gradient of each tensor of the generator; 0 turns it off, as in the paper.
    pub gradient_clip: f32,
    /// Steps between evaluations, checkpoints and picture sheets.
    pub report_every: usize,
}

impl Default for TrainConfig {
    fn default() -> Self {
        TrainConfig {
            seed: 1,
            generator_width: 16,
            levels: true,
            one_matrix: false,
            pins: true,
            inertia: true,
            discriminator_width: 16,
            conditional: true,
            picture: vec![Channel::Checker, Channel::Silhouette],
            grid: 16,
            reference: Reference::Both,
            scenes: vec![Scene::Hang2, Scene::Edge, Scene::Pins, Scene::Hang1],
            held_out: false,
            own: vec![],
            fabrics: 72,
            evaluation_fabrics: 8,
            batch: 32,
            steps: StageSteps { matching: 300, positions: 40, adversarial: 20 },
            matching_rate: 2e-3,
            matching_end: 0.03,
            learning_rate: 1e-4,
            beta1: 0.9,
            epoch_pictures: 4615,
            halve_every_epochs: 3,
            adversarial_loss: AdversarialLoss::LeastSquares,
            labels: [1.0, 0.0, 1.0],
            alpha: 1.5,
            beta: 0.1,
            phi: 1e-3,
            paired: 2.0,
            prior: 2.0,
            smoothness: 0.5,
            position_weight: 1e3,
            stretch_weight: 1e3,
            shape: 0.0,
            variation: 0.12,
            picture_noise: [0.01, 0.05],
            substeps: vec![8, 16, 48],
            gradient_clip: 1.0,
            report_every: 20,
        }
    }
}

impl TrainConfig {
    /// A run of a minute or two that goes through every stage: for tests and for a first look.
    pub fn quick() -> TrainConfig {
        TrainConfig {
            generator_width: 4,
            discriminator_width: 4,
            grid: 8,
            fabrics: 6,
            evaluation_fabrics: 2,
            batch: 4,
            steps: StageSteps { matching: 6, positions: 3, adversarial: 3 },
            report_every: 4,
            ..TrainConfig::default()
        }
    }

    /// The paper's own recipe: one matrix with fixed ratios from words and noise alone, a discriminator that does not see the
    /// words, one step of the cloth without inertia, the losses of eq. 15 to 21 and nothing beside them: no paired term, no
    /// prior, no regression, no clipping.
    pub fn paper() -> TrainConfig {
        let ours = TrainConfig::default();
        TrainConfig {
            levels: false,
            one_matrix: true,
            pins: false,
            inertia: false,
            conditional: false,
            paired: 0.0,
            prior: 0.0,
            smoothness: 0.0,
            substeps: vec![16],
            gradient_clip: 0.0,
            steps: StageSteps { matching: 0, positions: 0, adversarial: ours.steps.total() },
            ..ours
        }
    }

    /// Names the first value that is out of range.
    pub fn check(&self) -> Result<(), TrainError> {
        let must = |good: bool, what: &str| match good {
            true => Ok(()),
            false => Err(TrainError::Config(what.to_string())),
        };
        let share = |x: f64| (0.0..=1e6).contains(&x);
        must((4..=64).contains(&self.grid), "grid must be 4 to 64")?;
        must((1..=4096).contains(&self.fabrics), "fabrics must be 1 to 4096")?;
        must((1..=1024).contains(&self.evaluation_fabrics), "evaluation_fabrics must be 1 to 1024")?;
        let twice = self.scenes.iter().enumerate().any(|(i, s)| self.scenes[..i].contains(s));
        must(!self.scenes.is_empty() && !twice, "scenes must name one scene or more, none twice")?;
        for scene in &self.scenes {
            must(*scene != Scene::Drape, "scenes: the cloth of training has no ball, so drape is not one of them")?;
            let known = self.reference != Reference::Core || *scene != Scene::Pins;
            must(known, "scenes: pins is for the continuum cloth")?;
        }
        for fabric in &self.own {
            fabric.check().map_err(|e| TrainError::Config(format!("own: {e}")))?;
        }
        let flat = self.scenes.iter().any(|s| !s.folds());
        must(flat || self.steps.positions == 0, "scenes: positions need one of hang2, edge, pins")?;
        let folds = self.scenes.iter().any(|s| s.folds());
        must(!folds || self.shape == 0.0, "scenes: shape needs scenes whose folds do not bifurcate")?;
        let [a, b, c] = self.labels;
        must(self.labels.iter().all(|l| l.abs() <= 10.0) && a != b, "labels must be -10 to 10, and a not b")?;
        must(a.min(b) <= c && c <= a.max(b), "labels: c must lie between a and b, where ratings lie")?;
        must((2..=1024).contains(&self.batch), "batch must be 2 to 1024: batch normalisation needs two")?;
        must((1..=10_000_000).contains(&self.steps.total()), "steps must be 1 to 10 million in all")?;
        for (rate, name) in [(self.matching_rate, "matching_rate"), (self.learning_rate, "learning_rate")] {
            must(rate > 0.0 && rate <= 1.0, &format!("{name} must be above 0 and at most 1"))?;
        }
        must(self.matching_end > 0.0 && self.matching_end <= 1.0, "matching_end must be above 0 and at most 1")?;
        must((0.0..1.0).contains(&self.beta1), "beta1 must be 0 to below 1")?;
        must(self.epoch_pictures > 0 && self.halve_every_epochs > 0, "epochs must not be empty")?;
        must(
            [self.alpha, self.beta, self.phi, self.paired, self.prior].into_iter().all(share)
                && share(self.position_weight)
                && share(self.stretch_weight)
                && share(self.shape)
                && share(self.smoothness),
            "weights of losses must be 0 to 1e6",
        )?;
        must((0.0..=1.0).contains(&self.variation), "variation must be 0 to 1")?;
        must(
            !self.substeps.is_empty() && self.substeps.iter().all(|s| (1..=1024).contains(s)),
            "substeps must be a list of numbers from 1 to 1024",
        )?;
        must(!self.picture.is_empty() && self.picture.len() <= 3, "picture must have 1 to 3 channels")?;
        must(self.gradient_clip >= 0.0, "gradient_clip must be 0 or more")?;
        must(!(self.one_matrix && self.levels), "one_matrix goes without levels")?;
        must(self.report_every > 0, "report_every must be above 0")
    }

    /// The generator.
    pub fn generator(&self) -> GeneratorConfig {
        let TrainConfig { generator_width: width, levels, one_matrix, pins, .. } = *self;
        GeneratorConfig { width, levels, one_matrix, pins }
    }

    /// What the generator file says of itself. One matrix has the same range for all families but for their ratios, so that
    /// the same number decodes to stiffnesses in these ratios.
    pub fn meta(&self) -> Result<ExportMeta, TrainError> {
        let mut meta = ExportMeta { training_digest: self.digest()?, ..ExportMeta::default() };
        if self.one_matrix {
            let [(low, high), ..] = meta.channel_ranges_n_per_m;
            meta.channel_ranges_n_per_m = ONE_MATRIX.map(|ratio| (ratio * low, ratio * high));
        }
        Ok(meta)
    }

    /// Digest of the configuration in hexadecimal.
    pub fn digest(&self) -> Result<String, TrainError> {
        let text = serde_json::to_string(self).map_err(TrainError::part)?;
        let mut h = taut::Hash64::new();
        h.bytes(text.as_bytes());
        Ok(format!("{:016x}", h.finish()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_papers_recipe_has_nothing_of_ours() {
        let p = TrainConfig::paper();
        assert!(p.check().is_ok());
        assert!(p.one_matrix && !(p.levels || p.pins || p.inertia || p.conditional));
        assert_eq!([p.paired, p.prior, p.shape, p.smoothness], [0.0; 4]);
        assert_eq!((p.steps.matching, p.steps.positions, p.gradient_clip), (0, 0, 0.0));
        assert_eq!((p.alpha, p.beta, p.learning_rate, p.beta1, p.batch), (1.5, 0.1, 1e-4, 0.9, 32));
        // one number, four stiffnesses in fixed ratios
        for (range, ratio) in p.meta().unwrap().channel_ranges_n_per_m.iter().zip(ONE_MATRIX) {
            assert!((range.0 / (5.0 * ratio) - 1.0).abs() < 1e-12 && (range.1 / (2e4 * ratio) - 1.0).abs() < 1e-12);
        }
        assert!(TrainConfig { levels: true, ..p }.check().is_err());
    }

    #[test]
    fn the_last_stage_is_the_last_that_has_steps() {
        let last = |matching, positions, adversarial| StageSteps { matching, positions, adversarial }.last();
        assert_eq!(last(0, 0, 3), Stage::Adversarial);
        assert_eq!(last(5, 4, 3), Stage::Adversarial);
        assert_eq!(last(5, 4, 0), Stage::Positions);
        assert_eq!(last(5, 0, 0), Stage::Matching);
    }
}
