use taut_core::field::FieldView;

use crate::handle::{ClothHandle, change};
use crate::pointer::{Out, array};
use crate::result::Code;
use crate::types::{BudgetReport, Fabric, TAUT_MAX_SIDE};

/// Sets one stiffness for the whole cloth, in N/m, each at least 0: warp (along v), weft (along u), shear, bend. What the
/// step cannot carry is cut by the budget, with the ratios kept.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_NOT_FINITE,
/// TAUT_ERROR_NEGATIVE. Then the former stiffness stays.
/// Threads: changes the cloth.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_cloth_set_stiffness_uniform(
    cloth: *mut ClothHandle,
    warp_n_m: f32,
    weft_n_m: f32,
    shear_n_m: f32,
    bend_n_m: f32,
) -> Code {
    let k = [warp_n_m, weft_n_m, shear_n_m, bend_n_m];
    // SAFETY: the caller hands in a cloth that nobody else uses.
    unsafe { change(cloth, |cloth| Ok(cloth.set_stiffness_uniform(k)?)) }
}

/// The field of an array in C.
///
/// # Safety
/// As [`array`], for channels * rows * columns numbers where these are as the header asks.
unsafe fn lent<'a>(
    channels: u32,
    rows: u32,
    columns: u32,
    data: *const f32,
    make: fn(usize, usize, usize, &'a [f32]) -> Result<FieldView<'a>, taut_core::Error>,
) -> Result<FieldView<'a>, Code> {
    // the sizes are checked before the array is trusted
    if rows > TAUT_MAX_SIDE || columns > TAUT_MAX_SIDE {
        return Err(Code::TAUT_ERROR_GRID_SIZE);
    }
    if channels != 1 && channels != 4 {
        return Err(Code::TAUT_ERROR_SHAPE);
    }
    let (channels, rows, columns) = (channels as usize, rows as usize, columns as usize);
    // SAFETY: promised by the caller.
    let data = unsafe { array(data, channels * rows * columns) }?;
    Ok(make(channels, rows, columns, data)?)
}

/// Sets the stiffness field: channels * rows * columns numbers in N/m, each at least 0, as [channel][row][column], at the
/// particles; a spring has the mean of its two ends. 4 channels are warp, weft, shear, bend; 1 channel stands for all four in
/// the ratios 1, 1, 0.3, 0.02. Rows and columns, 2 to 4096 each, need not be those of the grid: the field is resampled.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_GRID_SIZE, TAUT_ERROR_SHAPE
/// (channels), TAUT_ERROR_NOT_FINITE, TAUT_ERROR_NEGATIVE. Then the former stiffness stays.
/// Threads: changes the cloth.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_cloth_set_stiffness_field(
    cloth: *mut ClothHandle,
    channels: u32,
    rows: u32,
    columns: u32,
    data: *const f32,
) -> Code {
    // SAFETY: the caller hands in a cloth that nobody else uses, and lends an array of the size that he names.
    unsafe {
        change(cloth, |cloth| {
            cloth.set_stiffness_field(&lent(channels, rows, columns, data, FieldView::new)?);
            Ok(())
        })
    }
}

/// The same for numbers that nobody vouches for, such as those that a network printed: every field of the right shape is
/// taken. NaN and negative numbers are read as 0, what is above 1e9 (infinity too) as 1e9. What the step cannot carry is cut
/// by the budget, as always. How many numbers were read otherwise than they stand goes to out_repaired, which may be NULL.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_GRID_SIZE, TAUT_ERROR_SHAPE
/// (channels). Then the former stiffness stays.
/// Threads: changes the cloth.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_cloth_set_stiffness_field_sanitised(
    cloth: *mut ClothHandle,
    channels: u32,
    rows: u32,
    columns: u32,
    data: *const f32,
    out_repaired: *mut u32,
) -> Code {
    // SAFETY: the caller hands in a cloth that nobody else uses, lends an array of the size that he names, and a place for
    // the answer or NULL.
    unsafe {
        change(cloth, |cloth| {
            let out = Out::optional(out_repaired)?;
            let field = lent(channels, rows, columns, data, FieldView::sanitised)?;
            cloth.set_stiffness_field(&field);
            out.set(field.repaired() as u32);
            Ok(())
        })
    }
}

/// Sets the stiffness from a baked field file of size bytes, resampled where its grid is another. What the file tells about
/// the fabric goes to out_fabric, which may be NULL.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, and those of taut_field_info. Then the
/// former stiffness stays.
/// Threads: changes the cloth.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_cloth_load_stiffness(
    cloth: *mut ClothHandle,
    data: *const core::ffi::c_void,
    size: usize,
    out_fabric: *mut Fabric,
) -> Code {
    // SAFETY: the caller hands in a cloth that nobody else uses, lends `size` bytes, and a place for the answer or NULL.
    unsafe {
        change(cloth, |cloth| {
            let (bytes, out) = (array(data.cast::<u8>(), size)?, Out::optional(out_fabric)?);
            out.set(cloth.load_stiffness(bytes)?.into());
            Ok(())
        })
    }
}

/// The report of taut_cloth_budget with the stretch to expect, and a sharper bound where that is known. The rest of a sheet that
/// hangs from an edge is searched for, which takes from milliseconds at 16 x 16 to seconds at 64 x 64: for a loading screen,
/// not for a frame.
///
/// Errors: those of taut_cloth_budget.
/// Threads: changes the cloth.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_cloth_predict_stretch(cloth: *mut ClothHandle, out: *mut BudgetReport) -> Code {
    // SAFETY: the caller hands in a cloth that nobody else uses, and a place for the answer.
    unsafe {
        change(cloth, |cloth| {
            let out = Out::new(out)?;
            out.set(cloth.predict_stretch()?.into());
            Ok(())
        })
    }
}

/// What the budget makes of the stiffness with the pins as they are, and the bound of the stretch: told before the first
/// step, and kept. What stretch to expect: taut_cloth_predict_stretch.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_NO_STIFFNESS.
/// Threads: changes the cloth.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_cloth_budget(cloth: *mut ClothHandle, out: *mut BudgetReport) -> Code {
    // SAFETY: the caller hands in a cloth that nobody else uses, and a place for the answer.
    unsafe {
        change(cloth, |cloth| {
            let out = Out::new(out)?;
            out.set(cloth.budget()?.into());
            Ok(())
        })
    }
}
