//! Every vector width steps tethers, strain limit and levels to the bits of single numbers.

mod common;

use common::{Random, bits, cloth, grid, snapshot, vector_widths};
use taut::{Cloth, ClothDef, Families, Features, StepFlags, Width};

/// Columns on both sides of each vector length and of the blocks of 16; thin sheets; several levels.
const SIZES: [(u32, u32); 16] = [
    (2, 2),
    (2, 3),
    (3, 2),
    (2, 40),
    (5, 4),
    (4, 5),
    (6, 9),
    (8, 15),
    (9, 16),
    (10, 17),
    (18, 18),
    (17, 31),
    (32, 33),
    (3, 97),
    (97, 3),
    (66, 47),
];

/// Which particles are missing.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Holes {
    None,
    Random,
    Disc,
    /// A tear down to three quarters and one along a row, in two pieces.
    Tears,
}

/// A crumpled sheet with random masses, pins and holes, limits that are reached in some places.
fn sheet(seed: u64, (rows, columns): (u32, u32), features: Features, holes: Holes) -> Cloth<'static> {
    // by themselves, or every kind of limit would always meet the same ones
    let (mut r, mut of) = (Random::new(seed), Random::new(seed + 1_000_000));
    let pins = [0, 1, 2, 40][of.below(4)];
    let masked = if holes == Holes::None { Features::NONE } else { Features::MASK };
    let def = ClothDef {
        features: Features(features.0 | Features::MASS.0 | masked.0),
        substeps: 3,
        strain_limit: if of.below(3) == 0 { [0.0; 3] } else { [0.02, 0.05, 0.04] },
        tether_slack: [0.03, 0.0, 0.05],
        strain_passes: 1 + of.below(3) as u32,
        // 0: until the limit is kept
        level_cycles: of.below(3) as u32,
        gravity_m_s2: [0.3, -9.81, -0.0],
        ..ClothDef::default()
    };
    let grid = grid(rows, columns, (columns - 1) as f32 * 0.05, (rows - 1) as f32 * 0.04, Families::ALL);
    let mut c = cloth(&grid, &def);
    c.set_stiffness_uniform([500.0, 300.0, 80.0, 2.0]).unwrap();
    let n = grid.particles();
    let masses: Vec<f32> = (0..n).map(|_| c.particle_mass_kg() * r.within(0.5, 2.0)).collect();
    c.set_masses(&masses).unwrap();
    let (middle_u, middle_v) = (columns as f32 / 2.0, rows as f32 / 2.0);
    let mask: Vec<u8> = (0..n)
        .map(|i| {
            let (u, v) = ((i % columns as usize) as f32 - middle_u, (i / columns as usize) as f32 - middle_v);
            match holes {
                Holes::None => 1,
                Holes::Random => u8::from(r.below(6) != 0),
                Holes::Tears => u8::from((u.floor() != 1.0 || v > 0.5 * middle_v) && v.floor() != -2.0),
                Holes::Disc => u8::from((u / middle_u).powi(2) + (v / middle_v).powi(2) < 0.9),
            }
        })
        .collect();
    if holes != Holes::None {
        c.set_mask(&mask).unwrap();
    }
    for _ in 0..pins {
        let p = r.below(n);
        if mask[p] == 1 {
            c.pin(p).unwrap();
        }
    }
    for i in 0..n {
        let bump = r.vector(0.01) * if r.below(3) == 0 { 1.5 } else { 0.1 };
        c.set_position(i, c.position(i).unwrap() * r.within(1.0, 1.01) + bump).unwrap();
        if mask[i] == 1 {
            c.set_velocity(i, r.vector(0.3)).unwrap();
        }
    }
    c
}

/// A sheet of every size, kind of mask and number of pins, with each feature: the same bits after every frame. And the
/// feature was at work, or nothing would have been compared.
#[test]
fn every_width_limits_to_the_same_bits() {
    let widths = vector_widths();
    let both = Features(Features::TETHERS.0 | Features::STRAIN_LIMIT.0);
    let (mut seed, mut compared, mut at_work) = (0, 0, [0; 4]);
    for size in SIZES {
        for holes in [Holes::None, Holes::Random, Holes::Disc, Holes::Tears] {
            for (kind, features) in
                [Features::TETHERS, Features::STRAIN_LIMIT, both, Features::LEVELS].into_iter().enumerate()
            {
                seed += 1;
                let mut c = sheet(seed, size, features, holes);
                let start = snapshot(&mut c);
                let mut plain = sheet(seed, size, Features::NONE, holes);
                c.set_width(Width::Scalar).unwrap();
                let wanted: Vec<_> = (0..2)
                    .map(|_| {
                        assert_eq!(c.step().unwrap(), StepFlags(0));
                        plain.step().unwrap();
                        bits(&c)
                    })
                    .collect();
                at_work[kind] += u32::from(bits(&plain) != bits(&c));
                for width in &widths {
                    c.set_width(*width).unwrap();
                    c.restore(&start).unwrap();
                    for (frame, wanted) in wanted.iter().enumerate() {
                        c.step().unwrap();
                        assert!(bits(&c) == *wanted, "{width:?} {size:?} {holes:?} {features:?} frame {frame}");
                        compared += 1;
                    }
                }
            }
        }
    }
    assert_eq!(compared, SIZES.len() * 4 * 4 * widths.len() * 2);
    assert!(at_work.iter().all(|n| *n > 30), "{at_work:?} of {} cloths were limited", SIZES.len() * 4);
}
