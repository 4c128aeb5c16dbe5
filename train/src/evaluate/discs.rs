//! Discs of fabrics that no net has seen on the pedestal of Cusick: the drape coefficient by what the words tell, by the mass
//! per area alone, and by the words of another fabric, against that of the fabric's own constants.

use serde::{Deserialize, Serialize};
use taut_lab::cusick::{Disc, Statistics};
use taut_lab::fabric::{self, Fabric, rigidity_at};
use taut_lab::metrics;
use taut_lab::scene::Scene;

use super::held::{Held, fabrics};
use super::net::{Net, Told};
use super::shuffle::derangement;
use super::table::{number, table};
use super::{Bench, EvaluateError};
use crate::nets::{CHANNELS, GRID};

/// How many fabrics: every kind once.
const FABRICS: usize = fabric::KINDS.len();

/// Particles along the diameter, and drapes of each disc from other starts; and in a quick run.
const SIZE: (u32, u64) = (33, 3);
const QUICK_SIZE: (u32, u64) = (13, 1);

/// Seed of the order in which words are handed on, and of the fabrics that a guess from the mass alone is made of.
const SHUFFLE: u64 = 11;
const COMMON: u64 = 1;

/// Fabrics whose medians are the common one.
const SAMPLES: u32 = 501;

/// A drape coefficient and what it was got by.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Choice {
    /// Its name.
    pub name: String,
    /// Bending rigidity in N m.
    pub rigidity_n_m: f32,
    /// Mean drape coefficient over the starts, 0 to 1.
    pub drape_coefficient: f64,
}

/// The disc of one fabric; the first choice is the truth.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Words of the fabric.
    pub words: String,
    /// Words that the shuffled generator heard.
    pub shuffled_words: String,
    /// Mass per area in kg/m^2.
    pub density_kg_m2: f32,
    /// What was compared.
    pub choices: Vec<Choice>,
}

/// Errors of a choice over the fabrics.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Mean {
    /// Its name.
    pub name: String,
    /// Mean of the absolute differences of the drape coefficients.
    pub error: f64,
    /// The largest of them.
    pub largest: f64,
}

/// Runs all. None stands for what another shard has.
pub fn rows(bench: &mut Bench<'_>) -> Result<Vec<Option<Row>>, EvaluateError> {
    let net = Net::load(&bench.model)?;
    let held = fabrics(if bench.quick { 2 } else { FABRICS });
    let order = derangement(held.len(), SHUFFLE);
    let jobs: Vec<(Held, String)> =
        held.iter().zip(order).map(|(h, other)| (h.clone(), held[other].words.clone())).collect();
    let size = if bench.quick { QUICK_SIZE } else { SIZE };
    let made_with = (bench.model_digest()?, size);
    bench.rows("discs", &made_with, &jobs, |j| j.0.words.clone(), |_, (held, heard)| measure(held, heard, &net, size))
}

fn measure(held: &Held, heard: &str, net: &Net, (side, drapes): (u32, u64)) -> Result<Row, EvaluateError> {
    let fabric = &held.fabric;
    let n = side as usize;
    let pins = Scene::Cusick.pins(GRID, GRID);
    let constants: Vec<f32> = fabric.stiffness.iter().flat_map(|k| vec![*k; n * n]).collect();
    debug_assert_eq!(constants.len(), CHANNELS * n * n);
    let (common_d, common_density) = common();
    let of_words =
        |told: &Told| (rigidity_at(told.rigidity_n_m, told.density_kg_m2, fabric.density_kg_m2), told.on(n, n));
    let own = of_words(&net.tell(&held.words, &pins, 0)?);
    let other = of_words(&net.tell(heard, &pins, 0)?);
    let by_mass = rigidity_at(common_d, common_density, fabric.density_kg_m2);
    let mut choices = Vec::new();
    for (name, (rigidity_n_m, field)) in [
        ("its constants", (fabric.hinge_rigidity_n_m, constants.clone())),
        ("generated", own),
        ("generated, shuffled words", other),
        ("by its mass alone", (by_mass, constants)),
    ] {
        let disc = Disc { side, density_kg_m2: fabric.density_kg_m2, rigidity_n_m, field };
        let all = (1..=drapes).map(|seed| disc.drape(seed).map(|d| d.silhouette)).collect::<Result<Vec<_>, _>>();
        let drape_coefficient = Statistics::of(&all.map_err(EvaluateError::part)?).mean;
        choices.push(Choice { name: name.into(), rigidity_n_m, drape_coefficient });
    }
    Ok(Row { words: held.words.clone(), shuffled_words: heard.into(), density_kg_m2: fabric.density_kg_m2, choices })
}

/// Medians of rigidity and mass per area of what nets learn from: all that is known without words.
fn common() -> (f32, f32) {
    let all: Vec<Fabric> = (0..SAMPLES).map(|i| fabric::sample(COMMON, i).0).collect();
    let median = |of: fn(&Fabric) -> f32| metrics::median(&all.iter().map(of).collect::<Vec<_>>());
    (median(|f| f.hinge_rigidity_n_m), median(|f| f.density_kg_m2))
}

/// Errors of every choice but the first, which is the truth.
pub fn means(rows: &[&Row]) -> Vec<Mean> {
    let count = rows.first().map_or(0, |r| r.choices.len());
    let mean = |i: usize| {
        let truth = |r: &&Row| (r.choices[i].drape_coefficient - r.choices[0].drape_coefficient).abs();
        let errors: Vec<f64> = rows.iter().map(truth).collect();
        Mean {
            name: rows[0].choices[i].name.clone(),
            error: errors.iter().sum::<f64>() / errors.len() as f64,
            largest: errors.iter().copied().fold(0.0, f64::max),
        }
    };
    (1..count).map(mean).collect()
}

/// A line for each fabric, and one for the mean errors.
pub fn text(rows: &[&Row]) -> String {
    let names = rows.first().map_or(vec![], |r| r.choices.iter().map(|c| c.name.as_str()).collect());
    let head: Vec<&str> = ["fabric", "kg/m^2"].into_iter().chain(names).collect();
    let line = |r: &&Row| {
        let told = r.choices.iter().map(|c| number(c.drape_coefficient, 3));
        [r.words.clone(), number(f64::from(r.density_kg_m2), 3)].into_iter().chain(told).collect()
    };
    let mut lines: Vec<Vec<String>> = rows.iter().map(line).collect();
    let errors = means(rows);
    for (name, of) in [("mean error", (|m| m.error) as fn(&Mean) -> f64), ("largest error", |m| m.largest)] {
        let told = errors.iter().map(|m| number(of(m), 3));
        lines.push([name.into(), String::new(), String::new()].into_iter().chain(told).collect());
    }
    table(&head, &lines)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_are_those_from_the_first_choice() {
        let choice =
            |name: &str, drape_coefficient| Choice { name: name.into(), rigidity_n_m: 1e-5, drape_coefficient };
        let row = |truth, told| Row {
            words: "w".into(),
            shuffled_words: "s".into(),
            density_kg_m2: 0.2,
            choices: vec![choice("its constants", truth), choice("generated", told)],
        };
        let rows = [row(0.5, 0.6), row(0.8, 0.5)];
        let means = means(&rows.iter().collect::<Vec<_>>());
        assert_eq!(means.len(), 1);
        assert!((means[0].error - 0.2).abs() < 1e-12 && (means[0].largest - 0.3).abs() < 1e-12);
        assert!(text(&rows.iter().collect::<Vec<_>>()).contains("mean error"));
    }

    #[test]
    fn the_common_fabric_is_one_of_them() {
        let (rigidity, density) = common();
        assert!((1e-6..1e-4).contains(&rigidity) && (0.1..0.4).contains(&density), "{rigidity} {density}");
    }
}
