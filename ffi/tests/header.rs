//! include/taut.h is what cbindgen makes of this crate. `TAUT_BLESS=1 cargo test -p taut-ffi` rewrites it.

use std::path::Path;

/// The header as cbindgen makes it.
fn generated() -> String {
    let crate_dir = Path::new(env!("CARGO_MANIFEST_DIR"));
    let config = cbindgen::Config::from_file(crate_dir.join("cbindgen.toml")).unwrap();
    let bindings = cbindgen::Builder::new().with_crate(crate_dir).with_config(config).generate().unwrap();
    let mut generated = Vec::new();
    bindings.write(&mut generated);
    String::from_utf8(generated).unwrap()
}

#[test]
fn the_committed_header_is_the_generated_one() {
    let crate_dir = Path::new(env!("CARGO_MANIFEST_DIR"));
    let generated = generated();
    let committed = crate_dir.join("../include/taut.h");
    if std::env::var_os("TAUT_BLESS").is_some_and(|v| v == "1") {
        std::fs::create_dir_all(crate_dir.join("../include")).unwrap();
        std::fs::write(&committed, &generated).unwrap();
    }
    let found = std::fs::read_to_string(&committed).unwrap_or_default();
    if let Some((i, (is, should))) = found.lines().zip(generated.lines()).enumerate().find(|(_, (a, b))| a != b) {
        panic!("include/taut.h, line {}: is\n  {is}\nshould be\n  {should}\nTAUT_BLESS=1 rewrites it", i + 1);
    }
    assert_eq!(found, generated, "include/taut.h; TAUT_BLESS=1 rewrites it");
}

#[test]
fn every_function_says_how_it_fails_and_which_threads_may_call_it() {
    let header = generated();
    let mut comment = String::new();
    let mut functions = 0;
    for line in header.lines() {
        if let Some(text) = line.strip_prefix("//") {
            comment.push_str(text);
            comment.push('\n');
        } else {
            if line.contains("taut_") && line.contains('(') && !line.starts_with(['#', ' ']) {
                functions += 1;
                assert!(comment.contains("Threads: "), "{line}");
                let fails = line.starts_with("taut_result ");
                assert_eq!(comment.contains("Errors: "), fails, "{line}");
            }
            comment.clear();
        }
    }
    assert_eq!(functions, 43);
}
