use taut_core::Width;

use crate::handle::{ClothHandle, change, look};
use crate::pointer::Out;
use crate::result::{Code, answer};

/// The width of a number of C.
fn width(number: u32) -> Result<Width, Code> {
    Width::ALL.into_iter().find(|w| *w as u32 == number).ok_or(Code::TAUT_ERROR_OUT_OF_RANGE)
}

/// Whether this machine has the vectors of a taut_width: 1, or 0.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_OUT_OF_RANGE (no taut_width).
/// Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_width_supported(number: u32, out: *mut u32) -> Code {
    answer(|| {
        // SAFETY: the caller hands in a place for the answer.
        let out = unsafe { Out::new(out) }?;
        out.set(width(number)?.is_supported().into());
        Ok(())
    })
}

/// Steps in other vectors (a taut_width) from now on, to time or test them: the bits stay the same. A cloth begins with the widest
/// ones of the machine. This is no part of the state: no snapshot holds it, and a reset keeps it.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_OUT_OF_RANGE (no taut_width),
/// TAUT_ERROR_UNSUPPORTED_WIDTH (this machine lacks it).
/// Threads: changes the cloth.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_cloth_set_width(cloth: *mut ClothHandle, number: u32) -> Code {
    // SAFETY: the caller hands in a cloth that nobody else uses.
    unsafe { change(cloth, |cloth| Ok(cloth.set_width(width(number)?)?)) }
}

/// The vectors that the cloth is stepped in: a taut_width.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE.
/// Threads: reads the cloth.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_cloth_width(cloth: *const ClothHandle, out: *mut u32) -> Code {
    // SAFETY: the caller lends a cloth that nobody changes, and a place for the answer.
    unsafe {
        look(cloth, |cloth| {
            Out::new(out)?.set(cloth.width() as u32);
            Ok(())
        })
    }
}
