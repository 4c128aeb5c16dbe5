use crate::handle::{ClothHandle, change};
use crate::pointer::value;
use crate::result::Code;

/// Gravity from the next step on, x, y, z in m/s^2, at most 1e4 in size. It is part of the state once it is not that of the
/// definition any more; so are damping and rest lengths.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_NOT_FINITE,
/// TAUT_ERROR_OUT_OF_RANGE.
/// Threads: changes the cloth.
/// cbindgen:ptrs-as-arrays=[[gravity_m_s2;3]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_cloth_set_gravity(cloth: *mut ClothHandle, gravity_m_s2: *const f32) -> Code {
    // SAFETY: the caller hands in a cloth that nobody else uses, and lends three numbers.
    unsafe { change(cloth, |cloth| Ok(cloth.set_gravity(*value(gravity_m_s2.cast::<[f32; 3]>())?)?)) }
}

/// Damping c from the next step on, in 1/s: at least 0, and c dt below 1. The budget depends on it and is computed anew.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_NOT_FINITE,
/// TAUT_ERROR_NEGATIVE, TAUT_ERROR_DAMPING.
/// Threads: changes the cloth.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_cloth_set_damping(cloth: *mut ClothHandle, damping_per_s: f32) -> Code {
    // SAFETY: the caller hands in a cloth that nobody else uses.
    unsafe { change(cloth, |cloth| Ok(cloth.set_damping(damping_per_s)?)) }
}

/// Factors of the rest lengths from the next step on, 0.5 to 2: of the warp (structural and bend springs along v), the weft
/// (those along u), and the diagonals. Below 1 the cloth shrinks, or is pre-stretched where pins hold it; above 1 it has slack.
/// With the same factor for all three a flat sheet is flat without tension again. Strain is that against the scaled lengths;
/// the stiffness stays, and the budget is computed anew.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_NOT_FINITE,
/// TAUT_ERROR_OUT_OF_RANGE.
/// Threads: changes the cloth.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_cloth_set_rest_scale(
    cloth: *mut ClothHandle,
    warp: f32,
    weft: f32,
    diagonal: f32,
) -> Code {
    // SAFETY: the caller hands in a cloth that nobody else uses.
    unsafe { change(cloth, |cloth| Ok(cloth.set_rest_scale([warp, weft, diagonal])?)) }
}
