//! The examples drape the cloth that core drapes in Rust, bit for bit.

use std::path::PathBuf;

use taut::baked::{self, Fabric};
use taut::{Cloth, ClothDef, Grid, GridDef};

use crate::library::{Language, root, run_all};

const SIDE: usize = 32;

/// Where the committed field lies.
pub fn denim() -> PathBuf {
    root().join("examples/data/denim.tautfield")
}

/// A field of our own for the examples: denim in N/m, the same everywhere.
fn denim_bytes() -> Vec<u8> {
    let mut field = Vec::new();
    for k in [2028.0f32, 410.0, 370.0, 8.0] {
        field.extend([k; SIDE * SIDE]);
    }
    let fabric = Fabric { density_kg_m2: 0.324, hinge_rigidity_n_m: 1.95e-5, stretch_limits: [0.01, 0.03, 0.06] };
    let mut bytes = vec![0; baked::size(SIDE, SIDE).unwrap()];
    let size = baked::write(SIDE, SIDE, &field, &fabric, 0, "denim", &mut bytes).unwrap();
    assert_eq!(size, bytes.len());
    bytes
}

#[test]
fn the_committed_field_is_the_one_that_core_writes() {
    let bytes = denim_bytes();
    if std::env::var_os("TAUT_BLESS").is_some_and(|v| v == "1") {
        std::fs::write(denim(), &bytes).unwrap();
    }
    let committed = std::fs::read(denim()).unwrap();
    assert!(committed == bytes, "examples/data/denim.tautfield differs; TAUT_BLESS=1 rewrites it");
}

/// The run of the examples through core: what they print at the end.
pub fn through_core() -> (String, String) {
    let bytes = denim_bytes();
    let grid = Grid::new(&GridDef::default()).unwrap();
    let def = ClothDef {
        density_kg_m2: baked::Baked::parse(&bytes).unwrap().fabric.density_kg_m2,
        inertia_radius_m: 0.3,
        max_pins: 2,
        ..ClothDef::default()
    };
    let mut block = vec![0.0; Cloth::memory(&grid, &def).unwrap()];
    let mut cloth = Cloth::create(&grid, &def, &mut block).unwrap();
    cloth.load_stiffness(&bytes).unwrap();
    cloth.pin(0).unwrap();
    cloth.pin(SIDE - 1).unwrap();
    for _ in 0..300 {
        assert_eq!(cloth.step().unwrap().0, 0);
    }
    let stretch = 100.0 * f64::from(cloth.strain().largest);
    assert!(stretch > 0.5 && stretch < 15.0, "{stretch} %");
    (format!("largest stretch {stretch:.2} %"), format!("state hash {:016x}", cloth.state_hash()))
}

#[test]
fn c_and_cpp_and_rust_give_the_same_bits() {
    let (stretch, hash) = through_core();
    for (language, source) in [(Language::C11, "examples/c/drape.c"), (Language::Cpp17, "examples/cpp/drape.cpp")] {
        let printed = run_all(language, &[root().join(source)], &[denim()]);
        assert!(printed.lines().any(|l| l == stretch), "{source}: {printed}");
        assert!(printed.lines().any(|l| l == hash), "{source}: {printed}");
        println!("{source}:\n{printed}");
    }
}

#[test]
fn the_modes_of_the_engine_do_not_reach_the_bits() {
    let source = root().join("tests/tests/c_programs/environment.c");
    let printed = run_all(Language::C11, &[source], &[denim()]);
    let (_, hash) = through_core();
    assert_eq!(printed.trim(), hash);
}
