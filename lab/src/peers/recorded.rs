//! What others measured: NvCloth and Jolt on a Zen 5, one thread, thread CPU time within 5 %.

use super::row::{Reached, Row};

/// Where these rows are from.
const SOURCE: &str = "recorded on another run (Zen 5)";

/// ns per particle and iteration, and the cheapest ms of CPU per simulated second until the mean stretch of the last second
/// is at most 1.5 %; None where that was not reached.
type Recorded = (&'static str, [(u32, f64, Option<f64>); 4]);

const ROWS: [Recorded; 3] = [
    ("NvCloth, AVX", [(32, 7.2, Some(2.19)), (64, 7.4, Some(18.0)), (128, 7.5, Some(215.0)), (256, 7.8, None)]),
    (
        "NvCloth, AVX, tethers",
        [(32, 9.7, Some(1.2)), (64, 9.9, Some(9.5)), (128, 10.0, Some(201.0)), (256, 10.5, None)],
    ),
    ("Jolt", [(32, 38.0, Some(11.7)), (64, 38.0, Some(187.0)), (128, 39.0, None), (256, 42.0, None)]),
];

/// The rows of some sizes.
pub fn recorded(sides: &[u32]) -> Vec<Row> {
    let row = |engine: &str, (n, ns, ms): (u32, f64, Option<f64>)| Row {
        engine: engine.into(),
        source: SOURCE.into(),
        n,
        ns_per_particle_iteration: Some(ns),
        mean_1_5: ms.map(|ms| Reached { cpu_ms_per_s: ms, ..Reached::default() }),
        mean_0_6: None,
        tried: None,
    };
    let all = ROWS.iter().flat_map(|(engine, cells)| cells.iter().map(|cell| row(engine, *cell)));
    all.filter(|r| sides.contains(&r.n)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_of_others_say_so() {
        let rows = recorded(&[64, 256]);
        assert_eq!(rows.len(), 6);
        assert!(rows.iter().all(|r| r.source.contains("another run") && r.tried.is_none()));
        let nv = rows.iter().find(|r| r.engine == "NvCloth, AVX" && r.n == 64).unwrap();
        assert_eq!(nv.mean_1_5.as_ref().unwrap().cpu_ms_per_s, 18.0);
        assert!(rows.iter().find(|r| r.engine == "Jolt" && r.n == 256).unwrap().mean_1_5.is_none());
    }
}
