//! Core allocates nothing: creating, stepping, snapshots and the budget, counted by an allocator around the system's.
#![allow(unsafe_code)] // GlobalAlloc is an unsafe trait

mod common;

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

use taut::field::FieldView;
use taut::{
    Cloth, ClothDef, ColliderDef, Families, Features, Pose, Shape, Solver, Target, TargetLimit, Vector3, baked,
};

struct Counting;

thread_local! {
    // const and without a destructor, so that touching it allocates nothing
    static COUNT: Cell<u64> = const { Cell::new(0) };
}

fn count() {
    COUNT.with(|c| c.set(c.get() + 1));
}

// SAFETY: every call is handed on to the system's allocator as it came.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count();
        // SAFETY: the caller's promise.
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        count();
        // SAFETY: the caller's promise.
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn dealloc(&self, place: *mut u8, layout: Layout) {
        count();
        // SAFETY: the caller's promise.
        unsafe { System.dealloc(place, layout) }
    }

    unsafe fn realloc(&self, place: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count();
        // SAFETY: the caller's promise.
        unsafe { System.realloc(place, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Calls of the allocator by this thread during `work`.
fn calls<T>(work: impl FnOnce() -> T) -> (T, u64) {
    let before = COUNT.with(Cell::get);
    let result = work();
    (result, COUNT.with(Cell::get) - before)
}

#[test]
fn the_counter_counts() {
    let (v, n) = calls(|| vec![1u8; 100]);
    assert_eq!(n, 1);
    let ((), n) = calls(move || drop(v));
    assert_eq!(n, 1);
}

#[test]
fn nothing_is_allocated() {
    let def = ClothDef { features: Features::ALL, inertia_radius_m: 0.3, sleep_speed_m_s: 1e-3, ..ClothDef::default() };
    allocates_nothing(&def);
    for solver in [Solver::ImplicitEuler, Solver::Bdf2] {
        allocates_nothing(&ClothDef { solver, ..def });
    }
}

fn allocates_nothing(def: &ClothDef) {
    let grid = common::squares(20, 33, 0.05, Families::ALL);
    let mut block = vec![0.0; Cloth::memory(&grid, def).unwrap()];
    let mut bytes = vec![0; 800_000];
    let field = [500.0; 4 * 7 * 5];
    let mut file = vec![0; baked::size(7, 5).unwrap()];
    let ((), n) = calls(|| {
        let mut c = Cloth::create(&grid, def, &mut block).unwrap();
        let written = baked::write(7, 5, &field, &baked::Fabric::default(), 3, "heavy blue denim", &mut file);
        c.load_stiffness(&file[..written.unwrap()]).unwrap();
        c.set_stiffness_field(&FieldView::new(4, 7, 5, &field).unwrap());
        c.set_stiffness_uniform([800.0, 700.0, 200.0, 10.0]).unwrap();
        c.pin(0).unwrap();
        c.pin(32).unwrap();
        c.budget().unwrap();
        let (m, mut mask) = (c.particle_mass_kg(), [1; 660]);
        mask[350] = 0;
        c.set_mask(&mask).unwrap();
        c.set_masses(&[2.0 * m; 660]).unwrap();
        c.set_gravity([0.0, -5.0, 1.0]).unwrap();
        c.set_damping(3.0).unwrap();
        c.set_rest_scale([0.9, 1.0, 1.0]).unwrap();
        for frame in 0..20 {
            c.move_pin(0, Vector3::new(0.01 * f64::from(frame), 0.0, 0.0)).unwrap();
            c.add_force(300, Vector3::new(0.0, 0.0, 0.1)).unwrap();
            let moved = Pose { position_m: [0.1 * f64::from(frame), 0.0, 0.0].into(), rotation: [0.0, 0.1, 0.0, 1.0] };
            c.set_frame(&moved, 0.5, 0.5).unwrap();
            c.pin_force(0).unwrap();
            assert_eq!(c.pin_forces().count(), c.pin_count());
            let pose = Pose::at(Vector3::new(0.5, -0.5, 0.01 * f64::from(frame)));
            let ball = c.add_collider(&ColliderDef::new(Shape::Sphere { radius_m: 0.2 }, pose)).unwrap();
            c.move_collider(ball, &pose).unwrap();
            let skin = Target { position_m: Vector3::zeros(), normal: Vector3::new(0.0, 0.0, 1.0) };
            c.move_targets(Vector3::zeros(), |_| skin).unwrap();
            c.set_target_limits(|_| TargetLimit { max_distance_m: 2.0, ..TargetLimit::default() }).unwrap();
            c.step().unwrap();
            c.remove_collider(ball).unwrap();
            if frame % 5 == 0 {
                c.pin(40 + frame as usize).unwrap();
            }
            let size = c.snapshot(&mut bytes).unwrap();
            c.step().unwrap();
            c.restore(&bytes[..size]).unwrap();
            c.restore(&bytes[..size - 1]).unwrap_err();
            c.state_hash();
            c.strain();
            c.kinetic_energy_j();
            assert_eq!(c.pinned().count(), c.pin_count());
            c.each_structural_strain(|_, _, strain| assert!(strain.is_finite()));
            assert!(c.positions().xyz[0].len() > 20);
        }
        c.teleport(&Pose { position_m: [1e9, 0.0, 0.0].into(), rotation: [0.0, 0.0, 0.0, 1.0] }).unwrap();
        c.set_origin(Vector3::zeros()).unwrap();
        c.wake();
        c.pin(usize::MAX).unwrap_err();
        c.reset();
    });
    assert_eq!(n, 0, "calls of the allocator");
}
