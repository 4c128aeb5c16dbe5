use core::ffi::c_void;

use taut_core::Bands;

use crate::handle::{ClothHandle, TAUT_CLOTH_ALIGN, change, look};
use crate::pointer::{Out, array_mut, value};
use crate::result::{Code, answer};
use crate::types::Memory;

const MAGIC: u64 = 0x736e_6164_7475_6174;

/// Bytes at the start of a block of bands, on every target.
const HEADER_BYTES: usize = 1024;

/// One frame of a cloth, stepped in bands of rows: begun by taut_cloth_bands_begin, ended by taut_bands_end. Between the two
/// nothing else may use the cloth; taut_bands_run and taut_bands_count may be called by any number of threads at a time.
#[repr(C, align(64))]
pub struct BandsHandle {
    magic: u64,
    bands: Bands<'static>,
}

const _: () = {
    assert!(size_of::<BandsHandle>() <= HEADER_BYTES);
    assert!(align_of::<BandsHandle>() == TAUT_CLOTH_ALIGN);
};

/// The first field, of the handle's alignment.
#[repr(C, align(64))]
struct Magic(u64);

/// # Safety
/// `handle` is NULL, misaligned, or good for reading 8 bytes that, if they are the magic number of this address, begin bands
/// that were made by `taut_cloth_bands_begin`.
unsafe fn check(handle: *const BandsHandle) -> Result<(), Code> {
    // SAFETY: the first field is looked at alone, before the rest is trusted.
    let magic = unsafe { value(handle.cast::<Magic>()) }?;
    if magic.0 != MAGIC ^ handle.addr() as u64 {
        return Err(Code::TAUT_ERROR_BAD_HANDLE);
    }
    Ok(())
}

fn bytes(numbers: usize) -> Result<usize, Code> {
    let bytes = numbers.checked_mul(size_of::<f32>()).and_then(|b| b.checked_add(HEADER_BYTES));
    bytes.ok_or(Code::TAUT_ERROR_OUT_OF_RANGE)
}

/// Memory that a frame in bands of rows_per_band rows needs beside the cloth, at least 8 rows; the last band takes what is
/// left over. It is the same for every frame.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_OUT_OF_RANGE (fewer rows than 8;
/// an implicit solver, TAUT_FEATURE_STRAIN_LIMIT or TAUT_FEATURE_LEVELS: such a cloth cannot be stepped in bands).
/// Threads: reads the cloth.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_cloth_bands_memory(
    cloth: *const ClothHandle,
    rows_per_band: u32,
    out: *mut Memory,
) -> Code {
    // SAFETY: the caller lends a cloth that nobody changes, and a place for the answer.
    unsafe {
        look(cloth, |cloth| {
            let out = Out::new(out)?;
            let numbers = cloth.bands_memory(rows_per_band as usize)?;
            out.set(Memory { size: bytes(numbers)?, align: TAUT_CLOTH_ALIGN });
            Ok(())
        })
    }
}

/// Begins a frame that many threads step: bands of rows_per_band rows, in a block of block_size bytes of the caller's, whose
/// content does not matter. Then taut_bands_run for every phase and band, then taut_bands_end: the cloth is as it is after
/// taut_cloth_step, with the same bits, for any number of bands and threads. The block must stay until the end.
///
/// Errors: those of taut_cloth_bands_memory, TAUT_ERROR_BLOCK_TOO_SMALL, TAUT_ERROR_NO_STIFFNESS. Then nothing was begun.
/// Threads: changes the cloth.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_cloth_bands_begin(
    cloth: *mut ClothHandle,
    rows_per_band: u32,
    block: *mut c_void,
    block_size: usize,
    out: *mut *mut BandsHandle,
) -> Code {
    // SAFETY: the caller hands in a cloth that nobody else uses until the end of the frame, a block of his own and a place
    // for the answer.
    unsafe {
        change(cloth, |cloth| {
            let out = Out::new(out)?;
            let handle = block.cast::<BandsHandle>();
            array_mut(handle, 0)?;
            let numbers = cloth.bands_memory(rows_per_band as usize)?;
            if block_size < bytes(numbers)? {
                return Err(Code::TAUT_ERROR_BLOCK_TOO_SMALL);
            }
            if !cloth.has_stiffness() {
                return Err(Code::TAUT_ERROR_NO_STIFFNESS);
            }
            let first = block.cast::<u8>().add(HEADER_BYTES).cast::<f32>();
            // fresh memory may be uninitialised
            first.write_bytes(0, numbers);
            // SAFETY: cloth and block live until the end of the frame, as the caller promises.
            let cloth = &mut *core::ptr::from_mut(cloth);
            let bands = cloth.bands(rows_per_band as usize, core::slice::from_raw_parts_mut(first, numbers))?;
            handle.write(BandsHandle { magic: MAGIC ^ handle.addr() as u64, bands });
            out.set(handle);
            Ok(())
        })
    }
}

/// How many bands there are, and how many phases: 0 where there is nothing to step, as in a cloth that sleeps.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE.
/// Threads: any, also several at a time.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_bands_count(
    bands: *const BandsHandle,
    out_bands: *mut u32,
    out_phases: *mut u32,
) -> Code {
    answer(|| {
        // SAFETY: the caller lends bands and places for the answers.
        let (out_bands, out_phases) = unsafe {
            check(bands)?;
            (Out::new(out_bands)?, Out::new(out_phases)?)
        };
        // SAFETY: made by `taut_cloth_bands_begin`, as the magic number tells.
        let bands = unsafe { &(*bands).bands };
        out_bands.set(bands.count());
        out_phases.set(bands.phases());
        Ok(())
    })
}

/// Steps one band through one phase, both counted from 0. All bands of a phase may run at the same time, in any order; a
/// phase begins when all bands have ended the one before, which a job system sees to (a barrier, a counter). What comes too
/// early or twice is refused.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_OUT_OF_RANGE (no such band; not the
/// band's next phase; a band has yet to end the phase before). Then nothing was done.
/// Threads: any, also several at a time.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_bands_run(bands: *const BandsHandle, phase: u32, band: u32) -> Code {
    answer(|| {
        // SAFETY: the caller lends bands that were begun and not ended, as the magic number tells.
        let bands = unsafe {
            check(bands)?;
            &(*bands).bands
        };
        Ok(bands.run(phase, band)?)
    })
}

/// Ends the frame; the handle is none any more. out_flags, which may be NULL, gets the TAUT_STEP_* of taut_cloth_step.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_OUT_OF_RANGE (a band has phases to
/// go: then the particles are taken back to where they were before the frame, and the handle is none any more either).
/// Threads: changes the cloth.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_bands_end(bands: *mut BandsHandle, out_flags: *mut u32) -> Code {
    answer(|| {
        // SAFETY: the caller hands in bands that nobody else uses, and a place for the answer or NULL. They are taken out
        // once: the magic number goes.
        let (out, bands) = unsafe {
            check(bands)?;
            let out = Out::optional(out_flags)?;
            (*bands).magic = 0;
            (out, core::ptr::read(&raw const (*bands).bands))
        };
        out.set(bands.end()?.0);
        Ok(())
    })
}
