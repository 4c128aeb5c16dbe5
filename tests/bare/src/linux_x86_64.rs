//! Linux on x86_64, by system calls.

use core::arch::{asm, naked_asm};

/// Whether the machine is fast enough for the long runs.
pub const FAST: bool = !cfg!(debug_assertions);

const WRITE: usize = 1;
const EXIT: usize = 60;

/// Where the kernel enters: the stack is aligned, as a call expects it, and never left.
#[unsafe(naked)]
#[unsafe(no_mangle)]
extern "C" fn _start() -> ! {
    naked_asm!("xor ebp, ebp", "and rsp, -16", "call {start}", "ud2", start = sym start)
}

extern "C" fn start() -> ! {
    crate::main()
}

/// Writes a text that ends with a zero byte to standard output; a failed or short write ends the program with 1.
pub fn write(text: &[u8]) {
    let bytes = text.len().saturating_sub(1);
    let mut done = WRITE;
    // SAFETY: write(2) reads `bytes` bytes of `text`; the kernel destroys rcx and r11 only.
    unsafe {
        asm!("syscall", inout("rax") done, in("rdi") 1, in("rsi") text.as_ptr(), in("rdx") bytes,
            out("rcx") _, out("r11") _, options(nostack));
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
    unsafe { asm!("syscall", in("rax") EXIT, in("rdi") code, options(noreturn, nostack)) }
}

/// The compiler writes calls to these three itself and a libc would have them. String instructions, since the compiler
/// would turn a loop into a call to the function that holds it.
///
/// # Safety
/// `to` and `from` are valid for `bytes` bytes and do not overlap.
#[unsafe(no_mangle)]
unsafe extern "C" fn memcpy(to: *mut u8, from: *const u8, bytes: usize) -> *mut u8 {
    // SAFETY: as above; the direction flag is clear in every Rust and C function.
    unsafe {
        asm!("rep movsb", inout("rcx") bytes => _, inout("rdi") to => _, inout("rsi") from => _,
            options(nostack, preserves_flags));
    }
    to
}

/// # Safety
/// `to` and `from` are valid for `bytes` bytes; they may overlap.
#[unsafe(no_mangle)]
unsafe extern "C" fn memmove(to: *mut u8, from: *const u8, bytes: usize) -> *mut u8 {
    if (to as usize).wrapping_sub(from as usize) >= bytes {
        // SAFETY: forwards no byte is read after it was written.
        return unsafe { memcpy(to, from, bytes) };
    }
    // SAFETY: as above; backwards, from the last byte on, which is there since `bytes` is not 0, and the flag is cleared again.
    unsafe {
        asm!("std", "rep movsb", "cld", inout("rcx") bytes => _, inout("rdi") to.add(bytes - 1) => _,
            inout("rsi") from.add(bytes - 1) => _, options(nostack));
    }
    to
}

/// # Safety
/// `to` is valid for `bytes` bytes.
#[unsafe(no_mangle)]
unsafe extern "C" fn memset(to: *mut u8, value: i32, bytes: usize) -> *mut u8 {
    // SAFETY: as above.
    unsafe {
        asm!("rep stosb", inout("rcx") bytes => _, inout("rdi") to => _, in("al") value as u8,
            options(nostack, preserves_flags));
    }
    to
}

// The precompiled core library is built for unwinding and names this symbol in what only an unoptimised program keeps.
// Nothing unwinds here, so nobody calls it.
#[cfg(debug_assertions)]
core::arch::global_asm!(".weak rust_eh_personality", "rust_eh_personality: ud2");
