//! What crosses the files of the differentiable cloth: gradients, closed forms, and agreement with core.

use std::sync::Arc;

use super::*;

/// Reproducible numbers, evenly spread over 0..1.
fn noise(seed: u64) -> impl FnMut() -> f64 {
    let mut index = 0;
    move || {
        index += 1;
        f64::from(taut::noise::uniform(seed, index))
    }
}

/// A field that wavers around the four values.
fn field(springs: &Springs, k: [f64; 4], seed: u64) -> Vec<f64> {
    let mut next = noise(seed);
    let n = springs.particles();
    (0..4 * n).map(|j| k[j / n] * (0.6 + 0.8 * next())).collect()
}

fn corners(springs: &Springs) -> Vec<usize> {
    vec![0, springs.columns() - 1]
}

fn largest_structural(springs: &Springs, solution: &Solution) -> f64 {
    let strains = solution.strains();
    let structural = springs.list().iter().zip(strains).filter(|(s, _)| s.channel <= WEFT);
    structural.map(|(_, e)| e).fold(0.0, f64::max)
}

/// Largest difference between the gradient and central differences over every number of the field, as a share of the
/// channel's largest entry.
fn gradient_error(pins: &[usize], dt_s: f64, k: [f64; 4]) -> (f64, f64) {
    let springs = Arc::new(Springs::new(8, 8, 1.0, 1.0).unwrap());
    let mut scene = Scene::new(&springs, SceneDef { dt_s, ..SceneDef::hung(&springs, pins) }).unwrap();
    let field = field(&springs, k, 11);
    let mut next = noise(12);
    let weights: Vec<[f64; 3]> = (0..64).map(|_| [next(), next(), next()].map(|w| w - 0.5)).collect();
    let base = scene.solve(&field).unwrap();
    assert!(base.outcome().settled);
    let gradient = base.gradient(&weights).unwrap();
    let mut worst = 0.0f64;
    for channel in 0..CHANNELS {
        let range = channel * 64..(channel + 1) * 64;
        let size = gradient[range.clone()].iter().fold(0.0, |m: f64, g| m.max(g.abs()));
        for j in range {
            let h = 3e-4 * field[j];
            let mut loss = |h: f64| {
                let mut moved = field.clone();
                moved[j] += h;
                scene.set_start(Some(base.positions().to_vec())).unwrap();
                let solution = scene.solve(&moved).unwrap();
                assert!(solution.outcome().settled);
                let x = solution.positions();
                x.iter().zip(&weights).map(|(x, w)| x[0] * w[0] + x[1] * w[1] + x[2] * w[2]).sum::<f64>()
            };
            let difference = (loss(h) - loss(-h)) / (2.0 * h);
            worst = worst.max((difference - gradient[j]).abs() / difference.abs().max(0.01 * size).max(1e-300));
        }
    }
    (worst, base.outcome().cut_fraction)
}

#[test]
fn gradient_agrees_with_finite_differences() {
    let edge: Vec<usize> = (0..8).collect();
    // Bend at the cap of 2 % for about half of the particles.
    let k = [900.0, 500.0, 120.0, 14.0];
    for pins in [&[0, 7][..], &edge[..]] {
        for (dt_s, cut) in [(1.0 / 240.0, 0.3..0.95), (1.0 / 600.0, 0.005..0.5), (1e-4, 0.0..1e-15)] {
            let (error, found) = gradient_error(pins, dt_s, k);
            assert!(cut.contains(&found), "{} pins, dt {dt_s}: cut {found}", pins.len());
            assert!(error < 1e-3, "{} pins, dt {dt_s}: {error}", pins.len());
        }
    }
}

#[test]
fn a_chain_hangs_by_the_closed_form() {
    // Two columns without shear and bend: spring i carries the weight of all particles below it.
    let springs = Arc::new(Springs::new(9, 2, 0.3, 1.2).unwrap());
    let def = SceneDef { dt_s: 1e-5, ..SceneDef::hung(&springs, &[0, 1]) };
    let mut scene = Scene::new(&springs, def).unwrap();
    let k = 35.0;
    let field: Vec<f64> = (0..4 * 18).map(|j| [k, 80.0, 0.0, 0.0][j / 18]).collect();
    let solution = scene.solve(&field).unwrap();
    assert!(solution.outcome().settled);
    let weight = 9.81 * 0.2 * 0.3 * 1.2 / 18.0;
    let mut y = 0.0;
    for row in 1..9 {
        y -= 0.15 + weight * (9 - row) as f64 / k;
        for column in 0..2 {
            let x = solution.positions()[2 * row + column];
            let expected = [0.3 * column as f64, y, 0.0];
            assert!(x.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-6), "{x:?} {expected:?}");
        }
    }
    // d y_bottom / d k of the same form.
    let mut by_position = vec![[0.0; 3]; 18];
    by_position[16][1] = 1.0;
    let gradient = solution.gradient(&by_position).unwrap();
    let total: f64 = gradient[..18].iter().sum();
    let expected = weight * (1..9).sum::<i32>() as f64 / (k * k);
    assert!((total / expected - 1.0).abs() < 1e-6, "{total} {expected}");
}

#[test]
fn settles_in_every_scene() {
    let springs = Arc::new(Springs::new(12, 12, 1.0, 1.0).unwrap());
    let edge: Vec<usize> = (0..12).collect();
    for pins in [&[0][..], &[0, 11], &edge] {
        for (k, density_kg_m2) in
            [([3900.0, 3900.0, 60.0, 1.0], 0.2), ([460.0, 110.0, 50.0, 1.0], 0.187), ([20.0, 15.0, 5.0, 0.1], 0.1)]
        {
            for dt_s in [1.0 / 240.0, 1.0 / 960.0, 1e-5] {
                let mut scene =
                    Scene::new(&springs, SceneDef { density_kg_m2, dt_s, ..SceneDef::hung(&springs, pins) }).unwrap();
                let solution = scene.solve(&field(&springs, k, 5)).unwrap();
                let outcome = solution.outcome();
                let weight = 9.81 * density_kg_m2 / 144.0;
                assert!(
                    outcome.settled && outcome.residual_n <= 1e-6 * weight,
                    "{} pins, {k:?}: {outcome:?}",
                    pins.len()
                );
                let gradient = solution.gradient(&vec![[0.3, 1.0, -0.2]; 144]).unwrap();
                assert!(gradient.iter().all(|g| g.is_finite()) && gradient.iter().any(|g| *g != 0.0));
            }
        }
    }
}

#[test]
fn a_warm_start_saves_iterations_and_two_runs_agree() {
    let springs = Arc::new(Springs::new(10, 10, 1.0, 1.0).unwrap());
    let run = || {
        let mut scene = Scene::new(&springs, SceneDef::hung(&springs, &corners(&springs))).unwrap();
        let first = scene.solve(&field(&springs, [460.0, 110.0, 50.0, 1.0], 1)).unwrap();
        let again = scene.solve(&field(&springs, [460.0, 110.0, 50.0, 1.0], 1)).unwrap();
        let other = scene.solve(&field(&springs, [460.0, 110.0, 50.0, 1.0], 2)).unwrap();
        assert_eq!(again.outcome().iterations, 1);
        assert!(other.outcome().settled && scene.start() == Some(other.positions()));
        (first.positions().to_vec(), other.gradient(&[[1.0, 2.0, 3.0]; 100]).unwrap())
    };
    assert!(run() == run());
}

#[test]
fn a_pin_may_stand_elsewhere() {
    let springs = Arc::new(Springs::new(8, 8, 1.0, 1.0).unwrap());
    let mut def = SceneDef::hung(&springs, &[0, 7]);
    def.pins[1].position_m = [0.7, 0.1, 0.2];
    let mut scene = Scene::new(&springs, def).unwrap();
    let solution = scene.solve(&field(&springs, [900.0, 900.0, 200.0, 4.0], 8)).unwrap();
    assert!(solution.outcome().settled);
    assert_eq!([solution.positions()[0], solution.positions()[7]], [[0.0; 3], [0.7, 0.1, 0.2]]);
}

#[test]
fn bad_scenes_are_named() {
    let springs = Arc::new(Springs::new(4, 4, 1.0, 1.0).unwrap());
    let def = SceneDef::hung(&springs, &[0, 3]);
    let error = |def: SceneDef| Scene::new(&springs, def).unwrap_err();
    assert_eq!(error(SceneDef { pins: Vec::new(), ..def.clone() }), ClothError::Pins);
    assert_eq!(error(SceneDef::hung(&springs, &[0, 0])), ClothError::Pin { particle: 0 });
    assert_eq!(error(SceneDef::hung(&springs, &[16])), ClothError::Pin { particle: 16 });
    assert!(error(SceneDef { dt_s: 0.0, ..def.clone() }).to_string().contains("time step"));
    assert!(error(SceneDef { density_kg_m2: f64::NAN, ..def.clone() }).to_string().contains("density"));
    assert!(error(SceneDef { damping_per_s: 1e4, ..def.clone() }).to_string().contains("damping"));
    let mut scene = Scene::new(&springs, def).unwrap();
    assert!(matches!(scene.solve(&[1.0; 63]), Err(ClothError::Shape { .. })));
    assert!(matches!(scene.solve(&[-1.0; 64]), Err(ClothError::Stiffness { item: 0, channel: 0, row: 0, column: 0 })));
    assert!(matches!(scene.set_start(Some(vec![[0.0; 3]; 3])), Err(ClothError::Shape { .. })));
    assert!(matches!(scene.set_start(Some(vec![[f64::NAN; 3]; 16])), Err(ClothError::OutOfRange { .. })));
}

/// The cloth of core with the same definition and field, pinned at the two upper corners.
fn in_core(springs: &Springs, def: &SceneDef, field: &[f64], visit: impl FnOnce(&mut taut::Cloth<'_>)) {
    let side = |n: usize| u32::try_from(n).unwrap();
    let grid = taut::Grid::new(&taut::GridDef {
        rows: side(springs.rows()),
        columns: side(springs.columns()),
        width_m: springs.width_m() as f32,
        height_m: springs.height_m() as f32,
        families: taut::Families::ALL,
    })
    .unwrap();
    let definition = taut::ClothDef {
        rate_hz: 60.0,
        substeps: (1.0 / (60.0 * def.dt_s)).round() as u32,
        density_kg_m2: def.density_kg_m2 as f32,
        damping_per_s: def.damping_per_s as f32,
        inertia_radius_m: def.inertia_radius_m as f32,
        inertia_max: def.inertia_max as f32,
        max_pins: side(def.pins.len()),
        ..taut::ClothDef::default()
    };
    let mut block = vec![0.0; taut::Cloth::memory(&grid, &definition).unwrap()];
    let mut cloth = taut::Cloth::create(&grid, &definition, &mut block).unwrap();
    let numbers: Vec<f32> = field.iter().map(|&k| k as f32).collect();
    let view = taut::field::FieldView::new(4, springs.rows(), springs.columns(), &numbers).unwrap();
    cloth.set_stiffness_field(&view);
    for pin in &def.pins {
        cloth.pin(pin.particle).unwrap();
    }
    visit(&mut cloth);
}

#[test]
fn the_budget_is_that_of_core() {
    let springs = Arc::new(Springs::new(9, 12, 1.1, 0.7).unwrap());
    for substeps in [4.0, 16.0, 64.0] {
        let def = SceneDef { dt_s: 1.0 / (60.0 * substeps), ..SceneDef::hung(&springs, &corners(&springs)) };
        let field = field(&springs, [3900.0, 2100.0, 300.0, 60.0], 4);
        let scene = Scene::new(&springs, def.clone()).unwrap();
        let ours = Projection::new(&springs, scene.budget(), &field).cut_fraction();
        in_core(&springs, &def, &field, |cloth| {
            let theirs = f64::from(cloth.budget().unwrap().cut_fraction);
            assert!((ours - theirs).abs() < 1e-5, "{substeps}: {ours} {theirs}");
        });
    }
}

#[test]
fn the_shape_at_rest_is_at_rest_in_core() {
    let springs = Arc::new(Springs::new(12, 12, 1.0, 1.0).unwrap());
    let def = SceneDef::hung(&springs, &corners(&springs));
    let field = field(&springs, [3900.0, 2100.0, 300.0, 60.0], 4);
    let mut scene = Scene::new(&springs, def.clone()).unwrap();
    let solution = scene.solve(&field).unwrap();
    assert!(solution.outcome().settled && solution.outcome().cut_fraction > 0.3);
    in_core(&springs, &def, &field, |cloth| {
        for (i, x) in solution.positions().iter().enumerate() {
            cloth.set_position(i, x.map(|x| x as f32).into()).unwrap();
        }
        for _ in 0..120 {
            cloth.step().unwrap();
        }
        for (i, x) in solution.positions().iter().enumerate() {
            let y = cloth.position(i).unwrap();
            let moved = (0..3).map(|c| (f64::from(y[c]) - x[c]).abs()).fold(0.0, f64::max);
            assert!(moved < 1e-4, "particle {i} moved by {moved} m");
        }
        let ours = largest_structural(&springs, &solution);
        assert!((f64::from(cloth.strain().largest) - ours).abs() < 1e-4);
    });
}

#[test]
fn stretch_is_that_of_the_measured_fabrics() {
    // 32 x 32, 1 m, two corners, physical stiffness, an independent implementation: 8.8 % for the knit, 0.69 % for the
    // stiff woven.
    let springs = Arc::new(Springs::new(32, 32, 1.0, 1.0).unwrap());
    for (k, density_kg_m2, percent) in
        [([460.0, 110.0, 50.0, 1.0], 0.187, 8.8), ([3900.0, 3900.0, 60.0, 1.0], 0.2, 0.69)]
    {
        let def = SceneDef { density_kg_m2, dt_s: 1e-5, ..SceneDef::hung(&springs, &corners(&springs)) };
        let mut scene = Scene::new(&springs, def).unwrap();
        let field: Vec<f64> = (0..4 * 1024).map(|j| k[j / 1024]).collect();
        let solution = scene.solve(&field).unwrap();
        assert!(solution.outcome().settled);
        let found = 100.0 * largest_structural(&springs, &solution);
        assert!((found / percent - 1.0).abs() < 0.03, "{found} %, expected {percent} %");
    }
}
