//! Linux on aarch64, by system calls: what `targets.sh` runs in an emulator.

use core::arch::{asm, naked_asm};

/// Whether the machine is fast enough for the long runs.
pub const FAST: bool = false;

const WRITE: usize = 64;
const EXIT: usize = 93;

/// Where the kernel enters; the stack is aligned.
#[unsafe(naked)]
#[unsafe(no_mangle)]
extern "C" fn _start() -> ! {
    naked_asm!("mov x29, xzr", "mov x30, xzr", "bl {start}", "brk 1", start = sym start)
}

extern "C" fn start() -> ! {
    crate::main()
}

/// Writes a text that ends with a zero byte to standard output; a failed or short write ends the program with 1.
pub fn write(text: &[u8]) {
    let bytes = text.len().saturating_sub(1);
    let mut done = 1;
    // SAFETY: write(2) reads `bytes` bytes of `text`.
    unsafe {
        asm!("svc 0", in("x8") WRITE, inout("x0") done, in("x1") text.as_ptr(), in("x2") bytes, options(nostack));
    }
    if done != bytes {
        exit(1);
    }
}

/// Flush-to-zero, default NaNs and rounding upwards.
pub fn set_modes_of_an_engine() -> bool {
    let modes = 1u64 << 25 | 1 << 24 | 1 << 22;
    // SAFETY: sets modes that are allowed; only whole numbers are computed in this crate.
    unsafe { asm!("msr fpcr, {}", in(reg) modes, options(nostack)) };
    true
}

/// Ends the process.
pub fn exit(code: i32) -> ! {
    // SAFETY: exit(2) does not come back.
    unsafe { asm!("svc 0", in("x8") EXIT, in("x0") code, options(noreturn, nostack)) }
}
