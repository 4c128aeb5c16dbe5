//! Numbers that are not finite: refused where they come in, and taken back and flagged where a step makes them.

mod common;

use common::{Random, bare, bits, cloth, positions, snapshot, squares, steps};
use taut::field::FieldView;
use taut::{Budget, Cloth, ClothDef, Error, Families, Features, Grid, GridDef, Hash64, StepFlags, Vector3, Width};

const BAD: [f32; 3] = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY];

#[test]
fn definitions_refuse_what_is_not_finite() {
    let d = ClothDef::default();
    for x in BAD {
        let three = |a: usize| {
            let mut v = [0.0, 1.0, 0.0];
            v[a] = x;
            v
        };
        let all = [
            ClothDef { rate_hz: x, ..d },
            ClothDef { density_kg_m2: x, ..d },
            ClothDef { damping_per_s: x, ..d },
            ClothDef { speed_limit: x, ..d },
            ClothDef { inertia_radius_m: x, ..d },
            ClothDef { inertia_max: x, ..d },
            ClothDef { gravity_m_s2: three(0), ..d },
            ClothDef { u_axis: three(1), ..d },
            ClothDef { v_axis: three(2), ..d },
            ClothDef { origin_m: [0.0, f64::from(x), 0.0], ..d },
        ];
        let grid = Grid::new(&GridDef::default()).unwrap();
        for def in all {
            assert_eq!(def.check(), Err(Error::NotFinite), "{def:?}");
            assert_eq!(Cloth::memory(&grid, &def), Err(Error::NotFinite));
            let mut block = [7.0; 64];
            assert_eq!(Cloth::create(&grid, &def, &mut block).err(), Some(Error::NotFinite));
            assert_eq!(block, [7.0; 64]);
        }
        for g in [GridDef { width_m: x, ..GridDef::default() }, GridDef { height_m: x, ..GridDef::default() }] {
            assert_eq!(Grid::new(&g), Err(Error::SideLength));
        }
    }
}

/// So small or so slow that squares underflow: with them the flat budget would compute with 0/0, and a speed limit would
/// turn rest into NaN.
#[test]
fn definitions_refuse_what_underflows() {
    for width_m in [1e-22, 1e-40, 9e-7] {
        let g = GridDef { width_m, ..GridDef::default() };
        assert_eq!(Grid::new(&g), Err(Error::SideLength));
    }
    for speed_limit in [1e-30, 9e-7] {
        let d = ClothDef { speed_limit, ..ClothDef::default() };
        assert_eq!(d.check(), Err(Error::OutOfRange));
    }
    // the smallest of everything that is accepted
    let tiny = GridDef { rows: 3, columns: 4096, width_m: 1e-6, height_m: 1e-6, ..GridDef::default() };
    let grid = Grid::new(&tiny).unwrap();
    for budget in [Budget::Tuned, Budget::Certified] {
        let def = ClothDef {
            density_kg_m2: 1e-6,
            speed_limit: 1e-6,
            rate_hz: 1.0,
            substeps: 1,
            damping_per_s: 0.5,
            inertia_radius_m: 1e-7,
            budget,
            ..ClothDef::default()
        };
        let mut c = cloth(&grid, &def);
        c.set_stiffness_uniform([f32::MAX; 4]).unwrap();
        c.pin(0).unwrap();
        let report = c.budget().unwrap();
        assert!(report.max_dt_s > 0.0 && report.cut_fraction > 0.9, "{report:?}");
        steps(&mut c, 3);
    }
}

#[test]
fn setters_refuse_what_is_not_finite_and_change_nothing() {
    let def = ClothDef { features: Features::PULL, ..bare() };
    let mut c = cloth(&squares(4, 4, 0.1, Families::ALL), &def);
    c.set_stiffness_uniform([100.0, 100.0, 30.0, 2.0]).unwrap();
    c.pin(3).unwrap();
    let (budget, hash) = (c.budget().unwrap(), c.state_hash());
    for x in BAD {
        for a in 0..3 {
            let mut v = Vector3::new(0.1, 0.2, 0.3);
            v[a] = x;
            assert_eq!(c.set_position(5, v), Err(Error::NotFinite));
            assert_eq!(c.set_velocity(5, v), Err(Error::NotFinite));
            assert_eq!(c.add_force(5, v), Err(Error::NotFinite));
            assert_eq!(c.move_pin(3, v.cast()), Err(Error::NotFinite));
        }
        for channel in 0..4 {
            let mut k = [1.0; 4];
            k[channel] = x;
            assert_eq!(c.set_stiffness_uniform(k), Err(Error::NotFinite));
        }
        let mut field = [1.0; 36];
        field[20] = x;
        assert_eq!(FieldView::new(4, 3, 3, &field).err(), Some(Error::NotFinite));
    }
    // finite but beyond any use
    let far = Vector3::new(0.0, 1.1e6, 0.0);
    assert_eq!(c.set_position(5, far), Err(Error::OutOfRange));
    assert_eq!(c.set_velocity(5, -far), Err(Error::OutOfRange));
    assert_eq!(c.add_force(5, far * 1e4), Err(Error::OutOfRange));
    for p in [16, usize::MAX] {
        assert_eq!(c.set_position(p, Vector3::zeros()), Err(Error::NoSuchParticle));
        assert_eq!(c.set_velocity(p, Vector3::zeros()), Err(Error::NoSuchParticle));
        assert_eq!(c.add_force(p, Vector3::zeros()), Err(Error::NoSuchParticle));
        assert!(c.position(p).is_err() && c.velocity(p).is_err() && c.world_position(p).is_err());
    }
    assert_eq!((c.budget().unwrap(), c.state_hash()), (budget, hash));
    let mut without = cloth(&squares(4, 4, 0.1, Families::ALL), &bare());
    assert_eq!(without.add_force(5, Vector3::zeros()), Err(Error::FeatureOff));
}

/// A snapshot of finite numbers at the end of what f32 holds, with its checksum right: the next step passes infinity.
fn near_infinity(c: &mut Cloth<'_>) {
    let mut s = snapshot(c);
    let n = c.grid().particles();
    let huge = f32::MAX.to_le_bytes();
    for plane in [0, 3] {
        let at = 40 + 4 * (plane * n + 6);
        s[at..at + 4].copy_from_slice(&huge);
    }
    let body = s.len() - 8;
    let mut h = Hash64::new();
    h.bulk(&s[..body]);
    s[body..].copy_from_slice(&h.finish().to_le_bytes());
    c.restore(&s).expect("finite, so accepted");
}

/// The frame is taken back whole: positions, velocities, pins, step index. A step that leaves the pins moved, or counts
/// the frame, or keeps a NaN at the far end of a row, fails here.
#[test]
fn a_frame_that_leaves_the_finite_is_taken_back() {
    let def = ClothDef { features: Features::PULL, substeps: 3, ..bare() };
    let widths = || Width::ALL.into_iter().filter(|w| w.is_supported());
    for (columns, width) in [2, 15, 16, 17].into_iter().flat_map(|n| widths().map(move |w| (n, w))) {
        let mut c = cloth(&squares(6, columns, 0.1, Families::ALL), &def);
        c.set_width(width).unwrap();
        c.set_stiffness_uniform([100.0, 100.0, 30.0, 2.0]).unwrap();
        c.pin(0).unwrap();
        steps(&mut c, 2);
        let well = snapshot(&mut c);
        near_infinity(&mut c);
        let (hash, index, state) = (c.state_hash(), c.step_index(), bits(&c));
        c.move_pin(0, Vector3::new(0.5, 0.5, 0.5)).unwrap();
        c.add_force(3, Vector3::new(1.0, 0.0, 0.0)).unwrap();
        let flags = c.step().unwrap();
        assert!(flags.contains(StepFlags::NON_FINITE));
        assert_eq!((c.state_hash(), c.step_index(), bits(&c)), (hash, index, state.clone()));
        // again, and with the forces and the target of the lost frame gone
        assert!(c.step().unwrap().contains(StepFlags::NON_FINITE));
        assert_eq!((c.state_hash(), bits(&c)), (hash, state));
        // and nothing of it stays once the cause is gone
        c.restore(&well).unwrap();
        let mut other = cloth(c.grid(), &def);
        other.set_stiffness_uniform([100.0, 100.0, 30.0, 2.0]).unwrap();
        other.restore(&well).unwrap();
        steps(&mut c, 5);
        steps(&mut other, 5);
        assert_eq!(c.state_hash(), other.state_hash());
    }
}

/// The same for a real explosion within one frame: `Tuned` without clamps, folded so that every spring pulls one way.
#[test]
fn an_explosion_within_a_frame_is_taken_back() {
    let def = ClothDef { rate_hz: 1.0, substeps: 1000, budget: Budget::Tuned, ..bare() };
    let mut c = cloth(&squares(8, 8, 0.1, Families(3)), &def);
    c.set_stiffness_uniform([1.0, 1.0, 1e6, 0.0]).unwrap();
    let mut r = Random::new(3);
    for i in 0..64 {
        let along = 0.13 * (i % 8) as f32 + 0.9 * (i / 8) as f32;
        let p = Vector3::new(along, 0.0, 0.0) + r.vector(1e-4);
        c.set_position(i, p).unwrap();
    }
    let (hash, before) = (c.state_hash(), positions(&c));
    assert!(c.step().unwrap().contains(StepFlags::NON_FINITE));
    assert_eq!((c.state_hash(), positions(&c)), (hash, before));
    assert_eq!(c.step_index(), 0);
}

/// The largest forces, speeds and distances that are accepted, on the lightest cloth: finite, or flagged and taken back.
#[test]
fn the_largest_accepted_inputs_never_leave_a_number_that_is_not_finite() {
    for seed in 0..60 {
        let mut r = Random::new(seed);
        let def = ClothDef {
            features: Features::PULL,
            rate_hz: r.log(1.0, 1e4),
            substeps: 1 + r.below(8) as u32,
            density_kg_m2: [1e-6, 1e6][r.below(2)],
            gravity_m_s2: [0.0, -1e4, 0.0],
            speed_limit: [0.0, 0.25, 1e6][r.below(3)],
            compression_limit: r.below(2) == 0,
            budget: [Budget::Tuned, Budget::Certified][r.below(2)],
            ..bare()
        };
        let cell = [1e-6, 0.1, 1000.0][r.below(3)];
        let mut c = cloth(&squares(5, 5, cell, Families::ALL), &def);
        let k = [1e-30, 1.0, f32::MAX][r.below(3)];
        c.set_stiffness_uniform([k; 4]).unwrap();
        for _ in 0..20 {
            let (i, j) = (r.below(25), r.below(25));
            let e = [1e6, -1e6, 0.0][r.below(3)];
            c.set_position(i, Vector3::new(e, -e, e)).unwrap();
            c.set_velocity(j, Vector3::new(e, e, -e)).unwrap();
            for _ in 0..50 {
                c.add_force(i, Vector3::new(1e9, -1e9, 1e9)).unwrap();
            }
            let flags = c.step().unwrap();
            let finite = |v: Vector3<f32>| v.iter().all(|x| x.is_finite());
            assert!(positions(&c).into_iter().chain(common::velocities(&c)).all(finite), "seed {seed}, {flags:?}");
        }
    }
}
