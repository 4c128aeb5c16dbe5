//! taut needs no std, no allocator, no libc and no loader: a program without any of them gives the hash that std gives.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The scenes, from the same file.
#[allow(dead_code, reason = "only the hashes are looked at")]
#[path = "../bare/src/scene.rs"]
mod scene;

/// What the variables of an outer build would change in the inner one.
const OUTER: [&str; 5] =
    ["RUSTFLAGS", "CARGO_ENCODED_RUSTFLAGS", "CARGO_BUILD_RUSTFLAGS", "CARGO_BUILD_TARGET", "CARGO_TARGET_DIR"];

fn project() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("bare")
}

/// Standard output of a command that must succeed.
fn output(command: &mut Command) -> String {
    let out = command.output().unwrap_or_else(|e| panic!("{command:?}: {e}"));
    assert!(out.status.success(), "{command:?}: {}\n{}", out.status, String::from_utf8_lossy(&out.stderr));
    String::from_utf8(out.stdout).expect("UTF-8")
}

/// The crates of the program with their features, none of them std or alloc.
const CRATES: [&str; 12] = [
    "approx",
    "autocfg", // runs on the host while num_traits is built
    "libm arch default",
    "nalgebra libm",
    "num_complex",
    "num_integer i128",
    "num_rational",
    "num_traits i128 libm",
    "simba libm",
    "taut avx2 avx512 default",
    "taut-bare",
    "typenum",
];

/// What a build made, fresh or not, from the messages of cargo: sorted names with sorted features. The metadata would
/// list crates too that are never built, for a feature `x?/y` of an optional dependency x which is off.
fn built(messages: &str) -> Vec<String> {
    let mut found = BTreeSet::new();
    for line in messages.lines() {
        let message: serde_json::Value = serde_json::from_str(line).expect("JSON");
        let target = &message["target"];
        if message["reason"] != "compiler-artifact" || target["kind"][0] == "custom-build" {
            continue;
        }
        let mut words: Vec<&str> =
            message["features"].as_array().expect("a list").iter().filter_map(|f| f.as_str()).collect();
        words.sort_unstable();
        words.insert(0, target["name"].as_str().expect("a name"));
        found.insert(words.join(" "));
    }
    found.into_iter().collect()
}

/// A call of cargo in the project, which has a lock file of its own.
fn cargo(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO"));
    command.args(arguments).arg("--locked").current_dir(project());
    for name in OUTER {
        command.env_remove(name);
    }
    command
}

/// Names and versions of a lock file.
fn locked(file: &Path) -> BTreeSet<(String, String)> {
    let text = std::fs::read_to_string(file).expect("a lock file");
    let value = |line: Option<&str>, key: &str| {
        let quoted = line.and_then(|l| l.strip_prefix(key)).and_then(|l| l.strip_prefix(" = "));
        quoted.map(|q| q.trim_matches('"').to_string())
    };
    let package = |p: &str| {
        let mut lines = p.trim().lines();
        Some((value(lines.next(), "name")?, value(lines.next(), "version")?))
    };
    text.split("[[package]]").filter_map(package).collect()
}

/// What the program prints: the hashes that `core/tests/scenes.rs` finds with std.
fn expected() -> String {
    let lines = |scenes: &[scene::Scene]| -> String {
        let line = |s: &scene::Scene| {
            let [short, long] = s.golden;
            format!("{:<8}{:>5} {short:016x}\n{:<8}{:>5} {long:016x}\n", s.name, scene::SHORT, s.name, scene::LONG)
        };
        scenes.iter().map(line).collect()
    };
    format!("{}with other floating-point modes\n{}", lines(&scene::SCENES), lines(&scene::SCENES[..2]))
}

#[test]
fn a_program_without_std_gives_the_same_hash() {
    if !cfg!(all(target_arch = "x86_64", target_os = "linux", target_env = "gnu")) {
        println!("SKIPPED: the program is for x86_64 Linux");
        return;
    }
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("bare");
    let messages = output(cargo(&["build", "--release", "--message-format", "json"]).env("CARGO_TARGET_DIR", &folder));
    assert_eq!(built(&messages), CRATES.map(String::from), "crates with their features");
    let program = folder.join("release").join("taut-bare");

    assert_eq!(output(&mut Command::new(&program)), expected());

    assert_eq!(output(Command::new("nm").arg("-u").arg(&program)), "", "nothing is left to be linked");
    let symbols = output(Command::new("nm").arg(&program));
    let names: Vec<&str> = symbols.lines().filter_map(|l| l.split_whitespace().last()).collect();
    assert!(names.contains(&"_start"), "the program has its symbols: {names:?}");
    for name in &names {
        let allocates = ["malloc", "calloc", "realloc", "__rust_alloc", "__rust_realloc", "__rdl_", "__rg_"];
        assert!(!allocates.iter().any(|a| name.contains(a)), "{name} allocates");
    }
    let bytes = std::fs::read(&program).expect("the program");
    const EXECUTABLE: u8 = 2; // e_type of the ELF header; a shared object or a position independent program has 3
    assert_eq!(bytes.get(16), Some(&EXECUTABLE), "the program needs a loader");
}

/// The hash is compared between equal crates, and what the workspace has fetched is enough to build the program.
#[test]
fn the_program_has_the_versions_of_the_workspace() {
    let program = locked(&project().join("Cargo.lock"));
    let workspace = locked(&project().join("../../Cargo.lock"));
    assert!(program.iter().any(|(name, _)| name == "nalgebra"));
    let other: Vec<_> = program.difference(&workspace).filter(|(name, _)| name != "taut-bare").collect();
    assert!(other.is_empty(), "not in the workspace: {other:?}");
}
