//! Bad input from C: each mistake has its code, and nothing is half done.

use taut::Hash64;

use crate::drape::denim;
use crate::library::{Language, root, run_all};

/// The field file with one number changed and the checksum made right again.
fn with_number(bytes: &[u8], index: usize, value: f32) -> Vec<u8> {
    let mut bytes = bytes[..bytes.len() - 8].to_vec();
    let at = 64 + 4 * index;
    bytes[at..at + 4].copy_from_slice(&value.to_le_bytes());
    let mut hash = Hash64::new();
    hash.bytes(&bytes);
    bytes.extend(hash.finish().to_le_bytes());
    bytes
}

#[test]
fn every_mistake_has_its_code_and_changes_nothing() {
    let good = std::fs::read(denim()).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let not_finite = folder.path().join("not_finite.tautfield");
    std::fs::write(&not_finite, with_number(&good, 100, f32::NAN)).unwrap();
    let negative = folder.path().join("negative.tautfield");
    std::fs::write(&negative, with_number(&good, 4095, -1.0)).unwrap();
    let source = root().join("tests/tests/c_programs/refusals.c");
    let printed = run_all(Language::C11, &[source], &[denim(), not_finite, negative]);
    println!("{printed}");
    let refused: usize = printed
        .strip_suffix(" calls were answered as they should be\n")
        .and_then(|n| n.parse().ok())
        .unwrap_or_else(|| panic!("{printed}"));
    assert!(refused > 150, "{refused}");
}
