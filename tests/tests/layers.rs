//! The house as it is drawn: dependencies point one way, files stay small, nothing names a machine.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the workspace").to_path_buf()
}

/// Normal dependencies of our crates: name to names.
fn dependencies() -> BTreeMap<String, Vec<String>> {
    let out = Command::new(env!("CARGO"))
        .args(["metadata", "--format-version", "1", "--no-deps", "--offline"])
        .current_dir(root())
        .output()
        .expect("cargo runs");
    assert!(out.status.success(), "{}", String::from_utf8_lossy(&out.stderr));
    let metadata: serde_json::Value = serde_json::from_slice(&out.stdout).expect("JSON");
    let list = |p: &serde_json::Value| {
        let normal = |d: &&serde_json::Value| d["kind"].is_null();
        let deps = p["dependencies"].as_array().expect("a list");
        deps.iter().filter(normal).map(|d| d["name"].as_str().expect("a name").to_string()).collect()
    };
    let packages = metadata["packages"].as_array().expect("a list");
    packages.iter().map(|p| (p["name"].as_str().expect("a name").to_string(), list(p))).collect()
}

#[test]
fn dependencies_point_one_way() {
    let allowed: BTreeMap<&str, &[&str]> = BTreeMap::from([
        ("taut", [].as_slice()),
        ("taut-ffi", &["taut", "taut-onnx"]),
        ("taut-onnx", &["taut"]),
        ("taut-lab", &["taut"]),
        ("taut-cli", &["taut", "taut-lab", "taut-onnx"]),
        ("taut-train", &["taut", "taut-lab"]),
        ("taut-tests", &[]),
    ]);
    let found = dependencies();
    assert_eq!(found.keys().map(String::as_str).collect::<Vec<_>>(), {
        let mut names: Vec<_> = allowed.keys().copied().collect();
        names.sort_unstable();
        names
    });
    for (name, deps) in &found {
        for dep in deps.iter().filter(|d| *d == "taut" || d.starts_with("taut-")) {
            assert!(allowed[name.as_str()].contains(&dep.as_str()), "{name} must not depend on {dep}");
        }
    }
    assert_eq!(found["taut"], ["libm", "nalgebra"], "core depends on these two and nothing else");
}

/// Files that git tracks or would track.
fn files() -> Vec<PathBuf> {
    let out = Command::new("git")
        .args(["ls-files", "-z", "--cached", "--others", "--exclude-standard"])
        .current_dir(root())
        .output()
        .expect("git runs");
    assert!(out.status.success());
    let text = String::from_utf8(out.stdout).expect("paths are UTF-8");
    text.split('\0').filter(|p| !p.is_empty()).map(|p| root().join(p)).filter(|p| p.is_file()).collect()
}

fn is_source(path: &Path) -> bool {
    path.extension().is_some_and(|e| ["rs", "c", "cpp", "hpp", "py"].iter().any(|s| e == *s))
}

#[test]
fn a_file_holds_one_concept() {
    for path in files().iter().filter(|p| is_source(p)) {
        let lines = std::fs::read_to_string(path).expect("text").lines().count();
        assert!(lines <= 650, "{} has {lines} lines: split it", path.display());
    }
}

#[test]
fn nothing_names_a_machine() {
    // written so that this file does not name them either
    let words = [["/wo", "rk/"].concat(), ["/ro", "ot/"].concat(), ["/ho", "me/"].concat()];
    for path in files() {
        let binary = ["onnx", "f16", "png", "tautfield"].iter().any(|b| path.extension().is_some_and(|e| e == *b));
        if binary {
            continue;
        }
        let Ok(text) = std::fs::read_to_string(&path) else { continue };
        for word in &words {
            assert!(!text.contains(word.as_str()), "{} names {word}", path.display());
        }
    }
}
