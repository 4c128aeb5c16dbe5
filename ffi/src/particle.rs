use taut_core::Vector3;

use crate::handle::{ClothHandle, change};
use crate::pointer::{array, value};
use crate::result::Code;

/// Farthest that core lets a position be from the origin, in m.
const REACH_M: f32 = 1e6;

/// Puts a particle somewhere, at rest; a pinned one together with its pin. local_m is x, y, z in m in the cloth's local
/// frame (the world less origin_m).
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_NO_SUCH_PARTICLE,
/// TAUT_ERROR_NOT_FINITE, TAUT_ERROR_OUT_OF_RANGE (more than 1e6 m along an axis).
/// Threads: changes the cloth.
/// cbindgen:ptrs-as-arrays=[[local_m;3]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_cloth_set_position(cloth: *mut ClothHandle, particle: u32, local_m: *const f32) -> Code {
    // SAFETY: the caller hands in a cloth that nobody else uses, and lends three numbers.
    unsafe {
        change(cloth, |cloth| {
            let local_m = *value(local_m.cast::<[f32; 3]>())?;
            Ok(cloth.set_position(particle as usize, Vector3::from(local_m))?)
        })
    }
}

/// Puts all particles somewhere, at rest, pinned ones together with their pins. local_m holds x, y, z of each of the count
/// particles in m in the cloth's local frame, particle after particle; count is the number of particles of the grid. All or
/// nothing.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_SHAPE (count),
/// TAUT_ERROR_NOT_FINITE, TAUT_ERROR_OUT_OF_RANGE (more than 1e6 m along an axis).
/// Threads: changes the cloth.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_cloth_set_positions(cloth: *mut ClothHandle, count: u32, local_m: *const f32) -> Code {
    // SAFETY: the caller hands in a cloth that nobody else uses, and lends 3 * count numbers. The count is checked before
    // the array is trusted.
    unsafe {
        change(cloth, |cloth| {
            if count as usize != cloth.grid().particles() {
                return Err(Code::TAUT_ERROR_SHAPE);
            }
            let positions = array(local_m.cast::<[f32; 3]>(), count as usize)?;
            let numbers = positions.as_flattened();
            if !numbers.iter().all(|x| x.is_finite()) {
                return Err(Code::TAUT_ERROR_NOT_FINITE);
            }
            if numbers.iter().any(|x| x.abs() > REACH_M) {
                return Err(Code::TAUT_ERROR_OUT_OF_RANGE);
            }
            for (particle, position) in positions.iter().enumerate() {
                cloth.set_position(particle, Vector3::from(*position))?;
            }
            Ok(())
        })
    }
}

/// Sets the velocity of a particle, x, y, z in m/s; a pinned one keeps that of its pin.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_NO_SUCH_PARTICLE,
/// TAUT_ERROR_ABSENT, TAUT_ERROR_NOT_FINITE, TAUT_ERROR_OUT_OF_RANGE (above 1e6 m/s along an axis).
/// Threads: changes the cloth.
/// cbindgen:ptrs-as-arrays=[[v_m_s;3]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_cloth_set_velocity(cloth: *mut ClothHandle, particle: u32, v_m_s: *const f32) -> Code {
    // SAFETY: the caller hands in a cloth that nobody else uses, and lends three numbers.
    unsafe {
        change(cloth, |cloth| {
            let v_m_s = *value(v_m_s.cast::<[f32; 3]>())?;
            Ok(cloth.set_velocity(particle as usize, Vector3::from(v_m_s))?)
        })
    }
}

/// Adds a force on a particle, x, y, z in N, which acts during the next frame. Needs TAUT_FEATURE_PULL.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_FEATURE_OFF,
/// TAUT_ERROR_NO_SUCH_PARTICLE, TAUT_ERROR_ABSENT, TAUT_ERROR_NOT_FINITE, TAUT_ERROR_OUT_OF_RANGE (above 1e9 N along an axis).
/// Threads: changes the cloth.
/// cbindgen:ptrs-as-arrays=[[force_n;3]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_cloth_add_force(cloth: *mut ClothHandle, particle: u32, force_n: *const f32) -> Code {
    // SAFETY: the caller hands in a cloth that nobody else uses, and lends three numbers.
    unsafe {
        change(cloth, |cloth| {
            let force_n = *value(force_n.cast::<[f32; 3]>())?;
            Ok(cloth.add_force(particle as usize, Vector3::from(force_n))?)
        })
    }
}
