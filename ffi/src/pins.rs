use taut_core::Vector3;

use crate::handle::{ClothHandle, change, look};
use crate::pointer::{Out, value};
use crate::result::Code;

/// Pins a particle where it is. One that is pinned already stays as it is.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_NO_SUCH_PARTICLE,
/// TAUT_ERROR_ABSENT, TAUT_ERROR_TOO_MANY_PINS.
/// Threads: changes the cloth.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_cloth_pin(cloth: *mut ClothHandle, particle: u32) -> Code {
    // SAFETY: the caller hands in a cloth that nobody else uses.
    unsafe { change(cloth, |cloth| Ok(cloth.pin(particle as usize)?)) }
}

/// Moves a pin: at the end of the next frame it is at world_m (x, y, z in m), and on the way there it is interpolated over
/// the substeps. Without a new call it then stays.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_NO_SUCH_PARTICLE,
/// TAUT_ERROR_NOT_PINNED, TAUT_ERROR_NOT_FINITE, TAUT_ERROR_OUT_OF_RANGE (more than 1e6 m from the cloth's origin).
/// Threads: changes the cloth.
/// cbindgen:ptrs-as-arrays=[[world_m;3]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_cloth_pin_move(cloth: *mut ClothHandle, particle: u32, world_m: *const f64) -> Code {
    // SAFETY: the caller hands in a cloth that nobody else uses, and lends three numbers.
    unsafe {
        change(cloth, |cloth| {
            let world_m = *value(world_m.cast::<[f64; 3]>())?;
            Ok(cloth.move_pin(particle as usize, Vector3::from(world_m))?)
        })
    }
}

/// Frees a pinned particle; it keeps the velocity of its pin.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_NO_SUCH_PARTICLE,
/// TAUT_ERROR_NOT_PINNED.
/// Threads: changes the cloth.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_cloth_unpin(cloth: *mut ClothHandle, particle: u32) -> Code {
    // SAFETY: the caller hands in a cloth that nobody else uses.
    unsafe { change(cloth, |cloth| Ok(cloth.unpin(particle as usize)?)) }
}

/// Number of pins.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE.
/// Threads: reads the cloth.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_cloth_pin_count(cloth: *const ClothHandle, out: *mut u32) -> Code {
    // SAFETY: the caller lends a cloth that nobody changes, and a place for the answer.
    unsafe {
        look(cloth, |cloth| {
            Out::new(out)?.set(cloth.pin_count() as u32);
            Ok(())
        })
    }
}
