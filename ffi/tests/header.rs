//! The headers in include/ are what cbindgen makes of this crate. `TAUT_BLESS=1 cargo test -p taut-ffi` rewrites them.

use std::path::Path;

/// The headers and what each is made by.
const HEADERS: [(&str, &str); 2] = [("taut.h", "cbindgen.toml"), ("taut_generator.h", "cbindgen_generator.toml")];

/// A header as cbindgen makes it.
fn generated(header: &str, config: &str) -> String {
    let crate_dir = Path::new(env!("CARGO_MANIFEST_DIR"));
    let config = cbindgen::Config::from_file(crate_dir.join(config)).unwrap();
    let builder = cbindgen::Builder::new().with_config(config);
    let builder = match header {
        "taut.h" => builder.with_crate(crate_dir),
        _ => builder.with_src(crate_dir.join("src/generator.rs")),
    };
    let mut generated = Vec::new();
    builder.generate().unwrap().write(&mut generated);
    String::from_utf8(generated).unwrap()
}

#[test]
fn the_committed_headers_are_the_generated_ones() {
    for (header, config) in HEADERS {
        let generated = generated(header, config);
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../include");
        let committed = folder.join(header);
        if std::env::var_os("TAUT_BLESS").is_some_and(|v| v == "1") {
            std::fs::create_dir_all(&folder).unwrap();
            std::fs::write(&committed, &generated).unwrap();
        }
        let found = std::fs::read_to_string(&committed).unwrap_or_default();
        if let Some((i, (is, should))) = found.lines().zip(generated.lines()).enumerate().find(|(_, (a, b))| a != b) {
            panic!("include/{header}, line {}: is\n  {is}\nshould be\n  {should}\nTAUT_BLESS=1 rewrites it", i + 1);
        }
        assert_eq!(found, generated, "include/{header}; TAUT_BLESS=1 rewrites it");
    }
}

#[test]
fn every_function_says_how_it_fails_and_which_threads_may_call_it() {
    let header: String = HEADERS.map(|(header, config)| generated(header, config)).concat();
    let mut comment = String::new();
    let mut functions = 0;
    // a long declaration has the export macro on a line of its own
    let mut exported = false;
    for line in header.lines() {
        if line == "TAUT_API" {
            exported = true;
        } else if let Some(text) = line.strip_prefix("//") {
            comment.push_str(text);
            comment.push('\n');
        } else {
            if line.contains("taut_") && line.contains('(') && !line.starts_with(['#', ' ']) {
                functions += 1;
                assert!(comment.contains("Threads: "), "{line}");
                assert!(exported || line.starts_with("TAUT_API "), "{line}");
                let fails = line.trim_start_matches("TAUT_API ").starts_with("taut_result ");
                assert_eq!(comment.contains("Errors: "), fails, "{line}");
            }
            comment.clear();
            exported = false;
        }
    }
    assert!(functions >= 47, "{functions}");
}
