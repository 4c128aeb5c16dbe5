//! Fig. 9: the cloth with K from data, from a formula and from both GANs, and beside them what a game has.

use serde::{Deserialize, Serialize};
use taut_lab::compare::{self, Case, Limits, Model, Outcome, Setting};
use taut_lab::fabric::Fabric;
use taut_lab::front::{FABRICS, fit};
use taut_lab::picture::{Grid, Panel, Sheet, encode_png};
use taut_lab::scene::Scene;

use super::held::{SCENES, case};
use super::ladder::{self, small};
use super::net::Net;
use super::score::Scores;
use super::table::{number, table};
use super::{Bench, EvaluateError};
use crate::gan::{StageSteps, TrainConfig, write_whole};
use crate::image::{RenderConfig, Renderer};
use crate::nets::GRID;

/// Particles of a side, and substeps of a frame of 60 Hz.
const SIDE: usize = 32;
const SUBSTEPS: u32 = 16;

/// The picture.
pub const PICTURE: &str = "figure-9.png";

/// One choice of K in a scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Choice {
    /// Its name.
    pub name: String,
    /// Largest structural stretch in percent.
    pub stretch_max_pct: f64,
    /// 99th percentile.
    pub stretch_p99_pct: f64,
    /// Mean.
    pub stretch_mean_pct: f64,
    /// Picture against the reference's; none of the reference itself.
    pub scores: Option<Scores>,
    /// Whether it stayed finite.
    pub finite: bool,
}

/// All choices for a fabric in a scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// In words.
    pub fabric: String,
    /// The scene.
    pub scene: String,
    /// The reference first.
    pub choices: Vec<Choice>,
}

/// The paper's recipe at the size of the other nets.
pub fn paper(steps: usize, quick: bool) -> TrainConfig {
    TrainConfig {
        steps: StageSteps { matching: 0, positions: 0, adversarial: steps },
        report_every: steps.div_ceil(2).max(1),
        ..small(TrainConfig::paper(), quick)
    }
}

/// K by the formula of Van Gelder 1998, k = E h sum(A)/|c|^2 over the triangles of an edge, for a grid with both diagonals: two
/// triangulations over one another, each with half of the sheet. A structural edge then has E h of its direction, a diagonal
/// a quarter of the mean. E h is the tension over strain of a strip, C - C12^2/C'; with springs C12 is the shear.
pub fn van_gelder(fabric: &Fabric) -> [f32; 4] {
    let [warp, weft, shear, bend] = fabric.stiffness;
    let [c22, c11] = [warp, weft].map(|k| k + shear + 4.0 * bend);
    let (along_v, along_u) = (c22 - shear * shear / c11, c11 - shear * shear / c22);
    [along_v, along_u, 0.125 * (along_v + along_u), taut::BEND_SHARE * 0.5 * (along_v + along_u)]
}

/// Runs all choices. None stands for what another shard has.
pub fn rows(bench: &mut Bench<'_>) -> Result<Vec<Option<Row>>, EvaluateError> {
    let quick = bench.quick;
    let config = paper(ladder::steps(bench.minutes, quick), quick);
    let fabrics = if quick { &FABRICS[..1] } else { &FABRICS };
    let jobs: Vec<(&str, Scene)> = fabrics.iter().flat_map(|f| SCENES.map(|s| (*f, s))).collect();
    let made_with = (&config, bench.model_digest()?);
    bench.rows(
        "9",
        &made_with,
        &jobs,
        |(fabric, scene)| format!("{fabric}, {scene}"),
        |bench, (words, scene)| {
            let nets = [bench.net(&config, "the paper's GAN")?, Net::load(&bench.model)?];
            let fabric = named(words)?;
            let side = if quick { 12 } else { SIDE };
            let (choices, outcomes) = choices(&fabric, words, *scene, side, &nets)?;
            // the picture is of the first fabric in the first scene
            if (*words, *scene) == (FABRICS[0], SCENES[0]) {
                let png = picture(words, *scene, side, &choices, &outcomes)?;
                write_whole(&bench.out.join(PICTURE), &png)?;
            }
            Ok(Row { fabric: words.to_string(), scene: scene.to_string(), choices })
        },
    )
}

fn named(words: &str) -> Result<Fabric, EvaluateError> {
    Fabric::named(words).ok_or_else(|| EvaluateError::Part(format!("`{words}` names no fabric")))
}

fn choices(
    fabric: &Fabric,
    words: &str,
    scene: Scene,
    side: usize,
    [paper, ours]: &[Net; 2],
) -> Result<(Vec<Choice>, Vec<Outcome>), EvaluateError> {
    let case = case(scene, fabric, side, SUBSTEPS);
    let pins = scene.pins(GRID, GRID);
    let told = ours.tell(words, &pins, 0)?;
    let field = told.on(side, side);
    let tethered = Model { limits: Limits::Tethers(0.0), ..Setting::Uniform.into() };
    let models: [(&str, Model); 9] = [
        ("reference", Setting::Reference(fabric.clone()).into()),
        ("data driven", Setting::DataDriven(fitted(fabric, side)?).into()),
        ("analytic (Van Gelder)", Setting::DataDriven(van_gelder(fabric)).into()),
        ("the paper's GAN", Setting::GeneratedAlone(paper.tell(words, &pins, 0)?.on(side, side)).into()),
        ("our GAN", Setting::Generated(field.clone()).into()),
        ("our GAN, its limits", Model::limited(Setting::Generated(field), told.limits)),
        ("uniform at the budget", Setting::Uniform.into()),
        ("1/r with inertia", Setting::UniformInertia.into()),
        ("uniform, tethers", tethered),
    ];
    let render = RenderConfig { channels: TrainConfig::default().picture, ..RenderConfig::default() };
    let renderer = Renderer::new(render, side, side).map_err(EvaluateError::part)?;
    let (mut choices, mut outcomes) = (Vec::new(), Vec::<Outcome>::new());
    let mut reference: Option<Vec<f32>> = None;
    for (name, model) in models {
        let outcome = run(&case, &model)?;
        let picture = match outcome.finite {
            true => Some(renderer.render(outcome.positions.as_flattened()).map_err(EvaluateError::part)?),
            false => None,
        };
        let scores = match (&reference, &picture) {
            (Some(reference), Some(picture)) => Some(Scores::of(reference, picture)?),
            _ => None,
        };
        reference = reference.or(picture);
        let s = outcome.stretch_pct;
        choices.push(Choice {
            name: name.into(),
            stretch_max_pct: s.max,
            stretch_p99_pct: s.p99,
            stretch_mean_pct: s.mean,
            scores,
            finite: outcome.finite,
        });
        outcomes.push(outcome);
    }
    Ok((choices, outcomes))
}

fn run(case: &Case, model: &Model) -> Result<Outcome, EvaluateError> {
    compare::run_model(case, model, |_, _| ()).map_err(EvaluateError::part)
}

/// Three numbers for the whole sheet that come nearest to the reference's strains in both scenes, in the least-squares sense
/// (Lloyd's first class).
fn fitted(fabric: &Fabric, side: usize) -> Result<[f32; 4], EvaluateError> {
    let goals = SCENES.map(|scene| {
        let case = case(scene, fabric, side, SUBSTEPS);
        let outcome = compare::run(&case, &Setting::Reference(fabric.clone()), |_| ())?;
        let goal = fit::strains(&case, &outcome.positions);
        Ok((case, goal))
    });
    let goals = goals.into_iter().collect::<Result<Vec<_>, taut::Error>>();
    goals.and_then(|goals| fit::to_strains(fabric, &goals)).map_err(EvaluateError::part)
}

fn picture(
    words: &str,
    scene: Scene,
    side: usize,
    choices: &[Choice],
    outcomes: &[Outcome],
) -> Result<Vec<u8>, EvaluateError> {
    let setup = format!("{scene}, {side} x {side}, 60 Hz x {SUBSTEPS}; dashed: the reference");
    let mut sheet = Sheet::new(format!("{words}: Fig. 9 of the paper, and its rivals")).subtitle(setup).outline_of(0);
    for (choice, outcome) in choices.iter().zip(outcomes) {
        let grid =
            Grid::new(&outcome.positions, side, side, 1.0, 1.0).and_then(|g| g.with_pins(&scene.pins(side, side)));
        let nmse = choice.scores.map_or("-".into(), |s| number(s.nmse, 3));
        sheet = sheet.panel(
            Panel::new(choice.name.clone(), grid.map_err(EvaluateError::part)?)
                .line(format!("max {} %", number(choice.stretch_max_pct, 1)))
                .line(format!("mean {} %", number(choice.stretch_mean_pct, 2)))
                .line(format!("NMSE {nmse}")),
        );
    }
    let image = sheet.render().map_err(EvaluateError::part)?;
    encode_png(&image).map_err(EvaluateError::part)
}

/// One table for each scene: largest / p99 / mean stretch in percent and NMSE for each fabric.
pub fn text(rows: &[&Row]) -> String {
    let mut out = String::new();
    for scene in SCENES {
        let of: Vec<&&Row> = rows.iter().filter(|r| r.scene == scene.name()).collect();
        let Some(first) = of.first() else { continue };
        let cell = |c: &Choice| {
            let nmse = c.scores.map_or("-".into(), |s| number(s.nmse, 4));
            let [max, mean] = [number(c.stretch_max_pct, 1), number(c.stretch_mean_pct, 2)];
            format!("{max} / {} / {mean}; {nmse}", number(c.stretch_p99_pct, 1))
        };
        let line = |i: usize| {
            let cells = of.iter().filter_map(|r| r.choices.get(i)).map(cell);
            std::iter::once(first.choices[i].name.clone()).chain(cells).collect::<Vec<_>>()
        };
        let lines: Vec<Vec<String>> = (0..first.choices.len()).map(line).collect();
        let mut header = vec![scene.name()];
        header.extend(of.iter().map(|r| r.fabric.as_str()));
        out.push_str(&table(&header, &lines));
        out.push('\n');
    }
    out.trim_end().to_string() + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn van_gelder_of_an_isotropic_sheet_is_the_formula() {
        // no shear: every direction has its own modulus
        let fabric = |stiffness| Fabric { stiffness, ..Fabric::named("denim").unwrap() };
        let [warp, weft, shear, bend] = van_gelder(&fabric([800.0, 400.0, 0.0, 0.0]));
        assert_eq!([warp, weft, shear], [800.0, 400.0, 150.0]);
        assert!((bend - 12.0).abs() < 1e-4);
        // an isotropic lattice: C11 = 3/4 + 3/8 of E h, Poisson ratio 1/3
        let [warp, weft, shear, _] = van_gelder(&fabric([750.0, 750.0, 375.0, 0.0]));
        assert!((warp - 1000.0).abs() < 1e-3 && warp == weft && (shear - 250.0).abs() < 1e-3);
    }

    #[test]
    fn the_papers_net_is_small_and_still_the_papers() {
        let (config, theirs) = (paper(40, false), TrainConfig::paper());
        assert!(config.check().is_ok() && config.steps.adversarial == 40 && config.steps.total() == 40);
        assert!(config.one_matrix && !config.inertia && !config.pins && !config.conditional && !config.levels);
        assert_eq!((config.alpha, config.beta, config.paired, config.prior), (theirs.alpha, theirs.beta, 0.0, 0.0));
        assert_eq!(config.substeps, theirs.substeps);
    }
}
