//! What a library without std must bring.

/// Nothing in taut panics: tests/tests/c_programs.rs finds no way to this function in the shared library. Should it
/// happen all the same, the thread stops here rather than go on with a state that nobody has checked.
#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    loop {
        core::hint::spin_loop();
    }
}

// The precompiled core library is built for unwinding: its objects name this symbol, which std would define. Nothing
// unwinds here, so nobody calls it. Weak, so that a program may link another Rust library beside this one; hidden, so
// that the shared library does not export it.
#[cfg(all(unix, not(target_vendor = "apple")))]
core::arch::global_asm!(
    ".pushsection .text.rust_eh_personality,\"ax\"",
    ".weak rust_eh_personality",
    ".hidden rust_eh_personality",
    "rust_eh_personality:",
    ".long 0",
    ".popsection",
);
