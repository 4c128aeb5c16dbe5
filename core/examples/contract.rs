use taut::*;
fn cpu() -> f64 {
    std::fs::read_to_string("/proc/thread-self/schedstat").unwrap().split(' ').next().unwrap().parse::<f64>().unwrap()
        * 1e-9
}
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let n: u32 = a[1].parse().unwrap();
    let sub: u32 = a[2].parse().unwrap();
    let feats = Features(a[3].parse().unwrap());
    let limit: f32 = a[4].parse().unwrap();
    let passes: u32 = a[5].parse().unwrap();
    let inertia: f32 = a[6].parse().unwrap();
    let cert = a[7] == "c";
    let speed: f32 = a[8].parse().unwrap();
    let kind = a.get(9).map(|s| s.as_str()).unwrap_or("uni");
    let only = std::env::var("S").unwrap_or_default();
    for scene in ["hang2", "edge", "swing", "curtain", "shake", "teleport", "hang1"] {
        if !only.is_empty() && only != scene {
            continue;
        }
        let grid = Grid::new(&GridDef { rows: n, columns: n, ..GridDef::default() }).unwrap();
        let flat = matches!(scene, "hang2" | "swing");
        let def = ClothDef {
            substeps: sub,
            features: feats,
            tether_slack: [std::env::var("SLACK").map(|s| s.parse().unwrap()).unwrap_or(0.0); 3],
            strain_limit: [limit; 3],
            strain_passes: passes,
            inertia_radius_m: inertia,
            budget: if cert { Budget::Certified } else { Budget::Tuned },
            speed_limit: speed,
            damping_per_s: if scene == "swing" { 0.0 } else { 2.0 },
            v_axis: if flat { [0.0, 0.0, 1.0] } else { [0.0, -1.0, 0.0] },
            ..ClothDef::default()
        };
        let mut block = vec![0.0; Cloth::memory(&grid, &def).unwrap()];
        let mut c = Cloth::create(&grid, &def, &mut block).unwrap();
        let k = match kind {
            "denim" => [1975., 356., 54., 1.],
            "woven" => [4052., 3996., 19.5, 1.],
            "knit" => [573., 59., 17., 1.],
            _ => [1e8; 4],
        };
        c.set_stiffness_uniform(k).unwrap();
        let nn = n as usize;
        // a small bump
        if !flat {
            for r in 0..nn {
                for q in 0..nn {
                    let i = r * nn + q;
                    let p = c.position(i).unwrap();
                    let (u, v) = (q as f32 / (nn - 1) as f32, r as f32 / (nn - 1) as f32);
                    let p = if scene == "hang1" {
                        let h = 0.70710678;
                        Vector3::new((u - v) * h, -(u + v) * h, 0.0)
                    } else {
                        p
                    };
                    c.set_position(
                        i,
                        Vector3::new(
                            p.x,
                            p.y,
                            0.004
                                * v
                                * ((9.4 * u).sin()
                                    + 0.6 * (15.7 * u + 1.0).cos()
                                    + 0.4 * (6.28 * u + 3.0 * v).sin()
                                    + (3.14 * u).sin() * (0.3 + v)),
                        ),
                    )
                    .unwrap();
                }
            }
        }
        let pins: Vec<usize> = match scene {
            "edge" | "swing" => (0..nn).collect(),
            "curtain" => (0..nn).step_by(4).chain([nn - 1]).collect(),
            "hang1" => vec![0],
            _ => vec![0, nn - 1],
        };
        for p in &pins {
            let _ = c.pin(*p);
        }
        let start: Vec<_> = pins.iter().map(|p| c.world_position(*p).unwrap()).collect();
        let (mut peak, mut peakm, mut t) = (0.0f32, 0.0f32, 0.0f64);
        let frames = 480;
        let mut jit = 0.0f32;
        let mut finite = true;
        let mut ke3 = 0.0;
        for f in 0..frames {
            let time = (f + 1) as f64 / 60.0;
            for (p, s) in pins.iter().zip(&start) {
                let d = match scene {
                    "curtain" => Vector3::new(0.2 * (std::f64::consts::TAU * time).sin(), 0.0, 0.0),
                    "shake" => Vector3::new(
                        0.1 * (std::f64::consts::TAU * time).sin(),
                        0.1 * (std::f64::consts::TAU * time * 1.0).cos() - 0.1,
                        0.0,
                    ),
                    "teleport" if f >= 240 => Vector3::new(3.0, 1.0, -2.0),
                    _ => continue,
                };
                c.move_pin(*p, s + d).unwrap();
            }
            let before: Vec<_> = (0..nn * nn).map(|i| c.position(i).unwrap()).collect();
            let t0 = cpu();
            finite &= c.step().unwrap() == StepFlags(0);
            t += cpu() - t0;
            if f >= frames - 60 {
                let m: f32 = (0..nn * nn).map(|i| (c.position(i).unwrap() - before[i]).norm()).sum::<f32>()
                    / (nn * nn) as f32
                    * 60.0;
                jit = jit.max(m);
            }
            let s = c.strain();
            if s.largest > peak {
                peak = s.largest;
            }
            peakm = peakm.max(s.mean);
            if f == 179 {
                ke3 = c.kinetic_energy_j();
            }
        }
        let mut all = vec![];
        c.each_structural_strain(|_, _, s| all.push(s));
        all.sort_by(f32::total_cmp);
        let rms = (2.0 * c.kinetic_energy_j() / 0.2).sqrt();
        println!(
            "{scene:9} peak {:8.2} rest max {:7.2} p99 {:6.2} mean {:6.2} rms {:.1e} jit {:.1e} ke3 {:.4} {} ns {:.1}",
            100. * peak,
            100. * all[all.len() - 1],
            100. * all[all.len() * 99 / 100],
            100. * c.strain().mean,
            rms,
            jit,
            ke3 / 0.2,
            if finite { "" } else { "NONFINITE" },
            t * 1e9 / (frames as f64 * sub as f64 * (n * n) as f64)
        );
    }
}
