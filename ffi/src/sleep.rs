use crate::handle::{ClothHandle, change, look};
use crate::pointer::Out;
use crate::result::Code;

/// Wakes a cloth that sleeps (taut_cloth_def.sleep_speed_m_s). Calls that change something do it by themselves.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE.
/// Threads: changes the cloth.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_cloth_wake(cloth: *mut ClothHandle) -> Code {
    // SAFETY: the caller hands in a cloth that nobody else uses.
    unsafe {
        change(cloth, |cloth| {
            cloth.wake();
            Ok(())
        })
    }
}

/// Whether the cloth sleeps: 1, or 0.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE.
/// Threads: reads the cloth.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_cloth_is_asleep(cloth: *const ClothHandle, out: *mut u32) -> Code {
    // SAFETY: the caller lends a cloth that nobody changes, and a place for the answer.
    unsafe {
        look(cloth, |cloth| {
            Out::new(out)?.set(cloth.is_asleep().into());
            Ok(())
        })
    }
}
