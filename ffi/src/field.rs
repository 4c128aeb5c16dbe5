use taut_core::baked::Baked;

use crate::pointer::{Out, array};
use crate::result::{Code, answer};
use crate::types::FieldInfo;

/// Checks a baked field file of size bytes and tells what it is: so the density is known before the cloth is made.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_TRUNCATED, TAUT_ERROR_WRONG_KIND,
/// TAUT_ERROR_UNSUPPORTED_VERSION, TAUT_ERROR_GRID_SIZE, TAUT_ERROR_SHAPE, TAUT_ERROR_CHECKSUM, TAUT_ERROR_NOT_FINITE,
/// TAUT_ERROR_NEGATIVE.
/// Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_field_info(data: *const core::ffi::c_void, size: usize, out: *mut FieldInfo) -> Code {
    answer(|| {
        // SAFETY: the caller lends `size` bytes and a place for the answer.
        let (bytes, out) = unsafe { (array(data.cast::<u8>(), size)?, Out::new(out)?) };
        let baked = Baked::parse(bytes)?;
        out.set(FieldInfo {
            seed: baked.seed,
            description_hash: baked.description_hash,
            rows: baked.rows as u32,
            columns: baked.columns as u32,
            fabric: baked.fabric.into(),
            reserved: 0,
        });
        Ok(())
    })
}
