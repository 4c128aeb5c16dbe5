//! Every vector width steps every cloth to the same bits as the scalar twin, which gathers all twelve springs of each
//! particle, while core computes each spring once.

mod common;

use common::twin::Twin;
use common::{Random, bits, cloth, grid, positions, snapshot, steps, widths};
use taut::field::FieldView;
use taut::{Cloth, ClothDef, Error, Families, Features, Width};

/// A crumpled and swinging sheet with pins, and its twin. The field is too soft to be cut.
fn twins(seed: u64, rows: u32, columns: u32, families: Families, pull: bool) -> (Cloth<'static>, Twin) {
    let mut r = Random::new(seed);
    let grid = grid(rows, columns, (columns - 1) as f32 * 0.1, (rows - 1) as f32 * 0.08, families);
    let def = ClothDef {
        rate_hz: 57.0,
        substeps: 3,
        damping_per_s: 1.5,
        speed_limit: [0.0, 0.04, 0.25][seed as usize % 3],
        compression_limit: seed % 2 == 0,
        gravity_m_s2: [0.3, -9.81, -0.0],
        features: if pull { Features::PULL } else { Features::NONE },
        ..ClothDef::default()
    };
    let mut c = cloth(&grid, &def);
    let n = grid.particles();
    let top = 0.05 * c.particle_mass_kg() * (57.0f32 * 3.0).powi(2);
    let field: Vec<f32> =
        (0..4 * n).map(|i| if i < 3 * n { r.log(0.1 * top, top) } else { r.log(1e-5, 2e-3) * top }).collect();
    c.set_stiffness_field(&FieldView::new(4, rows as usize, columns as usize, &field).unwrap());
    let mut twin = Twin::new(&grid, &def, positions(&c), &field);
    c.pin(0).unwrap();
    twin.pin(0);
    assert_eq!(c.budget().unwrap().cut_fraction, 0.0);
    twin.crumple(&mut c, &mut r);
    (c, twin)
}

/// Columns on both sides of each vector length, so that every width has whole and broken last vectors; thin sheets, where
/// neighbours two away are missing; sheets of one vector and of many.
const SIZES: [(u32, u32); 18] = [
    (2, 2),
    (2, 3),
    (3, 2),
    (2, 16),
    (5, 4),
    (4, 5),
    (6, 7),
    (7, 8),
    (5, 9),
    (4, 15),
    (5, 16),
    (6, 17),
    (4, 31),
    (3, 32),
    (5, 33),
    (17, 31),
    (3, 97),
    (97, 3),
];

#[test]
fn every_width_has_the_bits_of_the_gather() {
    let widths = widths();
    let (mut seed, mut compared) = (0, 0);
    for (rows, columns) in SIZES {
        for families in [1, 3, 5, 7].map(Families) {
            for pull in [false, true] {
                seed += 1;
                let (mut c, mut twin) = twins(seed, rows, columns, families, pull);
                let start = snapshot(&mut c);
                let mut r = Random::new(seed + 5000);
                let pulls: Vec<_> = (0..12).map(|_| (r.below(twin.x.len()), r.vector(0.05))).collect();
                let mut wanted = Vec::new();
                for (particle, force) in &pulls {
                    if pull {
                        twin.pull[*particle] += force;
                    }
                    twin.step();
                    wanted.push(twin.bits());
                }
                for width in &widths {
                    c.set_width(*width).unwrap();
                    c.restore(&start).unwrap();
                    for (frame, (particle, force)) in pulls.iter().enumerate() {
                        if pull {
                            c.add_force(*particle, *force).unwrap();
                        }
                        steps(&mut c, 1);
                        let at = (width, rows, columns, families.0, pull, frame);
                        assert!(bits(&c) == wanted[frame], "{at:?}");
                        compared += 1;
                    }
                }
            }
        }
    }
    assert_eq!(compared, SIZES.len() * 4 * 2 * 12 * widths.len());
}

/// The same sheet on a block that begins anywhere: vectors need no alignment.
#[test]
fn the_block_may_begin_anywhere() {
    let (mut c, _) = twins(3, 9, 21, Families::ALL, false);
    let start = snapshot(&mut c);
    steps(&mut c, 20);
    let wanted = c.state_hash();
    let (grid, def) = (*c.grid(), *c.def());
    for skip in [0, 1, 3, 7] {
        for width in widths() {
            let mut block = vec![f32::NAN; Cloth::memory(&grid, &def).unwrap() + skip];
            let mut other = Cloth::create(&grid, &def, &mut block[skip..]).unwrap();
            other.set_width(width).unwrap();
            let field: Vec<f32> = {
                // the field of the twins, made in the same order
                let mut r = Random::new(3);
                let top = 0.05 * other.particle_mass_kg() * (57.0f32 * 3.0).powi(2);
                let n = grid.particles();
                (0..4 * n).map(|i| if i < 3 * n { r.log(0.1 * top, top) } else { r.log(1e-5, 2e-3) * top }).collect()
            };
            other.set_stiffness_field(&FieldView::new(4, 9, 21, &field).unwrap());
            other.restore(&start).unwrap();
            steps(&mut other, 20);
            assert_eq!(other.state_hash(), wanted, "{width:?}, {skip} numbers in");
        }
    }
}

/// The width is a choice of the machine, not of the state: hash and snapshot do not know it, reset keeps it, and one that
/// the machine lacks is refused and changes nothing.
#[test]
fn the_width_is_no_state() {
    let (mut c, _) = twins(1, 6, 17, Families::ALL, false);
    assert_eq!(c.width(), Width::best());
    let (hash, bytes) = (c.state_hash(), snapshot(&mut c));
    for width in Width::ALL {
        let before = c.width();
        if width.is_supported() {
            c.set_width(width).unwrap();
            assert_eq!(c.width(), width);
            assert_eq!((c.state_hash(), snapshot(&mut c)), (hash, bytes.clone()));
        } else {
            assert_eq!(c.set_width(width), Err(Error::UnsupportedWidth));
            assert_eq!(c.width(), before);
        }
    }
    c.set_width(Width::Scalar).unwrap();
    c.reset();
    assert_eq!(c.width(), Width::Scalar);
    assert!(Width::ALL.iter().any(|w| !w.is_supported()), "no machine has them all");
}
