//! Builds the library once and compiles programs against it.

use std::collections::BTreeSet;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::OnceLock;

/// The root of the workspace.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("tests lies in the workspace").to_path_buf()
}

/// The folder with libtaut.a and libtaut.so of `cargo build --release -p taut-ffi`.
pub fn library() -> &'static Path {
    static BUILT: OnceLock<PathBuf> = OnceLock::new();
    BUILT.get_or_init(|| {
        let target = Path::new(env!("CARGO_TARGET_TMPDIR")).join("taut-ffi");
        let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
        let mut build = Command::new(cargo);
        build
            .args(["build", "--release", "--locked", "-p", "taut-ffi", "--target-dir"])
            .arg(&target)
            .current_dir(root())
            // what the tests themselves are built with (coverage, sanitizers) is no business of the library
            .env_remove("RUSTFLAGS")
            .env_remove("CARGO_ENCODED_RUSTFLAGS");
        succeed(&mut build);
        target.join("release")
    })
}

/// How a program gets at the library.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Linking {
    Static,
    Shared,
}

/// Both ways of linking.
pub const BOTH: [Linking; 2] = [Linking::Static, Linking::Shared];

/// The language of a program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Language {
    C11,
    Cpp17,
    /// Without exceptions and run-time type information, as many engines are built.
    Cpp17Bare,
}

impl Language {
    /// The compilers on this machine: the default one, which must be there, and clang if it is.
    pub fn compilers(self) -> Vec<&'static str> {
        let (default, clang) = match self {
            Language::C11 => ("cc", "clang"),
            Language::Cpp17 | Language::Cpp17Bare => ("c++", "clang++"),
        };
        let mut all = vec![default];
        if Command::new(clang).arg("--version").output().is_ok() {
            all.push(clang);
        }
        all
    }

    /// The flags of the language: every warning is an error.
    pub fn flags(self) -> &'static [&'static str] {
        match self {
            Language::C11 => &["-std=c11", "-Wall", "-Wextra", "-pedantic", "-Werror"],
            Language::Cpp17 => &["-std=c++17", "-Wall", "-Wextra", "-pedantic", "-Werror"],
            Language::Cpp17Bare => {
                &["-std=c++17", "-fno-exceptions", "-fno-rtti", "-Wall", "-Wextra", "-pedantic", "-Werror"]
            }
        }
    }
}

/// Compiles sources to the program `out`.
pub fn compile(compiler: &str, language: Language, sources: &[PathBuf], linking: Linking, out: &Path) {
    let mut command = Command::new(compiler);
    command.args(language.flags()).args(["-O1", "-pthread"]).arg("-I").arg(root().join("include")).args(sources);
    match linking {
        Linking::Static => {
            command.arg(library().join("libtaut.a"));
        }
        Linking::Shared => {
            let mut run_path = OsString::from("-Wl,-rpath,");
            run_path.push(library());
            command.arg("-L").arg(library()).arg("-ltaut").arg(run_path);
        }
    }
    // libtaut needs no other library; libm is for the programs' own use of fenv.h
    command.arg("-lm").arg("-o").arg(out);
    succeed(&mut command);
}

/// The functions that a header declares.
pub fn declared(header: &str) -> BTreeSet<String> {
    std::fs::read_to_string(root().join("include").join(header))
        .unwrap()
        .lines()
        .filter(|l| !l.starts_with(['/', '#', ' ']))
        .filter_map(|l| {
            let (before, _) = l.split_once('(')?;
            let name = before.rsplit([' ', '*']).next()?;
            name.starts_with("taut_").then(|| name.to_string())
        })
        .collect()
}

/// Writes a C program into a temporary folder, compiles and runs it with the arguments, both ways of linking and all
/// compilers. Returns what it printed, which must be the same every time.
pub fn run_c(source: &str, arguments: &[PathBuf]) -> String {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("program.c");
    std::fs::write(&file, source).unwrap();
    run_all(Language::C11, &[file], arguments)
}

/// The same for sources that lie somewhere.
pub fn run_all(language: Language, sources: &[PathBuf], arguments: &[PathBuf]) -> String {
    let folder = tempfile::tempdir().unwrap();
    let mut printed: Option<String> = None;
    for compiler in language.compilers() {
        for linking in BOTH {
            let program = folder.path().join(format!("{compiler}-{linking:?}"));
            compile(compiler, language, sources, linking, &program);
            let output = succeed(Command::new(&program).args(arguments));
            let text = String::from_utf8(output.stdout).unwrap();
            let first = printed.get_or_insert_with(|| text.clone());
            assert_eq!(*first, text, "{compiler}, {linking:?}");
        }
    }
    printed.expect("there is a compiler")
}

/// Runs a command that must succeed.
pub fn succeed(command: &mut Command) -> Output {
    // cargo names its own folders there, where a library of an earlier build may lie
    command.env_remove("LD_LIBRARY_PATH");
    let output = command.output().unwrap_or_else(|e| panic!("{command:?}: {e}"));
    assert!(
        output.status.success(),
        "{command:?}: {}\n{}{}",
        output.status,
        String::from_utf8_lossy(&output.stdout),
        String::from_utf8_lossy(&output.stderr)
    );
    output
}
