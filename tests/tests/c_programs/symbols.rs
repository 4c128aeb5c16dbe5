//! What the shared library gives away and what it needs.

use std::collections::BTreeSet;
use std::path::Path;
use std::process::Command;

use crate::library::{declared, library, root, succeed};

/// Runs nm on the shared library and returns (kind, name) of each symbol.
#[cfg(target_os = "linux")]
fn symbols(arguments: &[&str]) -> Vec<(String, String)> {
    symbols_of(&library().join("libtaut.so"), arguments)
}

#[cfg(target_os = "linux")]
fn symbols_of(file: &Path, arguments: &[&str]) -> Vec<(String, String)> {
    let output = succeed(Command::new("nm").args(arguments).arg(file));
    String::from_utf8(output.stdout)
        .unwrap()
        .lines()
        .filter_map(|line| {
            let mut words = line.split_whitespace().rev();
            let name = words.next()?.split('@').next()?.to_string();
            Some((words.next()?.to_string(), name))
        })
        .collect()
}

#[test]
#[cfg(target_os = "linux")]
fn it_exports_the_functions_of_the_header_and_nothing_else() {
    let exported: BTreeSet<String> = symbols(&["-D", "--defined-only"]).into_iter().map(|s| s.1).collect();
    let declared = declared("taut.h");
    assert!(declared.len() >= 47, "{declared:?}");
    assert_eq!(exported, declared);
}

#[test]
#[cfg(target_os = "linux")]
fn it_needs_no_allocator_and_no_library() {
    for (kind, name) in symbols(&["-D", "--undefined-only"]) {
        let allowed = ["memcpy", "memmove", "memset", "memcmp", "bcmp"];
        // weak ones are hooks of the C start-up code: a program without them runs
        assert!(kind == "w" || allowed.contains(&name.as_str()), "needs {name}");
    }
    let dynamic = succeed(Command::new("readelf").arg("-d").arg(library().join("libtaut.so")));
    let dynamic = String::from_utf8(dynamic.stdout).unwrap();
    assert!(!dynamic.contains("(NEEDED)"), "{dynamic}");
}

#[test]
#[cfg(target_os = "linux")]
fn no_way_leads_to_a_panic() {
    // the linker drops what nothing leads to: with a single way to a panic these would be there
    let panics: Vec<String> = symbols(&[])
        .into_iter()
        .map(|s| s.1)
        .filter(|n| ["panic", "rust_begin_unwind", "malloc", "_fail"].iter().any(|w| n.contains(w)))
        .collect();
    assert!(panics.is_empty(), "core or ffi has code that may panic; what is left of it: {panics:?}");
}

/// What a symbol of code that allocates or panics is called.
#[cfg(target_os = "linux")]
const FORBIDDEN: [&str; 9] =
    ["malloc", "calloc", "realloc", "__rust_alloc", "__rdl_", "__rg_", "panic", "rust_begin_unwind", "_fail"];

/// A C program that calls every function of the header, linked statically with what nothing leads to dropped: what is left of
/// core and ffi in it holds no way to an allocator or a panic, and is small.
#[test]
#[cfg(target_os = "linux")]
fn a_c_program_holds_no_allocator_and_no_panic() {
    let folder = tempfile::tempdir().unwrap();
    let (source, program) = (folder.path().join("all.c"), folder.path().join("all"));
    let header = std::fs::read_to_string(root().join("include/taut.h")).unwrap();
    let mut names: Vec<&str> = header
        .lines()
        .filter(|l| !l.starts_with(['/', '#', ' ']))
        .filter_map(|l| l.split_once('(')?.0.rsplit([' ', '*']).next())
        .filter(|n| n.starts_with("taut_"))
        .collect();
    names.sort_unstable();
    names.dedup();
    assert!(names.len() >= 40, "{names:?}");
    let list: String = names.iter().map(|n| format!("    (function){n},\n")).collect();
    let text = format!(
        "#include \"taut.h\"\ntypedef void (*function)(void);\nfunction volatile all[] = {{\n{list}}};\n\
         int main(void) {{ return all[0] == 0; }}\n"
    );
    std::fs::write(&source, text).unwrap();
    let mut link = Command::new("cc");
    link.args(["-std=c11", "-O2", "-ffunction-sections", "-fdata-sections", "-Wl,--gc-sections", "-I"])
        .arg(root().join("include"))
        .arg(&source)
        .arg(library().join("libtaut.a"))
        .arg("-o")
        .arg(&program);
    succeed(&mut link);
    succeed(&mut Command::new(&program));

    let found = symbols_of(&program, &[]);
    for name in &names {
        assert!(found.iter().any(|(_, s)| s == name), "{name} was dropped: the program is no proof");
    }
    for (_, name) in &found {
        assert!(!FORBIDDEN.iter().any(|f| name.contains(f)), "the program holds {name}");
    }
    let sizes = succeed(Command::new("size").arg(&program));
    let sizes = String::from_utf8(sizes.stdout).unwrap();
    let bytes: u64 = sizes.lines().nth(1).and_then(|l| l.split_whitespace().next()).unwrap().parse().unwrap();
    println!("text of all of taut: {bytes} bytes");
    // the aim is 300 kB, which steps and limits in four widths and the implicit solvers miss (docs/guarantees.md)
    assert!(bytes < 740_000, "{bytes} bytes of text");
}
