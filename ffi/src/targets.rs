use core::ffi::c_void;

use taut_core::{Cloth, Target, TargetLimit, Vector3};

use crate::handle::{ClothHandle, change};
use crate::pointer::{Vectors, array, value};
use crate::result::Code;

/// Sets how far each of the count particles may be from its target; count is the number of particles of the grid. Needs
/// TAUT_FEATURE_TARGETS. max_distance_m is the largest distance in m, 0 to 1e6 or infinity (free, as before the first call);
/// with 0 the particle is where its target is. The backstop is a ball that the particle stays out of: its radius in m, 0 to
/// 1e6 (0 = none), and the distance of its surface behind the target, against the normal of the skin, 0 to 1e6 m; either may
/// be NULL, which means 0. All or nothing.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_FEATURE_OFF, TAUT_ERROR_SHAPE
/// (count), TAUT_ERROR_NOT_FINITE, TAUT_ERROR_NEGATIVE, TAUT_ERROR_OUT_OF_RANGE.
/// Threads: changes the cloth.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_cloth_set_target_limits(
    cloth: *mut ClothHandle,
    count: u32,
    max_distance_m: *const f32,
    backstop_radius_m: *const f32,
    backstop_distance_m: *const f32,
) -> Code {
    // SAFETY: the caller hands in a cloth that nobody else uses, and lends arrays of count numbers. The count is checked
    // before they are trusted.
    unsafe {
        change(cloth, |cloth| {
            let n = counted(cloth, count)?;
            let max_distance = array(max_distance_m, n)?;
            let optional = |p: *const f32| if p.is_null() { Ok(&[] as &[f32]) } else { array(p, n) };
            let (radius, distance) = (optional(backstop_radius_m)?, optional(backstop_distance_m)?);
            let number = |of: &[f32], i: usize| of.get(i).copied().unwrap_or(0.0);
            Ok(cloth.set_target_limits(|i| TargetLimit {
                max_distance_m: number(max_distance, i),
                backstop_radius_m: number(radius, i),
                backstop_distance_m: number(distance, i),
            })?)
        })
    }
}

/// Moves the targets of the count particles: at the end of the next frame they are there, and on the way they are
/// interpolated linearly over the substeps. Without a new call they then stay. Before the first call they are the places and
/// the normal of the flat cloth at its start.
///
/// positions_m holds x, y, z in m of each particle as floats, as seen from base_m, a point of the world in m; normals the
/// outward normals of the skin, 1e-3 to 1e3 long (0, 0, 0 keeps the last one), or NULL, which keeps them all. stride is the
/// bytes from a particle to the next in both, at least 12; neither need be aligned. All or nothing.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED (cloth, base_m), TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_FEATURE_OFF,
/// TAUT_ERROR_SHAPE (count, stride), TAUT_ERROR_NOT_FINITE, TAUT_ERROR_OUT_OF_RANGE (more than 1e6 m from the cloth's
/// origin, a normal of another length).
/// Threads: changes the cloth.
/// cbindgen:ptrs-as-arrays=[[base_m;3]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_cloth_move_targets(
    cloth: *mut ClothHandle,
    base_m: *const f64,
    count: u32,
    positions_m: *const c_void,
    normals: *const c_void,
    stride: usize,
) -> Code {
    // SAFETY: the caller promises what `put` needs.
    unsafe { put(cloth, base_m, (count, positions_m, normals, stride), false) }
}

/// Puts the targets somewhere at once, with no way and no velocity between: for the first frame and for teleports. The
/// arguments are those of taut_cloth_move_targets.
///
/// Errors: those of taut_cloth_move_targets.
/// Threads: changes the cloth.
/// cbindgen:ptrs-as-arrays=[[base_m;3]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_cloth_set_targets(
    cloth: *mut ClothHandle,
    base_m: *const f64,
    count: u32,
    positions_m: *const c_void,
    normals: *const c_void,
    stride: usize,
) -> Code {
    // SAFETY: the caller promises what `put` needs.
    unsafe { put(cloth, base_m, (count, positions_m, normals, stride), true) }
}

/// # Safety
/// As [`change`], [`value`] and [`Vectors::new`].
unsafe fn put(
    cloth: *mut ClothHandle,
    base_m: *const f64,
    (count, positions_m, normals, stride): (u32, *const c_void, *const c_void, usize),
    at_once: bool,
) -> Code {
    // SAFETY: promised by the caller; the count is checked before the arrays are trusted.
    unsafe {
        change(cloth, |cloth| {
            let n = counted(cloth, count)?;
            let base = Vector3::from(*value(base_m.cast::<[f64; 3]>())?);
            let positions = Vectors::new(positions_m, stride, n)?;
            let normals = if normals.is_null() { None } else { Some(Vectors::new(normals, stride, n)?) };
            let target = |i: usize| Target {
                position_m: positions.get(i).into(),
                normal: normals.as_ref().map_or([0.0; 3], |normals| normals.get(i)).into(),
            };
            if at_once {
                cloth.set_targets(base, target)?;
            } else {
                cloth.move_targets(base, target)?;
            }
            Ok(())
        })
    }
}

fn counted(cloth: &Cloth<'_>, count: u32) -> Result<usize, Code> {
    let n = cloth.grid().particles();
    if count as usize == n { Ok(n) } else { Err(Code::TAUT_ERROR_SHAPE) }
}
