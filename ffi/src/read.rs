use core::ffi::c_void;

use taut_core::{Cloth, Error, Vector3};

use crate::handle::{ClothHandle, look};
use crate::pointer::{Out, Vertices, value};
use crate::result::Code;
use crate::types::{PositionView, Strain};

/// The positions without a copy.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE.
/// Threads: reads the cloth.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_cloth_positions(cloth: *const ClothHandle, out: *mut PositionView) -> Code {
    // SAFETY: the caller lends a cloth that nobody changes, and a place for the answer.
    unsafe {
        look(cloth, |cloth| {
            let view = cloth.positions();
            let [x, y, z] = view.xyz.map(<[f32]>::as_ptr);
            Out::new(out)?.set(PositionView {
                origin_m: view.origin_m,
                x,
                y,
                z,
                row_stride: view.row_stride,
                rows: cloth.grid().rows(),
                columns: cloth.grid().columns(),
            });
            Ok(())
        })
    }
}

/// Copies the world positions in m as three doubles per particle, in the order of the particles. out has out_size bytes;
/// stride is the bytes from a particle to the next, at least 24. Bytes between are left alone, and out need not be aligned.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED (cloth), TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_SHAPE (stride),
/// TAUT_ERROR_BLOCK_TOO_SMALL. Then nothing is written.
/// Threads: reads the cloth.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_cloth_copy_positions_f64(
    cloth: *const ClothHandle,
    out: *mut c_void,
    out_size: usize,
    stride: usize,
) -> Code {
    // SAFETY: the caller lends a cloth that nobody changes, and `out_size` bytes.
    unsafe { copy(cloth, out, out_size, stride, |cloth, i| Ok(cloth.world_position(i)?.into())) }
}

/// Copies the positions as seen from base_m, a point of the world in m (the camera, or 0, 0, 0), as three floats per
/// particle in m, in the order of the particles: so a vertex buffer stays exact far from the world's origin. out has
/// out_size bytes; stride is the bytes from a particle to the next, at least 12. Bytes between are left alone, and out need
/// not be aligned.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED (cloth, base_m), TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_NOT_FINITE
/// (base_m), TAUT_ERROR_SHAPE (stride), TAUT_ERROR_BLOCK_TOO_SMALL. Then nothing is written.
/// Threads: reads the cloth.
/// cbindgen:ptrs-as-arrays=[[base_m;3]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_cloth_copy_positions_f32(
    cloth: *const ClothHandle,
    base_m: *const f64,
    out: *mut c_void,
    out_size: usize,
    stride: usize,
) -> Code {
    // SAFETY: the caller lends a cloth that nobody changes, three numbers, and `out_size` bytes.
    unsafe {
        let base_m = match value(base_m.cast::<[f64; 3]>()) {
            Ok(base_m) => Vector3::from(*base_m),
            Err(code) => return code,
        };
        if !base_m.iter().all(|x| x.is_finite()) {
            return Code::TAUT_ERROR_NOT_FINITE;
        }
        copy(cloth, out, out_size, stride, |cloth, i| Ok((cloth.world_position(i)? - base_m).cast::<f32>().into()))
    }
}

/// Copies the velocities in m/s as three floats per particle, in the order of the particles. out has out_size bytes; stride
/// is the bytes from a particle to the next, at least 12. Bytes between are left alone, and out need not be aligned.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED (cloth), TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_SHAPE (stride),
/// TAUT_ERROR_BLOCK_TOO_SMALL. Then nothing is written.
/// Threads: reads the cloth.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_cloth_copy_velocities_f32(
    cloth: *const ClothHandle,
    out: *mut c_void,
    out_size: usize,
    stride: usize,
) -> Code {
    // SAFETY: the caller lends a cloth that nobody changes, and `out_size` bytes.
    unsafe { copy::<f32>(cloth, out, out_size, stride, |cloth, i| Ok(cloth.velocity(i)?.into())) }
}

/// Copies three numbers of each particle.
///
/// # Safety
/// As [`look`] and [`Vertices::new`].
unsafe fn copy<T: Copy + Default>(
    cloth: *const ClothHandle,
    out: *mut c_void,
    out_size: usize,
    stride: usize,
    vector: impl Fn(&Cloth<'static>, usize) -> Result<[T; 3], Error>,
) -> Code {
    // SAFETY: promised by the caller.
    unsafe {
        look(cloth, |cloth| {
            let vertices = Vertices::new::<[T; 3]>(out, out_size, stride, cloth.grid().particles())?;
            // the index is always that of a particle, so the zeros are never written
            vertices.fill(|i| vector(cloth, i).unwrap_or([T::default(); 3]));
            Ok(())
        })
    }
}

/// Strain of the structural springs as they are now. Takes time in proportion to the particles.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE.
/// Threads: reads the cloth.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_cloth_strain(cloth: *const ClothHandle, out: *mut Strain) -> Code {
    // SAFETY: the caller lends a cloth that nobody changes, and a place for the answer.
    unsafe {
        look(cloth, |cloth| {
            let out = Out::new(out)?;
            let s = cloth.strain();
            out.set(Strain { largest: s.largest, mean: s.mean });
            Ok(())
        })
    }
}

/// Kinetic energy in J, with the inertia of the inertia field. Takes time in proportion to the particles.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE.
/// Threads: reads the cloth.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_cloth_kinetic_energy(cloth: *const ClothHandle, out_j: *mut f64) -> Code {
    // SAFETY: the caller lends a cloth that nobody changes, and a place for the answer.
    unsafe {
        look(cloth, |cloth| {
            let out = Out::new(out_j)?;
            out.set(cloth.kinetic_energy_j());
            Ok(())
        })
    }
}
