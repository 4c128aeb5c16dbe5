//! Time of one frame of 16 substeps and of what a change of pins costs, for N x N particles on a sheet pinned at two
//! corners, stiff enough to be cut by the budget. Throughput is in particle-steps (one particle, one substep).

use std::hint::black_box;
use std::time::Duration;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use taut::{Cloth, ClothDef, Families, Features, Grid, GridDef, Width};
use taut_lab::block::Block;

const SIDES: [u32; 3] = [32, 64, 128];
const NO_BEND: Families = Families(3);

/// Hands a swinging cloth to `work`.
fn with_cloth(side: u32, families: Families, def: &ClothDef, work: impl FnOnce(&mut Cloth<'_>)) {
    let grid = Grid::new(&GridDef { rows: side, columns: side, families, ..GridDef::default() }).expect("a valid grid");
    let mut block = Block::new(Cloth::memory(&grid, def).expect("a valid definition"));
    let mut cloth = Cloth::create(&grid, def, block.numbers_mut()).expect("the block is large enough");
    cloth.set_stiffness_uniform([5000.0, 5000.0, 1500.0, 100.0]).expect("a stiffness");
    cloth.pin(0).expect("a pin");
    cloth.pin(side as usize - 1).expect("a pin");
    for _ in 0..10 {
        cloth.step().expect("a stiffness was set");
    }
    work(&mut cloth);
}

fn frames(c: &mut Criterion) {
    let plain = ClothDef::default();
    let inertia = ClothDef { inertia_radius_m: 0.3, ..plain };
    let unlimited = ClothDef { speed_limit: 0.0, ..plain };
    let air = ClothDef { features: Features::AIR, ..plain };
    let hinge = ClothDef { features: Features::HINGE, ..plain };
    let settings = [
        ("uniform", Families::ALL, plain),
        ("inertia", Families::ALL, inertia),
        ("no_speed_limit", Families::ALL, unlimited),
        ("structural_only", Families::STRUCTURAL, plain),
        ("air", Families::ALL, air),
        ("hinge", Families::ALL, hinge),
        // hinges instead of the bend springs of Provot
        ("no_bend", NO_BEND, plain),
        ("hinge_no_bend", NO_BEND, hinge),
    ];
    let mut group = c.benchmark_group("frame");
    for (name, families, def) in settings {
        for side in SIDES {
            let particle_steps = u64::from(side * side * def.substeps);
            group.throughput(Throughput::Elements(particle_steps));
            group.bench_function(BenchmarkId::new(name, side), |b| {
                with_cloth(side, families, &def, |cloth| {
                    b.iter(|| black_box(cloth.step()));
                });
            });
        }
    }
    group.finish();
}

/// A frame with all families in every vector width that the machine has.
fn widths(c: &mut Criterion) {
    let def = ClothDef::default();
    let mut group = c.benchmark_group("width");
    for width in Width::ALL.into_iter().filter(|w| w.is_supported()) {
        for side in [32, 64, 128, 256] {
            group.throughput(Throughput::Elements(u64::from(side * side * def.substeps)));
            group.bench_function(BenchmarkId::new(width.name(), side), |b| {
                with_cloth(side, Families::ALL, &def, |cloth| {
                    cloth.set_width(width).expect("it is supported");
                    b.iter(|| black_box(cloth.step()));
                });
            });
        }
    }
    group.finish();
}

/// What a frame pays on top when a pin came or went: the inertia field and the projection anew.
fn pins(c: &mut Criterion) {
    let mut group = c.benchmark_group("change_of_pins");
    for (name, radius) in [("uniform", 0.0), ("inertia", 0.3)] {
        let def = ClothDef { inertia_radius_m: radius, ..ClothDef::default() };
        for side in SIDES {
            group.throughput(Throughput::Elements(u64::from(side * side)));
            group.bench_function(BenchmarkId::new(name, side), |b| {
                with_cloth(side, Families::ALL, &def, |cloth| {
                    let middle = (side * side / 2 + side / 2) as usize;
                    b.iter(|| {
                        let change = if cloth.pin_count() == 2 { cloth.pin(middle) } else { cloth.unpin(middle) };
                        black_box((change, cloth.budget()))
                    });
                });
            });
        }
    }
    group.finish();
}

fn rollback(c: &mut Criterion) {
    let mut group = c.benchmark_group("rollback");
    for side in SIDES {
        with_cloth(side, Families::ALL, &ClothDef::default(), |cloth| {
            let mut bytes = vec![0; cloth.snapshot_size_max()];
            // a filter may leave out the first of the two
            cloth.snapshot(&mut bytes).unwrap();
            group.throughput(Throughput::Bytes(cloth.snapshot_size() as u64));
            group.bench_function(BenchmarkId::new("snapshot", side), |b| {
                b.iter(|| black_box(cloth.snapshot(&mut bytes)));
            });
            group.bench_function(BenchmarkId::new("restore", side), |b| {
                b.iter(|| cloth.restore(black_box(&bytes)).unwrap());
            });
        });
    }
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default()
        .sample_size(20)
        .warm_up_time(Duration::from_millis(300))
        .measurement_time(Duration::from_secs(1));
    targets = frames, widths, pins, rollback
}
criterion_main!(benches);
