//! taut on a bare machine: no std, no alloc crate, no libc, no loader. Steps the scene in a static block and prints
//! the hash of its last state as 16 hexadecimal digits. Exits with 0; 1 when the scene fails; 101 when something
//! panics.
#![no_std]
#![no_main]

#[cfg_attr(target_os = "linux", path = "linux.rs")]
#[cfg_attr(target_os = "none", path = "cortex_m.rs")]
mod machine;
mod scene;

use core::cell::UnsafeCell;
use core::panic::PanicInfo;

/// The memory of the cloth.
struct Block(UnsafeCell<[f32; scene::NUMBERS]>);

// SAFETY: the program has one thread.
unsafe impl Sync for Block {}

static BLOCK: Block = Block(UnsafeCell::new([0.0; scene::NUMBERS]));

/// What the entry point of the machine calls, once.
fn main() -> ! {
    // SAFETY: one thread, and this function, which runs once, holds the only reference.
    let block = unsafe { &mut *BLOCK.0.get() };
    match scene::hash(block) {
        Ok(hash) => {
            machine::write(&line(hash));
            machine::exit(0)
        }
        Err(_) => machine::exit(1),
    }
}

/// 16 hexadecimal digits, a line feed, and a zero byte, which some machines need at the end.
fn line(hash: u64) -> [u8; 18] {
    let mut text = [0; 18];
    let mut rest = hash;
    for digit in text[..16].iter_mut().rev() {
        let d = (rest & 15) as u8;
        *digit = if d < 10 { b'0' + d } else { b'a' + d - 10 };
        rest >>= 4;
    }
    text[16] = b'\n';
    text
}

#[panic_handler]
fn panic(_: &PanicInfo) -> ! {
    machine::exit(101)
}
