use crate::handle::{ClothHandle, change};
use crate::pointer::array;
use crate::result::Code;

/// Chooses which particles exist, by a byte for each of the count particles: 0 is absent, everything else is present. Needs
/// TAUT_FEATURE_MASK; at first all are present. May be called at any time, so a cloth can tear.
///
/// An absent particle has no springs, no weight and no pin, and is left out of strain and energy; its position stays where
/// it last was, and one that comes back is there at rest. A bend spring also needs the particle in its middle, a diagonal one
/// of the two other corners of its cell. taut_cloth_reset keeps the mask and a snapshot does not hold it, but a snapshot that
/// was taken under another mask is TAUT_ERROR_FOREIGN. All or nothing.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_FEATURE_OFF, TAUT_ERROR_SHAPE
/// (count is not the number of particles).
/// Threads: changes the cloth.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_cloth_set_mask(cloth: *mut ClothHandle, count: u32, present: *const u8) -> Code {
    // SAFETY: the caller hands in a cloth that nobody else uses, and lends `count` bytes. The count is checked before the
    // array is trusted.
    unsafe {
        change(cloth, |cloth| {
            if count as usize != cloth.grid().particles() {
                return Err(Code::TAUT_ERROR_SHAPE);
            }
            Ok(cloth.set_mask(array(present, count as usize)?)?)
        })
    }
}

/// Sets the mass of each of the count particles in kg, 1e-6 to 1e6 times its share of the sheet's mass (density times width
/// times height over the number of particles), which is what each has at first. Needs TAUT_FEATURE_MASS. Velocities stay as
/// they are. taut_cloth_reset keeps the masses and a snapshot does not hold them, but a snapshot that was taken with other
/// masses is TAUT_ERROR_FOREIGN. All or nothing.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_FEATURE_OFF, TAUT_ERROR_SHAPE
/// (count is not the number of particles), TAUT_ERROR_NOT_FINITE, TAUT_ERROR_NEGATIVE, TAUT_ERROR_OUT_OF_RANGE.
/// Threads: changes the cloth.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_cloth_set_masses(cloth: *mut ClothHandle, count: u32, mass_kg: *const f32) -> Code {
    // SAFETY: the caller hands in a cloth that nobody else uses, and lends `count` numbers. The count is checked before the
    // array is trusted.
    unsafe {
        change(cloth, |cloth| {
            if count as usize != cloth.grid().particles() {
                return Err(Code::TAUT_ERROR_SHAPE);
            }
            Ok(cloth.set_masses(array(mass_kg, count as usize)?)?)
        })
    }
}
