//! `taut measure features`: what each feature costs in bytes and in time.

use std::time::Duration;

use serde::Serialize;
use taut::{Cloth, Error, Width};

use super::load::Load;
use super::step::times;
use crate::block::Block;
use crate::metrics::percentile;

/// Rounds in which the loads take turns.
const ROUNDS: u32 = 5;

/// A feature.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FeatureRow {
    /// The load.
    pub feature: &'static str,
    /// What it is compared with.
    pub beside: &'static str,
    /// Bytes of the cloth per particle.
    pub bytes_per_particle: f64,
    /// Bytes more than what it is compared with.
    pub bytes_added_per_particle: f64,
    /// Time of a particle-step: the least of the lower quartiles of the rounds.
    pub ns_per_particle_step: f64,
    /// Time more than what it is compared with.
    pub ns_added: f64,
    /// Time over that of what it is compared with.
    pub ratio: f64,
}

/// Measures every load at a size, `time` of CPU each; `progress` is told the share that is done.
pub fn features(side: u32, time: Duration, mut progress: impl FnMut(f32)) -> Result<Vec<FeatureRow>, Error> {
    let numbers = Load::ALL.map(|load| load.memory(side));
    let mut blocks = Vec::with_capacity(numbers.len());
    for n in numbers {
        blocks.push(Block::new(n?));
    }
    let bytes: Vec<f64> =
        blocks.iter_mut().map(|b| 4.0 * b.numbers_mut().len() as f64 / f64::from(side) / f64::from(side)).collect();
    let mut cloths: Vec<Cloth<'_>> = Vec::with_capacity(blocks.len());
    for (load, block) in Load::ALL.into_iter().zip(&mut blocks) {
        cloths.push(load.create(side, Width::best(), block.numbers_mut())?);
    }
    let mut best = vec![f64::INFINITY; cloths.len()];
    let all = (ROUNDS as usize * cloths.len()) as f32;
    for round in 0..ROUNDS as usize {
        for (i, cloth) in cloths.iter_mut().enumerate() {
            best[i] = best[i].min(percentile(&times(cloth, side, time / ROUNDS)?, 0.25));
            progress((round * best.len() + i + 1) as f32 / all);
        }
    }
    let at = |load: Load| Load::ALL.iter().position(|l| *l == load).unwrap_or(0);
    let row = |(i, load): (usize, &Load)| {
        let other = at(load.beside());
        FeatureRow {
            feature: load.name(),
            beside: load.beside().name(),
            bytes_per_particle: bytes[i],
            bytes_added_per_particle: bytes[i] - bytes[other],
            ns_per_particle_step: best[i],
            ns_added: best[i] - best[other],
            ratio: best[i] / best[other],
        }
    };
    Ok(Load::ALL.iter().enumerate().map(row).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_feature_has_a_row_and_what_is_off_takes_no_bytes() {
        let mut last = 0.0;
        let rows = features(16, Duration::from_millis(1), |share| last = share).unwrap();
        assert_eq!((rows.len(), last), (Load::ALL.len(), 1.0));
        let bytes = |name| rows.iter().find(|r| r.feature == name).unwrap().bytes_added_per_particle;
        assert_eq!(bytes("plain"), 0.0);
        assert_eq!(bytes("no_clamps"), 0.0);
        assert!(bytes("pull") >= 12.0 && bytes("mass") >= 4.0 && bytes("implicit_euler") > 50.0);
        assert!(bytes("no_bend") < 0.0, "springs that are not there take no memory");
    }
}
