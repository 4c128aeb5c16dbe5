//! The C and C++ programs under the address and undefined-behaviour sanitizers and under Valgrind: nothing reads or writes
//! where it must not, leaks, or looks at what was never written. Needs gcc's sanitizers and valgrind; `.ci/run` installs it.
#![cfg(all(target_os = "linux", target_arch = "x86_64"))]

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::drape::{denim, through_core};
use crate::library::{Language, library, root, succeed};

fn build(language: Language, source: &str, options: &[&str], out: &Path) {
    let (compiler, standard) = match language {
        Language::C11 => ("cc", "-std=c11"),
        Language::Cpp17 | Language::Cpp17Bare => ("c++", "-std=c++17"),
    };
    let mut command = Command::new(compiler);
    command.args([standard, "-g", "-O1", "-I"]).arg(root().join("include")).args(options).arg(root().join(source));
    succeed(command.arg(library().join("libtaut.a")).arg("-lm").arg("-o").arg(out));
}

/// The programs; the first two print the hash of the run.
const PROGRAMS: [(Language, &str); 3] = [
    (Language::C11, "examples/c/drape.c"),
    (Language::Cpp17, "examples/cpp/drape.cpp"),
    (Language::C11, "tests/tests/c_programs/environment.c"),
];

fn check(name: &str, printed: Vec<u8>) {
    let (_, hash) = through_core();
    let printed = String::from_utf8(printed).unwrap();
    assert!(printed.lines().any(|l| l == hash), "{name}: {printed}");
}

#[test]
fn the_sanitizers_find_nothing() {
    const OPTIONS: [&str; 3] = ["-fsanitize=address,undefined", "-fno-sanitize-recover=all", "-fno-omit-frame-pointer"];
    let folder = tempfile::tempdir().unwrap();
    let program = folder.path().join("program");
    for (language, source) in PROGRAMS {
        build(language, source, &OPTIONS, &program);
        check(source, succeed(Command::new(&program).arg(denim())).stdout);
    }
    // and they are there: a program that reads beyond its end is stopped
    let bad = folder.path().join("bad.c");
    std::fs::write(&bad, "int main(int n, char **a) { int x[2] = {n, 0}; (void)a; return x[n + 1]; }\n").unwrap();
    succeed(Command::new("cc").args(OPTIONS).arg(&bad).arg("-o").arg(&program));
    assert!(!Command::new(&program).output().unwrap().status.success());
}

#[test]
fn valgrind_finds_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let program: PathBuf = folder.path().join("program");
    let (language, source) = PROGRAMS[0];
    build(language, source, &[], &program);
    let mut valgrind = Command::new("valgrind");
    valgrind.args(["--quiet", "--error-exitcode=9", "--leak-check=full", "--show-leak-kinds=all"]);
    let output = succeed(valgrind.arg(&program).arg(denim()));
    assert!(output.stderr.is_empty(), "{}", String::from_utf8_lossy(&output.stderr));
    check(source, output.stdout);
}
