//! The headers in other languages and for other systems; taut.hpp has all that taut.h has.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
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

/// What the preprocessor and the parser make of a header.
fn parse(compiler: &str, flags: &[&str], header: &Path) -> String {
    let mut strict = Command::new(compiler);
    strict.args(flags).args(["-Wall", "-Wextra", "-pedantic", "-Werror", "-fsyntax-only"]).arg(header);
    succeed(&mut strict);
    let text = succeed(Command::new(compiler).args(flags).args(["-E", "-P"]).arg(header));
    String::from_utf8(text.stdout).unwrap()
}

#[test]
fn the_headers_are_clean_in_every_standard() {
    for compiler in Language::C11.compilers() {
        for standard in ["-std=c99", "-std=c11", "-std=c17", "-std=gnu2x"] {
            parse(compiler, &["-xc", standard], &root().join("include/taut.h"));
        }
    }
    for compiler in Language::Cpp17.compilers() {
        for standard in ["-std=c++11", "-std=c++14", "-std=c++17", "-std=c++20"] {
            parse(compiler, &["-xc++", standard], &root().join("include/taut.h"));
        }
        for standard in ["-std=c++17", "-std=c++20"] {
            parse(compiler, &["-xc++", standard], &root().join("include/taut.hpp"));
        }
    }
}

/// The Windows target of clang, with nothing but its own freestanding headers. Each function is imported, exported or
/// neither, as the program asks. Elsewhere they are visible even in a program that hides its own.
#[test]
fn the_headers_are_clean_for_windows() {
    if !Language::C11.compilers().contains(&"clang") {
        println!("there is no clang on this machine");
        return;
    }
    let functions = declared("taut.h").len();
    for target in ["--target=x86_64-pc-windows-msvc", "--target=aarch64-pc-windows-msvc", "--target=x86_64-w64-mingw32"]
    {
        for (define, import, export) in
            [("-DNOTHING", 0, 0), ("-DTAUT_SHARED", functions, 0), ("-DTAUT_EXPORTS", 0, functions)]
        {
            for (language, header) in [("-xc", "taut.h"), ("-xc++", "taut.h"), ("-xc++", "taut.hpp")] {
                let standard = if language == "-xc" { "-std=c11" } else { "-std=c++17" };
                let flags = [target, "-ffreestanding", language, standard, define];
                let text = parse("clang", &flags, &root().join("include").join(header));
                let count = |word: &str| text.matches(word).count();
                assert_eq!((count("(dllimport)"), count("(dllexport)")), (import, export), "{header} {define}");
            }
        }
    }
    let text =
        parse("clang", &["--target=x86_64-unknown-linux-gnu", "-ffreestanding", "-xc"], &root().join("include/taut.h"));
    assert_eq!(text.matches("visibility(\"default\")").count(), functions);
}
