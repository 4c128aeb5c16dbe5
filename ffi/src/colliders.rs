use taut_core::Shape;

use crate::handle::{ClothHandle, change, look};
use crate::pointer::{Out, value};
use crate::result::Code;
use crate::types::{ColliderDef, ColliderShape, Pose};

const COOKIE: u32 = 0x6c6f_6374;

/// A definition of a collider with its defaults; shape is a taut_shape.
///
/// Threads: any.
#[unsafe(no_mangle)]
pub extern "C" fn taut_collider_def_default(shape: u32) -> ColliderDef {
    ColliderDef {
        size: size_of::<ColliderDef>() as u32,
        cookie: COOKIE,
        pose: Pose { position_m: [0.0; 3], rotation: [0.0, 0.0, 0.0, 1.0] },
        shape,
        friction: 0.3,
        thickness_m: 0.005,
        radius_m: [0.1; 2],
        ends_m: [[0.0, -0.1, 0.0], [0.0, 0.1, 0.0]],
        normal: [0.0, 1.0, 0.0],
        half_m: [0.1; 3],
        reserved: 0,
    }
}

/// # Safety
/// As [`value`].
unsafe fn checked(def: *const ColliderDef) -> Result<taut_core::ColliderDef, Code> {
    // SAFETY: promised by the caller; a definition is plain numbers.
    let d = unsafe { value(def) }?;
    if d.size as usize != size_of::<ColliderDef>() || d.cookie != COOKIE {
        return Err(Code::TAUT_ERROR_BAD_DEFINITION);
    }
    let shape = match d.shape {
        s if s == ColliderShape::TAUT_SHAPE_SPHERE as u32 => Shape::Sphere { radius_m: d.radius_m[0] },
        s if s == ColliderShape::TAUT_SHAPE_CAPSULE as u32 => Shape::Capsule { ends_m: d.ends_m, radii_m: d.radius_m },
        s if s == ColliderShape::TAUT_SHAPE_PLANE as u32 => Shape::Plane { normal: d.normal },
        s if s == ColliderShape::TAUT_SHAPE_BOX as u32 => Shape::Box { half_m: d.half_m },
        _ => return Err(Code::TAUT_ERROR_OUT_OF_RANGE),
    };
    Ok(taut_core::ColliderDef { shape, pose: d.pose.into(), friction: d.friction, thickness_m: d.thickness_m })
}

/// Adds a collider, of which a cloth has up to TAUT_MAX_COLLIDERS. Needs TAUT_FEATURE_COLLIDERS. out_id is its id: a value,
/// never 0, that is not given again after the collider was removed. Ids are part of the state: after taut_cloth_restore
/// or taut_cloth_reset the same calls give the same ids again. Particles that are inside are moved out over the nearest
/// surface, by at most 1/16 of the smallest rest length in each substep. docs/contact.md tells what a collider does.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_BAD_DEFINITION,
/// TAUT_ERROR_FEATURE_OFF, TAUT_ERROR_NOT_FINITE, TAUT_ERROR_NEGATIVE, TAUT_ERROR_OUT_OF_RANGE (also a shape that is none, a
/// size of 0), TAUT_ERROR_TOO_MANY_COLLIDERS.
/// Threads: changes the cloth.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_cloth_collider_add(
    cloth: *mut ClothHandle,
    def: *const ColliderDef,
    out_id: *mut u32,
) -> Code {
    // SAFETY: the caller hands in a cloth that nobody else uses, and lends a definition and a place for the answer.
    unsafe {
        change(cloth, |cloth| {
            let (def, out) = (checked(def)?, Out::new(out_id)?);
            out.set(cloth.add_collider(&def)?.0);
            Ok(())
        })
    }
}

/// Moves a collider: at the end of the next frame it is at pose, and on the way there its position is interpolated linearly
/// over the substeps and its rotation along the shorter arc. Its surface drags the cloth with it. Without a new call it then
/// stays.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_NO_SUCH_COLLIDER,
/// TAUT_ERROR_NOT_FINITE, TAUT_ERROR_OUT_OF_RANGE (more than 1e6 m from the cloth's origin, a rotation of length 0).
/// Threads: changes the cloth.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_cloth_collider_move(cloth: *mut ClothHandle, id: u32, pose: *const Pose) -> Code {
    // SAFETY: the caller hands in a cloth that nobody else uses, and lends a pose.
    unsafe {
        change(cloth, |cloth| {
            let pose = (*value(pose)?).into();
            Ok(cloth.move_collider(taut_core::ColliderId(id), &pose)?)
        })
    }
}

/// Puts a collider somewhere at once, with no way and no velocity between: a teleport. Particles that are inside then are
/// moved out as after taut_cloth_collider_add.
///
/// Errors: those of taut_cloth_collider_move.
/// Threads: changes the cloth.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_cloth_collider_set_pose(cloth: *mut ClothHandle, id: u32, pose: *const Pose) -> Code {
    // SAFETY: the caller hands in a cloth that nobody else uses, and lends a pose.
    unsafe {
        change(cloth, |cloth| {
            let pose = (*value(pose)?).into();
            Ok(cloth.set_collider_pose(taut_core::ColliderId(id), &pose)?)
        })
    }
}

/// Removes a collider; its id is answered with TAUT_ERROR_NO_SUCH_COLLIDER from now on.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_NO_SUCH_COLLIDER.
/// Threads: changes the cloth.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_cloth_collider_remove(cloth: *mut ClothHandle, id: u32) -> Code {
    // SAFETY: the caller hands in a cloth that nobody else uses.
    unsafe { change(cloth, |cloth| Ok(cloth.remove_collider(taut_core::ColliderId(id))?)) }
}

/// Where a collider is now, before the next frame.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_NO_SUCH_COLLIDER.
/// Threads: reads the cloth.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_cloth_collider_pose(cloth: *const ClothHandle, id: u32, out: *mut Pose) -> Code {
    // SAFETY: the caller lends a cloth that nobody changes, and a place for the answer.
    unsafe {
        look(cloth, |cloth| {
            let out = Out::new(out)?;
            out.set(cloth.collider(taut_core::ColliderId(id))?.pose.into());
            Ok(())
        })
    }
}

/// Number of colliders.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE.
/// Threads: reads the cloth.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_cloth_collider_count(cloth: *const ClothHandle, out: *mut u32) -> Code {
    // SAFETY: the caller lends a cloth that nobody changes, and a place for the answer.
    unsafe {
        look(cloth, |cloth| {
            Out::new(out)?.set(cloth.collider_count() as u32);
            Ok(())
        })
    }
}
