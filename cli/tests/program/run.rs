//! Runs the program and looks at what came of it.

use std::path::{Path, PathBuf};
use std::process::Command;

/// Exit code and both outputs of a run.
pub struct Run {
    pub code: Option<i32>,
    pub stdout: String,
    pub stderr: String,
}

/// Runs the program in a folder.
pub fn taut(folder: &Path, args: &[&str]) -> Run {
    let output =
        Command::new(env!("CARGO_BIN_EXE_taut")).args(args).current_dir(folder).output().expect("the program starts");
    Run {
        code: output.status.code(),
        stdout: String::from_utf8(output.stdout).expect("UTF-8"),
        stderr: String::from_utf8(output.stderr).expect("UTF-8"),
    }
}

/// Runs the program, which must succeed.
pub fn succeeds(folder: &Path, args: &[&str]) -> Run {
    let run = taut(folder, args);
    assert_eq!(run.code, Some(0), "{args:?}: {}", run.stderr);
    run
}

/// Runs the program, which must refuse with exit code 2 and one line on stderr. Returns the line.
pub fn refuses(folder: &Path, args: &[&str]) -> String {
    let run = taut(folder, args);
    assert_eq!(run.code, Some(2), "{args:?}: {} {}", run.stdout, run.stderr);
    assert_eq!(run.stdout, "", "{args:?}");
    assert_eq!(run.stderr.lines().count(), 1, "{args:?}: {}", run.stderr);
    let line = run.stderr.trim_end();
    assert!(line.starts_with("taut: "), "{line}");
    assert!(!line.contains("internal error") && !line.contains("panicked"), "{line}");
    line.into()
}

/// Names of what is in a folder, sorted.
pub fn entries(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = std::fs::read_dir(folder)
        .expect("listed")
        .map(|e| e.expect("an entry").file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}

/// A folder of this test's own.
pub fn home() -> tempfile::TempDir {
    tempfile::tempdir().expect("a temporary folder")
}

/// The generator that is built into the program.
pub fn generator() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../onnx/generator.onnx")
}
