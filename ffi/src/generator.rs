//! The generator in C: include/taut_generator.h is generated from this file, with the feature `generator`.

use core::cell::RefCell;
use core::ffi::{CStr, c_char, c_void};
use std::borrow::ToOwned;
use std::boxed::Box;
use std::format;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::string::{String, ToString};
use std::vec::Vec;

use taut_onnx::{Correction, Error, Generator, Request};

use crate::handle::{self, GridHandle};
use crate::pointer::{Out, array, array_mut, value};
use crate::result::{Code, answer};
use crate::types::Fabric;

const MAGIC: u64 = 0x6e65_6774_7561_7421;

/// Longest description and path in bytes.
const MOST_TEXT: usize = 16 << 10;

/// A generator that was read: words in, a stiffness field out. It never changes, and any number of threads may use it at a
/// time.
pub struct GeneratorHandle {
    magic: u64,
    generator: Generator,
}

std::thread_local! {
    /// What the last call of this thread had to say.
    static SAID: RefCell<String> = const { RefCell::new(String::new()) };
}

fn say(text: &str) {
    SAID.with_borrow_mut(|said| {
        said.clear();
        said.push_str(text);
    });
}

/// Runs the body of a call: what it has to say is kept for `taut_generator_last_error`, and a panic stays inside.
fn guarded(body: impl FnOnce() -> Result<(), Code>) -> Code {
    say("");
    let code = answer(|| {
        catch_unwind(AssertUnwindSafe(body)).unwrap_or_else(|_| {
            say("the generator panicked: please report it");
            Err(Code::TAUT_ERROR_INFERENCE)
        })
    });
    if code != Code::TAUT_OK && SAID.with_borrow(String::is_empty) {
        let row = crate::result::message_of(code);
        say(row);
    }
    code
}

/// Keeps the text of an error and gives its code.
fn refuse(e: &Error) -> Code {
    say(&e.to_string());
    match e {
        Error::Io { .. } => Code::TAUT_ERROR_FILE,
        Error::Truncated { .. } => Code::TAUT_ERROR_TRUNCATED,
        Error::NoKnownWord { .. } => Code::TAUT_ERROR_NO_KNOWN_WORD,
        Error::TooLarge { .. } | Error::LongDescription { .. } => Code::TAUT_ERROR_OUT_OF_RANGE,
        Error::GridSize { .. } => Code::TAUT_ERROR_GRID_SIZE,
        Error::SideLength { .. } => Code::TAUT_ERROR_SIDE_LENGTH,
        Error::Pin { .. } => Code::TAUT_ERROR_NO_SUCH_PARTICLE,
        Error::Inference { .. } | Error::Output { .. } => Code::TAUT_ERROR_INFERENCE,
        Error::Weights { .. } => Code::TAUT_ERROR_NOT_FINITE,
        Error::Baked(e) => Code::from(*e),
        // metadata, operations, graph and shapes: not a generator file
        _ => Code::TAUT_ERROR_WRONG_KIND,
    }
}

/// A text of C.
///
/// # Safety
/// `text` is NULL or points to bytes that end with NUL and live during `'a`.
unsafe fn text<'a>(text: *const c_char, what: &str) -> Result<&'a str, Code> {
    if text.is_null() {
        return Err(Code::TAUT_ERROR_NULL_POINTER);
    }
    // SAFETY: not NULL; the rest is what the caller promises.
    let bytes = unsafe { CStr::from_ptr(text) };
    if bytes.count_bytes() > MOST_TEXT {
        say(&format!("the {what} is longer than {MOST_TEXT} bytes"));
        return Err(Code::TAUT_ERROR_OUT_OF_RANGE);
    }
    bytes.to_str().map_err(|_| {
        say(&format!("the {what} is not UTF-8"));
        Code::TAUT_ERROR_WRONG_KIND
    })
}

/// The generator of a handle.
///
/// # Safety
/// `handle` is NULL, misaligned, or came from `taut_generator_load` and was not freed.
unsafe fn held_by<'a>(handle: *const GeneratorHandle) -> Result<&'a GeneratorHandle, Code> {
    // SAFETY: what the caller promises.
    let handle = unsafe { value(handle) }?;
    if handle.magic == MAGIC { Ok(handle) } else { Err(Code::TAUT_ERROR_BAD_HANDLE) }
}

fn hand_out(generator: Generator, out: Out<*mut GeneratorHandle>) {
    out.set(Box::into_raw(Box::new(GeneratorHandle { magic: MAGIC, generator })));
}

/// Reads a generator from the bytes of its file (generator.onnx), which are not kept. Takes memory from the system's heap,
/// unlike everything in taut.h; free it with taut_generator_free.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_TRUNCATED, TAUT_ERROR_WRONG_KIND (not a generator
/// file), TAUT_ERROR_NOT_FINITE (a weight), TAUT_ERROR_OUT_OF_RANGE (above 64 MiB), TAUT_ERROR_INFERENCE.
/// Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_generator_load(
    data: *const c_void,
    size: usize,
    out_generator: *mut *mut GeneratorHandle,
) -> Code {
    guarded(|| {
        // SAFETY: the caller lends `size` bytes and a place for the answer.
        let (bytes, out) = unsafe { (array(data.cast::<u8>(), size)?, Out::new(out_generator)?) };
        hand_out(Generator::from_bytes(bytes).map_err(|e| refuse(&e))?, out);
        Ok(())
    })
}

/// The same from a file of this path (UTF-8).
///
/// Errors: those of taut_generator_load, TAUT_ERROR_FILE.
/// Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_generator_load_file(
    path: *const c_char,
    out_generator: *mut *mut GeneratorHandle,
) -> Code {
    guarded(|| {
        // SAFETY: the caller lends a text and a place for the answer.
        let (path, out) = unsafe { (text(path, "path")?, Out::new(out_generator)?) };
        hand_out(Generator::load(path).map_err(|e| refuse(&e))?, out);
        Ok(())
    })
}

/// What a generator file says of itself.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct GeneratorInfo {
    /// Words that it knows.
    pub words: u64,
    /// Weights of the network.
    pub parameters: u64,
    /// Bytes of the file.
    pub file_bytes: u64,
    /// Particles along each side of its own field, before it is resampled.
    pub grid: u32,
    /// Words of a description that count at most.
    pub tokens: u32,
}

/// Tells what a generator is.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE.
/// Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_generator_info(generator: *const GeneratorHandle, out: *mut GeneratorInfo) -> Code {
    guarded(|| {
        // SAFETY: the caller lends a generator and a place for the answer.
        let (held, out) = unsafe { (held_by(generator)?, Out::new(out)?) };
        let info = held.generator.info();
        out.set(GeneratorInfo {
            words: info.words as u64,
            parameters: info.parameters as u64,
            file_bytes: info.file_bytes as u64,
            grid: info.grid as u32,
            tokens: info.tokens as u32,
        });
        Ok(())
    })
}

/// What a field is asked for.
///
/// # Safety
/// As the functions below ask of their arguments.
unsafe fn correction(
    generator: *const GeneratorHandle,
    description: *const c_char,
    seed: u64,
    grid: *const GridHandle,
    pins: *const u32,
    pin_count: usize,
) -> Result<Correction, Code> {
    // SAFETY: the caller lends all of these.
    let (held, description, grid) =
        unsafe { (held_by(generator)?, text(description, "description")?, handle::grid(grid)?) };
    let pins = match pin_count {
        0 => &[],
        // SAFETY: the caller lends so many numbers.
        n => unsafe { array(pins, n)? },
    };
    let columns = grid.columns();
    let places: Vec<(usize, usize)> = pins.iter().map(|p| (*p as usize / columns, *p as usize % columns)).collect();
    let request = Request {
        description,
        seed,
        rows: grid.rows(),
        columns,
        width_m: grid.def().width_m,
        height_m: grid.def().height_m,
        pins: &places,
    };
    let correction = held.generator.correct(&request).map_err(|e| refuse(&e))?;
    let skipped: Vec<&str> =
        correction.unknown_words.iter().chain(&correction.dropped_words).map(String::as_str).collect();
    if !skipped.is_empty() {
        say(&format!("words that do not count: {}", skipped.join(", ")));
    }
    Ok(correction)
}

/// The stiffness field of a fabric in words (UTF-8) for a grid and its pins, pin_count particles: 4 x rows x columns numbers
/// in N/m, channels warp, weft, shear, bend, as taut_cloth_set_stiffness_field takes them. Another seed is another piece of
/// the same fabric. What the words tell of the fabric goes to out_fabric, which may be NULL. The same arguments give the same
/// bytes on one machine, and fields within 1e-5 on another: where machines must agree, ship what taut_generator_bake writes.
/// Takes some milliseconds and memory of the heap: call it while a level is loaded. Words that the generator does not know
/// are skipped; taut_generator_last_error names them.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_SHAPE (count is not
/// 4 rows columns), TAUT_ERROR_WRONG_KIND (not UTF-8), TAUT_ERROR_NO_KNOWN_WORD, TAUT_ERROR_OUT_OF_RANGE (above 16 kB),
/// TAUT_ERROR_NO_SUCH_PARTICLE, TAUT_ERROR_INFERENCE.
/// Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_generator_correct(
    generator: *const GeneratorHandle,
    description: *const c_char,
    seed: u64,
    grid: *const GridHandle,
    pins: *const u32,
    pin_count: usize,
    out_field: *mut f32,
    count: usize,
    out_fabric: *mut Fabric,
) -> Code {
    guarded(|| {
        // SAFETY: the caller lends `count` numbers for writing and a place for the fabric or NULL.
        let (field, out) = unsafe { (array_mut(out_field, count)?, Out::optional(out_fabric)?) };
        // SAFETY: the caller lends the rest.
        let correction = unsafe { correction(generator, description, seed, grid, pins, pin_count) }?;
        if correction.field.len() != field.len() {
            say(&format!("the field has {} numbers, not {count}", correction.field.len()));
            return Err(Code::TAUT_ERROR_SHAPE);
        }
        field.iter_mut().zip(&correction.field).for_each(|(to, from)| *to = *from);
        out.set(correction.fabric().into());
        Ok(())
    })
}

/// The same as the bytes of a baked field file, which taut_cloth_load_stiffness reads: small, exact, the same everywhere.
/// Writes at most capacity bytes; out_size is told how many it has, and may be asked for alone with data NULL and capacity 0.
///
/// Errors: those of taut_generator_correct without TAUT_ERROR_SHAPE, TAUT_ERROR_BLOCK_TOO_SMALL (more than capacity; then
/// out_size is told nothing).
/// Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_generator_bake(
    generator: *const GeneratorHandle,
    description: *const c_char,
    seed: u64,
    grid: *const GridHandle,
    pins: *const u32,
    pin_count: usize,
    data: *mut c_void,
    capacity: usize,
    out_size: *mut usize,
) -> Code {
    guarded(|| {
        // SAFETY: the caller lends a place for the answer.
        let out = unsafe { Out::new(out_size)? };
        let place = match (data.is_null(), capacity) {
            (true, 0) => None,
            // SAFETY: the caller lends so many bytes for writing.
            _ => Some(unsafe { array_mut(data.cast::<u8>(), capacity)? }),
        };
        // SAFETY: the caller lends the rest.
        let correction = unsafe { correction(generator, description, seed, grid, pins, pin_count) }?;
        let skipped = SAID.with_borrow(ToOwned::to_owned);
        let bytes = correction.to_baked().map_err(|e| refuse(&e))?;
        if let Some(place) = place {
            let size = bytes.len();
            let to = place.get_mut(..size).ok_or_else(|| {
                say(&format!("the file has {size} bytes, there is room for {capacity}"));
                Code::TAUT_ERROR_BLOCK_TOO_SMALL
            })?;
            to.copy_from_slice(&bytes);
        }
        out.set(bytes.len());
        say(&skipped);
        Ok(())
    })
}

/// One line about the last call of this thread to a function of this header: why it failed; where it answered TAUT_OK, the
/// words that it skipped, or nothing. Writes at most size bytes with the NUL, cut where that is too few, and gives the bytes
/// that the whole line has without it. buffer may be NULL with size 0.
///
/// Threads: any; each has its own line.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_generator_last_error(buffer: *mut c_char, size: usize) -> usize {
    SAID.with_borrow(|said| {
        // SAFETY: the caller lends `size` bytes for writing, or NULL.
        if let Ok(place) = unsafe { array_mut(buffer.cast::<u8>(), size) } {
            let mut end = said.len().min(size.saturating_sub(1));
            while !said.is_char_boundary(end) {
                end -= 1;
            }
            if let Some((text, rest)) = place.split_at_mut_checked(end) {
                text.copy_from_slice(&said.as_bytes()[..end]);
                rest.iter_mut().take(1).for_each(|nul| *nul = 0);
            }
        }
        said.len()
    })
}

/// Frees a generator. NULL is nothing to free.
///
/// Threads: needs the generator for itself.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_generator_free(generator: *mut GeneratorHandle) {
    // SAFETY: what the caller promises of a handle.
    if unsafe { held_by(generator) }.is_ok() {
        // SAFETY: the magic number tells that `hand_out` made it; it is taken away so that a second call frees nothing while
        // the memory is not used again.
        unsafe {
            (*generator).magic = 0;
            drop(Box::from_raw(generator));
        }
    }
}
