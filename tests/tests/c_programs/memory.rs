//! TAUT_CLOTH_BYTES is what taut_cloth_memory asks for, and that is what core asks for with the header.

use taut::{Cloth, ClothDef, Features, Grid, GridDef};

use crate::library::{Language, root, run_all, run_c};

#[test]
fn the_macro_for_static_storage_is_the_query() {
    let printed = run_all(Language::C11, &[root().join("tests/tests/c_programs/memory.c")], &[]);
    let compared: usize = printed
        .strip_suffix(" sizes are those that the library asks for\n")
        .and_then(|n| n.parse().ok())
        .unwrap_or_else(|| panic!("{printed}"));
    assert!(compared > 10_000, "{compared}");
}

#[test]
fn the_query_is_that_of_core() {
    for (rows, columns, features, max_pins) in [(2, 2, 0, 0), (17, 33, 1, 3), (4096, 100, 0, 256)] {
        let grid = Grid::new(&GridDef { rows, columns, ..GridDef::default() }).unwrap();
        let def = ClothDef { features: Features(features), max_pins, ..ClothDef::default() };
        let bytes = 2048 + 4 * Cloth::memory(&grid, &def).unwrap();
        let text = format!(
            "#include \"taut.h\"\n\
             _Static_assert(TAUT_CLOTH_BYTES({rows}, {columns}, TAUT_FAMILY_ALL, {features}, {max_pins}) == {bytes}u,\n\
             \x20              \"core\");\n\
             int main(void) {{ return 0; }}\n"
        );
        assert_eq!(run_c(&text, &[]), "");
    }
}
