use crate::handle::{GridHandle, TAUT_GRID_ALIGN, TAUT_GRID_BYTES, grid};
use crate::pointer::{Out, array_mut, value};
use crate::result::{Code, answer};
use crate::types::{Counts, GridDef, Memory};

const COOKIE: u32 = 0x6472_6774;

/// The default grid: 32 x 32 particles, 1 m x 1 m, all spring families.
///
/// Threads: any.
#[unsafe(no_mangle)]
pub extern "C" fn taut_grid_def_default() -> GridDef {
    let d = taut_core::GridDef::default();
    GridDef {
        size: size_of::<GridDef>() as u32,
        cookie: COOKIE,
        rows: d.rows,
        columns: d.columns,
        width_m: d.width_m,
        height_m: d.height_m,
        families: d.families.0,
    }
}

/// # Safety
/// As [`value`].
pub(crate) unsafe fn checked(def: *const GridDef) -> Result<taut_core::Grid, Code> {
    // SAFETY: promised by the caller; a definition is plain numbers.
    check(unsafe { value(def) }?)
}

pub(crate) fn check(d: &GridDef) -> Result<taut_core::Grid, Code> {
    if d.size as usize != size_of::<GridDef>() || d.cookie != COOKIE {
        return Err(Code::TAUT_ERROR_BAD_DEFINITION);
    }
    Ok(taut_core::Grid::new(&taut_core::GridDef {
        rows: d.rows,
        columns: d.columns,
        width_m: d.width_m,
        height_m: d.height_m,
        families: taut_core::Families(d.families),
    })?)
}

/// Memory that a grid needs: never more than TAUT_GRID_BYTES, aligned to TAUT_GRID_ALIGN.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_DEFINITION, TAUT_ERROR_GRID_SIZE,
/// TAUT_ERROR_SIDE_LENGTH, TAUT_ERROR_OUT_OF_RANGE (families).
/// Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_grid_memory(def: *const GridDef, out: *mut Memory) -> Code {
    answer(|| {
        // SAFETY: the caller lends a definition and a place for the answer.
        let (_, out) = unsafe { (checked(def)?, Out::new(out)?) };
        out.set(Memory { size: TAUT_GRID_BYTES, align: TAUT_GRID_ALIGN });
        Ok(())
    })
}

/// Makes a grid in the caller's block of block_size bytes. The block is the caller's to keep and to free; there is nothing
/// to destroy.
///
/// Errors: those of taut_grid_memory, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BLOCK_TOO_SMALL. Then nothing is written.
/// Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_grid_create(
    def: *const GridDef,
    block: *mut core::ffi::c_void,
    block_size: usize,
    out: *mut *mut GridHandle,
) -> Code {
    answer(|| {
        // SAFETY: the caller lends a definition and a place for the answer.
        let (made, out) = unsafe { (checked(def)?, Out::new(out)?) };
        let handle = block.cast::<GridHandle>();
        // SAFETY: the caller hands in a block of his own; an array of no values only checks the pointer.
        unsafe { array_mut(handle, 0) }?;
        if block_size < TAUT_GRID_BYTES {
            return Err(Code::TAUT_ERROR_BLOCK_TOO_SMALL);
        }
        // SAFETY: not NULL, aligned, large enough, and the caller's own.
        unsafe { handle.write(GridHandle::new(made)) };
        out.set(handle);
        Ok(())
    })
}

/// Rows, columns, particles and springs of a grid.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE.
/// Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_grid_counts(from: *const GridHandle, out: *mut Counts) -> Code {
    answer(|| {
        // SAFETY: the caller lends a grid and a place for the answer.
        let (g, out) = unsafe { (grid(from)?, Out::new(out)?) };
        out.set(Counts {
            rows: g.rows() as u32,
            columns: g.columns() as u32,
            particles: g.particles() as u32,
            springs: g.springs() as u32,
        });
        Ok(())
    })
}

/// 64-bit digest of what a grid was made of: two grids are the same topology when their digests agree. The same on every
/// machine.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE.
/// Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_grid_digest(from: *const GridHandle, out: *mut u64) -> Code {
    answer(|| {
        // SAFETY: the caller lends a grid and a place for the answer.
        let (g, out) = unsafe { (grid(from)?, Out::new(out)?) };
        out.set(g.digest());
        Ok(())
    })
}
