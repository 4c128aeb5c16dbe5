use core::ffi::{CStr, c_char};

use taut_core::Error;

/// What a call answers: 0 is success, everything else is negative. A number keeps its meaning for good; new ones are only
/// appended. A call that answers with an error has changed nothing and written nothing.
#[allow(non_camel_case_types, reason = "these are the names in C")]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(i32)]
pub enum Code {
    /// Done.
    TAUT_OK = 0,
    /// A pointer is NULL.
    TAUT_ERROR_NULL_POINTER = -1,
    /// A pointer or the block of memory is not aligned as was asked for.
    TAUT_ERROR_MISALIGNED = -2,
    /// The block of memory is smaller than was asked for.
    TAUT_ERROR_BLOCK_TOO_SMALL = -3,
    /// A definition was not made by its default function, or belongs to another version (its size or cookie is wrong).
    TAUT_ERROR_BAD_DEFINITION = -4,
    /// A grid side has fewer than 2 or more than 4096 particles.
    TAUT_ERROR_GRID_SIZE = -5,
    /// A side length is not finite, not above 0, or above 10 km.
    TAUT_ERROR_SIDE_LENGTH = -6,
    /// The frame rate is not within 1 to 10,000 Hz, or the substeps are not within 1 to 1,024.
    TAUT_ERROR_STEP_SIZE = -7,
    /// A number that must be finite is NaN or infinite.
    TAUT_ERROR_NOT_FINITE = -8,
    /// A number that must not be negative is negative.
    TAUT_ERROR_NEGATIVE = -9,
    /// A number is outside the range that its documentation gives.
    TAUT_ERROR_OUT_OF_RANGE = -10,
    /// There is no particle of this index.
    TAUT_ERROR_NO_SUCH_PARTICLE = -11,
    /// The particle is not pinned.
    TAUT_ERROR_NOT_PINNED = -12,
    /// More pins than max_pins of the definition.
    TAUT_ERROR_TOO_MANY_PINS = -13,
    /// The feature was not asked for in the definition, so it has no memory.
    TAUT_ERROR_FEATURE_OFF = -14,
    /// The stiffness was never set.
    TAUT_ERROR_NO_STIFFNESS = -15,
    /// An array has another shape than the call needs.
    TAUT_ERROR_SHAPE = -16,
    /// The bytes end early.
    TAUT_ERROR_TRUNCATED = -17,
    /// The bytes are not of the expected kind.
    TAUT_ERROR_WRONG_KIND = -18,
    /// The bytes were written by a version that this one cannot read.
    TAUT_ERROR_UNSUPPORTED_VERSION = -19,
    /// The bytes were changed: their checksum does not match.
    TAUT_ERROR_CHECKSUM = -20,
    /// The snapshot belongs to a cloth of another grid or definition.
    TAUT_ERROR_FOREIGN = -21,
    /// The damping is too strong for the step: damping times dt must stay below 1.
    TAUT_ERROR_DAMPING = -22,
    /// The program was compiled with the header of another version.
    TAUT_ERROR_VERSION_MISMATCH = -23,
    /// This machine lacks the vector width.
    TAUT_ERROR_UNSUPPORTED_WIDTH = -24,
    /// The particle is absent: the mask says so.
    TAUT_ERROR_ABSENT = -25,
    /// There is no collider of this id (any more).
    TAUT_ERROR_NO_SUCH_COLLIDER = -26,
    /// There are TAUT_MAX_COLLIDERS colliders already.
    TAUT_ERROR_TOO_MANY_COLLIDERS = -27,
    /// Not even the cheapest settings fit the time.
    TAUT_ERROR_NO_PLAN = -28,
    /// The handle was not made by its create function, its block was overwritten, or the block was moved. Codes from -100
    /// on exist in C only.
    TAUT_ERROR_BAD_HANDLE = -100,
    /// A file cannot be opened or read (taut_generator.h).
    TAUT_ERROR_FILE = -101,
    /// The generator knows no word of the description (taut_generator.h).
    TAUT_ERROR_NO_KNOWN_WORD = -102,
    /// The network of a generator file cannot be run, or answers with what is no stiffness (taut_generator.h).
    TAUT_ERROR_INFERENCE = -103,
}

use Code::*;

/// A code, its name and its message with the NUL that C needs.
type Row = (Code, &'static CStr, &'static [u8]);

/// A message of core with a NUL behind it.
macro_rules! message {
    ($text:expr) => {{
        const TEXT: &str = $text;
        const BYTES: [u8; TEXT.len() + 1] = terminated(TEXT);
        &BYTES
    }};
}

macro_rules! rows {
    ($($code:ident $name:literal $error:ident,)*) => {
        /// The codes of core, in the order of [`Error::ALL`].
        const CORE: &[Row] = &[$(($code, $name, message!(Error::$error.message())),)*];
    };
}

rows! {
    TAUT_ERROR_NULL_POINTER c"TAUT_ERROR_NULL_POINTER" NullPointer,
    TAUT_ERROR_MISALIGNED c"TAUT_ERROR_MISALIGNED" Misaligned,
    TAUT_ERROR_BLOCK_TOO_SMALL c"TAUT_ERROR_BLOCK_TOO_SMALL" BlockTooSmall,
    TAUT_ERROR_BAD_DEFINITION c"TAUT_ERROR_BAD_DEFINITION" BadDefinition,
    TAUT_ERROR_GRID_SIZE c"TAUT_ERROR_GRID_SIZE" GridSize,
    TAUT_ERROR_SIDE_LENGTH c"TAUT_ERROR_SIDE_LENGTH" SideLength,
    TAUT_ERROR_STEP_SIZE c"TAUT_ERROR_STEP_SIZE" StepSize,
    TAUT_ERROR_NOT_FINITE c"TAUT_ERROR_NOT_FINITE" NotFinite,
    TAUT_ERROR_NEGATIVE c"TAUT_ERROR_NEGATIVE" Negative,
    TAUT_ERROR_OUT_OF_RANGE c"TAUT_ERROR_OUT_OF_RANGE" OutOfRange,
    TAUT_ERROR_NO_SUCH_PARTICLE c"TAUT_ERROR_NO_SUCH_PARTICLE" NoSuchParticle,
    TAUT_ERROR_NOT_PINNED c"TAUT_ERROR_NOT_PINNED" NotPinned,
    TAUT_ERROR_TOO_MANY_PINS c"TAUT_ERROR_TOO_MANY_PINS" TooManyPins,
    TAUT_ERROR_FEATURE_OFF c"TAUT_ERROR_FEATURE_OFF" FeatureOff,
    TAUT_ERROR_NO_STIFFNESS c"TAUT_ERROR_NO_STIFFNESS" NoStiffness,
    TAUT_ERROR_SHAPE c"TAUT_ERROR_SHAPE" Shape,
    TAUT_ERROR_TRUNCATED c"TAUT_ERROR_TRUNCATED" Truncated,
    TAUT_ERROR_WRONG_KIND c"TAUT_ERROR_WRONG_KIND" WrongKind,
    TAUT_ERROR_UNSUPPORTED_VERSION c"TAUT_ERROR_UNSUPPORTED_VERSION" UnsupportedVersion,
    TAUT_ERROR_CHECKSUM c"TAUT_ERROR_CHECKSUM" Checksum,
    TAUT_ERROR_FOREIGN c"TAUT_ERROR_FOREIGN" Foreign,
    TAUT_ERROR_DAMPING c"TAUT_ERROR_DAMPING" Damping,
    TAUT_ERROR_VERSION_MISMATCH c"TAUT_ERROR_VERSION_MISMATCH" VersionMismatch,
    TAUT_ERROR_UNSUPPORTED_WIDTH c"TAUT_ERROR_UNSUPPORTED_WIDTH" UnsupportedWidth,
    TAUT_ERROR_ABSENT c"TAUT_ERROR_ABSENT" Absent,
    TAUT_ERROR_NO_SUCH_COLLIDER c"TAUT_ERROR_NO_SUCH_COLLIDER" NoSuchCollider,
    TAUT_ERROR_TOO_MANY_COLLIDERS c"TAUT_ERROR_TOO_MANY_COLLIDERS" TooManyColliders,
    TAUT_ERROR_NO_PLAN c"TAUT_ERROR_NO_PLAN" NoPlan,
}

/// The codes that only C has.
const OWN: &[Row] = &[
    (TAUT_OK, c"TAUT_OK", message!("done")),
    (
        TAUT_ERROR_BAD_HANDLE,
        c"TAUT_ERROR_BAD_HANDLE",
        message!("the handle was not made by its create function or its block was overwritten or moved"),
    ),
    (TAUT_ERROR_FILE, c"TAUT_ERROR_FILE", message!("the file cannot be opened or read")),
    (TAUT_ERROR_NO_KNOWN_WORD, c"TAUT_ERROR_NO_KNOWN_WORD", message!("the generator knows no word of the description")),
    (TAUT_ERROR_INFERENCE, c"TAUT_ERROR_INFERENCE", message!("the network of the generator file cannot be run")),
];

// An error that core appends must be appended here too: without it this crate does not compile.
const _: () = {
    assert!(CORE.len() == Error::ALL.len());
    let mut i = 0;
    while i < CORE.len() {
        assert!(CORE[i].0 as i32 == Error::ALL[i].code());
        assert!(Error::ALL[i].code() == -1 - i as i32);
        i += 1;
    }
};

const fn terminated<const N: usize>(text: &str) -> [u8; N] {
    let mut bytes = [0; N];
    let mut i = 0;
    while i + 1 < N {
        bytes[i] = text.as_bytes()[i];
        i += 1;
    }
    bytes
}

impl From<Error> for Code {
    fn from(error: Error) -> Code {
        let place = (-1 - error.code()) as usize;
        CORE.get(place).map_or(TAUT_ERROR_VERSION_MISMATCH, |r| r.0)
    }
}

/// Runs the body of a call.
#[inline(always)]
pub(crate) fn answer(body: impl FnOnce() -> Result<(), Code>) -> Code {
    match body() {
        Ok(()) => TAUT_OK,
        Err(code) => code,
    }
}

fn row(code: i32) -> Option<&'static Row> {
    CORE.iter().chain(OWN).find(|r| r.0 as i32 == code)
}

/// The message of a code as a text.
#[allow(dead_code, reason = "the generator's functions alone use it")]
pub(crate) fn message_of(code: Code) -> &'static str {
    let text = row(code as i32).and_then(|r| r.2.split_last());
    text.and_then(|(_, text)| core::str::from_utf8(text).ok()).unwrap_or_default()
}

/// The name of a result as it stands in this header ("TAUT_ERROR_GRID_SIZE"), "TAUT_ERROR_UNKNOWN" for a number that is
/// no result. Never NULL; the text lives as long as the library.
///
/// Threads: any.
#[unsafe(no_mangle)]
pub extern "C" fn taut_result_name(result: i32) -> *const c_char {
    row(result).map_or(c"TAUT_ERROR_UNKNOWN", |r| r.1).as_ptr()
}

/// One line in English that says what a result means. Never NULL; the text lives as long as the library.
///
/// Threads: any.
#[unsafe(no_mangle)]
pub extern "C" fn taut_result_message(result: i32) -> *const c_char {
    row(result).map_or(c"this number is no result of taut".as_ptr(), |r| r.2.as_ptr().cast())
}
