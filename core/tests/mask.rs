//! Absent particles: nothing leaks across their border, to the bit, and nothing counts them.

mod common;

use common::{Random, bare, bits, cloth, positions, snapshot, squares, steps, stir, velocities};
use taut::{Budget, Cloth, ClothDef, Error, Families, Features, Vector3};

const WITH_MASK: Features = Features(Features::MASK.0 | Features::PULL.0 | Features::MASS.0);

fn disc(n: usize) -> Vec<u8> {
    let middle = (n - 1) as f32 / 2.0;
    let inside = |i: usize| {
        let (r, c) = ((i / n) as f32 - middle, (i % n) as f32 - middle);
        u8::from(r * r + c * c <= middle * middle)
    };
    (0..n * n).map(inside).collect()
}

/// The bits of one particle.
fn bits_of(c: &Cloth<'_>, particle: usize) -> [u32; 6] {
    let (x, v) = (c.position(particle).unwrap(), c.velocity(particle).unwrap());
    [x.x, x.y, x.z, v.x, v.y, v.z].map(f32::to_bits)
}

#[test]
fn a_full_mask_has_the_bits_of_no_mask() {
    let run = |features: Features, set: bool| {
        let def = ClothDef { features, inertia_radius_m: 0.3, ..ClothDef::default() };
        let mut c = cloth(&squares(9, 20, 0.05, Families::ALL), &def);
        if set {
            c.set_mask(&[7; 180]).unwrap();
        }
        c.set_stiffness_uniform([3000.0, 2000.0, 500.0, 30.0]).unwrap();
        c.pin(0).unwrap();
        c.pin(19).unwrap();
        stir(&mut c, &mut Random::new(3), 0.5);
        steps(&mut c, 100);
        (bits(&c), c.state_hash(), c.strain(), c.kinetic_energy_j())
    };
    let none = run(Features::NONE, false);
    assert_eq!(run(Features::MASK, false), none);
    assert_eq!(run(Features::MASK, true), none);
}

/// A column that is missing makes two cloths: each has the bits of the same cloth alone, with the budget at work, so neither
/// a spring nor a bound reaches over the gap.
#[test]
fn a_grid_in_two_pieces_is_two_cloths() {
    let rows = 9;
    for budget in [Budget::Certified, Budget::Tuned] {
        let def = ClothDef { budget, features: WITH_MASK, ..ClothDef::default() };
        let make = |columns: u32| {
            let mut c = cloth(&squares(rows, columns, 0.125, Families::ALL), &def);
            let kg = 0.003;
            c.set_masses(&vec![kg; c.grid().particles()]).unwrap();
            c.set_stiffness_uniform([4000.0, 3000.0, 900.0, 60.0]).unwrap();
            c
        };
        let mut both = make(20);
        both.set_mask(&(0..180).map(|i| u8::from(i % 20 != 9)).collect::<Vec<_>>()).unwrap();
        let mut pieces = [make(9), make(10)];
        let mut random = Random::new(8);
        for row in 0..rows as usize {
            for (piece, first, columns) in [(0, 0, 9), (1, 10, 10)] {
                for column in 0..columns {
                    let (alone, together) = (row * columns + column, row * 20 + first + column);
                    let place = both.position(together).unwrap() + random.vector(0.01);
                    both.set_position(together, place).unwrap();
                    pieces[piece].set_position(alone, place).unwrap();
                }
            }
        }
        for (alone, together) in [(0, 0), (8, 8)] {
            both.pin(together).unwrap();
            pieces[0].pin(alone).unwrap();
        }
        both.pin(10).unwrap();
        pieces[1].pin(0).unwrap();
        for frame in 0..120 {
            if frame == 60 {
                let to = both.world_position(0).unwrap() + Vector3::new(0.1, 0.0, 0.2);
                both.move_pin(0, to).unwrap();
                pieces[0].move_pin(0, to).unwrap();
            }
            steps(&mut both, 1);
            for (piece, first, columns) in [(0, 0, 9), (1, 10, 10)] {
                let c: &mut Cloth<'_> = &mut pieces[piece];
                steps(c, 1);
                for i in 0..rows as usize * columns {
                    let together = i / columns * 20 + first + i % columns;
                    assert_eq!(bits_of(c, i), bits_of(&both, together), "piece {piece}, frame {frame}, {i}");
                }
            }
        }
        assert!(both.budget().unwrap().cut_fraction > 0.01, "the budget must have been at work");
        assert_eq!(both.strain().largest, pieces[0].strain().largest.max(pieces[1].strain().largest));
    }
}

/// Whatever one side does, the other does not notice: across a row, a column, a diagonal one particle wide, and a ring.
#[test]
fn nothing_reaches_over_a_gap() {
    let n = 13usize;
    type Side = fn(isize, isize) -> isize;
    let sides: [Side; 5] =
        [|r, _| r - 6, |_, c| c - 6, |r, c| r - c, |r, c| r + c - 12, |r, c| (r - 6).abs().max((c - 6).abs()) - 3];
    for (k, side) in sides.into_iter().enumerate() {
        let side = |i: usize| side((i / n) as isize, (i % n) as isize);
        let run = |stirred: bool| {
            let def = ClothDef { features: WITH_MASK, ..ClothDef::default() };
            let mut c = cloth(&squares(13, 13, 0.1, Families::ALL), &def);
            c.set_stiffness_uniform([2000.0, 2000.0, 900.0, 60.0]).unwrap();
            c.set_mask(&(0..n * n).map(|i| u8::from(side(i) != 0)).collect::<Vec<_>>()).unwrap();
            let mut random = Random::new(4);
            for i in 0..n * n {
                let v = random.vector(1.0);
                if side(i) > 0 || (stirred && side(i) < 0) {
                    c.set_velocity(i, v).unwrap();
                }
            }
            steps(&mut c, 30);
            let of = |sign: isize| -> Vec<_> {
                (0..n * n).filter(|i| side(*i).signum() == sign).map(|i| bits_of(&c, i)).collect()
            };
            (of(1), of(-1))
        };
        let (quiet, stirred) = (run(false), run(true));
        assert_eq!(quiet.0, stirred.0, "gap {k}");
        assert_ne!(quiet.1, stirred.1, "gap {k}");
    }
}

/// Where absent particles are is nobody's business; they stay there, at rest.
#[test]
fn absent_particles_can_be_anywhere() {
    let run = |far: bool| {
        let def = ClothDef { features: Features::MASK, inertia_radius_m: 0.3, ..ClothDef::default() };
        let mut c = cloth(&squares(17, 17, 0.0625, Families::ALL), &def);
        c.set_stiffness_uniform([2000.0, 2000.0, 500.0, 30.0]).unwrap();
        let mask = disc(17);
        c.set_mask(&mask).unwrap();
        c.pin(8).unwrap();
        let mut random = Random::new(2);
        for i in 0..289 {
            let place = random.vector(1e4);
            if mask[i] == 0 && far {
                c.set_position(i, place).unwrap();
            }
        }
        let before = positions(&c);
        steps(&mut c, 60);
        for i in (0..289).filter(|i| mask[*i] == 0) {
            assert_eq!(c.position(i).unwrap(), before[i]);
            assert_eq!(c.velocity(i).unwrap(), Vector3::zeros());
        }
        let there: Vec<_> = (0..289).filter(|i| mask[*i] == 1).map(|i| bits_of(&c, i)).collect();
        (there, c.strain(), c.kinetic_energy_j())
    };
    let (a, b) = (run(false), run(true));
    assert!(a.1.largest > 0.0 && a.2 > 0.0);
    assert_eq!(a, b);
}

/// Strain and energy by hand over what is there.
#[test]
fn only_what_exists_is_counted() {
    let def = ClothDef { features: Features::MASK, inertia_radius_m: 0.25, inertia_max: 6.0, ..bare() };
    let mut c = cloth(&squares(11, 11, 0.1, Families::ALL), &def);
    c.set_stiffness_uniform([100.0; 4]).unwrap();
    let mask = disc(11);
    c.set_mask(&mask).unwrap();
    c.pin(5).unwrap();
    c.pin(60).unwrap();
    let mut random = Random::new(1);
    for i in 0..121 {
        let p = c.position(i).unwrap() + random.vector(0.02);
        c.set_position(i, p).unwrap();
    }
    for i in (0..121).filter(|i| mask[*i] == 1) {
        c.set_velocity(i, random.vector(1.0)).unwrap();
    }
    c.budget().unwrap();
    let m = f64::from(c.particle_mass_kg());
    let (x, v) = (positions(&c), velocities(&c));
    let mut energy = 0.0;
    for i in (0..121).filter(|i| mask[*i] == 1 && *i != 5 && *i != 60) {
        let away = |p: usize| {
            let (r, k) = ((i / 11) as f64 - (p / 11) as f64, (i % 11) as f64 - (p % 11) as f64);
            0.1 * (r * r + k * k).sqrt()
        };
        let q = (0.25 / away(5).min(away(60))).clamp(1.0, 6.0);
        energy += 0.5 * q * m * f64::from(v[i].norm_squared());
    }
    common::near(c.kinetic_energy_j(), energy, 1e-5, "kinetic energy");
    let mut strains = Vec::new();
    for i in 0..121 {
        for (other, there) in [(i + 1, i % 11 < 10), (i + 11, i < 110)] {
            if there && mask[i] == 1 && mask[other] == 1 {
                strains.push((x[i] - x[other]).norm() / 0.1 - 1.0);
            }
        }
    }
    let s = c.strain();
    let mean = strains.iter().sum::<f32>() / strains.len() as f32;
    let largest = strains.iter().copied().fold(f32::MIN, f32::max);
    assert!((s.mean - mean).abs() < 1e-5 && (s.largest - largest).abs() < 1e-5, "{s:?} {mean} {largest}");
    let mut seen = 0;
    c.each_structural_strain(|a, b, _| {
        assert!(mask[a] == 1 && mask[b] == 1);
        seen += 1;
    });
    assert_eq!(seen, strains.len());
}

/// Half of a hanging sheet is torn off: it falls freely, and the rest goes on as if it had hung alone.
#[test]
fn a_cloth_tears() {
    let def = ClothDef { features: WITH_MASK, damping_per_s: 0.0, speed_limit: 0.0, ..ClothDef::default() };
    let mut c = cloth(&squares(9, 6, 0.1, Families::ALL), &def);
    c.set_stiffness_uniform([500.0, 500.0, 100.0, 8.0]).unwrap();
    for i in 0..6 {
        c.pin(i).unwrap();
    }
    c.pin(27).unwrap();
    steps(&mut c, 5);
    let before = velocities(&c);
    c.set_mask(&(0..54).map(|i| u8::from(i / 6 != 4)).collect::<Vec<_>>()).unwrap();
    assert_eq!(c.pinned().collect::<Vec<_>>(), [0, 1, 2, 3, 4, 5]);
    let lower: Vec<usize> = (30..54).collect();
    let speed = |v: &[Vector3<f32>]| lower.iter().map(|i| f64::from(v[*i].y)).sum::<f64>() / 24.0;
    steps(&mut c, 60);
    // the centre of mass of the piece has no force but its weight: v = v0 - g t
    common::near(speed(&velocities(&c)), speed(&before) - 9.81, 1e-4, "fall");
    assert!(positions(&c)[..24].iter().all(|p| p.y > -0.45));
    // it comes back where it was put
    for i in 24..30 {
        c.set_position(i, Vector3::new(0.1 * (i - 24) as f32, -0.4, 0.0)).unwrap();
    }
    c.set_mask(&[1; 54]).unwrap();
    steps(&mut c, 1);
    assert!(c.velocity(26).unwrap().norm() > 0.0);
}

#[test]
fn absent_particles_are_refused() {
    let def = ClothDef { features: WITH_MASK, ..ClothDef::default() };
    let mut c = cloth(&squares(4, 4, 0.1, Families::ALL), &def);
    c.set_stiffness_uniform([100.0; 4]).unwrap();
    c.pin(5).unwrap();
    c.pin(6).unwrap();
    c.add_force(5, Vector3::new(1.0, 0.0, 0.0)).unwrap();
    let mut mask = [1; 16];
    mask[5] = 0;
    c.set_mask(&mask).unwrap();
    assert_eq!(c.pinned().collect::<Vec<_>>(), [6]);
    assert_eq!((c.is_present(5), c.is_present(4)), (Ok(false), Ok(true)));
    assert_eq!(c.is_present(16), Err(Error::NoSuchParticle));
    assert_eq!(c.mass_kg(5), Ok(0.0));
    let hash = c.state_hash();
    assert_eq!(c.pin(5), Err(Error::Absent));
    assert_eq!(c.set_velocity(5, Vector3::zeros()), Err(Error::Absent));
    assert_eq!(c.add_force(5, Vector3::zeros()), Err(Error::Absent));
    assert_eq!(c.move_pin(5, Vector3::zeros()), Err(Error::NotPinned));
    assert_eq!(c.unpin(5), Err(Error::NotPinned));
    assert_eq!(c.set_mask(&mask[..15]), Err(Error::Shape));
    assert_eq!(c.state_hash(), hash);
    let mut none = cloth(&squares(4, 4, 0.1, Families::ALL), &ClothDef::default());
    assert_eq!(none.set_mask(&mask), Err(Error::FeatureOff));
    assert_eq!(none.is_present(3), Ok(true));
    // nothing at all
    c.set_mask(&[0; 16]).unwrap();
    steps(&mut c, 3);
    assert_eq!((c.strain().largest, c.strain().mean, c.kinetic_energy_j()), (0.0, 0.0, 0.0));
    assert_eq!(c.budget().unwrap().cut_fraction, 0.0);
}

/// The mask is a parameter: `reset` keeps it, and a snapshot of another one is foreign until it is set again.
#[test]
fn a_snapshot_belongs_to_its_mask() {
    let def = ClothDef { features: WITH_MASK, ..ClothDef::default() };
    let mut c = cloth(&squares(9, 9, 0.1, Families::ALL), &def);
    c.set_stiffness_uniform([500.0; 4]).unwrap();
    c.set_mask(&disc(9)).unwrap();
    c.pin(4).unwrap();
    steps(&mut c, 10);
    let saved = snapshot(&mut c);
    steps(&mut c, 10);
    let hash = c.state_hash();
    c.set_mask(&[1; 81]).unwrap();
    assert_eq!(c.restore(&saved), Err(Error::Foreign));
    steps(&mut c, 3);
    c.set_mask(&disc(9)).unwrap();
    c.reset();
    assert_eq!(c.is_present(0), Ok(false));
    c.restore(&saved).unwrap();
    steps(&mut c, 10);
    assert_eq!(c.state_hash(), hash);
}
