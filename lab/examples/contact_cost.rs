//! What colliders and targets cost beside the plain step: thread CPU time per particle-step, settings taken in turn within
//! one run, the least of several rounds, as a ratio to the plain cloth.
//!
//! `cargo run --release -p taut-lab --example contact_cost` (pin it to a core, e.g. with taskset).

use std::time::Duration;

use cpu_time::ThreadTime;
use taut::{Cloth, ClothDef, ColliderDef, Features, Grid, GridDef, Pose, Shape, Target, TargetLimit, Vector3};
use taut_lab::block::Block;

const ROUNDS: usize = 9;
const FRAMES: u32 = 40;

/// A horizontal sheet of 1 m x 1 m with the features, prepared and settled.
fn made(side: u32, features: Features, prepare: impl Fn(&mut Cloth<'_>)) -> Cloth<'static> {
    let grid = Grid::new(&GridDef { rows: side, columns: side, ..GridDef::default() }).expect("a valid grid");
    let def = ClothDef { features, v_axis: [0.0, 0.0, 1.0], damping_per_s: 4.0, ..ClothDef::default() };
    let block = Block::leaked(Cloth::memory(&grid, &def).expect("a valid definition"));
    let mut cloth = Cloth::create(&grid, &def, block).expect("the block is large enough");
    cloth.set_stiffness_uniform([2000.0, 2000.0, 600.0, 20.0]).expect("a stiffness");
    prepare(&mut cloth);
    for _ in 0..60 {
        cloth.step().expect("a stiffness was set");
    }
    cloth
}

fn add(cloth: &mut Cloth<'_>, shape: Shape, x: f64, y: f64, z: f64) {
    let def = ColliderDef::new(shape, Pose::at(Vector3::new(x, y, z)));
    cloth.add_collider(&def).expect("a valid collider");
}

fn limits(cloth: &mut Cloth<'_>, limit: TargetLimit) {
    cloth.set_target_limits(|_| limit).expect("valid limits");
}

fn main() {
    let side = std::env::args().nth(1).and_then(|a| a.parse().ok()).unwrap_or(64);
    let corners = |c: &mut Cloth<'_>| {
        for p in [0, side as usize - 1] {
            c.pin(p).expect("a pin");
        }
    };
    let (colliders, targets) = (Features::COLLIDERS, Features::TARGETS);
    let floor = Shape::Plane { normal: [0.0, 1.0, 0.0] };
    let ball = |radius_m| Shape::Sphere { radius_m };
    let rod = Shape::Capsule { ends_m: [[-0.4, 0.0, 0.0], [0.4, 0.0, 0.0]], radii_m: [0.15, 0.1] };
    let table = Shape::Box { half_m: [0.3, 0.05, 0.3] };
    let wide = TargetLimit { max_distance_m: 100.0, ..TargetLimit::default() };
    let mut settings: Vec<(&str, Cloth<'static>)> = vec![
        ("plain, two corners pinned", made(side, Features::NONE, corners)),
        ("colliders on, none added", made(side, colliders, corners)),
        (
            "1 far sphere",
            made(side, colliders, |c| {
                corners(c);
                add(c, ball(0.2), 9.0, 0.0, 0.0);
            }),
        ),
        (
            "32 far spheres",
            made(side, colliders, |c| {
                corners(c);
                (0..32).for_each(|i| add(c, ball(0.2), 9.0 + f64::from(i), 0.0, 0.0));
            }),
        ),
        ("lying on a plane, all touch", made(side, colliders, |c| add(c, floor, 0.0, -0.1, 0.0))),
        ("draped over a sphere of 0.25 m", made(side, colliders, |c| add(c, ball(0.25), 0.5, -0.3, 0.5))),
        ("draped over a capsule", made(side, colliders, |c| add(c, rod, 0.5, -0.3, 0.5))),
        ("draped over a box", made(side, colliders, |c| add(c, table, 0.5, -0.3, 0.5))),
        (
            "a body: 12 capsules, 2 spheres",
            made(side, colliders, |c| {
                let bone = Shape::Capsule { ends_m: [[-0.1, 0.0, 0.0], [0.1, 0.0, 0.0]], radii_m: [0.06, 0.05] };
                for i in 0..12 {
                    let (x, z) = (0.2 + 0.2 * f64::from(i % 4), 0.3 + 0.2 * f64::from(i / 4));
                    add(c, bone, x, -0.2 - 0.02 * f64::from(i % 3), z);
                }
                add(c, ball(0.12), 0.3, -0.25, 0.4);
                add(c, ball(0.12), 0.7, -0.25, 0.6);
            }),
        ),
        ("targets on, all free", made(side, targets, corners)),
        (
            "targets, within a wide distance",
            made(side, targets, |c| {
                corners(c);
                limits(c, wide);
            }),
        ),
        (
            "targets and backstops, not reached",
            made(side, targets, |c| {
                corners(c);
                limits(c, TargetLimit { backstop_radius_m: 1.0, backstop_distance_m: 3.0, ..wide });
                let up = Target { position_m: Vector3::new(0.5, 0.0, 0.5), normal: Vector3::new(0.0, 1.0, 0.0) };
                c.set_targets(Vector3::zeros(), |_| up).expect("valid targets");
            }),
        ),
        (
            "targets, all held at 5 cm",
            made(side, targets, |c| limits(c, TargetLimit { max_distance_m: 0.05, ..TargetLimit::default() })),
        ),
    ];
    let mut least = vec![Duration::MAX; settings.len()];
    for _ in 0..ROUNDS {
        for ((_, cloth), least) in settings.iter_mut().zip(&mut least) {
            let start = ThreadTime::now();
            for _ in 0..FRAMES {
                cloth.step().expect("a stiffness was set");
            }
            *least = start.elapsed().min(*least);
        }
    }
    let steps = f64::from(side * side * 16 * FRAMES);
    let plain = least.first().map_or(1.0, |t| t.as_secs_f64() / steps);
    println!("{side} x {side}, ns per particle-step; what it adds to the plain step; ratio");
    for ((name, _), time) in settings.iter().zip(&least) {
        let ns = time.as_secs_f64() / steps;
        println!("{name:36} {:6.2}  +{:5.2}  {:5.2}", ns * 1e9, (ns - plain) * 1e9, ns / plain);
    }
}
