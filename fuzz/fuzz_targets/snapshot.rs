//! Any bytes as a snapshot, as they are and as changes of a good one with its checksum made right: refused without a trace, or
//! restored so that the same bytes come out again.
#![no_main]

mod input;

use input::Input;
use libfuzzer_sys::fuzz_target;
use taut_core::{Cloth, ClothDef, Features, Grid, GridDef, Hash64, Vector3};

fn restore(cloth: &mut Cloth<'_>, bytes: &[u8]) {
    let before = cloth.state_hash();
    match cloth.restore(bytes) {
        Err(_) => assert_eq!(cloth.state_hash(), before, "refused, and changed"),
        Ok(()) => {
            let mut again = vec![0; cloth.snapshot_size()];
            let n = cloth.snapshot(&mut again).unwrap();
            assert!(again[..n] == bytes[..n], "another state than the snapshot's");
            let index = cloth.step_index();
            let flags = cloth.step().unwrap();
            let stepped = if flags.0 == 0 { index.wrapping_add(1) } else { index };
            assert_eq!(cloth.step_index(), stepped);
            for i in 0..cloth.grid().particles() {
                let (x, v) = (cloth.position(i).unwrap(), cloth.velocity(i).unwrap());
                assert!(x.iter().chain(v.iter()).all(|x| x.is_finite()));
            }
        }
    }
}

fuzz_target!(|data: &[u8]| {
    let grid = Grid::new(&GridDef { rows: 3, columns: 4, ..GridDef::default() }).unwrap();
    let features = Features(Features::PULL.0 | Features::LEVELS.0);
    let def = ClothDef { substeps: 2, features, inertia_radius_m: 0.5, ..ClothDef::default() };
    let mut block = vec![0.0; Cloth::memory(&grid, &def).unwrap()];
    let mut cloth = Cloth::create(&grid, &def, &mut block).unwrap();
    cloth.set_stiffness_uniform([500.0, 400.0, 100.0, 8.0]).unwrap();
    let mut input = Input(data);
    for _ in 0..input.u8() % 4 {
        cloth.pin(usize::from(input.u8() % 12)).unwrap();
    }
    if input.u8() % 2 == 0 {
        cloth.add_force(3, Vector3::new(0.0, 0.25, 0.5)).unwrap();
    }
    let mut good = vec![0; cloth.snapshot_size()];
    cloth.snapshot(&mut good).unwrap();
    let size = good.len();
    restore(&mut cloth, input.0);
    // up to 16 words changed
    for _ in 0..16 {
        if input.is_empty() {
            break;
        }
        let at = 4 * (usize::from(input.u8()) % (size / 4 - 2));
        let word = input.u32();
        good[at..at + 4].copy_from_slice(&word.to_le_bytes());
    }
    let mut hash = Hash64::new();
    hash.bulk(&good[..size - 8]);
    good[size - 8..].copy_from_slice(&hash.finish().to_le_bytes());
    restore(&mut cloth, &good);
});
