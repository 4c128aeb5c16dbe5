use taut_core::StepFlags;

use crate::handle::{ClothHandle, change, look};
use crate::pointer::Out;
use crate::result::Code;

/// Steps one frame: 1 / rate_hz seconds in `substeps` equal substeps. Pins move to their targets, forces act. The same
/// calls give the same bits on every machine, whatever floating-point modes the engine has set.
///
/// out_flags, which may be NULL, tells what happened: 0, or TAUT_STEP_* or-ed.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_NO_STIFFNESS.
/// Threads: changes the cloth.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_cloth_step(cloth: *mut ClothHandle, out_flags: *mut u32) -> Code {
    // SAFETY: the same promises are made to both functions.
    unsafe { taut_cloth_step_many(cloth, 1, out_flags) }
}

/// Steps count frames, 0 or more; pin targets and forces belong to the first. It ends early after a frame that was taken back
/// (TAUT_STEP_NON_FINITE); taut_cloth_step_index tells how far it came.
///
/// out_flags, which may be NULL, tells what happened: 0, or TAUT_STEP_* or-ed.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_NO_STIFFNESS.
/// Threads: changes the cloth.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_cloth_step_many(cloth: *mut ClothHandle, count: u32, out_flags: *mut u32) -> Code {
    // SAFETY: the caller hands in a cloth that nobody else uses, and a place for the flags or NULL.
    unsafe {
        change(cloth, |cloth| {
            let out = Out::optional(out_flags)?;
            let mut flags = 0;
            for _ in 0..count {
                flags |= cloth.step()?.0;
                if StepFlags(flags).contains(StepFlags::NON_FINITE) {
                    break;
                }
            }
            out.set(flags);
            Ok(())
        })
    }
}

/// Frames stepped since the creation, the last reset, or those of the snapshot that was restored.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE.
/// Threads: reads the cloth.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_cloth_step_index(cloth: *const ClothHandle, out: *mut u64) -> Code {
    // SAFETY: the caller lends a cloth that nobody changes, and a place for the answer.
    unsafe {
        look(cloth, |cloth| {
            Out::new(out)?.set(cloth.step_index());
            Ok(())
        })
    }
}
