//! The same bits everywhere: the scenes of `tests/bare`, which run there without std on other targets, give the same
//! hashes here, whatever floating-point modes the caller has set.

/// The scenes, from the same file.
#[path = "../../tests/bare/src/scene.rs"]
mod scene;

use scene::{NUMBERS, SCENES};

/// Runs every scene to the end, each step in the environment of the caller.
fn compare() {
    let mut block = vec![f32::NAN; NUMBERS];
    let mut wrong = Vec::new();
    for scene in &SCENES {
        let mut hashes = [0; 2];
        scene.run(&mut block, true, |i, hash| hashes[i] = hash).expect("the scene steps");
        if hashes != scene.golden {
            wrong.push(format!("{}: [{:#018x}, {:#018x}]", scene.name, hashes[0], hashes[1]));
        }
    }
    assert!(wrong.is_empty(), "now\n{}", wrong.join("\n"));
}

#[test]
fn ten_thousand_steps_give_the_golden_hashes() {
    compare();
}

/// Whether a denormal halved is 0 and 1 + tiny is above 1. Apart, so that it is not computed before the switch.
#[cfg(target_arch = "x86_64")]
#[inline(never)]
fn modes_are_on(denormal: f32, tiny: f32) -> bool {
    use std::hint::black_box;
    black_box(denormal) * 0.5 == 0.0 && 1.0 + black_box(tiny) > 1.0
}

/// Flush-to-zero, denormals-are-zero and rounding upwards, as engines and careless libraries leave them.
#[test]
#[cfg(target_arch = "x86_64")]
fn the_modes_of_the_caller_do_not_reach_the_bits() {
    use std::arch::asm;
    let (mut before, modes, mut after) = (0u32, 0x1f80u32 | 0x8040 | 0x4000, 0u32);
    // SAFETY: stores MXCSR in a local variable, then sets modes that are allowed. Between here and where it is set back
    // nothing of the test depends on them.
    unsafe {
        asm!("stmxcsr [{}]", in(reg) &raw mut before);
        asm!("ldmxcsr [{}]", in(reg) &raw const modes);
    }
    let on = modes_are_on(1e-39, 1e-20);
    let result = std::panic::catch_unwind(compare);
    // SAFETY: as above; `before` was read from MXCSR.
    unsafe {
        asm!("stmxcsr [{}]", in(reg) &raw mut after);
        asm!("ldmxcsr [{}]", in(reg) &raw const before);
    }
    assert!(on, "the modes were not on");
    assert_eq!(after & 0xffc0, modes, "the caller's modes were given back");
    if let Err(panic) = result {
        std::panic::resume_unwind(panic);
    }
}
