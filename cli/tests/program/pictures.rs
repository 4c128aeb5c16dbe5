//! `taut film`, `taut gallery` and the page of `taut measure report`.

use std::fs;

use serde_json::Value;

use crate::run::{entries, home, refuses, succeeds};

#[test]
fn a_film_shows_four_settings_in_motion() {
    let home = home();
    let args = ["film", "red silk", "--scene", "swing", "--grid", "8x8", "--seconds", "0.5", "--out", "f"];
    let text = succeeds(home.path(), &args).stdout;
    assert!(text.contains("generated, levels 5 %") && text.contains("Wrote"), "{text}");
    assert_eq!(entries(&home.path().join("f")), ["film.gif", "film.json"]);
    let gif = fs::read(home.path().join("f/film.gif")).expect("written");
    assert_eq!(&gif[..6], b"GIF89a");
    let report: Value =
        serde_json::from_slice(&fs::read(home.path().join("f/film.json")).expect("written")).expect("JSON");
    assert_eq!(report["pictures"], 10, "20 a second");
    let names: Vec<&str> =
        report["settings"].as_array().expect("settings").iter().filter_map(|s| s["name"].as_str()).collect();
    assert_eq!(names, ["reference", "uniform", "generated", "generated_limits"]);
    assert!(report["settings"][3]["peak_stretch_pct"].as_f64().expect("a number") < 5.01);
    refuses(home.path(), &["film", "silk", "--seconds", "31"]);
    refuses(home.path(), &["film", "qzxvw"]);
}

#[test]
fn a_gallery_hangs_what_it_is_told() {
    let home = home();
    let args = ["gallery", "stiff canvas", "chiffon", "--scene", "edge", "--scene", "cusick", "--grid", "9x9"];
    let args = [&args[..], &["--seconds", "1", "--substeps", "8", "--out", "g", "--json"]].concat();
    let run = succeeds(home.path(), &args);
    assert_eq!(entries(&home.path().join("g")), ["cusick.png", "edge.png", "gallery.json"]);
    let report: Value = serde_json::from_str(&run.stdout).expect("JSON");
    let rows = report["rows"].as_array().expect("rows");
    assert_eq!(rows.len(), 4);
    let density = |i: usize| rows[i]["generator"]["density_kg_m2"].as_f64().expect("a number");
    assert!(density(0) > 3.0 * density(1), "the words count: {} and {}", density(0), density(1));
    let many: Vec<&str> = std::iter::once("gallery").chain(std::iter::repeat_n("denim", 13)).collect();
    assert!(refuses(home.path(), &many).contains("at most 12"));
    assert!(refuses(home.path(), &["gallery", "denim", "qzxvw"]).contains("qzxvw"));
    assert_eq!(entries(home.path()), ["g"], "what was refused left nothing");
}

#[test]
fn the_page_binds_parts_that_are_there_and_runs_the_others() {
    let home = home();
    let part = home.path().join("r/gallery");
    fs::create_dir_all(&part).expect("made");
    let mut hash = taut::Hash64::new();
    hash.bulk(&fs::read(env!("CARGO_BIN_EXE_taut")).expect("read"));
    let summary = format!("taut gallery\nprogram {:016x}\nfabric  max %\nWrote x.png\n", hash.finish());
    fs::write(part.join("summary.txt"), summary).expect("written");
    fs::write(part.join("hang2.png"), b"not looked at").expect("written");
    let args = ["measure", "report", "--only", "gallery", "--out", "r", "--json"];
    let told: Value = serde_json::from_str(&succeeds(home.path(), &args).stdout).expect("JSON");
    assert_eq!(told["parts"][0]["command"], "taut gallery");
    assert_eq!(told["parts"][0]["pictures"], 1);
    let page = fs::read_to_string(home.path().join("r/report.html")).expect("written");
    assert!(page.contains("fabric  max %") && page.contains("data:image/png;base64,bm90IGxvb2tlZCBhdA=="));
    assert!(!page.contains("x.png"));

    // a part that is not whole is measured; one that cannot be is named, and no page is written
    fs::create_dir_all(home.path().join("q")).expect("made");
    fs::write(home.path().join("q/swing"), "a file in the way").expect("written");
    let run = crate::run::taut(home.path(), &["measure", "report", "--only", "swing", "--out", "q"]);
    assert_eq!(run.code, Some(2));
    assert!(run.stderr.contains("taut film \"heavy blue denim\" --scene swing"), "{}", run.stderr);
    assert_eq!(entries(&home.path().join("q")), ["swing"]);
}
