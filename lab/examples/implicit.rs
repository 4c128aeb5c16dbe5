//! experiment
use cpu_time::ThreadTime;
use taut::{Cloth, ClothDef, Features, Grid, GridDef, Solver, Vector3};

struct Out { rest: f32, peak: f32, ke: f64, ke1: f64, com: f64, us: f64 }

fn run(def: &ClothDef, n: u32, k: [f32; 4], edge: bool, reference: Option<&Vec<f64>>, trace: &mut Vec<f64>) -> Out {
    let grid = Grid::new(&GridDef { rows: n, columns: n, ..GridDef::default() }).unwrap();
    let fall = ClothDef { damping_per_s: 0.0, u_axis: [1.0, 0.0, 0.0], v_axis: [0.0, 0.0, 1.0], ..*def };
    let setup = |c: &mut Cloth<'_>| {
        c.set_stiffness_uniform(k).unwrap();
        let n = n as usize;
        if edge { for i in 0..n { c.pin(i).unwrap(); } } else { c.pin(0).unwrap(); c.pin(n - 1).unwrap(); }
    };
    let mut block = vec![0.0; Cloth::memory(&grid, &fall).unwrap()];
    let mut c = Cloth::create(&grid, &fall, &mut block).unwrap();
    setup(&mut c);
    let (mut peak, mut ke, mut ke1, mut com) = (0.0f32, 0.0, 0.0, 0.0);
    let start = ThreadTime::now();
    let mut cpu = std::time::Duration::ZERO;
    for f in 0..210 {
        let t = ThreadTime::now();
        let flags = c.step().unwrap();
        cpu += t.elapsed();
        if flags.0 != 0 { peak = f32::NAN; break; }
        peak = peak.max(c.strain().largest);
        let y: f64 = (0..(n * n) as usize).map(|i| f64::from(c.position(i).unwrap().y)).sum::<f64>() / f64::from(n * n);
        trace.push(y);
        let e = c.kinetic_energy_j() / f64::from(def.density_kg_m2);
        if (45..75).contains(&f) { ke1 += e / 30.0; }
        if f >= 150 { ke += e / 60.0; }
        if let Some(r) = reference { com += (y - r[f]).powi(2) / 210.0; }
    }
    let _ = start;
    let us = cpu.as_secs_f64() * 1e6 / 210.0;
    // rest
    let hang = ClothDef { damping_per_s: 2.0, ..*def };
    let mut block = vec![0.0; Cloth::memory(&grid, &hang).unwrap()];
    let mut c = Cloth::create(&grid, &hang, &mut block).unwrap();
    setup(&mut c);
    for i in 0..(n * n) as usize {
        let p = c.position(i).unwrap();
        if c.pinned().all(|q| q != i) {
            c.set_position(i, p + Vector3::new(0.0, 0.0, 0.004 * (9.0 * p.x).sin() * (1.0 + p.y))).unwrap();
        }
    }
    let mut rest = f32::NAN;
    if peak.is_finite() {
        for _ in 0..60 * 8 { c.step().unwrap(); }
        rest = c.strain().largest;
    }
    Out { rest, peak, ke, ke1, com: com.sqrt(), us }
}

fn main() {
    let n: u32 = std::env::args().nth(1).map_or(32, |s| s.parse().unwrap());
    let edge = std::env::args().nth(2).is_some_and(|s| s == "edge");
    let thetas: Vec<f32> = std::env::args().nth(3).map_or(vec![0.0], |s| s.split(',').map(|x| x.parse().unwrap()).collect());
    let lv: u32 = std::env::args().nth(6).map_or(1, |s| s.parse().unwrap());
    taut::implicit::gradients::LEVELS.store(lv, std::sync::atomic::Ordering::Relaxed);
    for (name, k, density, sub) in [("woven", [3900.0, 3900.0, 60.0, 1.0], 0.2, 160)] {
        let base = ClothDef { density_kg_m2: density, speed_limit: 0.0, features: Features::IMPLICIT, ..ClothDef::default() };
        let mut reference = Vec::new();
        let def = ClothDef { substeps: sub, features: Features::NONE, ..base };
        let o = run(&def, n, k, edge, None, &mut reference);
        println!("{name} explicit {sub}: rest {:.2} peak {:.2} ke1 {:.3} ke {:.3} us {:.0}", 100.0 * o.rest, 100.0 * o.peak, o.ke1, o.ke, o.us);
        let r = o;
        let passes: Vec<u32> = std::env::args().nth(4).map_or(vec![1], |s| s.split(',').map(|x| x.parse().unwrap()).collect());
        let its: Vec<u32> = std::env::args().nth(5).map_or(vec![20, 80, 300], |s| s.split(',').map(|x| x.parse().unwrap()).collect());
        for (theta, p) in thetas.iter().flat_map(|t| passes.iter().map(move |p| (t, *p))) {
            taut::implicit::integrate::PASSES.store(p, std::sync::atomic::Ordering::Relaxed);
            taut::implicit::integrate::THETA.store(theta.to_bits(), std::sync::atomic::Ordering::Relaxed);
            for solver in [Solver::ImplicitEuler, Solver::Bdf2] {
                for substeps in [1, 2] {
                    for it in its.clone() {
                        let def = ClothDef { solver, substeps, cg_iterations: it, ..base };
                        let o = run(&def, n, k, edge, Some(&reference), &mut Vec::new());
                        println!("{theta} {p} {solver:?} {substeps} x {it}: rest {:.2} peak {:.2} ke1 {:.3} ({:.2}) ke {:.3} ({:.2}) com {:.1} mm us {:.0}", 100.0 * o.rest, 100.0 * o.peak, o.ke1, o.ke1 / r.ke1, o.ke, o.ke / r.ke, 1e3 * o.com, o.us);
                    }
                }
            }
        }
    }
}
