use core::ffi::c_void;

use crate::handle::{ClothHandle, change};
use crate::pointer::{Out, Vertices};
use crate::result::Code;

/// Force with which a pin holds its particle in the state as it is now, x, y, z in N: the opposite of springs, weight, pull,
/// air and hinges on the particle; what it is pinned to feels the opposite. At rest the sum over the pins is the weight of
/// the sheet. What tethers, strain limits, colliders and targets carry is not in it, nor what accelerates the particle.
///
/// Takes the time of a particle; with TAUT_FEATURE_AIR, _HINGE or _MASS that of a pass over the cloth.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_NO_SUCH_PARTICLE,
/// TAUT_ERROR_NOT_PINNED.
/// Threads: changes the cloth (it settles what a change of pins does to the inertia).
/// cbindgen:ptrs-as-arrays=[[out_n;3]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_cloth_pin_force(cloth: *mut ClothHandle, particle: u32, out_n: *mut f32) -> Code {
    // SAFETY: the caller hands in a cloth that nobody else uses, and a place for three numbers.
    unsafe {
        change(cloth, |cloth| {
            let out = Out::new(out_n.cast::<[f32; 3]>())?;
            out.set(cloth.pin_force(particle as usize)?.into());
            Ok(())
        })
    }
}

/// Copies the force of every pin (taut_cloth_pin_force) as three floats in N, in the order of the pinned particles, of which
/// there are taut_cloth_pin_count. out has out_size bytes; stride is the bytes from a pin to the next, at least 12. Bytes
/// between are left alone, and out need not be aligned.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED (cloth), TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_SHAPE (stride),
/// TAUT_ERROR_BLOCK_TOO_SMALL. Then nothing is written.
/// Threads: changes the cloth (it settles what a change of pins does to the inertia).
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_cloth_copy_pin_forces_f32(
    cloth: *mut ClothHandle,
    out: *mut c_void,
    out_size: usize,
    stride: usize,
) -> Code {
    // SAFETY: the caller hands in a cloth that nobody else uses, and `out_size` bytes.
    unsafe {
        change(cloth, |cloth| {
            let vertices = Vertices::new::<[f32; 3]>(out, out_size, stride, cloth.pin_count())?;
            let mut forces = cloth.pin_forces();
            // there are as many forces as pins, so the zeros are never written
            vertices.fill(|_| forces.next().map_or([0.0; 3], |(_, force)| force.into()));
            Ok(())
        })
    }
}
