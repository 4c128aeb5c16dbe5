//! The headers in other languages and for other systems; taut.hpp has all that taut.h has.

use std::collections::BTreeSet;
use std::path::PathBuf;
use std::process::Command;

use crate::drape::denim;
use crate::library::{Language, declared, root, run_all, succeed};

fn everything() -> PathBuf {
    root().join("tests/tests/c_programs/everything.cpp")
}

#[test]
fn every_function_can_be_called_through_the_classes() {
    for language in [Language::Cpp17Bare, Language::Cpp17] {
        assert_eq!(run_all(language, &[everything()], &[denim()]), "every function was called\n");
    }
}

/// The program above knows only taut.hpp; what it needs of the library is every function of taut.h.
#[test]
fn the_classes_leave_no_function_out() {
    let folder = tempfile::tempdir().unwrap();
    let object = folder.path().join("everything.o");
    let mut compile = Command::new("c++");
    compile.args(Language::Cpp17Bare.flags()).arg("-c").arg(everything());
    compile.arg("-I").arg(root().join("include")).arg("-o").arg(&object);
    succeed(&mut compile);
    let needed = succeed(Command::new("nm").arg("--undefined-only").arg(&object));
    let needed: BTreeSet<String> = String::from_utf8(needed.stdout)
        .unwrap()
        .split_whitespace()
        .map(|w| w.trim_start_matches('_').to_string())
        .filter(|w| w.starts_with("taut_"))
        .collect();
    assert_eq!(needed, declared("taut.h"));
    let text = std::fs::read_to_string(everything()).unwrap();
    assert!(!text.contains("\"taut.h\"") && !text.contains(" taut_grid_c") && !text.contains(" taut_cloth_s"));
}

/// The parser has nothing to say about a header.
fn clean(compiler: &str, flags: &[&str], header: &str) {
    let mut command = Command::new(compiler);
    command.args(flags).args(["-Wall", "-Wextra", "-pedantic", "-Werror", "-fsyntax-only"]);
    succeed(command.arg(root().join("include").join(header)));
}

/// How often a word is there when the preprocessor is through. (It turns __declspec into an attribute for MinGW.)
fn count(flags: &[&str], header: &str, word: &str) -> usize {
    let mut command = Command::new("clang");
    let output = succeed(command.args(flags).args(["-E", "-P"]).arg(root().join("include").join(header)));
    String::from_utf8(output.stdout).unwrap().matches(word).count()
}

#[test]
fn the_headers_are_clean_in_every_standard() {
    for compiler in Language::C11.compilers() {
        for standard in ["-std=c99", "-std=gnu2x"] {
            clean(compiler, &["-xc", standard], "taut.h");
            clean(compiler, &["-xc", standard], "taut_generator.h");
        }
    }
    for compiler in Language::Cpp17.compilers() {
        clean(compiler, &["-xc++", "-std=c++11"], "taut.h");
        clean(compiler, &["-xc++", "-std=c++11"], "taut_generator.h");
        for standard in ["-std=c++17", "-std=c++20"] {
            clean(compiler, &["-xc++", standard], "taut.hpp");
        }
    }
}

/// The Windows targets of clang, with nothing but its own freestanding headers. Each function is imported, exported or
/// neither, as the program asks. Elsewhere they are visible even in a program that hides its own.
#[test]
fn the_headers_are_clean_for_windows() {
    if !Language::C11.compilers().contains(&"clang") {
        println!("there is no clang on this machine");
        return;
    }
    let functions = declared("taut.h").len();
    for target in ["x86_64-pc-windows-msvc", "aarch64-pc-windows-msvc", "x86_64-w64-mingw32"] {
        let target = format!("--target={target}");
        for (define, import, export) in
            [("-DNOTHING", 0, 0), ("-DTAUT_SHARED", functions, 0), ("-DTAUT_EXPORTS", 0, functions)]
        {
            let c = [&target, "-ffreestanding", "-xc", "-std=c11", define];
            clean("clang", &c, "taut.h");
            clean("clang", &c, "taut_generator.h");
            clean("clang", &[&target, "-ffreestanding", "-xc++", "-std=c++17", define], "taut.hpp");
            assert_eq!(count(&c, "taut.h", "(dllimport)"), import, "{target} {define}");
            assert_eq!(count(&c, "taut.h", "(dllexport)"), export, "{target} {define}");
        }
    }
    let linux = ["--target=x86_64-unknown-linux-gnu", "-ffreestanding", "-xc"];
    assert_eq!(count(&linux, "taut.h", "visibility(\"default\")"), functions);
}
