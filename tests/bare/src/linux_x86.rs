//! Linux on 32-bit x86 with SSE2, by system calls.

use core::arch::{asm, naked_asm};

/// Whether the machine is fast enough for the long runs.
pub const FAST: bool = false;

const WRITE: usize = 4;
const EXIT: usize = 1;

/// Where the kernel enters.
#[unsafe(naked)]
#[unsafe(no_mangle)]
extern "C" fn _start() -> ! {
    naked_asm!("xor ebp, ebp", "and esp, -16", "call {start}", "ud2", start = sym start)
}

extern "C" fn start() -> ! {
    crate::main()
}

/// Writes a text that ends with a zero byte to standard output; a failed or short write ends the program with 1.
pub fn write(text: &[u8]) {
    let bytes = text.len().saturating_sub(1);
    let mut done = WRITE;
    // SAFETY: write(2) reads `bytes` bytes of `text`.
    unsafe {
        asm!("int 0x80", inout("eax") done, in("ebx") 1, in("ecx") text.as_ptr(), in("edx") bytes, options(nostack));
    }
    if done != bytes {
        exit(1);
    }
}

/// Flush-to-zero, denormals-are-zero and rounding upwards.
pub fn set_modes_of_an_engine() -> bool {
    let modes = 0x1f80u32 | 0x8040 | 0x4000;
    // SAFETY: sets modes that are allowed; only whole numbers are computed in this crate.
    unsafe { asm!("ldmxcsr [{}]", in(reg) &raw const modes, options(nostack)) };
    true
}

/// Ends the process.
pub fn exit(code: i32) -> ! {
    // SAFETY: exit(2) does not come back.
    unsafe { asm!("int 0x80", in("eax") EXIT, in("ebx") code, options(noreturn, nostack)) }
}
