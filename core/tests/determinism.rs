//! The same bits everywhere: golden hashes that every target must give, and the step in lanes against the scalar twin.

mod common;

use common::twin::Twin;
use common::{Random, Scene, bits, cloth, grid, positions, squares, steps};
use taut::field::FieldView;
use taut::{Cloth, ClothDef, Families, Features, Vector3};

const FAMILIES: [Families; 4] = [Families(1), Families(3), Families(5), Families(7)];

/// A cloth and its twin of random size, families, clamps, field and pins, crumpled alike. The field is soft enough not to
/// be cut, so each spring has the mean of its ends to the bit.
fn twins(seed: u64, rows: u32, columns: u32) -> (Cloth<'static>, Twin) {
    let mut r = Random::new(seed);
    let grid = grid(
        rows,
        columns,
        (columns - 1) as f32 * 0.1,
        (rows - 1) as f32 * r.within(0.05, 0.15),
        FAMILIES[seed as usize % 4],
    );
    let def = ClothDef {
        rate_hz: 57.0,
        substeps: 4,
        damping_per_s: [0.0, 3.0][r.below(2)],
        speed_limit: [0.0, 0.05, 0.25][r.below(3)],
        compression_limit: r.below(2) == 0,
        gravity_m_s2: [0.3, -9.81, 1.7],
        features: Features::PULL,
        ..ClothDef::default()
    };
    let mut c = cloth(&grid, &def);
    let n = grid.particles();
    let dt = def.dt_s();
    let top = 0.05 * c.particle_mass_kg() / (dt * dt);
    let field: Vec<f32> =
        (0..4 * n).map(|i| if i < 3 * n { r.log(0.1 * top, top) } else { r.log(1e-5, 2e-3) * top }).collect();
    c.set_stiffness_field(&FieldView::new(4, rows as usize, columns as usize, &field).unwrap());
    let mut twin = Twin::new(&grid, &def, positions(&c), &field);
    for _ in 0..r.below(5) {
        let p = r.below(n);
        if c.pinned().all(|q| q != p) {
            c.pin(p).unwrap();
            twin.pin(p);
        }
    }
    assert_eq!(c.budget().unwrap().cut_fraction, 0.0);
    twin.crumple(&mut c, &mut r);
    (c, twin)
}

/// Core works on rows in lanes and moves positions two rows behind the velocities; the paper's equations one by one give
/// the same bits. Catches a row that is moved too early, a border that is read wrongly, another order of sums.
#[test]
fn the_step_in_lanes_has_the_bits_of_the_scalar_twin() {
    let sizes = [(2, 2), (3, 2), (2, 9), (4, 15), (5, 16), (7, 17), (33, 3), (12, 33)];
    for (i, (rows, columns)) in sizes.into_iter().enumerate() {
        for variant in 0..8 {
            let seed = 8 * i as u64 + variant;
            let (mut c, mut twin) = twins(seed, rows, columns);
            let mut r = Random::new(seed + 999);
            // 200 substeps
            for frame in 0..50 {
                for pin in &mut twin.pins {
                    if r.below(2) == 0 {
                        let to = pin.to.cast::<f64>() + r.vector(0.01).cast();
                        c.move_pin(pin.particle, to).unwrap();
                        pin.to = to.cast();
                    }
                }
                if r.below(3) == 0 {
                    let (p, f) = (r.below(twin.x.len()), r.vector(0.05));
                    c.add_force(p, f).unwrap();
                    twin.pull[p] += f;
                }
                steps(&mut c, 1);
                twin.step();
                assert!(bits(&c) == twin.bits(), "{rows} x {columns}, seed {seed}, frame {frame}");
            }
            let moved = twin.x.iter().fold(0.0f32, |a, p| a.max(p.norm()));
            assert!(moved < 50.0, "the twins exploded together: {moved}");
        }
    }
}

/// The limits must have been at work in the twins' test, or it would not see them.
#[test]
fn the_twins_do_reach_their_limits() {
    let (mut limited, mut pressed) = (0, 0);
    for seed in 0..24 {
        let (mut c, mut twin) = twins(seed, 7, 17);
        let limit = twin.def.speed_limit * twin.grid.rest_u().min(twin.grid.rest_v()) / twin.dt;
        steps(&mut c, 5);
        limited += c_speeds(&c).filter(|v| limit > 0.0 && (v / limit - 1.0).abs() < 1e-6).count();
        twin.def.compression_limit ^= true;
        for _ in 0..5 {
            twin.step();
        }
        pressed += usize::from(bits(&c) != twin.bits());
    }
    assert!(limited > 100 && pressed > 16, "{limited} {pressed}");
}

fn c_speeds(c: &Cloth<'_>) -> impl Iterator<Item = f32> {
    common::velocities(c).into_iter().map(|v| v.norm())
}

/// Equal input, equal bits, whatever the block held before and however long another cloth has been stepped.
#[test]
fn a_run_repeats_itself() {
    let (mut a, _) = twins(5, 12, 33);
    steps(&mut a, 40);
    let hash = a.state_hash();
    let (mut other, _) = twins(6, 9, 9);
    steps(&mut other, 3);
    let (mut b, _) = twins(5, 12, 33);
    for _ in 0..40 {
        steps(&mut b, 1);
        b.state_hash();
        b.budget().unwrap();
    }
    assert_eq!(b.state_hash(), hash);
}

/// Away from the world's origin the cloth is as exact as at it.
#[test]
fn the_origin_is_not_in_the_bits() {
    let run = |origin: Vector3<f64>| {
        let def = ClothDef { origin_m: origin.into(), ..ClothDef::default() };
        let mut c = cloth(&squares(8, 8, 0.125, Families::ALL), &def);
        c.set_stiffness_uniform([400.0, 400.0, 100.0, 8.0]).unwrap();
        c.pin(0).unwrap();
        c.move_pin(0, origin + Vector3::new(0.25, 0.5, 0.125)).unwrap();
        steps(&mut c, 60);
        let at = c.world_position(63).unwrap() - origin;
        assert!((at - c.position(63).unwrap().cast()).norm() < 1e-9 * origin.norm().max(1.0));
        c.state_hash()
    };
    let home = run(Vector3::zeros());
    assert_eq!(run(Vector3::new(1e6, -2e6, 1e6)), home);
}

/// A uniform field is uniform to the bit on every grid, however it is resampled.
#[test]
fn a_constant_field_stays_constant() {
    let mut r = Random::new(1);
    for _ in 0..200 {
        let k = r.log(1e-3, 1e6);
        let data = [k; 4 * 6];
        let f = FieldView::new(4, 2, 3, &data).unwrap();
        let (m, n) = (2 + r.below(60), 2 + r.below(60));
        for _ in 0..50 {
            let s = f.sample(r.below(m), r.below(n), m, n);
            assert_eq!(s, [k; 4]);
        }
    }
}

const SIZES: [(u32, u32); 4] = [(2, 2), (3, 97), (17, 31), (32, 32)];

/// 300 frames of 16 substeps; with all families a graded field, inertia and the default clamps, with the structural ones
/// alone a uniform field without clamps.
fn golden(scene: Scene, (rows, columns): (u32, u32), all: bool) -> u64 {
    let grid = grid(rows, columns, 1.0, 1.0, if all { Families::ALL } else { Families::STRUCTURAL });
    let def = if all {
        ClothDef { inertia_radius_m: 0.3, ..ClothDef::default() }
    } else {
        ClothDef { budget: taut::Budget::Certified, speed_limit: 0.0, compression_limit: false, ..ClothDef::default() }
    };
    let mut c = cloth(&grid, &def);
    if all {
        let field: Vec<f32> =
            (0..4 * 35).map(|i| [900.0, 500.0, 150.0, 20.0][i / 35] * (1.0 + (i % 35) as f32 / 16.0)).collect();
        c.set_stiffness_field(&FieldView::new(4, 5, 7, &field).unwrap());
    } else {
        c.set_stiffness_uniform([60.0, 45.0, 0.0, 0.0]).unwrap();
    }
    scene.pin(&mut c);
    // out of the plane, so that nothing stays zero
    let last = grid.particles() - 1;
    if c.pinned().all(|p| p != last) {
        c.set_velocity(last, Vector3::new(0.0, 0.0, 0.5)).unwrap();
    }
    steps(&mut c, 300);
    c.state_hash()
}

/// Printed once on x86_64; every other target, width of vector and optimisation level must give the same.
const GOLDEN: [u64; 24] = [
    0x9fe9_ff72_c38f_ad23,
    0x13b9_854b_5d78_681d,
    0x51da_3fb3_9871_d4cf,
    0x1278_7a28_3d97_71e2,
    0xbad4_26da_7495_f73f,
    0x5469_136a_6a7f_6ea5,
    0x7db6_8529_c1e7_dcbc,
    0x6255_18e5_00c0_e5ce,
    0x9fe9_ff72_c38f_ad23,
    0x13b9_854b_5d78_681d,
    0x75ab_79d5_b058_4137,
    0xc831_ab80_7912_d27a,
    0x46c3_66c3_de9b_a1f7,
    0xf07a_fc5e_979c_56c5,
    0x6316_139a_9817_db18,
    0xda3b_2668_e4ac_3254,
    0xb644_ae5b_6cf8_8b04,
    0x5736_0724_2296_8ab5,
    0xa252_3cd2_f166_eaff,
    0x4523_8f32_5837_edba,
    0x7f6f_f9b4_e769_d32a,
    0xaf22_2828_2b3e_ccf0,
    0x8e8a_b083_2d3f_6a8c,
    0x2fdb_04eb_1d7c_0935,
];

#[test]
fn golden_hashes() {
    let mut hashes = Vec::new();
    for scene in Scene::ALL {
        for size in SIZES {
            for all in [true, false] {
                hashes.push(golden(scene, size, all));
            }
        }
    }
    assert!(hashes == GOLDEN, "now {hashes:#x?}");
}
