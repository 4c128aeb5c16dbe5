//! A run that was interrupted goes on as if it had not been, and refuses another configuration's folder.

use std::path::Path;
use std::sync::Arc;

use taut_train::data::Scene;
use taut_train::export::{ExportMeta, export};
use taut_train::gan::{
    AdversarialLoss, Checkpoint, Dataset, Reference, Stage, StageSteps, TrainConfig, TrainError, Trainer,
};
use taut_train::image::{RenderConfig, Renderer};
use taut_train::words::WordTable;

/// Two steps of each stage on a tiny cloth.
fn config() -> TrainConfig {
    TrainConfig {
        fabrics: 2,
        evaluation_fabrics: 1,
        steps: StageSteps { matching: 2, positions: 2, adversarial: 2 },
        ..TrainConfig::quick()
    }
}

fn trainer(config: &TrainConfig) -> Trainer {
    let render = RenderConfig { channels: config.picture.clone(), ..RenderConfig::default() };
    let renderer = Arc::new(Renderer::new(render, config.grid, config.grid).expect("a renderer"));
    let words = WordTable::committed().expect("the table that ships");
    let data = Dataset::new(config, words, &ExportMeta::default(), &renderer, |_| ()).expect("a data set");
    Trainer::new(config, data, renderer).expect("a trainer")
}

/// Steps until `end`, with a checkpoint in `folder` if the run is to be cut there.
fn advance(trainer: &mut Trainer, end: usize) {
    while trainer.step < end {
        trainer.advance().expect("a step");
    }
}

fn bytes(trainer: &Trainer) -> Vec<u8> {
    export(trainer.generator(), trainer.data().words(), &ExportMeta::default()).expect("a file")
}

#[test]
fn goes_on_as_if_it_had_not_been_interrupted() {
    let config = config();
    let mut whole = trainer(&config);
    assert_eq!(whole.stage(), Stage::Matching);
    advance(&mut whole, 6);
    let expected = bytes(&whole);
    let mut again = trainer(&config);
    advance(&mut again, 6);
    assert!(bytes(&again) == expected, "two runs of one configuration differ");

    // cut in the middle of each stage
    let folder = tempfile::tempdir().expect("a folder");
    let mut cut = trainer(&config);
    for end in [1, 3, 5] {
        advance(&mut cut, end);
        cut.save(folder.path(), Some((0.5, end))).expect("a checkpoint");
        let state = Checkpoint::read(folder.path()).expect("readable").expect("there");
        assert_eq!((state.step, state.best), (end, Some((0.5, end))));
        cut = trainer(&config);
        cut.resume(folder.path(), &state).expect("resumes");
    }
    advance(&mut cut, 6);
    assert!(bytes(&cut) == expected, "the weights differ from those of the run that was not interrupted");

    // every stage changes the weights
    let mut fewer = trainer(&config);
    advance(&mut fewer, 5);
    assert!(bytes(&fewer) != expected);
    refuses_another_configuration(folder.path(), &config);
}

fn refuses_another_configuration(folder: &Path, config: &TrainConfig) {
    let state = Checkpoint::read(folder).expect("readable").expect("there");
    let other = TrainConfig { alpha: 1.0, ..config.clone() };
    let refused = trainer(&other).resume(folder, &state).expect_err("another configuration");
    assert!(matches!(refused, TrainError::Config(_)), "{refused}");
}

#[test]
fn bad_configurations_are_named() {
    let name = |c: TrainConfig| c.check().expect_err("out of range").to_string();
    let ok = TrainConfig::default();
    assert!(ok.check().is_ok() && TrainConfig::paper().check().is_ok());
    assert!(name(TrainConfig { batch: 1, ..ok.clone() }).contains("batch"));
    assert!(name(TrainConfig { learning_rate: f64::NAN, ..ok.clone() }).contains("learning_rate"));
    assert!(name(TrainConfig { substeps: vec![], ..ok.clone() }).contains("substeps"));
    assert!(name(TrainConfig { grid: 1, ..ok.clone() }).contains("grid"));
    let scenes = |reference, scenes: &[Scene]| TrainConfig { reference, scenes: scenes.to_vec(), ..ok.clone() };
    for bad in [&[][..], &[Scene::Edge, Scene::Edge], &[Scene::Pins], &[Scene::Drape], &[Scene::Hang1]] {
        assert!(name(scenes(Reference::Core, bad)).contains("scenes"));
    }
    assert!(scenes(Reference::Continuum, &[Scene::Pins, Scene::Hang1]).check().is_ok());
    let labels = |labels| TrainConfig { labels, ..ok.clone() };
    assert!(labels([1.0, -1.0, 0.0]).check().is_ok());
    for bad in [[1.0, 1.0, 1.0], [1.0, 0.0, 1.5], [f64::NAN, 0.0, 0.0], [1.0, f64::INFINITY, 1.0]] {
        assert!(name(labels(bad)).contains("labels"), "{bad:?}");
    }
}

/// The continuum cloth in every scene, the held-out fabrics, and the other losses of the paper.
#[test]
fn every_switch_trains() {
    for (adversarial_loss, labels) in
        [(AdversarialLoss::CrossEntropy, [1.0, 0.0, 1.0]), (AdversarialLoss::LeastSquares, [1.0, -1.0, 0.0])]
    {
        let config = TrainConfig {
            reference: Reference::Continuum,
            scenes: vec![Scene::Hang2, Scene::Edge, Scene::Pins, Scene::Hang1],
            held_out: true,
            adversarial_loss,
            labels,
            fabrics: 1,
            evaluation_fabrics: 1,
            steps: StageSteps { matching: 1, positions: 1, adversarial: 1 },
            ..TrainConfig::quick()
        };
        let mut run = trainer(&config);
        let first = bytes(&run);
        advance(&mut run, 3);
        assert!(bytes(&run) != first);
        let score = run.evaluate(None).expect("a score");
        assert_eq!(score.by_scene.len(), 4, "{score:?}");
        let flat = |name: &str| score.by_scene[name];
        assert!(flat("hang2") < 0.1 && flat("edge") < 0.1 && flat("pins") < 0.1, "{score:?}");
        let mean = score.by_scene.values().sum::<f64>() / 4.0;
        assert!((score.nmse - mean).abs() < 1e-12);
    }
}
