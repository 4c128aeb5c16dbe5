//! The cells of an atlas with what was found, as a table, as JSON and as maps.

use std::collections::HashMap;

use serde_json::{Map as Object, Value, json};
use taut::Hash64;

use super::axes::{MAPS, sample};
use super::cell::{Cell, Variant, plain};
use super::run::{Class, Effort, Finding, run};
use crate::plot::{CellMap, CellMaps, Places};

/// Cells of the full product.
const SAMPLES: u64 = 600;
const QUICK_SAMPLES: u64 = 100;

/// A cell and where it belongs.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// Name of the map, or `sample`.
    pub map: &'static str,
    /// Name of the variant; of a sampled cell that of its solver.
    pub variant: &'static str,
    /// The cell.
    pub cell: Cell,
}

/// All cells of an atlas, in the order in which they are measured, and what was found.
#[derive(Clone, Debug)]
pub struct Atlas {
    quick: bool,
    entries: Vec<Entry>,
    found: HashMap<String, Finding>,
}

impl Atlas {
    /// The cells of all maps and of the sample: about 6,000, or for the quick atlas about 2,000.
    pub fn new(quick: bool) -> Atlas {
        let mut entries = Vec::new();
        for map in &MAPS {
            let [xs, ys] = map.places(quick);
            for variant in Variant::ALL {
                for y in &ys {
                    for x in &xs {
                        let cell = map.cell(variant, *x, *y);
                        entries.push(Entry { map: map.name, variant: variant.name(), cell });
                    }
                }
            }
        }
        for seed in 1..=if quick { QUICK_SAMPLES } else { SAMPLES } {
            entries.push(Entry { map: "sample", variant: "any", cell: sample(seed) });
        }
        Atlas { quick, entries, found: HashMap::new() }
    }

    /// What a cell may cost.
    pub fn effort(&self) -> Effort {
        if self.quick {
            Effort { seconds: 4.0, particle_steps: 1e6 }
        } else {
            Effort { seconds: 5.0, particle_steps: 4e6 }
        }
    }

    /// All cells. Some stand in more than one map.
    pub fn entries(&self) -> &[Entry] {
        &self.entries
    }

    /// What a ledger of this atlas must begin with: another effort, another version or a core that steps otherwise is
    /// another measurement.
    pub fn header(&self) -> Value {
        let mut h = Hash64::new();
        let effort = Effort { seconds: 0.5, particle_steps: 1e6 };
        for variant in Variant::ALL {
            let found = run(&variant.cell(), &effort, |_| {});
            for x in [found.peak_strain_pct, found.rms_speed_m_s, found.energy_ratio] {
                h.bytes(&x.unwrap_or(f64::NAN).to_bits().to_le_bytes());
            }
        }
        json!({ "atlas": 1, "quick": self.quick, "effort": self.effort(), "digest": format!("{:016x}", h.finish()) })
    }

    /// Adds what was found in a cell.
    pub fn add(&mut self, key: String, finding: Finding) {
        self.found.insert(key, finding);
    }

    /// What was found in a cell.
    pub fn finding(&self, cell: &Cell) -> Option<&Finding> {
        self.found.get(&cell.key())
    }

    /// How many entries of a map and a variant ended in each class, in the order of [`Class::ALL`]. None counts all.
    pub fn counts(&self, map: Option<&str>, variant: Option<&str>) -> [usize; 6] {
        let wanted = |e: &&Entry| map.is_none_or(|m| m == e.map) && variant.is_none_or(|v| v == e.variant);
        let classes = self.entries.iter().filter(wanted).filter_map(|e| self.finding(&e.cell)).map(|f| f.class);
        let mut counts = [0; 6];
        for class in classes {
            counts[Class::ALL.iter().position(|c| *c == class).unwrap_or(0)] += 1;
        }
        counts
    }

    /// The broken cells with what is wrong, one line each.
    pub fn broken(&self) -> Vec<String> {
        let broken = self.entries.iter().filter_map(|e| {
            let found = self.finding(&e.cell).filter(|f| f.class == Class::Broken)?;
            Some(format!("{}: {}", found.fault.as_deref().unwrap_or("broken"), e.cell.key()))
        });
        let mut lines: Vec<String> = broken.collect();
        lines.sort();
        lines.dedup();
        lines
    }

    /// Every cell that was measured, its fields by name in one order.
    fn rows(&self) -> impl Iterator<Item = Vec<(&'static str, Value)>> {
        self.entries.iter().filter_map(|e| {
            let found = self.finding(&e.cell)?;
            let mut row = vec![("map", json!(e.map)), ("variant", json!(e.variant))];
            row.extend(e.cell.fields());
            row.extend(found.fields());
            Some(row)
        })
    }

    /// The counts by variant and by map.
    pub fn summary(&self) -> Value {
        let row = |name: &str, counts: [usize; 6]| {
            let mut o = Object::new();
            o.insert("name".into(), json!(name));
            o.extend(Class::ALL.iter().zip(counts).map(|(c, n)| (c.name().to_string(), json!(n))));
            Value::Object(o)
        };
        let variants: Vec<&str> = Variant::ALL.map(Variant::name).into_iter().chain(["any"]).collect();
        let maps: Vec<&str> = MAPS.iter().map(|m| m.name).chain(["sample"]).collect();
        json!({
            "quick": self.quick,
            "effort": self.effort(),
            "all": row("all", self.counts(None, None)),
            "by_variant": variants.iter().map(|v| row(v, self.counts(None, Some(v)))).collect::<Vec<_>>(),
            "by_map": maps.iter().map(|m| row(m, self.counts(Some(m), None))).collect::<Vec<_>>(),
            "broken": self.broken(),
        })
    }

    /// The summary and every cell.
    pub fn json(&self) -> Value {
        let object = |row: Vec<(&'static str, Value)>| row.into_iter().map(|(k, v)| (k.to_string(), v)).collect();
        json!({ "summary": self.summary(), "cells": self.rows().map(object).map(Value::Object).collect::<Vec<_>>() })
    }

    /// Every cell as a line of values with commas between them.
    pub fn csv(&self) -> String {
        let mut text = String::new();
        for row in self.rows() {
            if text.is_empty() {
                text = row.iter().map(|(name, _)| *name).collect::<Vec<_>>().join(",") + "\n";
            }
            // only the text of a fault could hold a comma or a quote
            let cell = |v: &Value| {
                let v = plain(v);
                if v.contains([',', '"', '\n']) { format!("\"{}\"", v.replace('"', "\"\"")) } else { v }
            };
            text += &(row.iter().map(|(_, v)| cell(v)).collect::<Vec<_>>().join(",") + "\n");
        }
        text
    }

    /// The maps: a row of maps for each pair of axes, a column for each variant.
    pub fn maps(&self) -> CellMaps {
        let rows = MAPS.iter().map(|map| {
            let [xs, ys] = map.places(self.quick);
            let maps = Variant::ALL.map(|variant| {
                let class = |x: usize, y: usize| {
                    let class = self.finding(&map.cell(variant, x, y))?.class;
                    Class::ALL.iter().position(|c| *c == class)
                };
                CellMap {
                    title: variant.title().into(),
                    x: Places { label: map.x.label().into(), names: xs.iter().map(|x| map.x.name(*x)).collect() },
                    y: Places { label: map.y.label().into(), names: ys.iter().map(|y| map.y.name(*y)).collect() },
                    cells: ys.iter().flat_map(|y| xs.iter().map(|x| class(*x, *y))).collect(),
                }
            });
            maps.into()
        });
        CellMaps {
            legend: Class::ALL.iter().map(|c| (c.about().to_string(), colour(*c))).collect(),
            rows: rows.collect(),
        }
    }
}

/// Colours that most people can tell apart (Okabe and Ito 2008).
fn colour(class: Class) -> [u8; 3] {
    match class {
        Class::Stable => [0, 158, 115],
        Class::Stretched => [240, 228, 66],
        Class::Fast => [230, 120, 0],
        Class::TakenBack => [204, 121, 167],
        Class::Refused => [205, 205, 205],
        Class::Broken => [0, 0, 0],
    }
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use super::*;

    /// The regression test of the atlas: a sample of the full product and of every map, short. All cells, and longer:
    /// `taut measure atlas`.
    #[test]
    fn no_cell_breaks() {
        let effort = Effort { seconds: 0.25, particle_steps: 2e5 };
        let maps = Atlas::new(true);
        let some = maps.entries().iter().filter(|e| e.cell.frame_cost() < 2e5).step_by(11);
        let cells: Vec<Cell> =
            some.map(|e| e.cell).chain((2001..2200).map(sample).filter(|c| c.frame_cost() < 2e5)).collect();
        assert!(cells.len() > 200, "{} cells", cells.len());
        let mut classes = HashSet::new();
        for cell in &cells {
            let found = run(cell, &effort, |_| {});
            assert_ne!(found.class, Class::Broken, "{found:?} in {cell:?}");
            classes.insert(found.class);
        }
        assert!(classes.contains(&Class::Stable) && classes.contains(&Class::Refused), "{classes:?}");
    }

    #[test]
    fn sampled_cells_are_accepted() {
        for seed in 1..=SAMPLES {
            let c = sample(seed);
            assert!(c.grid().is_ok() && c.def().check().is_ok(), "{c:?}: {:?}", c.def().check());
        }
        assert_eq!(sample(5), sample(5));
        let different: HashSet<String> = (1..=SAMPLES).map(|s| sample(s).key()).collect();
        assert_eq!(different.len() as u64, SAMPLES);
    }

    #[test]
    fn the_report_has_every_cell_that_was_measured() {
        let mut atlas = Atlas::new(true);
        let effort = Effort { seconds: 0.05, particle_steps: 1e4 };
        for entry in atlas.entries().to_vec().iter().take(12) {
            let found = run(&entry.cell, &effort, |_| {});
            atlas.add(entry.cell.key(), found);
        }
        let cells = atlas.json()["cells"].as_array().unwrap().len();
        let csv = atlas.csv();
        assert!(cells >= 12);
        assert_eq!(csv.lines().count(), cells + 1);
        let width = csv.lines().next().unwrap().split(',').count();
        assert!(csv.lines().all(|line| line.split(',').count() == width), "{csv}");
        assert_eq!(atlas.counts(None, None).iter().sum::<usize>(), cells);
        assert!(csv.starts_with("map,variant,rows,columns,rate_hz,substeps,stiffness_n_m,"), "{csv}");
    }
}
