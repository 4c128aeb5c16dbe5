//! Fabrics that no net has seen: the generated correction with its own limits against the best analytic choices with the same
//! inertia and the same levels, one limit for all fabrics, and against itself with the words of another fabric.

use serde::{Deserialize, Serialize};
use taut_lab::against::{Comparison, Mesh, Reference, Stage};
use taut_lab::compare::{self, Model, Setting};
use taut_lab::scene::Scene;

use super::held::{Held, SCENES, case, fabrics};
use super::net::Net;
use super::shuffle::derangement;
use super::table::{number, table};
use super::{Bench, EvaluateError};
use crate::nets::GRID;

/// How many fabrics.
const FABRICS: usize = 6;

/// The limits that the analytic choices are given, for all fabrics alike.
const SLACKS: [f32; 2] = [0.02, 0.05];

/// Where the cloth is compared: particles of a side, substeps of a frame. The first is the scene's own.
const PLACES: [(usize, u32); 6] = [(33, 16), (16, 16), (64, 16), (33, 8), (33, 32), (33, 48)];

/// Vertices of a side of the mesh on which both cloths are measured, and particles of the reference; and in a quick run.
const MESH: usize = 33;
const QUICK_MESH: usize = 13;

/// Seed of the order in which words are handed on.
const SHUFFLE: u64 = 5;

/// One correction of one fabric in one scene at one place.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Choice {
    /// Its name.
    pub name: String,
    /// Mean strain away from the pins, along u, v and the diagonal, in percent: of the cloth and of its reference.
    pub ex_pin_mean_pct: [[f64; 2]; 3],
    /// NMSE of the silhouettes.
    pub silhouette_nmse: f64,
    /// Distance in percent of the side.
    pub distance_pct: f64,
    /// Share of the field that the budget took, 0 to 1.
    pub cut_fraction: f64,
    /// Whether it stayed finite.
    pub finite: bool,
}

/// All corrections of one fabric in one scene at one place.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Words of the fabric.
    pub words: String,
    /// Words that the shuffled generator heard.
    pub shuffled_words: String,
    /// Scene.
    pub scene: String,
    /// Particles of a side.
    pub side: usize,
    /// Substeps of a frame of 60 Hz.
    pub substeps: u32,
    /// What was compared.
    pub choices: Vec<Choice>,
}

/// Mean errors of a correction over fabrics, scenes and places.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Mean {
    /// Its name.
    pub name: String,
    /// Sum of the absolute differences of the mean strains over the sum of the reference's, along u, v and the diagonal.
    pub strain_error_relative: [f64; 3],
    /// NMSE of the silhouettes.
    pub silhouette_nmse: f64,
    /// Distance in percent of the side.
    pub distance_pct: f64,
    /// Runs that did not stay finite; they are not in the means.
    pub not_finite: usize,
}

struct Job {
    held: Held,
    heard: String,
    scene: Scene,
    side: usize,
    substeps: u32,
}

fn jobs(quick: bool) -> Vec<Job> {
    let held = fabrics(if quick { 2 } else { FABRICS });
    let order = derangement(held.len(), SHUFFLE);
    let places = if quick { &[(12, 8)] } else { &PLACES[..] };
    let mut jobs = Vec::new();
    for &(side, substeps) in places {
        for (h, other) in held.iter().zip(&order) {
            for scene in SCENES {
                jobs.push(Job { held: h.clone(), heard: held[*other].words.clone(), scene, side, substeps });
            }
        }
    }
    jobs
}

/// Runs all. None stands for what another shard has.
pub fn rows(bench: &mut Bench<'_>) -> Result<Vec<Option<Row>>, EvaluateError> {
    let net = Net::load(&bench.model)?;
    let made_with = (bench.model_digest()?, SLACKS, super::held::SECONDS);
    bench.rows(
        "unseen",
        &made_with,
        &jobs(bench.quick),
        |j| format!("{}, {}, {} x {}", j.held.words, j.scene, j.side, j.substeps),
        |bench, job| measure(job, &net, if bench.quick { QUICK_MESH } else { MESH }),
    )
}

fn measure(job: &Job, net: &Net, vertices: usize) -> Result<Row, EvaluateError> {
    let (fabric, scene) = (&job.held.fabric, job.scene);
    let stage = Stage::named(scene.name()).map_err(EvaluateError::part)?;
    let mesh = Mesh::square(vertices);
    let run = |side: usize, model: &Model| {
        compare::run_model(&case(scene, fabric, side, job.substeps), model, |_, _| ()).map_err(EvaluateError::part)
    };
    let truth = run(vertices, &Setting::Reference(fabric.clone()).into())?;
    let reference = Reference::of_grid(&mesh, stage, &truth.positions, vertices, vertices);
    let pins = scene.pins(GRID, GRID);
    let told = net.tell(&job.held.words, &pins, 0)?;
    let wrong = net.tell(&job.heard, &pins, 0)?;
    let field = told.on(job.side, job.side);
    let mut models = vec![
        ("generated".to_string(), Setting::Generated(field.clone()).into()),
        ("generated, its limits".into(), Model::limited(Setting::Generated(field.clone()), told.limits)),
        ("generated, limits where cut".into(), Model::limited_where_cut(Setting::Generated(field), told.limits)),
        (
            "generated, shuffled words".into(),
            Model::limited_where_cut(Setting::Generated(wrong.on(job.side, job.side)), wrong.limits),
        ),
    ];
    for slack in SLACKS {
        let percent = (100.0 * slack).round();
        models.push((format!("ratios, levels {percent} %"), Model::limited(Setting::RatiosInertia, [slack; 3])));
        let analytic = Setting::AnalyticInertia(fabric.clone());
        models.push((format!("its constants, levels {percent} %"), Model::limited(analytic, [slack; 3])));
    }
    let mut choices = Vec::new();
    for (name, model) in models {
        let outcome = run(job.side, &model)?;
        choices.push(Choice {
            cut_fraction: outcome.cut_fraction,
            ..choice(name, &reference.compare(&outcome.positions, job.side, job.side, outcome.finite))
        });
    }
    Ok(Row {
        words: job.held.words.clone(),
        shuffled_words: job.heard.clone(),
        scene: scene.to_string(),
        side: job.side,
        substeps: job.substeps,
        choices,
    })
}

fn choice(name: String, c: &Comparison) -> Choice {
    let d = &c.ex_pin_pct;
    // what is not finite has no place in JSON
    let sound = |x: f64| if x.is_finite() { x } else { 0.0 };
    Choice {
        name,
        ex_pin_mean_pct: [d.u, d.v, d.diag].map(|b| [sound(b.taut.mean), b.reference.mean]),
        silhouette_nmse: sound(c.silhouette_nmse),
        distance_pct: sound(c.distance_pct.unwrap_or(0.0)),
        cut_fraction: 0.0,
        finite: c.finite,
    }
}

/// The means of each correction over some rows.
pub fn means(rows: &[&Row]) -> Vec<Mean> {
    let names = rows.first().map_or(vec![], |r| r.choices.iter().map(|c| c.name.clone()).collect());
    let mean = |name: String| {
        let all: Vec<&Choice> = rows.iter().flat_map(|r| &r.choices).filter(|c| c.name == name).collect();
        let good: Vec<&&Choice> = all.iter().filter(|c| c.finite).collect();
        let n = good.len() as f64;
        let relative = |i: usize| {
            let off = good.iter().map(|c| (c.ex_pin_mean_pct[i][0] - c.ex_pin_mean_pct[i][1]).abs());
            off.sum::<f64>() / good.iter().map(|c| c.ex_pin_mean_pct[i][1].abs()).sum::<f64>()
        };
        Mean {
            strain_error_relative: std::array::from_fn(relative),
            silhouette_nmse: good.iter().map(|c| c.silhouette_nmse).sum::<f64>() / n,
            distance_pct: good.iter().map(|c| c.distance_pct).sum::<f64>() / n,
            not_finite: all.len() - good.len(),
            name,
        }
    };
    names.into_iter().map(mean).collect()
}

/// The groups in which the rows are told: the scene's own place by scene, then every place.
pub fn groups<'a>(rows: &[&'a Row]) -> Vec<(String, Vec<&'a Row>)> {
    let at = |side: usize, substeps: u32| rows.iter().filter(move |r| (r.side, r.substeps) == (side, substeps));
    let mut places: Vec<(usize, u32)> = Vec::new();
    for row in rows {
        if !places.contains(&(row.side, row.substeps)) {
            places.push((row.side, row.substeps));
        }
    }
    let mut groups = Vec::new();
    for (i, (side, substeps)) in places.into_iter().enumerate() {
        let name = format!("{side} x {side}, 60 Hz x {substeps}");
        if i == 0 {
            for scene in SCENES {
                let of = at(side, substeps).filter(|r| r.scene == scene.name()).copied().collect();
                groups.push((format!("{scene}, {name}"), of));
            }
        } else {
            groups.push((format!("both scenes, {name}"), at(side, substeps).copied().collect()));
        }
    }
    groups
}

/// A table for each group.
pub fn text(rows: &[&Row]) -> String {
    let mut out = String::new();
    for (name, rows) in groups(rows) {
        let line = |m: &Mean| {
            let [u, v, d] = m.strain_error_relative.map(|e| number(e, 2));
            let name = if m.not_finite > 0 { format!("{} ({} blew up)", m.name, m.not_finite) } else { m.name.clone() };
            vec![name, u, v, d, number(m.silhouette_nmse, 4), number(m.distance_pct, 2)]
        };
        let lines: Vec<Vec<String>> = means(&rows).iter().map(line).collect();
        out.push_str(&table(&[&name, "u", "v", "diag", "silhouette", "distance %"], &lines));
        out.push('\n');
    }
    out.trim_end().to_string() + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn means_pool_the_strains() {
        let choice = |mine: f64, theirs: f64, finite| Choice {
            name: "a".into(),
            ex_pin_mean_pct: [[mine, theirs]; 3],
            silhouette_nmse: 0.5,
            distance_pct: mine,
            cut_fraction: 0.0,
            finite,
        };
        let row = |c: Choice| Row {
            words: "w".into(),
            shuffled_words: "s".into(),
            scene: "edge".into(),
            side: 9,
            substeps: 4,
            choices: vec![c],
        };
        // off by 1 of 2 and by 1 of -8: 2 of 10
        let rows = [row(choice(3.0, 2.0, true)), row(choice(-9.0, -8.0, true)), row(choice(0.0, 1.0, false))];
        let m = &means(&rows.iter().collect::<Vec<_>>())[0];
        assert!((m.strain_error_relative[1] - 0.2).abs() < 1e-12);
        assert_eq!((m.silhouette_nmse, m.distance_pct, m.not_finite), (0.5, -3.0, 1));
        let groups = groups(&rows.iter().collect::<Vec<_>>());
        assert_eq!(groups.iter().map(|g| g.1.len()).collect::<Vec<_>>(), [0, 3]);
    }

    #[test]
    fn nobody_hears_its_own_words() {
        let jobs = jobs(false);
        assert_eq!(jobs.len(), PLACES.len() * FABRICS * SCENES.len());
        assert!(jobs.iter().all(|j| j.heard != j.held.words));
        let steps: std::collections::BTreeSet<u32> = PLACES.iter().map(|p| p.1).collect();
        assert!(steps.len() == 4 && PLACES.iter().any(|p| p.0 == 16) && PLACES.iter().any(|p| p.0 == 64));
    }
}
