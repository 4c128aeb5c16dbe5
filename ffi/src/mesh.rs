//! What a renderer reads beside the positions.

use core::ffi::c_void;

use crate::handle::{ClothHandle, GridHandle, grid, look};
use crate::pointer::{Out, Vertices};
use crate::result::{Code, answer};
use crate::types::Bounds;

/// Number of triangles of a grid, two in each cell. For static storage TAUT_TRIANGLES tells the same.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE.
/// Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_grid_triangle_count(from: *const GridHandle, out: *mut u32) -> Code {
    answer(|| {
        // SAFETY: the caller lends a grid and a place for the answer.
        let (g, out) = unsafe { (grid(from)?, Out::new(out)?) };
        out.set(g.triangle_count() as u32);
        Ok(())
    })
}

/// Copies the triangles as three particle indices each, a list without gaps for an index buffer: cell after cell along the
/// rows, each cell cut from its lower left to its upper right corner. Counterclockwise is the front, the side from which u
/// runs to the right and v runs down, as a picture is looked at. out has out_size bytes, of which 12 per triangle are
/// written, and need not be aligned.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED (from), TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_BLOCK_TOO_SMALL. Then
/// nothing is written.
/// Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_grid_copy_triangles_u32(
    from: *const GridHandle,
    out: *mut c_void,
    out_size: usize,
) -> Code {
    // SAFETY: the caller lends a grid and `out_size` bytes.
    unsafe { copy_triangles(from, out, out_size, usize::MAX, |i| i) }
}

/// The same as 16-bit indices, 6 bytes per triangle, for a grid of at most 65,536 particles.
///
/// Errors: those of taut_grid_copy_triangles_u32, TAUT_ERROR_OUT_OF_RANGE (more particles). Then nothing is written.
/// Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_grid_copy_triangles_u16(
    from: *const GridHandle,
    out: *mut c_void,
    out_size: usize,
) -> Code {
    // SAFETY: the caller lends a grid and `out_size` bytes.
    unsafe { copy_triangles(from, out, out_size, 1 << 16, |i| i as u16) }
}

/// Copies the triangles with indices of a type that can number so many particles.
///
/// # Safety
/// As [`grid`] and [`Vertices::new`].
unsafe fn copy_triangles<T: Copy>(
    from: *const GridHandle,
    out: *mut c_void,
    out_size: usize,
    most_particles: usize,
    index: impl Fn(u32) -> T + Copy,
) -> Code {
    answer(|| {
        // SAFETY: promised by the caller.
        let g = unsafe { grid(from) }?;
        if g.particles() > most_particles {
            return Err(Code::TAUT_ERROR_OUT_OF_RANGE);
        }
        // SAFETY: promised by the caller.
        let places = unsafe { Vertices::new::<[T; 3]>(out, out_size, size_of::<[T; 3]>(), g.triangle_count()) }?;
        let mut triangles = g.triangles();
        // there are as many triangles as places, so the zeros are never written
        places.fill(|_| triangles.next().unwrap_or([0; 3]).map(index));
        Ok(())
    })
}

/// Copies the texture coordinates as two floats per particle, 0 to 1, in the order of the particles: 0, 0 at particle 0, u
/// along the columns, v along the rows. out has out_size bytes; stride is the bytes from a particle to the next, at least 8.
/// Bytes between are left alone, and out need not be aligned.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED (from), TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_SHAPE (stride),
/// TAUT_ERROR_BLOCK_TOO_SMALL. Then nothing is written.
/// Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_grid_copy_uvs_f32(
    from: *const GridHandle,
    out: *mut c_void,
    out_size: usize,
    stride: usize,
) -> Code {
    answer(|| {
        // SAFETY: the caller lends a grid and `out_size` bytes.
        let (g, places) = unsafe {
            let g = grid(from)?;
            (g, Vertices::new::<[f32; 2]>(out, out_size, stride, g.particles())?)
        };
        // the index is always that of a particle, so the zeros are never written
        places.fill(|i| g.uv(i).unwrap_or([0.0; 2]));
        Ok(())
    })
}

/// Copies the unit normals as three floats per particle, in the order of the particles, into a vertex buffer of its own or,
/// with out at the place of the first normal, into one that the positions are in too. A normal is the mean of those of the
/// one to four cells around the particle, weighted by their areas. It points to the front, the side from which u runs to
/// the right and v runs down; 0, 0, 0 where those cells have no area. out has out_size bytes; stride is the bytes from a
/// particle to the next, at least 12. Bytes between are left alone, and out need not be aligned.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED (cloth), TAUT_ERROR_BAD_HANDLE, TAUT_ERROR_SHAPE (stride),
/// TAUT_ERROR_BLOCK_TOO_SMALL. Then nothing is written.
/// Threads: reads the cloth.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_cloth_copy_normals_f32(
    cloth: *const ClothHandle,
    out: *mut c_void,
    out_size: usize,
    stride: usize,
) -> Code {
    // SAFETY: the caller lends a cloth that nobody changes, and `out_size` bytes.
    unsafe {
        look(cloth, |cloth| {
            let places = Vertices::new::<[f32; 3]>(out, out_size, stride, cloth.grid().particles())?;
            let mut normals = cloth.normals();
            // there are as many normals as places, so the zeros are never written
            places.fill(|_| normals.next().map_or([0.0; 3], Into::into));
            Ok(())
        })
    }
}

/// The box around all particles, in the world in m, for culling. Takes time in proportion to the particles.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE.
/// Threads: reads the cloth.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_cloth_bounds(cloth: *const ClothHandle, out: *mut Bounds) -> Code {
    // SAFETY: the caller lends a cloth that nobody changes, and a place for the answer.
    unsafe {
        look(cloth, |cloth| {
            let out = Out::new(out)?;
            let b = cloth.bounds();
            out.set(Bounds { low_m: b.low_m, high_m: b.high_m });
            Ok(())
        })
    }
}
