use core::ffi::c_void;

use crate::handle::{ClothHandle, change, look};
use crate::pointer::{Out, array, array_mut};
use crate::result::Code;

/// Bytes of a snapshot of the cloth as it is now. It grows with the pins and with pending forces.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE.
/// Threads: reads the cloth.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_cloth_snapshot_size(cloth: *const ClothHandle, out: *mut usize) -> Code {
    // SAFETY: the caller lends a cloth that nobody changes, and a place for the answer.
    unsafe {
        look(cloth, |cloth| {
            Out::new(out)?.set(cloth.snapshot_size());
            Ok(())
        })
    }
}

/// Bytes that every snapshot of this cloth fits in, however many pins and forces it will have.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE.
/// Threads: reads the cloth.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_cloth_snapshot_size_max(cloth: *const ClothHandle, out: *mut usize) -> Code {
    // SAFETY: the caller lends a cloth that nobody changes, and a place for the answer.
    unsafe {
        look(cloth, |cloth| {
            Out::new(out)?.set(cloth.snapshot_size_max());
            Ok(())
        })
    }
}

/// Writes the state (positions, velocities, pins, pending forces, step index, and what was changed of gravity, damping,
/// rest lengths and frame) into out, which has out_size bytes and need not
/// be aligned. Every machine writes and reads the same bytes. Stiffness, masses, mask and definition are left out: they do
/// not change by stepping. out_written, which may be NULL, gets the number of bytes.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED (cloth, out_written), TAUT_ERROR_BAD_HANDLE,
/// TAUT_ERROR_BLOCK_TOO_SMALL. Then nothing is written.
/// Threads: changes the cloth (it settles what a change of pins does to the inertia).
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_cloth_snapshot(
    cloth: *mut ClothHandle,
    out: *mut c_void,
    out_size: usize,
    out_written: *mut usize,
) -> Code {
    // SAFETY: the caller hands in a cloth that nobody else uses, `out_size` bytes, and a place for the number or NULL.
    unsafe {
        change(cloth, |cloth| {
            let written = Out::optional(out_written)?;
            let out = array_mut(out.cast::<u8>(), out_size.min(cloth.snapshot_size()))?;
            written.set(cloth.snapshot(out)?);
            Ok(())
        })
    }
}

/// Reads a state back from size bytes, which need not be aligned. The whole snapshot is checked before anything is changed.
/// Going on from it gives the bits that it gave the first time, provided that the stiffness is the same.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED (cloth), TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_TRUNCATED,
/// TAUT_ERROR_WRONG_KIND, TAUT_ERROR_UNSUPPORTED_VERSION, TAUT_ERROR_FOREIGN, TAUT_ERROR_SHAPE, TAUT_ERROR_CHECKSUM,
/// and, where a cloth did not write the bytes, TAUT_ERROR_NOT_FINITE, TAUT_ERROR_OUT_OF_RANGE, TAUT_ERROR_NEGATIVE,
/// TAUT_ERROR_DAMPING, TAUT_ERROR_NO_SUCH_PARTICLE, TAUT_ERROR_ABSENT. Then the cloth is as it was.
/// Threads: changes the cloth.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_cloth_restore(cloth: *mut ClothHandle, data: *const c_void, size: usize) -> Code {
    // SAFETY: the caller hands in a cloth that nobody else uses, and lends `size` bytes.
    unsafe { change(cloth, |cloth| Ok(cloth.restore(array(data.cast::<u8>(), size)?)?)) }
}

/// 64-bit hash of the state: two machines that play in lockstep compare it. The frame is not in it, so they may have their
/// worlds' origins elsewhere.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE.
/// Threads: changes the cloth (it settles what a change of pins does to the inertia).
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_cloth_state_hash(cloth: *mut ClothHandle, out: *mut u64) -> Code {
    // SAFETY: the caller hands in a cloth that nobody else uses, and a place for the answer.
    unsafe {
        change(cloth, |cloth| {
            let out = Out::new(out)?;
            out.set(cloth.state_hash());
            Ok(())
        })
    }
}
