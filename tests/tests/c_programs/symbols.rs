//! What the shared library gives away and what it needs.

use std::collections::BTreeSet;
use std::process::Command;

use crate::library::{declared, library, succeed};

/// Runs nm on the shared library and returns (kind, name) of each symbol.
#[cfg(target_os = "linux")]
fn symbols(arguments: &[&str]) -> Vec<(String, String)> {
    let output = succeed(Command::new("nm").args(arguments).arg(library().join("libtaut.so")));
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
