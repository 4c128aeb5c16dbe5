use crate::handle::{ClothHandle, change, look};
use crate::pointer::{Out, value};
use crate::result::Code;
use crate::types::Air;

/// Still air of 1.2 kg/m^3, drag and lift 1.2: what a cloth with TAUT_FEATURE_AIR starts with.
///
/// Threads: any.
#[unsafe(no_mangle)]
pub extern "C" fn taut_air_default() -> Air {
    taut_core::Air::default().into()
}

/// Sets the air from the next step on. Needs TAUT_FEATURE_AIR. May be called every frame; but the budget counts drag as
/// damping, in steps of a factor of 2, so a wind that grows a lot makes the next step cut the stiffness anew.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_FEATURE_OFF,
/// TAUT_ERROR_NOT_FINITE, TAUT_ERROR_NEGATIVE, TAUT_ERROR_OUT_OF_RANGE. Then the former air stays.
/// Threads: changes the cloth.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_cloth_set_air(cloth: *mut ClothHandle, air: *const Air) -> Code {
    // SAFETY: the caller hands in a cloth that nobody else uses, and lends the air.
    unsafe {
        change(cloth, |cloth| {
            let air = *value(air)?;
            Ok(cloth.set_air(&air.into())?)
        })
    }
}

/// The air as it is now. Needs TAUT_FEATURE_AIR.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_FEATURE_OFF.
/// Threads: reads the cloth.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_cloth_air(cloth: *const ClothHandle, out: *mut Air) -> Code {
    // SAFETY: the caller hands in a cloth that nobody changes, and a place for the answer.
    unsafe {
        look(cloth, |cloth| {
            let out = Out::new(out)?;
            out.set(cloth.air()?.into());
            Ok(())
        })
    }
}
