//! The examples in C do what they say. Each of them checks itself and tells by its exit code; here its output is looked at, and
//! the hash of the engine loop is that of core.

use taut::{Cloth, ClothDef, Grid, GridDef, Vector3};

use crate::library::{Language, root, run_all};

/// Runs an example and returns its lines.
fn lines(name: &str) -> Vec<String> {
    let printed = run_all(Language::C11, &[root().join("examples/c").join(name)], &[]);
    println!("{name}:\n{printed}");
    printed.lines().map(String::from).collect()
}

/// The ten seconds of the engine loop, stepped plainly.
fn ten_seconds_through_core() -> u64 {
    let grid = Grid::new(&GridDef { rows: 24, columns: 24, ..GridDef::default() }).unwrap();
    let def = ClothDef { inertia_radius_m: 0.3, max_pins: 2, ..ClothDef::default() };
    let mut block = vec![0.0; Cloth::memory(&grid, &def).unwrap()];
    let mut cloth = Cloth::create(&grid, &def, &mut block).unwrap();
    cloth.set_stiffness_uniform([1000.0, 600.0, 200.0, 8.0]).unwrap();
    cloth.pin(0).unwrap();
    cloth.pin(23).unwrap();
    for step in 0..600 {
        let phase = step % 120;
        let swing = f64::from(if phase < 60 { phase } else { 120 - phase }) / 60.0;
        cloth.move_pin(23, Vector3::new(1.0 - 0.2 * swing, 0.0, 0.0)).unwrap();
        cloth.step().unwrap();
    }
    cloth.state_hash()
}

#[test]
fn frame_times_do_not_reach_the_cloth() {
    let lines = lines("engine_loop.c");
    let end = format!(", 600 steps, state hash {:016x}", ten_seconds_through_core());
    assert_eq!(lines.len(), 4);
    assert!(lines.iter().all(|l| l.ends_with(&end)), "core has{end}");
    let frames: Vec<usize> = lines.iter().map(|l| l.trim().split(' ').next().unwrap().parse().unwrap()).collect();
    // 10 s at 144 Hz; frames of 50.5 ms on average, all less often than the steps
    assert!((1440..=1441).contains(&frames[0]), "{frames:?}");
    assert!(frames[1..].iter().all(|f| (150..250).contains(f)), "{frames:?}");
}

#[test]
fn sixty_frames_are_rolled_back() {
    let lines = lines("rollback.c");
    let hash = |name: &str| lines.iter().find_map(|l| l.strip_prefix(name)).unwrap().trim().to_string();
    assert_eq!(hash("replayed"), hash("believed"));
    assert_eq!(hash("corrected"), hash("the truth"));
    assert_ne!(hash("believed"), hash("the truth"));
}

#[test]
fn many_threads_give_the_bits_of_one() {
    let lines = lines("jobs.c");
    assert_eq!(lines.len(), 1);
    assert!(lines[0].starts_with("32 cloths, 4 threads, 3840 steps, 0 different from one thread, "), "{}", lines[0]);
}

#[test]
fn the_cape_stays_on_the_shoulders() {
    let lines = lines("cape.c");
    assert_eq!(lines[0], "690 triangles, 16 pins moved in each of 480 frames");
    let stretch: f64 = lines[1].strip_prefix("largest stretch ").unwrap().split(' ').next().unwrap().parse().unwrap();
    assert!(stretch > 0.5 && stretch < 10.0, "{stretch} %");
    let touches: u32 = lines[2].split(' ').next().unwrap().parse().unwrap();
    assert!(touches > 200, "{}", lines[2]);
}

#[test]
fn a_plan_keeps_what_it_tells() {
    let lines = lines("plan.c");
    assert_eq!(lines.len(), 3);
    // more than one way to step, and at this size one of them is a given number of cycles
    assert!(lines.iter().any(|l| l.contains("one cycle")), "{lines:?}");
}

#[test]
fn one_cloth_on_two_threads_has_the_bits_of_one() {
    let lines = lines("bands.c");
    assert_eq!(lines.len(), 1);
    assert!(lines[0].starts_with("128 x 128, 8 bands, 2 threads, the bits of one thread, "), "{}", lines[0]);
}
