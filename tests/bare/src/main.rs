//! taut on a bare machine: no std, no alloc crate, no libc, no loader. Steps the scenes in a static block, prints the name
//! of each and the hash of its state as 16 hexadecimal digits, then two of them once more with the floating-point modes that
//! an engine may have set. Exits with 0; 1 when a scene fails or has another hash than its golden one; 101 when something panics.
#![no_std]
#![no_main]

#[cfg_attr(all(target_arch = "x86_64", target_os = "linux"), path = "linux_x86_64.rs")]
#[cfg_attr(all(target_arch = "x86", target_os = "linux"), path = "linux_x86.rs")]
#[cfg_attr(target_arch = "aarch64", path = "linux_aarch64.rs")]
#[cfg_attr(target_arch = "arm", path = "cortex_m.rs")]
#[cfg_attr(target_arch = "wasm32", path = "wasm.rs")]
mod machine;
mod scene;

use core::cell::UnsafeCell;
use core::panic::PanicInfo;

use scene::{NUMBERS, SCENES, Scene};

/// The memory of the cloth.
struct Block(UnsafeCell<[f32; NUMBERS]>);

// SAFETY: the program has one thread.
unsafe impl Sync for Block {}

static BLOCK: Block = Block(UnsafeCell::new([0.0; NUMBERS]));

/// What the entry point of the machine calls, once.
fn main() -> ! {
    // SAFETY: one thread, and this function, which runs once, holds the only reference.
    let block = unsafe { &mut *BLOCK.0.get() };
    let mut good = run(&SCENES, block);
    if machine::set_modes_of_an_engine() {
        machine::write(b"with other floating-point modes\n\0");
        good &= run(&SCENES[..2], block);
    }
    machine::exit(if good { 0 } else { 1 })
}

/// Runs scenes; whether all gave their golden hashes.
fn run(scenes: &[Scene], block: &mut [f32]) -> bool {
    let mut good = true;
    for scene in scenes {
        let stepped = scene.run(block, machine::FAST, |i, hash| {
            machine::write(&line(scene.name, i, hash));
            good &= scene.golden.get(i) == Some(&hash);
        });
        good &= stepped.is_ok();
    }
    good
}

/// Name, which of the hashes, 16 hexadecimal digits, a line feed, and a zero byte, which some machines need at the end.
fn line(name: &str, which: usize, hash: u64) -> [u8; 32] {
    let mut text = [b' '; 32];
    for (to, from) in text.iter_mut().take(8).zip(name.bytes()) {
        *to = from;
    }
    let steps: &[u8; 6] = if which == 0 { b"  1000" } else { b" 10000" };
    text[7..13].copy_from_slice(steps);
    let mut rest = hash;
    for digit in text[14..30].iter_mut().rev() {
        let d = (rest & 15) as u8;
        *digit = if d < 10 { b'0' + d } else { b'a' + d - 10 };
        rest >>= 4;
    }
    text[30] = b'\n';
    text[31] = 0;
    text
}

#[panic_handler]
fn panic(_: &PanicInfo) -> ! {
    machine::exit(101)
}
