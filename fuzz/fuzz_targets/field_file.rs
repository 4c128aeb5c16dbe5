//! Any bytes as a baked field file, as they are and with a header and checksum made right: refused, or loaded and stepped.
#![no_main]

use libfuzzer_sys::fuzz_target;
use taut_core::baked::Baked;
use taut_core::{Cloth, ClothDef, Grid, GridDef, Hash64};

fn load(bytes: &[u8]) {
    let grid = Grid::new(&GridDef { rows: 5, columns: 6, ..GridDef::default() }).unwrap();
    let def = ClothDef { substeps: 2, ..ClothDef::default() };
    let mut block = vec![0.0; Cloth::memory(&grid, &def).unwrap()];
    let mut cloth = Cloth::create(&grid, &def, &mut block).unwrap();
    let loaded = cloth.load_stiffness(bytes);
    assert_eq!(loaded.is_ok(), Baked::parse(bytes).is_ok());
    if loaded.is_ok() {
        let report = cloth.budget().unwrap();
        assert!((0.0..=1.0).contains(&report.cut_fraction), "{report:?}");
        assert_eq!(cloth.step().unwrap().0, 0);
    } else {
        assert!(cloth.step().is_err(), "a file that was refused left a stiffness");
    }
}

fuzz_target!(|data: &[u8]| {
    load(data);
    // the same content behind a header that fits it
    if let [rows, columns, rest @ ..] = data {
        let (rows, columns) = (2 + u32::from(rows % 5), 2 + u32::from(columns % 5));
        let size = 72 + 16 * (rows * columns) as usize;
        let mut file = vec![0; size];
        for (to, from) in file[24..size - 8].iter_mut().zip(rest) {
            *to = *from;
        }
        file[..8].copy_from_slice(b"TAUTFELD");
        for (at, word) in [(8, 1), (12, size as u32), (16, rows), (20, columns)] {
            file[at..at + 4].copy_from_slice(&word.to_le_bytes());
        }
        let mut hash = Hash64::new();
        hash.bytes(&file[..size - 8]);
        file[size - 8..].copy_from_slice(&hash.finish().to_le_bytes());
        load(&file);
    }
});
