//! Rows measured more than once, so that what the machine does beside can be taken off.

use std::error::Error;

use super::{Bench, Row, Spec};
use crate::ledger::Ledger;

/// Measures rows in so many rounds, all of them in each; the rows of a spec by round. What the ledger has is not measured again.
/// `look` sees the round, the place in the list and the key of each row before it is measured.
pub fn rounds(
    bench: &mut Bench<'_>,
    ledger: &mut Ledger<Row>,
    specs: &[Spec],
    rounds: usize,
    look: &mut dyn FnMut(usize, usize, &str),
) -> Result<Vec<Vec<Row>>, Box<dyn Error>> {
    let mut rows = vec![Vec::with_capacity(rounds); specs.len()];
    for round in 0..rounds {
        for (i, (spec, rows)) in specs.iter().zip(&mut rows).enumerate() {
            let key = format!("{round}/{}", spec.key());
            if ledger.get(&key).is_none() {
                look(round, i, &key);
                ledger.add(&key, bench.measure(spec)?)?;
            }
            rows.push(ledger.get(&key).ok_or("no row")?.clone());
        }
    }
    Ok(rows)
}

/// The row that took the least time: what the machine does beside only adds. None of none.
pub fn least(rows: &[Row]) -> Option<&Row> {
    rows.iter().min_by(|a, b| a.ns_per_particle_step.total_cmp(&b.ns_per_particle_step))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::front::{Correction, FABRICS, Set};
    use crate::scene::Scene;

    #[test]
    fn what_the_ledger_has_is_not_measured_again() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("rows.jsonl");
        let mut none = |_: &str, _: Scene, _: u32| -> Result<Vec<f32>, String> { Err("no generator".into()) };
        let mut bench = Bench::new(Set::Quick, &mut none);
        let spec = Spec { substeps: 2, ..Spec::new(Scene::Edge, FABRICS[0], 8, Correction::Uniform) };
        let mut all = Vec::new();
        for measured in [2, 0] {
            let mut ledger = Ledger::open(&path, &"rows").unwrap();
            let mut seen = 0;
            all = rounds(&mut bench, &mut ledger, &[spec], 2, &mut |_, _, _| seen += 1).unwrap().remove(0);
            assert_eq!(seen, measured);
        }
        assert_eq!(all.len(), 2);
        let fastest = all.iter().map(|r| r.ns_per_particle_step).fold(f64::INFINITY, f64::min);
        assert_eq!(least(&all).unwrap().ns_per_particle_step, fastest);
        assert!(least(&[]).is_none());
    }
}
