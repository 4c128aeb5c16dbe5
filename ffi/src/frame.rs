use taut_core::Vector3;

use crate::handle::{ClothHandle, change, look};
use crate::pointer::{Out, value};
use crate::result::Code;
use crate::types::Pose;

/// The frame is at a new place at the end of the next step: that of the character whom the cloth follows. linear_inertia and
/// angular_inertia, 0 to 1, are the shares of its shift and its turn since the last frame that the cloth feels; with the rest
/// it is carried along, at no strain and no velocity. Pins and colliders go where they are told to be in the world, so it
/// does not matter whether they are moved before or after this call; a pin that is not moved stays where it is.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_NOT_FINITE,
/// TAUT_ERROR_OUT_OF_RANGE (also a way of more than 1e6 m along an axis: that is a teleport).
/// Threads: changes the cloth.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_cloth_set_frame(
    cloth: *mut ClothHandle,
    frame: *const Pose,
    linear_inertia: f32,
    angular_inertia: f32,
) -> Code {
    // SAFETY: the caller hands in a cloth that nobody else uses, and lends a frame.
    unsafe {
        change(cloth, |cloth| {
            let frame = (*value(frame)?).into();
            Ok(cloth.set_frame(&frame, linear_inertia, angular_inertia)?)
        })
    }
}

/// The cloth is elsewhere at once, with its pins and colliders and where they go to: it does not notice. A change of place alone
/// leaves every bit of the local state; a turn rounds positions and velocities.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_NOT_FINITE,
/// TAUT_ERROR_OUT_OF_RANGE.
/// Threads: changes the cloth.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_cloth_teleport(cloth: *mut ClothHandle, frame: *const Pose) -> Code {
    // SAFETY: the caller hands in a cloth that nobody else uses, and lends a frame.
    unsafe { change(cloth, |cloth| Ok(cloth.teleport(&(*value(frame)?).into())?)) }
}

/// Moves the origin of the local frame, x, y, z in m, each at most 1e12 in size, and the cloth with all that is attached to it:
/// for engines that shift their world. The local state and its hash stay, to the bit.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_NOT_FINITE,
/// TAUT_ERROR_OUT_OF_RANGE.
/// Threads: changes the cloth.
/// cbindgen:ptrs-as-arrays=[[origin_m;3]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_cloth_set_origin(cloth: *mut ClothHandle, origin_m: *const f64) -> Code {
    // SAFETY: the caller hands in a cloth that nobody else uses, and lends three numbers.
    unsafe { change(cloth, |cloth| Ok(cloth.set_origin(Vector3::from(*value(origin_m.cast::<[f64; 3]>())?))?)) }
}

/// Where the frame is.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE.
/// Threads: reads the cloth.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_cloth_frame(cloth: *const ClothHandle, out: *mut Pose) -> Code {
    // SAFETY: the caller lends a cloth that nobody changes, and a place for the answer.
    unsafe {
        look(cloth, |cloth| {
            Out::new(out)?.set(cloth.frame().into());
            Ok(())
        })
    }
}
