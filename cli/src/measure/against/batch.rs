//! A folder of trajectories at once: every file, and the mean errors of each setting over the fabrics of a scene.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use taut_lab::against::{Comparison, Mesh, Reference, Stage};
use taut_lab::ledger::Ledger;

use super::{Args, Done, Job, compare, simulate, table};
use crate::failure::{self, Failure, complain};
use crate::numbers;
use crate::output;
use taut_onnx::Generator;

/// A trajectory of a folder.
#[derive(Clone, Debug, PartialEq)]
struct File {
    path: PathBuf,
    scene: String,
    fabric: String,
    variant: Option<String>,
}

/// What `materials.json` tells of a fabric.
#[derive(Deserialize)]
struct Material {
    #[serde(default, rename = "use")]
    made_into: String,
    #[serde(default)]
    fibre: String,
    density_kg_m2: f32,
}

#[derive(Deserialize)]
struct Materials {
    fabrics: BTreeMap<String, Material>,
}

impl Material {
    /// What it is made into, its name and its fibres.
    fn description(&self, name: &str) -> String {
        let words = |text: &str| {
            let letters = |w: &&str| !w.starts_with(|c: char| c.is_ascii_digit());
            text.split([' ', '-', ',']).filter(letters).collect::<Vec<_>>().join(" ")
        };
        [self.made_into.clone(), words(name), words(&self.fibre)].join(" ").trim().to_string()
    }
}

/// A trajectory beside all settings, as it stands in the file and in the ledger.
#[derive(Clone, Serialize, Deserialize)]
struct Row {
    file: String,
    scene: String,
    fabric: String,
    variant: Option<String>,
    description: String,
    density_kg_m2: f32,
    seconds: f32,
    settings: serde_json::Value,
}

/// Errors of a setting, as means over fabrics. Strains: the absolute difference in points of %, along u, v, diagonal.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Mean {
    pub mean_points: [f64; 3],
    pub p99_points: [f64; 3],
    pub silhouette_nmse: f64,
    pub psnr_db: f64,
    pub ssim: f64,
    pub distance_pct: Option<f64>,
}

/// What the ledger holds rows of.
#[derive(Serialize)]
struct Header {
    measurement: &'static str,
    generator: String,
    grid: [u32; 2],
    rate_hz: f32,
    substeps: u32,
    seconds: Option<f32>,
    slack: f32,
    seed: u64,
}

/// Runs all files of a folder.
pub fn run(args: &Args, folder: &Path, generator: &Generator) -> Result<(), Failure> {
    let files = list(folder)?;
    let materials = materials(folder)?;
    let mesh = Mesh::load(&folder.join("mesh.npz")).map_err(Failure::new)?;
    let header = Header {
        measurement: "against",
        generator: generator.info().training_digest.clone(),
        grid: [args.grid.rows, args.grid.columns],
        rate_hz: args.rate,
        substeps: args.substeps,
        seconds: args.seconds,
        slack: args.slack,
        seed: args.seed,
    };
    let mut ledger: Option<Ledger<Row>> = match &args.json {
        Some(path) => Some(Ledger::open(&path.with_extension("jsonl"), &header).map_err(Failure::new)?),
        None => None,
    };
    let mut done = Done::new();
    let mut rows: Vec<Row> = Vec::new();
    for file in &files {
        let name = file.path.strip_prefix(folder).unwrap_or(&file.path).display().to_string();
        if let Some(row) = ledger.as_ref().and_then(|l| l.get(&name)) {
            rows.push(row.clone());
            continue;
        }
        let Some(material) = materials.fabrics.get(&file.fabric) else {
            return Err(Failure::new(format_args!("{name}: materials.json has no fabric `{}`", file.fabric)));
        };
        let stage = Stage::named(&file.scene).map_err(Failure::new)?;
        let own = file.variant.as_deref().and_then(side_of).map(Mesh::square);
        let reference = Reference::load(&file.path, own.as_ref().unwrap_or(&mesh), stage).map_err(Failure::new)?;
        let job = Job {
            scene: file.scene.clone(),
            description: material.description(&file.fabric),
            density_kg_m2: numbers::density(&material.density_kg_m2.to_string())
                .map_err(|e| Failure::new(format_args!("materials.json: the density of {}: {e}", file.fabric)))?,
            seconds: args.seconds.or_else(|| lasted(&file.path)).unwrap_or(stage.seconds),
        };
        let key = format!("{job:?}");
        if !done.contains_key(&key) {
            failure::print_aside(&format!("{name}\n"));
            done.insert(key.clone(), simulate(args, generator, &job)?);
        }
        let settings: BTreeMap<&str, Comparison> =
            compare(args, &reference, &done[&key].outcomes).into_iter().collect();
        let row = Row {
            file: name.clone(),
            scene: file.scene.clone(),
            fabric: file.fabric.clone(),
            variant: file.variant.clone(),
            description: job.description,
            density_kg_m2: job.density_kg_m2,
            seconds: job.seconds,
            settings: serde_json::to_value(settings).map_err(Failure::new)?,
        };
        if let Some(ledger) = &mut ledger {
            ledger.add(&name, row.clone()).map_err(Failure::new)?;
        }
        rows.push(row);
    }
    let means = means(&rows);
    let mut text = String::new();
    for (scene, (fabrics, of)) in &means {
        text.push_str(&table::means(scene, *fabrics, of));
        text.push('\n');
    }
    if let Some(path) = &args.json {
        let means: BTreeMap<&String, BTreeMap<&String, &Mean>> =
            means.iter().map(|(s, (_, of))| (s, of.iter().map(|(n, m)| (n, m)).collect())).collect();
        let all = serde_json::json!({ "header": header, "runs": rows, "mean_errors": means });
        let json = serde_json::to_string_pretty(&all).map_err(Failure::new)? + "\n";
        output::write(path, json.as_bytes())?;
    }
    failure::print(&text)
}

/// All trajectories of a folder, by scene and name. Folders that are no scene are named on stderr and left out.
fn list(folder: &Path) -> Result<Vec<File>, Failure> {
    let wrong = |path: &Path, e: std::io::Error| Failure::new(format_args!("{}: cannot be read: {e}", path.display()));
    let entries = |path: &Path| -> Result<Vec<PathBuf>, Failure> {
        let all: Result<Vec<_>, _> = std::fs::read_dir(path).map_err(|e| wrong(path, e))?.collect();
        let mut all: Vec<PathBuf> = all.map_err(|e| wrong(path, e))?.into_iter().map(|e| e.path()).collect();
        all.sort();
        Ok(all)
    };
    let mut files = Vec::new();
    for scene in entries(folder)?.into_iter().filter(|p| p.is_dir()) {
        let name = scene.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
        if Stage::named(&name).is_err() {
            complain(&format!("warning: {} is no scene of trajectories: left out", scene.display()));
            continue;
        }
        for path in entries(&scene)?.into_iter().filter(|p| p.extension().is_some_and(|e| e == "npz")) {
            let stem = path.file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default();
            let (fabric, variant) = match stem.split_once('_') {
                Some((fabric, variant)) => (fabric.to_string(), Some(variant.to_string())),
                None => (stem, None),
            };
            files.push(File { path, scene: name.clone(), fabric, variant });
        }
    }
    if files.is_empty() {
        return Err(Failure::new(format_args!("{}: no SCENE/FABRIC.npz in it", folder.display())));
    }
    Ok(files)
}

fn materials(folder: &Path) -> Result<Materials, Failure> {
    let path = folder.join("materials.json");
    let wrong = |e: &dyn std::fmt::Display| Failure::new(format_args!("{}: {e}", path.display()));
    let text = std::fs::read_to_string(&path).map_err(|e| wrong(&e))?;
    serde_json::from_str(&text).map_err(|e| wrong(&e))
}

/// The vertices along a side that a variant such as `n17` names.
fn side_of(variant: &str) -> Option<usize> {
    variant.strip_prefix('n')?.parse().ok().filter(|n| (2..=1024).contains(n))
}

/// How long a trajectory lasted, by the json beside it.
fn lasted(path: &Path) -> Option<f32> {
    let text = std::fs::read_to_string(path.with_extension("json")).ok()?;
    let value: serde_json::Value = serde_json::from_str(&text).ok()?;
    numbers::seconds(&value.get("duration_s")?.to_string()).ok()
}

/// The mean errors of every setting by scene, over the fabrics without a variant.
fn means(rows: &[Row]) -> BTreeMap<String, (usize, Vec<(String, Mean)>)> {
    let mut all = BTreeMap::new();
    let scenes: Vec<&String> = rows.iter().filter(|r| r.variant.is_none()).map(|r| &r.scene).collect();
    for scene in scenes {
        let of: Vec<&Row> = rows.iter().filter(|r| r.variant.is_none() && r.scene == *scene).collect();
        let names: Vec<String> =
            of.first().and_then(|r| r.settings.as_object()).map(|s| s.keys().cloned().collect()).unwrap_or_default();
        let mean = |name: &str| {
            let over = |f: &dyn Fn(&serde_json::Value) -> Option<f64>| {
                let values = of.iter().map(|r| f(&r.settings[name]).unwrap_or(f64::NAN));
                values.sum::<f64>() / of.len() as f64
            };
            let strain = |direction: &str, what: &str| {
                over(&|c| {
                    let both = &c["ex_pin_pct"][direction];
                    Some((both["taut"][what].as_f64()? - both["reference"][what].as_f64()?).abs())
                })
            };
            let distance = over(&|c| c["distance_pct"].as_f64());
            Mean {
                mean_points: ["u", "v", "diag"].map(|d| strain(d, "mean")),
                p99_points: ["u", "v", "diag"].map(|d| strain(d, "p99")),
                silhouette_nmse: over(&|c| c["silhouette_nmse"].as_f64()),
                psnr_db: over(&|c| c["psnr_db"].as_f64()),
                ssim: over(&|c| c["ssim"].as_f64()),
                distance_pct: distance.is_finite().then_some(distance),
            }
        };
        all.insert(scene.clone(), (of.len(), names.iter().map(|n| (n.clone(), mean(n))).collect()));
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn descriptions_are_words() {
        let m = Material { made_into: "jeans".into(), fibre: "99% cotton 1% spandex".into(), density_kg_m2: 0.324 };
        assert_eq!(m.description("11oz-black-denim"), "jeans black denim cotton spandex");
        assert_eq!((side_of("n17"), side_of("sl"), side_of("n1"), side_of("n9999")), (Some(17), None, None, None));
    }

    #[test]
    fn means_are_over_fabrics_without_a_variant() {
        let row = |fabric: &str, variant: Option<&str>, taut: f64| {
            let strain =
                serde_json::json!({"taut": {"mean": taut, "p99": taut}, "reference": {"mean": 1.0, "p99": 2.0}});
            Row {
                file: fabric.into(),
                scene: "hang2".into(),
                fabric: fabric.into(),
                variant: variant.map(String::from),
                description: String::new(),
                density_kg_m2: 0.2,
                seconds: 4.0,
                settings: serde_json::json!({"uniform": {"ex_pin_pct": {"u": strain, "v": strain, "diag": strain},
                    "silhouette_nmse": taut, "psnr_db": null, "ssim": 0.5, "distance_pct": null, "finite": true}}),
            }
        };
        let means = means(&[row("a", None, 2.0), row("b", None, 0.5), row("b", Some("sl"), 100.0)]);
        let (fabrics, of) = &means["hang2"];
        let m = &of[0].1;
        assert_eq!((*fabrics, of[0].0.as_str()), (2, "uniform"));
        assert_eq!((m.mean_points[0], m.p99_points[2], m.silhouette_nmse), (0.75, 0.75, 1.25));
        assert!(m.psnr_db.is_nan() && m.distance_pct.is_none());
    }
}
