//! `taut info`, and the program's own help.

use serde_json::Value;

use crate::run::{generator, home, succeeds};

#[test]
fn a_file_and_the_built_in_generator_tell_the_same() {
    let home = home();
    let path = generator();
    let path = path.to_str().expect("a path");
    let json = |args: &[&str]| -> Value { serde_json::from_str(&succeeds(home.path(), args).stdout).expect("JSON") };
    let (mut file, mut own) = (json(&["info", path, "--json"]), json(&["info", "--json"]));
    assert_eq!(own["file"], "built in");
    assert_eq!(file["file"], path);
    file["file"] = Value::Null;
    own["file"] = Value::Null;
    assert_eq!(file, own);
    assert!(own["words"].as_u64() > Some(0) && own["tokens"] == 16 && own["noise"] == 128);
    assert!(own["file_bytes"].as_u64() < Some(16_000_000));
    let warp = own["channel_ranges_n_per_m"]["warp"].as_array().expect("a range");
    assert!(warp[0].as_f64() < warp[1].as_f64());

    let text = succeeds(home.path(), &["info", path]).stdout;
    for part in ["Vocabulary", "warp", "density_kg_m2", "Training digest"] {
        assert!(text.contains(part), "{part}: {text}");
    }
}

#[test]
fn help_and_version_are_on_stdout() {
    let home = home();
    for args in [&["--help"][..], &["drape", "--help"], &["correct", "-h"], &["info", "-h"]] {
        let run = succeeds(home.path(), args);
        assert!(run.stdout.contains("Usage:") && run.stderr.is_empty(), "{args:?}");
    }
    let version = succeeds(home.path(), &["--version"]).stdout;
    assert_eq!(version, format!("taut {}\n", env!("CARGO_PKG_VERSION")));
}
