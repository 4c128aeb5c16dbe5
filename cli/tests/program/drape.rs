//! `taut drape` on a small cloth for a short time.

use serde_json::Value;

use crate::run::{Run, entries, home, succeeds};

const SMALL: [&str; 8] = ["--grid", "8x10", "--substeps", "4", "--seconds", "0.5", "--size", "1x0.8"];
const NAMES: [&str; 7] =
    ["reference", "random", "uniform", "analytic", "uniform_inertia", "analytic_inertia", "generated"];

fn drape(folder: &std::path::Path, description: &str, more: &[&str]) -> Run {
    succeeds(folder, &[&["drape", description], &SMALL[..], more].concat())
}

fn report(run: &Run) -> Value {
    serde_json::from_str(&run.stdout).expect("JSON and nothing else on stdout")
}

fn hash(report: &Value, setting: usize) -> &str {
    report["settings"][setting]["state_hash"].as_str().expect("a hash")
}

#[test]
fn the_report_has_the_promised_keys() {
    let home = home();
    let run = drape(home.path(), "heavy blue denim", &["--json", "--density", "0.3", "--seed", "7"]);
    let r = report(&run);
    assert_eq!(r["scene"], "hang2");
    assert_eq!(r["description"], "heavy blue denim");
    assert_eq!(r["seed"], 7);
    assert_eq!(r["grid"], serde_json::json!([8, 10]));
    assert_eq!(r["rate_hz"], 60.0);
    assert_eq!(r["substeps"], 4);
    assert_eq!(r["budget"], "tuned");
    let density = r["density_kg_m2"].as_f64().expect("a number");
    assert!((density - 0.3).abs() < 1e-6);
    let settings = r["settings"].as_array().expect("a list");
    let names: Vec<&str> = settings.iter().filter_map(|s| s["name"].as_str()).collect();
    assert_eq!(names, NAMES);
    for s in settings {
        for key in ["max", "p99", "mean", "ex_pin_max"] {
            assert!(s["stretch_pct"][key].is_f64(), "{key} of {s}");
        }
        let cut = s["cut_fraction"].as_f64().expect("a number");
        assert!((0.0..=1.0).contains(&cut), "{s}");
        assert!(s["ns_per_particle_step"].as_f64() > Some(0.0), "{s}");
        assert_eq!(s["finite"], true);
        let hash = s["state_hash"].as_str().expect("text");
        assert!(hash.len() == 16 && hash.bytes().all(|b| b.is_ascii_hexdigit()), "{hash}");
        assert!(s["peak_stretch_pct"].is_f64() && s["rms_speed_m_s"].is_f64());
    }
    let size: Vec<f64> = r["size_m"].as_array().expect("a list").iter().filter_map(Value::as_f64).collect();
    assert!(size[0] == 1.0 && (size[1] - 0.8).abs() < 1e-6, "{size:?}");
    assert_eq!(r["reference_fabric"]["kind"], "denim");
    assert_eq!(r["reference_fabric"]["measured"], true);
    assert_eq!(r["reference_fabric"]["changed_by_words"], true);
    assert!(r["reference_substeps"].as_u64() >= Some(4));
    assert!(settings[0]["cut_fraction"].as_f64() < Some(1e-6), "the reference is not cut");
    for other in ["uniform_inertia", "analytic_inertia"] {
        assert!(r["net_share"][other]["max_points"].is_f64());
        assert!(r["net_share"][other]["ex_pin_max_points"].is_f64());
    }
    assert!(r["generator"]["stretch_limits"]["diagonal"].is_f64());

    // the table goes to stderr, and the file is what stdout says
    for name in ["reference", "uniform + inertia", "generated"] {
        assert!(run.stderr.contains(name), "{}", run.stderr);
    }
    let folder = home.path().join("out/drape");
    assert_eq!(entries(&folder), ["drape.png", "report.json"]);
    let file = std::fs::read_to_string(folder.join("report.json")).expect("read");
    assert_eq!(file, run.stdout);
    let png = std::fs::read(folder.join("drape.png")).expect("read");
    assert!(png.starts_with(b"\x89PNG") && png.ends_with(b"IEND\xae\x42\x60\x82"));
}

#[test]
fn without_json_the_table_is_on_stdout() {
    let home = home();
    let run = drape(home.path(), "heavy blue denim", &["--out", "a/b", "--scene", "edge"]);
    let stdout = &run.stdout;
    for text in ["heavy blue denim", "edge, 8 x 10", "max %", "analytic + inertia", "net's own share", "report.json"] {
        assert!(stdout.contains(text), "{text}: {stdout}");
    }
    assert_eq!(run.stderr, "");
    assert_eq!(entries(&home.path().join("a/b")), ["drape.png", "report.json"]);
}

#[test]
fn the_same_words_and_seed_give_the_same_states() {
    let home = home();
    let one = |words, more: &[&str]| report(&drape(home.path(), words, &[&["--json"], more].concat()));
    let (a, b, other) = (one("silk", &[]), one("silk", &[]), one("silk", &["--seed", "1"]));
    for (i, name) in NAMES.iter().enumerate() {
        assert_eq!(hash(&a, i), hash(&b, i), "{name}");
    }
    assert_ne!(hash(&a, 6), hash(&other, 6), "another seed is another field");
    assert_ne!(hash(&a, 1), hash(&other, 1), "and another random K");
    let stiff = one("heavy blue denim", &[]);
    assert_ne!(hash(&a, 0), hash(&stiff, 0));
    assert_ne!(hash(&a, 6), hash(&stiff, 6));
    // the density is the generator's, for all settings
    assert_ne!(a["density_kg_m2"], stiff["density_kg_m2"]);
}

#[test]
fn the_budget_and_the_step_matter() {
    let home = home();
    let max = |more: &[&str]| {
        let r = report(&drape(home.path(), "denim", &[&["--json"], more].concat()));
        r["settings"][2]["stretch_pct"]["max"].as_f64().expect("a number")
    };
    let (tuned, certified, fine) = (max(&[]), max(&["--budget", "certified"]), max(&["--rate", "240"]));
    assert!(certified > tuned && tuned > fine, "{certified} {tuned} {fine}");
}

#[test]
fn unknown_words_are_named_and_skipped() {
    let home = home();
    let run = drape(home.path(), "heavy qzxvw denim bqqzt", &["--json"]);
    let r = report(&run);
    assert_eq!(r["unknown_words"], serde_json::json!(["qzxvw", "bqqzt"]));
    let warning = run.stderr.lines().next().expect("a line");
    assert!(warning.starts_with("taut: warning:"), "{warning}");
    assert!(warning.contains("qzxvw") && warning.contains("bqqzt"), "{warning}");
    let long = vec!["denim"; 17].join(" ");
    let run = succeeds(home.path(), &["correct", &long, "--out", "f"]);
    assert!(run.stderr.contains("only the first 16"), "{}", run.stderr);
}

#[test]
fn a_fabric_without_a_name_is_compared_with_its_own_medians() {
    let home = home();
    let r = report(&drape(home.path(), "heavy", &["--json"]));
    let reference = &r["reference_fabric"];
    assert_eq!(reference["kind"], "none named: the generator's own medians");
    assert_eq!(reference["measured"], false);
    assert_eq!(reference["stiffness_n_per_m"], r["generator"]["median_stiffness_n_per_m"]);
}

#[test]
fn a_full_folder_is_written_over_and_other_files_stay() {
    let home = home();
    std::fs::write(home.path().join("notes.txt"), "mine").expect("written");
    for seed in ["1", "2"] {
        let run = drape(home.path(), "denim", &["--out", ".", "--json", "--seed", seed]);
        let file = std::fs::read_to_string(home.path().join("report.json")).expect("read");
        assert_eq!(file, run.stdout);
    }
    assert_eq!(entries(home.path()), ["drape.png", "notes.txt", "report.json"]);
}
