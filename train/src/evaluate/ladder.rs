//! Fig. 8's ladder: configurations that differ from the one before by one term each.

use crate::data::Scene;
use crate::gan::{AdversarialLoss, Reference, StageSteps, TrainConfig};

/// What a rung is, and what it adds to the one below.
#[derive(Clone, Debug, PartialEq)]
pub struct Rung {
    /// Name in tables.
    pub name: &'static str,
    /// The configuration, for seed 1.
    pub config: TrainConfig,
}

/// A recipe at the size of the nets and of the cloth that the figures share: small enough that a net is trained in minutes. The step size
/// is ten times the paper's: a few hundred steps at the paper's would leave the first weights as they were.
pub fn small(recipe: TrainConfig, quick: bool) -> TrainConfig {
    let (grid, width, batch, fabrics) = if quick { (8, 2, 2, 2) } else { (16, 8, 8, 48) };
    TrainConfig {
        grid,
        // the core's own reference, whose fabrics take seconds, where no fold bifurcates
        reference: Reference::Core,
        scenes: vec![Scene::Hang2, Scene::Edge],
        held_out: false,
        generator_width: width,
        discriminator_width: width,
        batch,
        fabrics,
        evaluation_fabrics: if quick { 1 } else { 4 },
        learning_rate: 1e-3,
        ..recipe
    }
}

/// Steps of such a net in a minute of one core: a number, so that no figure depends on the machine.
const STEPS_PER_MINUTE: f64 = 60.0;

/// Steps of a net in so many minutes.
pub fn steps(minutes: f64, quick: bool) -> usize {
    if quick { 2 } else { (minutes * STEPS_PER_MINUTE).round().max(1.0) as usize }
}

/// The rungs from the game alone upwards, the first with cross entropy and the others with least squares, each trained for `steps` of the game and nothing before it.
pub fn rungs(steps: usize, quick: bool) -> Vec<Rung> {
    let ours = small(TrainConfig::default(), quick);
    let bare = TrainConfig {
        conditional: false,
        beta: 0.0,
        paired: 0.0,
        prior: 0.0,
        shape: 0.0,
        steps: StageSteps { matching: 0, positions: 0, adversarial: steps },
        report_every: steps.div_ceil(2).max(1),
        ..ours.clone()
    };
    let entropy = TrainConfig { adversarial_loss: AdversarialLoss::CrossEntropy, ..bare };
    let mut rungs = vec![Rung { name: "cross entropy", config: entropy }];
    type Add = fn(&mut TrainConfig, &TrainConfig);
    let adds: [(&'static str, Add); 6] = [
        ("least squares", |c, ours| c.adversarial_loss = ours.adversarial_loss),
        ("+ L2", |c, ours| c.beta = ours.beta),
        ("+ words seen", |c, ours| c.conditional = ours.conditional),
        ("+ paired pictures", |c, ours| c.paired = ours.paired),
        ("+ prior", |c, ours| c.prior = ours.prior),
        ("+ positions", |c, _| c.shape = 1.0),
    ];
    for (name, add) in adds {
        let mut config = rungs[rungs.len() - 1].config.clone();
        add(&mut config, &ours);
        rungs.push(Rung { name, config });
    }
    rungs
}

/// The configurations of Fig. 7: the whole ladder with this much noise on both sides' pictures.
pub fn noisy(percent: u32, steps: usize, quick: bool) -> TrainConfig {
    let mut rungs = rungs(steps, quick);
    let top = rungs.swap_remove(rungs.len() - 1).config;
    TrainConfig { picture_noise: [0.01 * f64::from(percent); 2], ..top }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The settings in which two configurations differ.
    fn differences(a: &TrainConfig, b: &TrainConfig) -> Vec<String> {
        let [a, b] = [a, b].map(|c| serde_json::to_value(c).unwrap());
        let a = a.as_object().unwrap();
        a.iter().filter(|(key, value)| b[key.as_str()] != **value).map(|(key, _)| key.clone()).collect()
    }

    #[test]
    fn every_rung_differs_from_the_one_below_by_one_term() {
        for quick in [false, true] {
            let rungs = rungs(100, quick);
            let expected = ["adversarial_loss", "beta", "conditional", "paired", "prior", "shape"];
            assert_eq!(rungs.len(), 1 + expected.len());
            for (pair, expected) in rungs.windows(2).zip(expected) {
                assert_eq!(differences(&pair[0].config, &pair[1].config), [expected]);
            }
            assert!(rungs.iter().all(|r| r.config.check().is_ok()));
            let first = &rungs[0].config;
            assert_eq!([first.beta, first.paired, first.prior, first.shape], [0.0; 4]);
            assert!(first.alpha > 0.0 && !first.conditional);
        }
    }

    #[test]
    fn noise_is_all_that_differs_in_fig_7() {
        let nets: Vec<TrainConfig> = (1..=6).map(|p| noisy(p, 9, false)).collect();
        for net in &nets[1..] {
            assert_eq!(differences(&nets[0], net), ["picture_noise"]);
        }
        assert!(
            (nets[5].picture_noise[0] - 0.06).abs() < 1e-12 && nets[5].picture_noise[0] == nets[5].picture_noise[1]
        );
    }
}
