//! `taut plan`: settings and sentences.

use serde_json::Value;

use crate::run::{home, refuses, succeeds};

fn plan(args: &[&str]) -> Value {
    let home = home();
    serde_json::from_str(&succeeds(home.path(), &[&["plan"], args, &["--json"]].concat()).stdout).expect("JSON")
}

#[test]
fn a_plan_says_why() {
    let home = home();
    let text = succeeds(home.path(), &["plan", "denim", "--scene", "edge", "--grid", "64x64"]).stdout;
    for part in [
        "solver",
        "substeps",
        "bend off: the scene (top row pinned) stretches ",
        "less than your tolerance as it is; with bend springs it needs ",
        " off: it needs",
    ] {
        assert!(text.contains(part), "{part}: {text}");
    }
}

#[test]
fn a_tighter_tolerance_costs_more_and_a_short_time_is_told() {
    let loose = plan(&["denim", "--tolerance", "10"]);
    let tight = plan(&["denim", "--tolerance", "1"]);
    assert!(loose["meets_tolerance"] == true && tight["meets_tolerance"] == true);
    assert!(tight["us_per_frame"].as_f64() > loose["us_per_frame"].as_f64());
    assert!(tight["stretch_pct"].as_f64() <= Some(1.0));
    let short = plan(&["denim", "--tolerance", "1", "--budget-us", "60"]);
    assert!(short["meets_tolerance"] == false && short["us_per_frame"].as_f64() <= Some(60.0), "{short}");
    assert!(short["why"][0].as_str().is_some_and(|s| s.starts_with("nothing meets 1.00 %")), "{short}");
    assert!(plan(&["felt", "--scene", "drape"])["bend"] == true);
}

#[test]
fn what_cannot_be_planned_is_refused() {
    let home = home();
    assert!(refuses(home.path(), &["plan", "quantum foam"]).contains("names no fabric"));
    assert!(refuses(home.path(), &["plan", "denim", "--budget-us", "0.001"]).contains("not even the cheapest"));
    assert!(refuses(home.path(), &["plan", "denim", "--tolerance", "0"]).contains("--tolerance"));
}
