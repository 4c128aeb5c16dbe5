//! `taut measure step`: ns per particle-step by width and size, beside the bound.

use std::time::{Duration, Instant};

use cpu_time::ThreadTime;
use serde::Serialize;
use taut::{Cloth, Error, Width};

use super::load::Load;
use crate::block::Block;
use crate::bound::Throughput;
use crate::metrics::percentile;

/// Springs that start at a particle of a large grid: warp, weft, two of shear, two of bend.
const SPRINGS: f64 = 6.0;

/// A cell of the table.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StepRow {
    /// The solver.
    pub solver: &'static str,
    /// scalar, sse2, avx2, avx512 or neon.
    pub width: &'static str,
    /// Particles along each side.
    pub n: u32,
    /// The load; empty for the plain step.
    pub features: Vec<&'static str>,
    /// Median over many frames.
    pub ns_per_particle_step: f64,
    /// Lower and upper quartile.
    pub quartiles_ns: [f64; 2],
    /// Springs per second at the median, where all families are on.
    pub springs_per_s: f64,
    /// The gather of every spring from both ends cannot be faster on this core. Null where nothing is known of the width.
    pub bound_gather_ns: Option<f64>,
    /// A step with every spring once cannot be faster on this core.
    pub bound_once_ns: Option<f64>,
    /// Bound of every spring once over the time.
    pub share_of_bound: Option<f64>,
}

/// The cells that [`step`] measures, with their sizes: the plain step in every width the machine has at every size, then
/// loads. A build without debug assertions has single numbers for the plain step alone, so there that width has no loads.
pub fn step_cells(sides: &[u32]) -> Vec<(Width, u32, Load)> {
    let widths = || Width::ALL.into_iter().filter(|w| w.is_supported());
    let mut cells: Vec<(Width, u32, Load)> =
        widths().flat_map(|w| sides.iter().map(move |side| (w, *side, Load::Plain))).collect();
    for width in widths().filter(|w| *w != Width::Scalar || cfg!(debug_assertions)) {
        for load in [Load::Inertia, Load::Tethers, Load::LevelsIdle, Load::Levels] {
            cells.extend(sides.iter().filter(|s| (32..=256).contains(*s)).map(|side| (width, *side, load)));
        }
    }
    for load in [Load::ImplicitEuler, Load::Bdf2] {
        cells.extend(sides.iter().filter(|s| **s <= 128).map(|side| (Width::best(), *side, load)));
    }
    cells
}

/// Measures a cell for about `time` of CPU.
pub fn step(
    (width, side, load): (Width, u32, Load),
    bound: Option<&Throughput>,
    time: Duration,
) -> Result<StepRow, Error> {
    let numbers = load.memory(side)?;
    let mut block = Block::new(numbers);
    let mut cloth = load.create(side, width, block.numbers_mut())?;
    let times = times(&mut cloth, side, time)?;
    let bound = bound.filter(|_| load.solver() == "symplectic_euler");
    let median = percentile(&times, 0.5);
    Ok(StepRow {
        solver: load.solver(),
        width: width.name(),
        n: side,
        features: if load == Load::Plain { vec![] } else { vec![load.name()] },
        ns_per_particle_step: median,
        quartiles_ns: [percentile(&times, 0.25), percentile(&times, 0.75)],
        springs_per_s: SPRINGS / median * 1e9,
        bound_gather_ns: bound.map(Throughput::gather_ns),
        bound_once_ns: bound.map(Throughput::once_ns),
        share_of_bound: bound.map(|b| b.once_ns() / median),
    })
}

/// ns per particle-step of frame after frame, ascending.
pub(super) fn times(cloth: &mut Cloth<'_>, side: u32, time: Duration) -> Result<Vec<f64>, Error> {
    let steps = f64::from(side) * f64::from(side) * f64::from(cloth.def().substeps);
    let (begun, mut spent, mut times) = (Instant::now(), Duration::ZERO, Vec::new());
    // a busy machine gives less CPU time than it takes of the wall's
    while times.len() < 5 || (spent < time && begun.elapsed() < 20 * time) {
        let start = ThreadTime::now();
        cloth.step()?;
        let took = start.elapsed();
        spent += took;
        times.push(took.as_nanos() as f64 / steps);
    }
    times.sort_by(f64::total_cmp);
    Ok(times)
}

/// The law that the time of a frame should follow: c0 + c1 times the padded particles.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Law {
    /// ns of a substep that do not depend on the size.
    pub c0_ns: f64,
    /// ns of a substep per padded particle.
    pub c1_ns: f64,
    /// Largest relative difference of a size up to 256 from the law.
    pub largest_off: f64,
    /// The time at 512 over the law's, if it was measured.
    pub at_512: Option<f64>,
}

/// Fits the law to the plain rows of a width from 16 to 256, by least squares of the relative differences.
pub fn law(rows: &[StepRow], width: &str) -> Option<Law> {
    let padded = |n: u32| f64::from(n.next_multiple_of(16) * n);
    let plain = || rows.iter().filter(|r| r.width == width && r.features.is_empty() && r.solver == "symplectic_euler");
    let time = |r: &StepRow| r.ns_per_particle_step * f64::from(r.n) * f64::from(r.n);
    let points: Vec<(f64, f64)> = plain().filter(|r| r.n <= 256).map(|r| (padded(r.n), time(r))).collect();
    if points.len() < 3 {
        return None;
    }
    // minimise sum (c0/t + c1 p/t - 1)^2
    let (mut a, mut b, mut c, mut d, mut e) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for (p, t) in &points {
        let (x, y) = (1.0 / t, p / t);
        a += x * x;
        b += x * y;
        c += y * y;
        d += x;
        e += y;
    }
    let det = a * c - b * b;
    if det.abs() < 1e-30 {
        return None;
    }
    let (c0, c1) = ((d * c - b * e) / det, (a * e - b * d) / det);
    let off = points.iter().map(|(p, t)| ((c0 + c1 * p) / t - 1.0).abs()).fold(0.0, f64::max);
    let at_512 = plain().find(|r| r.n == 512).map(|r| time(r) / (c0 + c1 * padded(512)));
    Some(Law { c0_ns: c0, c1_ns: c1, largest_off: off, at_512 })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(n: u32, ns: f64) -> StepRow {
        StepRow {
            solver: "symplectic_euler",
            width: "sse2",
            n,
            features: vec![],
            ns_per_particle_step: ns,
            quartiles_ns: [ns; 2],
            springs_per_s: 0.0,
            bound_gather_ns: None,
            bound_once_ns: None,
            share_of_bound: None,
        }
    }

    #[test]
    fn the_law_is_found() {
        let made = |n: u32| row(n, (500.0 + 3.0 * f64::from(n * n)) / f64::from(n * n));
        let rows: Vec<StepRow> = [16, 32, 64, 128, 256, 512].map(made).to_vec();
        let law = law(&rows, "sse2").unwrap();
        assert!((law.c0_ns - 500.0).abs() < 1e-3 && (law.c1_ns - 3.0).abs() < 1e-6, "{law:?}");
        assert!(law.largest_off < 1e-9 && (law.at_512.unwrap() - 1.0).abs() < 1e-9);
        assert_eq!(super::law(&rows, "avx2"), None);
    }

    #[test]
    fn cells_are_measured() {
        let bound = Throughput::measure(Width::best());
        for load in [Load::Plain, Load::ImplicitEuler] {
            let cell = step((Width::best(), 16, load), bound.as_ref(), Duration::from_millis(2)).unwrap();
            assert!(cell.ns_per_particle_step > 0.0 && cell.quartiles_ns[0] <= cell.quartiles_ns[1]);
            assert_eq!(cell.bound_once_ns.is_some(), load == Load::Plain && bound.is_some());
        }
        let cells = step_cells(&[16, 64]);
        assert!(cells.iter().filter(|(_, _, load)| *load == Load::Plain).count() >= 2);
    }
}
