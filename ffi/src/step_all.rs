use crate::handle::{ClothHandle, change, look};
use crate::pointer::{Out, array};
use crate::result::Code;

/// Steps each of count cloths one frame, in the order of the list: for each of them the same as taut_cloth_step. It starts
/// no threads; to step on many give each a list of its own. A cloth that is named twice is stepped twice. out_flags, which
/// may be NULL, gets the TAUT_STEP_* of each cloth, count of them; it must not overlap the list or a cloth.
///
/// All or nothing: the whole list is checked before the first cloth is stepped.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE (any cloth), TAUT_ERROR_NO_STIFFNESS (any
/// cloth). Then no cloth was stepped.
/// Threads: changes all cloths of the list.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_cloth_step_all(cloths: *const *mut ClothHandle, count: u32, out_flags: *mut u32) -> Code {
    // SAFETY: the caller lends a list of `count` cloths that nobody else uses.
    let cloths = match unsafe { array(cloths, count as usize) } {
        Ok(cloths) => cloths,
        Err(code) => return code,
    };
    // SAFETY: the caller lends a place for `count` flags, or NULL, which is answered.
    if let (false, Err(code)) = (out_flags.is_null(), unsafe { array(out_flags.cast::<[u8; 4]>(), count as usize) }) {
        return code;
    }
    for cloth in cloths {
        // SAFETY: nobody else uses the cloths.
        let code = unsafe {
            look(*cloth, |cloth| if cloth.has_stiffness() { Ok(()) } else { Err(Code::TAUT_ERROR_NO_STIFFNESS) })
        };
        if code != Code::TAUT_OK {
            return code;
        }
    }
    for (i, cloth) in cloths.iter().enumerate() {
        // SAFETY: as above; there is a place for `count` flags or NULL.
        let code = unsafe {
            let place = if out_flags.is_null() { out_flags } else { out_flags.add(i) };
            change(*cloth, |cloth| {
                let out = Out::optional(place)?;
                out.set(cloth.step()?.0);
                Ok(())
            })
        };
        // found above to be all right, so this is never taken
        if code != Code::TAUT_OK {
            return code;
        }
    }
    Code::TAUT_OK
}
