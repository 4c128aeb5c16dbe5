//! The floating-point environment. Engines switch on flush-to-zero, some change the rounding: with either a step would
//! have other bits. So every call that computes sets the default environment and gives back what it found.
//!
//! Why this is sound. The two instructions of each target are available to every program, and what they write is the
//! default or was read from the same register before, so no reserved bit is set and no trap is switched on that was off.
//! Rust takes the default environment for granted: code that computes must not be moved across the switch. The body is
//! therefore a function of its own that is never inlined, and the assembly counts as reading and writing memory.
#![allow(unsafe_code)]

#[cfg(all(any(target_arch = "x86", target_arch = "x86_64"), target_feature = "sse2"))]
mod register {
    use core::arch::asm;

    pub(super) type Register = u32;

    /// MXCSR after reset: round to nearest, denormals kept, no exception traps.
    pub(super) const DEFAULT: Register = 0x1f80;

    pub(super) fn get() -> Register {
        let mut now: Register = 0;
        // SAFETY: stores MXCSR in a local variable.
        unsafe { asm!("stmxcsr [{}]", in(reg) &raw mut now, options(nostack, preserves_flags)) };
        now
    }

    pub(super) fn set(value: Register) {
        // SAFETY: `value` is the default or was read from MXCSR, so no reserved bit is set.
        unsafe { asm!("ldmxcsr [{}]", in(reg) &raw const value, options(nostack, preserves_flags)) };
    }
}

#[cfg(target_arch = "aarch64")]
mod register {
    use core::arch::asm;

    pub(super) type Register = u64;

    /// FPCR after reset: round to nearest, denormals kept, no exception traps.
    pub(super) const DEFAULT: Register = 0;

    pub(super) fn get() -> Register {
        let now: Register;
        // SAFETY: reads FPCR, which every program may.
        unsafe { asm!("mrs {}, fpcr", out(reg) now, options(nostack, preserves_flags)) };
        now
    }

    pub(super) fn set(value: Register) {
        // SAFETY: `value` is the default or was read from FPCR.
        unsafe { asm!("msr fpcr, {}", in(reg) value, options(nostack, preserves_flags)) };
    }
}

#[cfg(all(target_arch = "arm", target_abi = "eabihf"))]
mod register {
    use core::arch::asm;

    pub(super) type Register = u32;

    /// FPSCR after reset: round to nearest, denormals kept, no exception traps.
    pub(super) const DEFAULT: Register = 0;

    pub(super) fn get() -> Register {
        let now: Register;
        // SAFETY: reads FPSCR; targets of this ABI have a float unit.
        unsafe { asm!("vmrs {}, fpscr", out(reg) now, options(nostack, preserves_flags)) };
        now
    }

    pub(super) fn set(value: Register) {
        // SAFETY: `value` is the default or was read from FPSCR.
        unsafe { asm!("vmsr fpscr, {}", in(reg) value, options(nostack)) };
    }
}

/// Elsewhere (wasm has no such modes; other processors start in the default one) there is nothing to do.
#[cfg(not(any(
    all(any(target_arch = "x86", target_arch = "x86_64"), target_feature = "sse2"),
    target_arch = "aarch64",
    all(target_arch = "arm", target_abi = "eabihf")
)))]
mod register {
    pub(super) type Register = ();

    pub(super) const DEFAULT: Register = ();

    pub(super) fn get() -> Register {}

    pub(super) fn set(_: Register) {}
}

use register::Register;

/// The default environment while it lives: also where the body panics.
struct Environment {
    found: Register,
}

impl Environment {
    #[inline]
    fn enter() -> Environment {
        let found = register::get();
        register::set(register::DEFAULT);
        Environment { found }
    }
}

impl Drop for Environment {
    #[inline]
    fn drop(&mut self) {
        register::set(self.found);
    }
}

/// Runs `body` in the default floating-point environment (round to nearest, denormals kept) and gives back the one that
/// it found. Every call of [`crate::Cloth`] that computes does so itself; a caller who computes what must have the same
/// bits everywhere may use it too. Costs a few nanoseconds.
#[inline]
pub fn in_default_environment<R>(body: impl FnOnce() -> R) -> R {
    let _environment = Environment::enter();
    apart(body)
}

/// Apart, so that nothing of the body moves across the switch of the environment.
#[inline(never)]
fn apart<R>(body: impl FnOnce() -> R) -> R {
    body()
}

#[cfg(all(test, any(target_arch = "x86", target_arch = "x86_64")))]
mod tests {
    use super::*;

    #[test]
    fn flush_to_zero_is_off_inside_and_back_on_outside() {
        let before = register::get();
        let flush = before | 0x8040 | 0x6000;
        register::set(flush);
        let inside = in_default_environment(register::get);
        let after = register::get();
        register::set(before);
        assert_eq!(inside, register::DEFAULT);
        assert_eq!(after, flush);
    }
}
