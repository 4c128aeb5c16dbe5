//! Whatever is wrong with the input: one line, exit code 2, nothing half done.

use std::fs;
use std::path::Path;

use crate::run::{entries, generator, home, refuses};

/// Refuses a command for a reason that the line names, and leaves the folder as it was.
fn refused(folder: &Path, args: &[&str], named: &str) {
    let before = entries(folder);
    let line = refuses(folder, args);
    assert!(line.contains(named), "{args:?}: {line}");
    assert_eq!(entries(folder), before, "{args:?} left something behind");
}

#[test]
fn arguments() {
    let home = home();
    for (option, value, named) in [
        ("--grid", "1x1", "2 to 4096"),
        ("--grid", "70000x2", "2 to 4096"),
        ("--grid", "32", "--grid"),
        ("--grid", "-4x4", "--grid"),
        ("--size", "0x1", "--size"),
        ("--size", "1xNaN", "--size"),
        ("--substeps", "0", "--substeps"),
        ("--rate", "0", "--rate"),
        ("--rate", "NaN", "--rate"),
        ("--rate", "inf", "--rate"),
        ("--seconds", "-1", "--seconds"),
        ("--seconds", "0", "--seconds"),
        ("--seconds", "NaN", "--seconds"),
        ("--seconds", "3601", "3600"),
        ("--density", "0", "--density"),
        ("--density", "-0.3", "--density"),
        ("--density", "NaN", "--density"),
        ("--seed", "-1", "--seed"),
        ("--scene", "moon", "flag or cusick"),
        ("--budget", "huge", "tuned or certified"),
        ("--colour", "red", "--colour"),
    ] {
        refused(home.path(), &["drape", "denim", option, value], named);
    }
    refused(home.path(), &[], "drape, film");
    refused(home.path(), &["drop"], "drop");
    refused(home.path(), &["drape"], "DESCRIPTION");
    refused(home.path(), &["correct", "denim"], "--out");
    // damping times dt must stay below 1
    refused(home.path(), &["drape", "denim", "--rate", "1", "--substeps", "1"], "damping");
}

#[test]
fn descriptions() {
    let home = home();
    for command in [&["drape"][..], &["correct", "--out", "f"]] {
        for (description, named) in [
            ("qzxvw bqqzt", "qzxvw, bqqzt"),
            ("", "no words"),
            (" !? \u{fffd} \n", "no words"),
            (&"denim ".repeat(5000), "limit"),
        ] {
            refused(home.path(), &[command, &[description]].concat(), named);
        }
    }
}

#[test]
fn outputs_that_cannot_be_written() {
    let home = home();
    fs::write(home.path().join("file"), "x").expect("written");
    fs::create_dir_all(home.path().join("taken/drape.png")).expect("made");
    let drape = |out| refused(home.path(), &["drape", "denim", "--out", out], "cannot write");
    drape("file");
    drape("file/deeper");
    drape("taken");
    let correct = |out| refused(home.path(), &["correct", "denim", "--out", out], "cannot write");
    correct("taken");
    correct("missing/f");
    correct("file/f");
    correct("..");
    assert_eq!(fs::read_to_string(home.path().join("file")).expect("read"), "x");
    assert_eq!(entries(&home.path().join("taken")), ["drape.png"]);
}

#[test]
fn generator_files() {
    let home = home();
    let whole = fs::read(generator()).expect("the generator");
    let write = |name: &str, bytes: &[u8]| fs::write(home.path().join(name), bytes).expect("written");
    write("empty", b"");
    write("text", b"heavy blue denim\n".repeat(100).as_slice());
    write("png", b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR");
    for (name, share) in [("cut10", 10), ("cut50", 50), ("cut99", 99)] {
        write(name, &whole[..whole.len() * share / 100]);
    }
    write("last", &whole[..whole.len() - 1]);
    // a field file is no generator
    crate::run::succeeds(home.path(), &["correct", "denim", "--grid", "4x4", "--out", "field"]);
    // the metadata says 16 tokens, the graph too: 17 is a lie
    let key = b"taut.tokens";
    let at = whole.windows(key.len()).position(|w| w == key).expect("the key");
    let mut lie = whole.clone();
    let value = at + key.len() + 2;
    assert_eq!(&lie[value..value + 2], b"16");
    lie[value + 1] = b'7';
    write("lie", &lie);

    for file in ["missing", ".", "empty", "text", "png", "cut10", "cut50", "cut99", "last", "field", "lie"] {
        let named = if file == "." { "cannot read" } else { file };
        refused(home.path(), &["info", file], named);
    }
    for file in ["missing", "cut50", "lie"] {
        refused(home.path(), &["drape", "denim", "--model", file], file);
        refused(home.path(), &["correct", "denim", "--out", "f", "--model", file], file);
    }
}
