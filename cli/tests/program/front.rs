//! `taut measure front`: what it makes of the rows of an interrupted run, and what it refuses.

use serde_json::{Value, json};
use taut_lab::front::{Correction, Set, Spec};
use taut_lab::scene::Scene;

use crate::run::{entries, home, refuses, succeeds};

/// A ledger in which every row of edge is there: nothing is left to be measured.
fn ledger(digest: &str) -> String {
    // the keys in the order in which the program writes them
    let mut text = format!("{{\"measure\":\"front\",\"version\":1,\"quick\":true,\"generator\":\"{digest}\"}}\n");
    for (i, spec) in Spec::list(Set::Quick, &[Scene::Edge]).iter().enumerate() {
        let error = if spec.correction == Correction::Reference { 0.0 } else { 1.0 + i as f64 };
        let row = json!({
            "scene": "edge", "fabric": spec.fabric, "side": spec.side, "rate_hz": 60.0, "substeps": spec.substeps,
            "solver": if spec.key().contains("euler/") && !spec.key().contains("implicit") { "euler" } else { "bdf2" },
            "cg_iterations": null, "families": if spec.families.0 == 7 { "all" } else { "no_bend" },
            "limits": spec.limits.name(), "limit_pct": null, "correction": spec.correction,
            "ns_per_particle_step": 7.0, "cost_in_plain_steps": 1.0, "cpu_ms_per_simulated_s": 5.0,
            "frame_us_p95": 1.0, "relative_cost": f64::from(spec.substeps) / 16.0, "memory_bytes": 1000,
            "stretch_max_pct": 2.0 * error, "stretch_p99_pct": null, "stretch_mean_pct": null,
            "peak_stretch_pct": null, "strain_error_points": error, "distance_pct": null, "centre_error_mm": null,
            "kinetic_energy_error_pct": null, "period_error_pct": null, "same_stiffness": false, "cut_fraction": 0.0,
            "inertia_added": 0.0, "rms_speed_m_s": null, "finite": true, "state_hash": "0"
        });
        text += &format!("{}\n", json!({"key": spec.key(), "row": row}));
    }
    text
}

#[test]
fn rows_become_a_table_a_picture_and_a_scoreboard() {
    let home = home();
    let info: Value = serde_json::from_str(&succeeds(home.path(), &["info", "--json"]).stdout).expect("JSON");
    let digest = info["training_digest"].as_str().expect("a digest");
    let out = home.path().join("out");
    std::fs::create_dir(&out).expect("made");
    std::fs::write(out.join("front.jsonl"), ledger(digest)).expect("written");

    let args = ["measure", "front", "--quick", "--scene", "edge", "--out", "out"];
    let text = succeeds(home.path(), &args).stdout;
    for part in ["uniform + inertia", "data driven", "strain limit", "the learned field", "Wrote"] {
        assert!(text.contains(part), "{part}: {text}");
    }
    assert_eq!(entries(&out), ["edge.png", "front.csv", "front.json", "front.jsonl"]);
    let json = succeeds(home.path(), &[&args[..], &["--json"]].concat()).stdout;
    assert_eq!(json, std::fs::read_to_string(out.join("front.json")).expect("written"));
    let report: Value = serde_json::from_str(&json).expect("JSON");
    let rows = report["rows"].as_array().expect("rows");
    assert_eq!(rows.len(), Spec::list(Set::Quick, &[Scene::Edge]).len());
    assert_eq!(std::fs::read_to_string(out.join("front.csv")).expect("written").lines().count(), rows.len() + 1);
    assert_eq!(report["scoreboards"].as_array().map(Vec::len), Some(6), "three fabrics, two costs");
}

#[test]
fn a_ledger_of_something_else_is_left_alone() {
    let home = home();
    std::fs::create_dir(home.path().join("out")).expect("made");
    std::fs::write(home.path().join("out/front.jsonl"), "{}\n").expect("written");
    let line = refuses(home.path(), &["measure", "front", "--quick", "--out", "out"]);
    assert!(line.contains("another measurement"), "{line}");
    assert_eq!(std::fs::read_to_string(home.path().join("out/front.jsonl")).expect("read"), "{}\n");
    assert!(refuses(home.path(), &["measure", "front", "--scene", "moon"]).contains("cusick"));
}
