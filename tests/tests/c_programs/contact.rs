//! Colliders and targets from C.

use crate::library::{Language, root, run_all};

#[test]
fn colliders_and_targets_work_from_c() {
    let source = root().join("tests/tests/c_programs/contact.c");
    assert_eq!(run_all(Language::C11, &[source], &[]), "ok\n");
}
