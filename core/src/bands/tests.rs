extern crate std;

use std::vec;
use std::vec::Vec;

use super::REFUSED;
use crate::colliders::MAX_COLLIDERS;
use crate::field::FieldView;
use crate::{
    Air, Cloth, ClothDef, ColliderDef, ColliderId, Error, Families, Features, Grid, GridDef, Pose, Shape, StepFlags,
    Target, TargetLimit, Vector3, Width, noise,
};

/// All that bands can step, and the memory of what they cannot.
const EVERY_FEATURE: Features = Features(!REFUSED & ((1 << 11) - 1));

/// A sheet in motion with a stiffness of its own at every particle, an inertia field and two pins of which one moves.
fn sheet<'a>(rows: u32, columns: u32, families: Families, features: Features, block: &'a mut Vec<f32>) -> Cloth<'a> {
    let grid = Grid::new(&GridDef { rows, columns, families, ..GridDef::default() }).unwrap();
    let def = ClothDef {
        features,
        substeps: 5,
        inertia_radius_m: 0.2,
        v_axis: [0.0, 0.0, 1.0],
        hinge_rigidity_n_m: 1e-4,
        ..ClothDef::default()
    };
    block.resize(Cloth::memory(&grid, &def).unwrap(), 0.0);
    let mut cloth = Cloth::create(&grid, &def, block).unwrap();
    let n = (rows * columns) as usize;
    let field: Vec<f32> = (0..4 * n).map(|i| 2000.0 * (0.2 + noise::uniform(3, i as u32))).collect();
    cloth.set_stiffness_field(&FieldView::new(4, rows as usize, columns as usize, &field).unwrap());
    if features.contains(Features::MASK) {
        // holes of all sizes, so also across the borders of bands, and none at the pins or the pulled particle
        let mask: Vec<u8> =
            (0..n).map(|i| u8::from([0, 7, n / 2].contains(&i) || noise::uniform(5, i as u32) > 0.2)).collect();
        cloth.set_mask(&mask).unwrap();
    }
    cloth.pin(0).unwrap();
    cloth.pin(n / 2).unwrap();
    if features.contains(Features::AIR) {
        cloth.set_air(&Air { wind_m_s: [3.0, 1.0, 4.0], gust: 0.5, ..Air::default() }).unwrap();
    }
    if features.contains(Features::MASS) {
        let each = cloth.particle_mass_kg();
        let masses: Vec<f32> = (0..n).map(|i| each * (0.5 + noise::uniform(6, i as u32))).collect();
        cloth.set_masses(&masses).unwrap();
    }
    if features.contains(Features::TARGETS) {
        let limit = |particle: usize| TargetLimit {
            max_distance_m: if particle.is_multiple_of(3) { 0.02 } else { f32::INFINITY },
            backstop_radius_m: if particle.is_multiple_of(5) { 0.1 } else { 0.0 },
            backstop_distance_m: 0.001,
        };
        cloth.set_target_limits(limit).unwrap();
    }
    if features.contains(Features::COLLIDERS) {
        let (sphere, capsule) = (
            Shape::Sphere { radius_m: 0.2 },
            Shape::Capsule { ends_m: [[0.0, -0.1, 0.0], [0.0, 0.1, 0.0]], radii_m: [0.05, 0.04] },
        );
        for (shape, x) in [(sphere, 0.3), (capsule, 0.7)] {
            cloth.add_collider(&ColliderDef::new(shape, at(x, 0))).unwrap();
        }
    }
    cloth
}

/// Where a collider is after a number of frames: it comes up from below.
fn at(x: f64, frame: u32) -> Pose {
    Pose::at(Vector3::new(x, 0.012 * f64::from(frame) - 0.25, 0.5))
}

fn drive(cloth: &mut Cloth<'_>, frame: u32) {
    cloth.move_pin(0, Vector3::new(0.0, 0.02 * f64::from(frame), 0.0)).unwrap();
    if cloth.def().features.contains(Features::PULL) {
        cloth.add_force(7, Vector3::new(0.0, 0.1, 0.3)).unwrap();
    }
    if cloth.def().features.contains(Features::TARGETS) {
        let (columns, each) = (cloth.grid().columns(), 1.0 / (cloth.grid().columns() - 1) as f32);
        let target = |particle: usize| Target {
            position_m: Vector3::new((particle % columns) as f32, -0.03 * frame as f32, (particle / columns) as f32)
                .component_mul(&Vector3::new(each, 1.0, 0.02)),
            normal: Vector3::new(0.1, 1.0, 0.0),
        };
        cloth.move_targets(Vector3::zeros(), target).unwrap();
    }
    for (place, x) in [(0, 0.3), (1, 0.7)].into_iter().take(cloth.collider_count()) {
        // the first of its place
        cloth.move_collider(ColliderId(MAX_COLLIDERS as u32 + place), &at(x, frame)).unwrap();
    }
}

/// One frame in bands; the bands of a phase in the order of `order`.
fn frame(cloth: &mut Cloth<'_>, rows: usize, memory: &mut [f32], order: impl Fn(u32, u32) -> u32) -> StepFlags {
    let bands = cloth.bands(rows, memory).unwrap();
    for phase in 0..bands.phases() {
        for i in 0..bands.count() {
            bands.run(phase, order(i, bands.count())).unwrap();
        }
    }
    bands.end().unwrap()
}

#[test]
fn bands_have_the_bits_of_the_step() {
    let all = Families::ALL;
    let no_bend = Families(Families::STRUCTURAL.0 | Families::SHEAR.0);
    let no_shear = Families(Families::STRUCTURAL.0 | Families::BEND.0);
    let masked_tethers = Features(Features::MASK.0 | Features::TETHERS.0);
    for (rows, columns, per_band) in [(40, 33, 8), (31, 17, 8), (97, 5, 16), (24, 64, 11), (9, 9, 8)] {
        for families in [all, no_bend, no_shear, Families::STRUCTURAL] {
            let mut without = Vec::new();
            for features in [
                Features::NONE,
                Features::PULL,
                Features::TETHERS,
                Features::MASK,
                masked_tethers,
                Features::AIR,
                Features::HINGE,
                Features::MASS,
                Features::TARGETS,
                Features::COLLIDERS,
                EVERY_FEATURE,
            ] {
                for width in Width::ALL.into_iter().filter(|w| w.is_supported()) {
                    let (mut one, mut other) = (Vec::new(), Vec::new());
                    let mut plain = sheet(rows, columns, families, features, &mut one);
                    let mut banded = sheet(rows, columns, families, features, &mut other);
                    plain.set_width(width).unwrap();
                    banded.set_width(width).unwrap();
                    let mut memory = vec![7.0; banded.bands_memory(per_band).unwrap()];
                    for i in 1..=12 {
                        drive(&mut plain, i);
                        drive(&mut banded, i);
                        let flags = plain.step().unwrap();
                        // forwards, backwards, and from the middle
                        let order = |k: u32, n: u32| [k, n - 1 - k, (k + n / 2) % n][i as usize % 3];
                        assert_eq!(frame(&mut banded, per_band, &mut memory, order), flags);
                        assert_eq!(plain.state_hash(), banded.state_hash(), "{rows} x {columns}, frame {i}, {width:?}");
                    }
                    assert!(plain.strain().largest > 1e-4, "it moves");
                    let ends: Vec<_> = (0..(rows * columns) as usize).map(|i| plain.position(i).unwrap()).collect();
                    if features == Features::NONE {
                        without = ends;
                    } else {
                        assert_ne!(ends, without, "{features:?} does something");
                    }
                }
            }
        }
    }
}

#[test]
fn bands_of_any_number_of_threads_have_the_same_bits() {
    let mut block = Vec::new();
    let features = EVERY_FEATURE;
    let mut plain = sheet(64, 48, Families::ALL, features, &mut block);
    for i in 1..=10 {
        drive(&mut plain, i);
        plain.step().unwrap();
    }
    for threads in 1..=4u32 {
        let mut block = Vec::new();
        let mut cloth = sheet(64, 48, Families::ALL, features, &mut block);
        let mut memory = vec![0.0; cloth.bands_memory(8).unwrap()];
        for i in 1..=10 {
            drive(&mut cloth, i);
            let bands = cloth.bands(8, &mut memory).unwrap();
            let barrier = std::sync::Barrier::new(threads as usize);
            std::thread::scope(|scope| {
                for thread in 0..threads {
                    let (bands, barrier) = (&bands, &barrier);
                    scope.spawn(move || {
                        for phase in 0..bands.phases() {
                            for band in (thread..bands.count()).step_by(threads as usize) {
                                bands.run(phase, band).unwrap();
                            }
                            barrier.wait();
                        }
                    });
                }
            });
            assert_eq!(bands.end(), Ok(StepFlags(0)));
        }
        assert_eq!(cloth.state_hash(), plain.state_hash(), "{threads} threads");
    }
}

#[test]
fn a_wrong_order_is_refused_and_an_unfinished_frame_taken_back() {
    let mut block = Vec::new();
    let mut cloth = sheet(32, 16, Families::ALL, Features::NONE, &mut block);
    let mut memory = vec![0.0; cloth.bands_memory(8).unwrap()];
    let before = cloth.state_hash();
    {
        let bands = cloth.bands(8, &mut memory).unwrap();
        assert_eq!((bands.count(), bands.phases()), (4, 10));
        let no = Err(Error::OutOfRange);
        assert_eq!(bands.run(1, 0), no, "not its next phase");
        assert_eq!(bands.run(0, 4), no, "no such band");
        assert_eq!(bands.run(10, 0), no, "no such phase");
        for band in [0, 1, 2] {
            assert_eq!(bands.run(0, band), Ok(()));
        }
        assert_eq!(bands.run(0, 1), no, "twice");
        assert_eq!(bands.run(1, 1), no, "band 3 has yet to end phase 0");
        assert_eq!(bands.run(0, 3), Ok(()));
        for band in 0..4 {
            assert_eq!(bands.run(1, band), Ok(()));
        }
        assert_eq!(bands.end(), Err(Error::OutOfRange), "phases to go");
    }
    assert_eq!(cloth.state_hash(), before);

    // what bands cannot do
    assert_eq!(cloth.bands_memory(7), Err(Error::OutOfRange));
    let needed = memory.len();
    assert_eq!(cloth.bands(8, &mut memory[..needed - 1]).err(), Some(Error::BlockTooSmall));
    let mut block = Vec::new();
    let levels = sheet(32, 16, Families::ALL, Features::LEVELS, &mut block);
    assert_eq!(levels.bands_memory(8), Err(Error::OutOfRange));
    let grid = Grid::new(&GridDef::default()).unwrap();
    let mut block = vec![0.0; Cloth::memory(&grid, &ClothDef::default()).unwrap()];
    let mut soft = Cloth::create(&grid, &ClothDef::default(), &mut block).unwrap();
    let mut memory = vec![0.0; soft.bands_memory(8).unwrap()];
    assert_eq!(soft.bands(8, &mut memory).err(), Some(Error::NoStiffness));
}

#[test]
fn what_is_not_finite_is_taken_back_as_in_a_step() {
    let (mut one, mut other) = (Vec::new(), Vec::new());
    let mut plain = sheet(16, 16, Families::ALL, Features::PULL, &mut one);
    let mut banded = sheet(16, 16, Families::ALL, Features::PULL, &mut other);
    let mut memory = vec![0.0; banded.bands_memory(8).unwrap()];
    // found before the frame, and only in it
    for force in [f32::NAN, 3e38] {
        for cloth in [&mut plain, &mut banded] {
            let at = cloth.layout.at(2, 8);
            cloth.pull[0][at] = force;
            cloth.has_pull = true;
        }
        let flags = plain.step().unwrap();
        assert!(flags.contains(StepFlags::NON_FINITE) && flags.contains(StepFlags::NON_FINITE_FORCE));
        assert_eq!(frame(&mut banded, 8, &mut memory, |i, _| i), flags);
        assert_eq!(plain.state_hash(), banded.state_hash());
    }
    assert_eq!(frame(&mut banded, 8, &mut memory, |i, _| i), plain.step().unwrap());
    assert_eq!(plain.state_hash(), banded.state_hash());
}
