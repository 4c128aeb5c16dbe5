//! The stretch that the budget predicts against cloths that were let come to rest.

mod common;

use common::{cloth, grid, near, squares, steps};
use taut::{
    Air, Budget, BudgetFlags, BudgetReport, Cloth, ClothDef, ColliderDef, Families, Features, Pose, STRETCH_RANGE,
    Shape, Vector3,
};

/// What hangs: a sheet, its fabric and its step. A fabric of weak shear needs the certified budget to come to rest: the tuned one
/// knows the flat sheet only.
#[derive(Clone, Copy, Debug)]
struct Case {
    rows: u32,
    columns: u32,
    size_m: [f32; 2],
    /// 1/dt.
    steps_per_s: u32,
    stiffness: [f32; 4],
    density: f32,
    budget: Budget,
    radius_m: f32,
    whole_row: bool,
}

impl Case {
    fn hung(&self) -> Cloth<'static> {
        let [width, height] = self.size_m;
        let def = ClothDef {
            substeps: self.steps_per_s / 60,
            density_kg_m2: self.density,
            budget: self.budget,
            inertia_radius_m: self.radius_m,
            ..ClothDef::default()
        };
        let g = grid(self.rows, self.columns, width, height, Families::ALL);
        let mut c = cloth(&g, &def);
        c.set_stiffness_uniform(self.stiffness).unwrap();
        let (m, n) = (self.rows as usize, self.columns as usize);
        // folds, without which a flat sheet would stay flat
        for i in 0..m * n {
            let (u, v) = ((i % n) as f32 / (n - 1) as f32, (i / n) as f32 / (m - 1) as f32);
            let wave =
                (9.4 * u).sin() + 0.6 * (15.7 * u + 1.0).cos() + 0.4 * (6.3 * u + 3.0 * v).sin() + (3.1 * u).sin();
            c.set_position(i, Vector3::new(width * u, -height * v, 0.004 * width * v * wave)).unwrap();
        }
        let pins: Vec<usize> = if self.whole_row { (0..n).collect() } else { vec![0, n - 1] };
        pins.iter().for_each(|p| c.pin(*p).unwrap());
        c
    }

    /// What is predicted, and what is measured once the largest strain stands still.
    fn measured(&self) -> (BudgetReport, Option<f32>) {
        let mut c = self.hung();
        let report = c.predict_stretch().unwrap();
        (report, rest(&mut c))
    }
}

/// Largest strain at rest; none where the cloth never rests (the tuned budget knows the flat sheet only).
fn rest(c: &mut Cloth<'_>) -> Option<f32> {
    let particles = c.grid().particles();
    for frame in 0..600 {
        assert_eq!(c.step().unwrap().0, 0);
        // drag that does not touch the budget, after the fall
        let mut energy = 0.0;
        for i in 0..particles {
            let v = c.velocity(i).unwrap();
            energy += v.norm_squared();
            if frame > 30 {
                c.set_velocity(i, v * 0.9).unwrap();
            }
        }
        if frame > 60 && energy < 4e-6 * particles as f32 {
            return Some(c.strain().largest);
        }
    }
    None
}

const STIFF: [f32; 4] = [1e8, 1e8, 3e7, 2e6];
const WEAK_SHEAR: [f32; 4] = [1e8, 1e8, 3e6, 1e6];
const DENIM: [f32; 4] = [1975.0, 356.0, 54.0, 1.0];

const SHEET: Case = Case {
    rows: 16,
    columns: 16,
    size_m: [1.0; 2],
    steps_per_s: 480,
    stiffness: STIFF,
    density: 0.2,
    budget: Budget::Tuned,
    radius_m: 0.0,
    whole_row: false,
};

/// Sizes, shapes, densities, fabrics, steps: none of them went into the prediction. It sees a wrong weight, a wrong end of
/// a cut, a spring family that is left out, an edge column taken for an inner one.
#[test]
fn what_hangs_is_stretched_as_predicted() {
    let weak = Budget::Certified;
    let cases = [
        SHEET,
        Case { whole_row: true, steps_per_s: 240, ..SHEET },
        Case { radius_m: 0.3, steps_per_s: 240, ..SHEET },
        Case { rows: 24, columns: 14, size_m: [0.5, 1.1], density: 0.05, ..SHEET },
        Case { rows: 12, columns: 27, size_m: [2.0, 0.7], density: 0.9, radius_m: 0.2, ..SHEET },
        Case { rows: 31, columns: 18, size_m: [0.7, 1.3], whole_row: true, stiffness: DENIM, budget: weak, ..SHEET },
        Case { stiffness: WEAK_SHEAR, budget: weak, ..SHEET },
        Case { stiffness: [1975.0, 1000.0, 54.0, 1.0], radius_m: 0.3, budget: weak, ..SHEET },
        // nothing is cut
        Case { stiffness: [300.0, 150.0, 60.0, 4.0], steps_per_s: 3840, density: 0.15, ..SHEET },
        Case { rows: 32, columns: 32, steps_per_s: 960, ..SHEET },
    ];
    for case in cases {
        let (report, now) = case.measured();
        let now = now.unwrap_or_else(|| panic!("{case:?} never rests"));
        let ratio = report.stretch / now;
        println!("{} predicted, {now} measured, {case:?}", report.stretch);
        assert_eq!(report.flags, BudgetFlags(0), "{case:?}");
        assert!((0.85..1.15).contains(&ratio), "{} for {now}, {case:?}", report.stretch);
        assert!(now <= report.stretch_bound, "{now} above {}, {case:?}", report.stretch_bound);
    }
}

/// A column of springs under the weight below it: k a e = (rows - 1) m g. The prediction ends where 1 % of a particle's weight is
/// left.
#[test]
fn a_row_of_columns_is_the_closed_form() {
    for (rows, k) in [(2, 40.0), (9, 90.0), (40, 500.0)] {
        let def = ClothDef { rate_hz: 10_000.0, ..ClothDef::default() };
        let mut c = cloth(&squares(rows, 5, 0.05, Families::STRUCTURAL), &def);
        c.set_stiffness_uniform([k; 4]).unwrap();
        (0..5).for_each(|p| c.pin(p).unwrap());
        let report = c.predict_stretch().unwrap();
        assert_eq!((report.cut_fraction, report.flags), (0.0, BudgetFlags(0)));
        let strain = (rows - 1) as f32 * c.particle_mass_kg() * 9.81 / (k * 0.05);
        near(report.stretch.into(), strain.into(), 0.015, "strain at the top");
    }
}

/// It hangs from any edge alike.
#[test]
fn every_edge_is_an_edge() {
    let predicted = |pins: &[usize], u_axis: [f32; 3], v_axis: [f32; 3]| {
        let def = ClothDef { u_axis, v_axis, ..ClothDef::default() };
        let mut c = cloth(&squares(16, 16, 1.0 / 15.0, Families::ALL), &def);
        c.set_stiffness_uniform(STIFF).unwrap();
        pins.iter().for_each(|p| c.pin(*p).unwrap());
        let report = c.predict_stretch().unwrap();
        assert_eq!(report.flags, BudgetFlags(0));
        f64::from(report.stretch)
    };
    let (right, down) = ([1.0, 0.0, 0.0], [0.0, -1.0, 0.0]);
    let first_row = predicted(&[0, 15], right, down);
    assert!(first_row > 0.005);
    near(predicted(&[240, 255], right, [0.0, 1.0, 0.0]), first_row, 0.02, "last row");
    near(predicted(&[0, 240], down, right), first_row, 0.02, "first column");
    near(predicted(&[15, 255], [0.0, 1.0, 0.0], right), first_row, 0.02, "last column");
}

#[test]
fn rubber_is_above_the_range() {
    let case = Case { steps_per_s: 240, ..SHEET };
    let (report, now) = case.measured();
    assert_eq!(report.flags, BudgetFlags::ABOVE_RANGE);
    let now = now.expect("it rests");
    assert!(now > STRETCH_RANGE && now < report.stretch_bound, "{now}, {report:?}");
}

/// What the prediction was not made for says so, and the bound holds from the first frame on.
#[test]
fn what_is_not_known_is_said_and_bounded() {
    type Change = fn(&mut Cloth<'_>);
    let changes: [Change; 10] = [
        |c| c.set_stiffness_uniform(DENIM).unwrap(),
        |c| c.unpin(0).unwrap(),
        |c| c.pin(100).unwrap(),
        |c| c.set_position(0, Vector3::new(0.2, 0.0, 0.0)).unwrap(),
        |c| c.set_position(0, Vector3::new(0.0, -0.3, 0.0)).unwrap(),
        |c| c.set_gravity([9.81, 0.0, 0.0]).unwrap(),
        |c| c.set_air(&Air { wind_m_s: [0.0, 0.0, 1.0], ..Air::default() }).unwrap(),
        |c| {
            let sphere = ColliderDef::new(Shape::Sphere { radius_m: 0.1 }, Pose::at(Vector3::new(0.0, -9.0, 0.0)));
            c.add_collider(&sphere).unwrap();
        },
        |c| c.set_rest_scale([1.0, 1.0, 0.99]).unwrap(),
        |c| {
            let mut masses = vec![c.particle_mass_kg(); 256];
            masses[9] *= 2.0;
            c.set_masses(&masses).unwrap();
        },
    ];
    for (i, change) in changes.iter().enumerate() {
        let features = Features(Features::AIR.0 | Features::COLLIDERS.0 | Features::MASS.0);
        let def = ClothDef { features, ..ClothDef::default() };
        let mut c = cloth(&squares(16, 16, 1.0 / 15.0, Families::ALL), &def);
        c.set_stiffness_uniform(STIFF).unwrap();
        c.pin(0).unwrap();
        c.pin(15).unwrap();
        assert_eq!(c.predict_stretch().unwrap().flags, BudgetFlags(0), "before {i}");
        change(&mut c);
        let report = c.predict_stretch().unwrap();
        assert_eq!((report.flags, report.stretch), (BudgetFlags::STRETCH_UNKNOWN, 0.0), "{i}");
        for _ in 0..60 {
            steps(&mut c, 1);
            assert!(c.strain().largest <= report.stretch_bound, "{i}: {}", c.strain().largest);
        }
        // a pin that was moved away, and a scaled sheet, which starts under tension
        assert!(report.stretch_bound < 60.0 || i == 4 || i == 8, "{i}: {report:?}");
    }
    // nothing bounds what is pulled apart, nor what falls
    let mut c = cloth(&squares(8, 8, 0.1, Families::ALL), &ClothDef::default());
    c.set_stiffness_uniform(STIFF).unwrap();
    assert_eq!(c.predict_stretch().unwrap().stretch_bound, f32::INFINITY);
    c.pin(0).unwrap();
    c.pin(7).unwrap();
    c.set_position(7, Vector3::new(0.8, 0.0, 0.0)).unwrap();
    assert_eq!(c.predict_stretch().unwrap().stretch_bound, f32::INFINITY);
}

/// Limits that this cloth keeps cap the prediction; those that it may exceed are named. The first two are the contract of
/// docs/limits.md.
#[test]
fn limits_that_are_not_kept_are_named() {
    let report_of = |features: Features, substeps: u32, limit: f32, side: u32, level_cycles: u32| {
        let def = ClothDef { features, substeps, strain_limit: [limit; 3], level_cycles, ..ClothDef::default() };
        let mut c = cloth(&squares(side, side, 1.0 / (side - 1) as f32, Families::ALL), &def);
        c.set_stiffness_uniform([300.0, 300.0, 100.0, 5.0]).unwrap();
        c.pin(0).unwrap();
        c.pin(side as usize - 1).unwrap();
        c.predict_stretch().unwrap()
    };
    let report = |features, substeps, limit, side| report_of(features, substeps, limit, side, 0);
    for (substeps, limit, side) in [(16, 0.1, 32), (32, 0.05, 32), (64, 0.05, 64)] {
        let r = report(Features::LEVELS, substeps, limit, side);
        assert_eq!(r.flags, BudgetFlags(0), "{substeps}, {limit}, {side}");
        assert!(r.stretch > 0.01 && r.stretch <= limit && r.stretch_bound <= limit, "{r:?}");
    }
    let both = BudgetFlags(BudgetFlags::LIMIT_NOT_KEPT.0 | BudgetFlags::STRETCH_UNKNOWN.0);
    let masked = Features(Features::LEVELS.0 | Features::MASK.0);
    for (features, substeps, limit, side) in [
        (Features::LEVELS, 16, 0.05, 32),
        (Features::LEVELS, 16, 0.1, 64),
        (Features::STRAIN_LIMIT, 32, 0.1, 32),
        (Features::TETHERS, 32, 0.1, 32),
        (masked, 32, 0.1, 32),
    ] {
        assert_eq!(report(features, substeps, limit, side).flags, both, "{features:?}, {substeps}, {limit}, {side}");
    }
    // a given number of cycles promises nothing
    assert_eq!(report_of(Features::LEVELS, 32, 0.05, 32, 2).flags, both);
    assert_eq!(report(Features::NONE, 16, 0.05, 32).flags.0 & BudgetFlags::LIMIT_NOT_KEPT.0, 0);
}

/// `cargo test -p taut --test stretch --release -- --ignored --nocapture` prints the table of docs/budget.md.
#[test]
#[ignore = "minutes"]
fn the_table() {
    let (mut worst, mut off, mut beyond) = (1.0f32, Vec::new(), Vec::new());
    for side in [16, 32, 64, 128] {
        let only = std::env::var("SIDE").ok();
        if only.is_some_and(|only| only != side.to_string()) {
            continue;
        }
        for steps_per_s in [240, 480, 960, 1920, 3840] {
            let fabrics = [
                ("stiff", STIFF, Budget::Tuned),
                ("weak shear", WEAK_SHEAR, Budget::Certified),
                ("denim", DENIM, Budget::Certified),
            ];
            for (name, stiffness, budget) in fabrics {
                for radius_m in [0.0, 0.3] {
                    for whole_row in [true, false] {
                        let case = Case {
                            rows: side,
                            columns: side,
                            size_m: [1.0; 2],
                            steps_per_s,
                            stiffness,
                            density: 0.2,
                            budget,
                            radius_m,
                            whole_row,
                        };
                        let clock = std::time::Instant::now();
                        let report = case.hung().budget().unwrap();
                        let ms = clock.elapsed().as_secs_f64() * 1e3;
                        let what = format!(
                            "{side:3} 1/{steps_per_s:4} {name:10} r {radius_m} {}",
                            if whole_row { "row" } else { "two" }
                        );
                        if report.flags == BudgetFlags::ABOVE_RANGE && report.stretch > 0.4 {
                            println!("{what} {:8.1} %  flags {}", 100.0 * report.stretch, report.flags.0);
                            continue;
                        }
                        let (report, Some(now)) = case.measured() else {
                            println!("{what} {:8.3} % never rests, flags {}", 100.0 * report.stretch, report.flags.0);
                            continue;
                        };
                        let ratio = report.stretch / now;
                        println!(
                            "{what} {:8.3} % measured {:8.3} % ratio {ratio:.3} bound {:8.1} % flags {} {ms:.0} ms",
                            100.0 * report.stretch,
                            100.0 * now,
                            100.0 * report.stretch_bound,
                            report.flags.0
                        );
                        if now > report.stretch_bound {
                            beyond.push(what.clone());
                        }
                        if now < 0.2 && report.flags != BudgetFlags::STRETCH_UNKNOWN {
                            worst = worst.max(ratio.max(1.0 / ratio));
                            if !(0.85..=1.15).contains(&ratio) {
                                off.push(what);
                            }
                        }
                    }
                }
            }
        }
    }
    println!("worst {worst}, off: {off:?}, beyond the bound: {beyond:?}");
}
