//! `taut correct`: the file that a game loads.

use serde_json::Value;
use taut::baked::Baked;
use taut::{Cloth, ClothDef, Grid, GridDef};

use crate::run::{entries, home, succeeds};

#[test]
fn the_file_is_one_that_the_cloth_loads() {
    let home = home();
    let run =
        succeeds(home.path(), &["correct", "heavy blue denim", "--grid", "12x9", "--out", "denim.taut", "--json"]);
    let told: Value = serde_json::from_str(&run.stdout).expect("JSON");
    let bytes = std::fs::read(home.path().join("denim.taut")).expect("read");
    assert_eq!(told["file"], "denim.taut");
    assert_eq!(told["file_bytes"], bytes.len());
    assert_eq!(told["grid"], serde_json::json!([12, 9]));

    let baked = Baked::parse(&bytes).expect("a field file");
    assert_eq!((baked.rows, baked.columns, baked.seed), (12, 9, 0));
    let density = told["generator"]["density_kg_m2"].as_f64().expect("a number");
    assert!((f64::from(baked.fabric.density_kg_m2) - density).abs() < 1e-6);
    for (channel, name) in taut::field::CHANNELS.into_iter().enumerate() {
        let mut values: Vec<f32> = (0..108).map(|i| baked.stiffness(channel, i / 9, i % 9)).collect();
        values.sort_by(f32::total_cmp);
        let middle = f64::from(0.5 * (values[53] + values[54]));
        let median = told["generator"]["median_stiffness_n_per_m"][name].as_f64().expect("a number");
        assert!((middle - median).abs() <= 1e-6 * median, "{name}: {middle} {median}");
    }

    let grid = Grid::new(&GridDef { rows: 12, columns: 9, ..GridDef::default() }).expect("a grid");
    let def = ClothDef { density_kg_m2: baked.fabric.density_kg_m2, ..ClothDef::default() };
    let mut block = vec![0.0; Cloth::memory(&grid, &def).expect("a size")];
    let mut cloth = Cloth::create(&grid, &def, &mut block).expect("a cloth");
    assert_eq!(cloth.load_stiffness(&bytes), Ok(baked.fabric));
    cloth.pin(0).expect("pinned");
    assert!(cloth.step().is_ok());
}

#[test]
fn the_same_words_and_seed_give_the_same_bytes() {
    let home = home();
    let file = |words: &str, more: &[&str], name: &str| {
        succeeds(home.path(), &[&["correct", words, "--out", name], more].concat());
        std::fs::read(home.path().join(name)).expect("read")
    };
    let first = file("silk", &[], "a");
    assert_eq!(first, file("silk", &[], "b"));
    assert_eq!(first, file("silk", &["--seed", "0", "--scene", "hang2"], "a"), "written over");
    assert_ne!(first, file("silk", &["--seed", "1"], "c"));
    assert_ne!(first, file("silk", &["--scene", "edge"], "d"), "the pins are part of the scene");
    assert_ne!(first, file("heavy blue denim", &[], "e"));
    assert_eq!(entries(home.path()), ["a", "b", "c", "d", "e"]);
}

#[test]
fn tells_what_it_wrote() {
    let home = home();
    let run = succeeds(home.path(), &["correct", "heavy qzxvw denim", "--out", "f"]);
    for text in ["warp", "bend", "Density", "Hinge rigidity", "Stretch limits", "Wrote f ("] {
        assert!(run.stdout.contains(text), "{text}: {}", run.stdout);
    }
    assert!(run.stderr.contains("`qzxvw`"), "{}", run.stderr);
}
