use crate::result::{Code, answer};

/// Version of this header and library, as in 1.2.3.
pub const TAUT_VERSION_MAJOR: u32 = 0;
/// Second number of the version. While the first one is 0, a change of it may break programs.
pub const TAUT_VERSION_MINOR: u32 = 1;
/// Third number of the version.
pub const TAUT_VERSION_PATCH: u32 = 0;

// The numbers are spelled out for the header, and must be those of the package.
const _: () = {
    assert!(TAUT_VERSION_MAJOR == number(env!("CARGO_PKG_VERSION_MAJOR")));
    assert!(TAUT_VERSION_MINOR == number(env!("CARGO_PKG_VERSION_MINOR")));
    assert!(TAUT_VERSION_PATCH == number(env!("CARGO_PKG_VERSION_PATCH")));
};

const fn number(text: &str) -> u32 {
    let bytes = text.as_bytes();
    let (mut value, mut i) = (0, 0);
    while i < bytes.len() {
        value = 10 * value + (bytes[i] - b'0') as u32;
        i += 1;
    }
    value
}

const fn id(major: u32, minor: u32, patch: u32) -> u32 {
    major << 24 | minor << 16 | patch
}

/// The version of the library that runs, in the form of TAUT_VERSION_ID: major << 24 | minor << 16 | patch.
///
/// Threads: any.
#[unsafe(no_mangle)]
pub extern "C" fn taut_version() -> u32 {
    id(TAUT_VERSION_MAJOR, TAUT_VERSION_MINOR, TAUT_VERSION_PATCH)
}

/// Whether a program that was compiled with this header may use the library that it found at run time: call
/// taut_check_version(TAUT_VERSION_ID) first. Before 1.0 the first two numbers must be equal; from then on the first one
/// must be equal and the library's second one must not be smaller.
///
/// Errors: TAUT_ERROR_VERSION_MISMATCH; taut_version() tells what was found.
/// Threads: any.
#[unsafe(no_mangle)]
pub extern "C" fn taut_check_version(version_id: u32) -> Code {
    answer(|| if fits(taut_version(), version_id) { Ok(()) } else { Err(Code::TAUT_ERROR_VERSION_MISMATCH) })
}

/// Whether a library of the version `have` serves a program compiled for `want`.
fn fits(have: u32, want: u32) -> bool {
    let parts = |v: u32| (v >> 24, v >> 16 & 0xff);
    let ((have_major, have_minor), (want_major, want_minor)) = (parts(have), parts(want));
    have_major == want_major && if have_major == 0 { have_minor == want_minor } else { have_minor >= want_minor }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_fit_as_documented() {
        assert!(fits(id(0, 1, 0), id(0, 1, 7)));
        assert!(!fits(id(0, 2, 0), id(0, 1, 0)));
        assert!(!fits(id(0, 1, 0), id(0, 2, 0)));
        assert!(fits(id(1, 4, 0), id(1, 2, 9)));
        assert!(!fits(id(1, 1, 0), id(1, 2, 0)));
        assert!(!fits(id(2, 0, 0), id(1, 0, 0)));
        assert_eq!(taut_check_version(taut_version()), Code::TAUT_OK);
    }
}
