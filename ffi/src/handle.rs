//! What the handles of C point to: the first bytes of the blocks that the caller handed in.

use taut_core::{Cloth, Grid, in_default_environment};

use crate::pointer::value;
use crate::result::{Code, answer};

/// Bytes of the block of a grid, on every target.
pub const TAUT_GRID_BYTES: usize = 64;
/// Alignment of the block of a grid in bytes.
pub const TAUT_GRID_ALIGN: usize = 8;
/// Bytes at the start of a cloth's block that its numbers follow, on every target.
pub const TAUT_CLOTH_HEADER_BYTES: usize = 2048;
/// Alignment of the block of a cloth in bytes.
pub const TAUT_CLOTH_ALIGN: usize = 64;

const GRID_MAGIC: u64 = 0x6469_7267_7475_6174;
const CLOTH_MAGIC: u64 = 0x6874_6f6c_6374_6174;

/// The topology of a cloth: which particles exist and which springs join them. It never changes, and any number of threads
/// may use it at a time. A cloth copies what it needs, so the grid's block may go when its cloths are made.
#[repr(C, align(8))]
pub struct GridHandle {
    magic: u64,
    grid: Grid,
}

/// A cloth in a block of the caller's memory. One thread at a time: functions that take `taut_cloth *` change it, and
/// nothing else may use it meanwhile; functions that take `const taut_cloth *` may run at the same time as one another.
/// Different cloths never share anything.
#[repr(C, align(64))]
pub struct ClothHandle {
    magic: u64,
    cloth: Cloth<'static>,
}

const _: () = {
    assert!(size_of::<GridHandle>() <= TAUT_GRID_BYTES);
    assert!(align_of::<GridHandle>() == TAUT_GRID_ALIGN);
    assert!(size_of::<ClothHandle>() <= TAUT_CLOTH_HEADER_BYTES);
    assert!(align_of::<ClothHandle>() == TAUT_CLOTH_ALIGN);
    assert!(TAUT_CLOTH_HEADER_BYTES.is_multiple_of(TAUT_CLOTH_ALIGN));
};

impl GridHandle {
    pub(crate) fn new(grid: Grid) -> GridHandle {
        GridHandle { magic: GRID_MAGIC, grid }
    }
}

impl ClothHandle {
    /// `at` is the address that it will be written to. The cloth points into its own block, so a copy of the block
    /// elsewhere is no cloth: the address is part of the magic number.
    pub(crate) fn new(cloth: Cloth<'static>, at: usize) -> ClothHandle {
        ClothHandle { magic: CLOTH_MAGIC ^ at as u64, cloth }
    }
}

/// The grid of a handle.
///
/// # Safety
/// `handle` is NULL, misaligned, or good for reading 8 bytes that, if they are the magic number, begin a grid made by
/// `taut_grid_create` that lives during `'a`.
pub(crate) unsafe fn grid<'a>(handle: *const GridHandle) -> Result<&'a Grid, Code> {
    // SAFETY: the first field is looked at alone, before the rest is trusted.
    let magic = unsafe { value(handle.cast::<AlignedMagic<GridHandle>>()) }?;
    if magic.0 != GRID_MAGIC {
        return Err(Code::TAUT_ERROR_BAD_HANDLE);
    }
    // SAFETY: made by `taut_grid_create`, as the magic number tells.
    Ok(unsafe { &(*handle).grid })
}

/// Runs `body` with the cloth of a handle, for reading.
///
/// # Safety
/// `handle` is NULL, misaligned, or good for reading 8 bytes that, if they are the magic number of this address, begin a
/// cloth made by `taut_cloth_create` whose block nobody changes meanwhile.
#[inline]
pub(crate) unsafe fn look(handle: *const ClothHandle, body: impl FnOnce(&Cloth<'static>) -> Result<(), Code>) -> Code {
    answer(|| {
        // SAFETY: the caller promises what `check` needs.
        unsafe { check(handle) }?;
        // SAFETY: made by `taut_cloth_create`, as the magic number tells, and nobody changes it.
        in_default_environment(|| body(unsafe { &(*handle).cloth }))
    })
}

/// Runs `body` with the cloth of a handle, for changing.
///
/// # Safety
/// As [`look`], and nobody else uses the block meanwhile.
#[inline]
pub(crate) unsafe fn change(
    handle: *mut ClothHandle,
    body: impl FnOnce(&mut Cloth<'static>) -> Result<(), Code>,
) -> Code {
    answer(|| {
        // SAFETY: the caller promises what `check` needs.
        unsafe { check(handle) }?;
        // SAFETY: made by `taut_cloth_create`, as the magic number tells, and nobody else uses it.
        in_default_environment(|| body(unsafe { &mut (*handle).cloth }))
    })
}

/// Whether a handle is that of a cloth.
///
/// # Safety
/// `handle` is NULL, misaligned, or good for reading 8 bytes.
unsafe fn check(handle: *const ClothHandle) -> Result<(), Code> {
    // SAFETY: the first field is looked at alone, before the rest is trusted.
    let magic = unsafe { value(handle.cast::<AlignedMagic<ClothHandle>>()) }?;
    if magic.0 != CLOTH_MAGIC ^ handle.addr() as u64 {
        return Err(Code::TAUT_ERROR_BAD_HANDLE);
    }
    Ok(())
}

/// The first field of a handle, of the handle's alignment.
#[repr(C)]
struct AlignedMagic<T>(u64, [T; 0]);
