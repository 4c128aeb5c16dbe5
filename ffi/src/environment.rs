//! The floating-point environment. Engines switch on flush-to-zero, some change the rounding: with either a step would
//! have other bits. So every call that computes sets the default environment and gives back what it found.

/// The default environment while it lives.
pub(crate) struct Environment {
    #[cfg_attr(
        not(any(target_arch = "x86_64", target_arch = "aarch64")),
        allow(dead_code, reason = "there is nothing to give back")
    )]
    found: Register,
}

#[cfg(target_arch = "x86_64")]
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
        // SAFETY: `value` is the default or was read from MXCSR, so no reserved bit is set. The assembly counts as reading
        // and writing memory, so no computation on the state of a cloth is moved across it.
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
        // SAFETY: `value` is the default or was read from FPCR. The assembly counts as reading and writing memory, so no
        // computation on the state of a cloth is moved across it.
        unsafe { asm!("msr fpcr, {}", in(reg) value, options(nostack, preserves_flags)) };
    }
}

/// Elsewhere (wasm has no such modes; other processors start in the default one) there is nothing to do.
#[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
mod register {
    pub(super) type Register = ();

    pub(super) const DEFAULT: Register = ();

    pub(super) fn get() -> Register {}

    pub(super) fn set(_: Register) {}
}

use register::Register;

impl Environment {
    /// Sets the default environment.
    #[inline]
    pub fn enter() -> Environment {
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

#[cfg(all(test, target_arch = "x86_64"))]
mod tests {
    use super::*;

    #[test]
    fn flush_to_zero_is_off_inside_and_back_on_outside() {
        let before = register::get();
        let flush = before | 0x8040 | 0x6000;
        register::set(flush);
        let inside = {
            let _environment = Environment::enter();
            register::get()
        };
        let after = register::get();
        register::set(before);
        assert_eq!(inside, register::DEFAULT);
        assert_eq!(after, flush);
    }
}
