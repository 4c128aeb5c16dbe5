//! The checks of what a C caller hands in. Everything that turns a pointer into a Rust value goes through here.

use core::ptr;

use crate::result::Code;

/// NULL and alignment, and that `count` values end before the address space does.
fn check<T>(pointer: *const T, count: usize) -> Result<(), Code> {
    if pointer.is_null() {
        return Err(Code::TAUT_ERROR_NULL_POINTER);
    }
    if !pointer.is_aligned() {
        return Err(Code::TAUT_ERROR_MISALIGNED);
    }
    let bytes = count.checked_mul(size_of::<T>()).filter(|b| *b <= isize::MAX as usize);
    if bytes.and_then(|b| pointer.addr().checked_add(b)).is_none() {
        return Err(Code::TAUT_ERROR_OUT_OF_RANGE);
    }
    Ok(())
}

/// A value that the caller lends for reading.
///
/// # Safety
/// `pointer` is NULL, misaligned, or good for reading a `T` during `'a`. Every bit pattern must be a valid `T`.
pub(crate) unsafe fn value<'a, T>(pointer: *const T) -> Result<&'a T, Code> {
    check(pointer, 1)?;
    // SAFETY: not NULL and aligned; the rest is what the caller promises.
    Ok(unsafe { &*pointer })
}

/// An array that the caller lends for reading.
///
/// # Safety
/// As [`value`], for `count` values.
pub(crate) unsafe fn array<'a, T>(pointer: *const T, count: usize) -> Result<&'a [T], Code> {
    check(pointer, count)?;
    // SAFETY: not NULL, aligned, at most isize::MAX bytes; the rest is what the caller promises.
    Ok(unsafe { core::slice::from_raw_parts(pointer, count) })
}

/// An array that the caller lends for writing.
///
/// # Safety
/// As [`value`], for reading and writing `count` values, and nobody else touches them during `'a`.
pub(crate) unsafe fn array_mut<'a, T>(pointer: *mut T, count: usize) -> Result<&'a mut [T], Code> {
    check(pointer, count)?;
    // SAFETY: not NULL, aligned, at most isize::MAX bytes; the rest is what the caller promises.
    Ok(unsafe { core::slice::from_raw_parts_mut(pointer, count) })
}

/// A place for a result: checked before a call does anything, written when all went well.
pub(crate) struct Out<T>(*mut T);

impl<T> Out<T> {
    /// # Safety
    /// `pointer` is NULL, misaligned, or good for writing a `T` until [`Out::set`] is called.
    pub unsafe fn new(pointer: *mut T) -> Result<Out<T>, Code> {
        check(pointer, 1)?;
        Ok(Out(pointer))
    }

    /// The same where the caller may do without: NULL is a place that nothing is written to.
    ///
    /// # Safety
    /// As [`Out::new`].
    pub unsafe fn optional(pointer: *mut T) -> Result<Out<T>, Code> {
        if !pointer.is_null() {
            check(pointer, 1)?;
        }
        Ok(Out(pointer))
    }

    /// Writes the result.
    pub fn set(self, value: T) {
        if !self.0.is_null() {
            // SAFETY: checked by `new` or `optional`, and the caller promised the rest. The old content is not read: it
            // may be uninitialised.
            unsafe { ptr::write(self.0, value) }
        }
    }
}

/// A vertex buffer: `count` places of `stride` bytes, of which the first bytes are written. It need not be aligned.
pub(crate) struct Vertices {
    start: *mut u8,
    stride: usize,
    count: usize,
}

impl Vertices {
    /// Checks that `count` values of the type `T` fit into `size` bytes.
    ///
    /// # Safety
    /// `pointer` is NULL or good for writing `size` bytes while this lives.
    pub unsafe fn new<T>(
        pointer: *mut core::ffi::c_void,
        size: usize,
        stride: usize,
        count: usize,
    ) -> Result<Vertices, Code> {
        check(pointer.cast::<u8>(), size)?;
        if stride < size_of::<T>() {
            return Err(Code::TAUT_ERROR_SHAPE);
        }
        let needed = count.saturating_sub(1).checked_mul(stride).and_then(|b| b.checked_add(size_of::<T>()));
        if needed.is_none_or(|n| n > size) {
            return Err(Code::TAUT_ERROR_BLOCK_TOO_SMALL);
        }
        Ok(Vertices { start: pointer.cast(), stride, count })
    }

    /// Writes `value(i)` for every place i.
    pub fn fill<T: Copy>(self, mut value: impl FnMut(usize) -> T) {
        for i in 0..self.count {
            // SAFETY: `new` found that (count - 1) * stride + size_of::<T>() bytes lie within the buffer.
            unsafe { ptr::write_unaligned(self.start.add(i * self.stride).cast::<T>(), value(i)) }
        }
    }
}

/// Vectors that the caller lends for reading: `count` places of `stride` bytes that begin with three floats. They need not
/// be aligned.
pub(crate) struct Vectors<'a> {
    start: *const u8,
    stride: usize,
    count: usize,
    lent: core::marker::PhantomData<&'a u8>,
}

impl Vectors<'_> {
    /// # Safety
    /// `pointer` is NULL, or good for reading `(count - 1) * stride + 12` bytes while this lives.
    pub unsafe fn new<'a>(pointer: *const core::ffi::c_void, stride: usize, count: usize) -> Result<Vectors<'a>, Code> {
        if stride < size_of::<[f32; 3]>() {
            return Err(Code::TAUT_ERROR_SHAPE);
        }
        let bytes = count.checked_mul(stride).ok_or(Code::TAUT_ERROR_OUT_OF_RANGE)?;
        check(pointer.cast::<u8>(), bytes)?;
        Ok(Vectors { start: pointer.cast(), stride, count, lent: core::marker::PhantomData })
    }

    /// The vector of a place; zeros past the last one.
    pub fn get(&self, i: usize) -> [f32; 3] {
        if i >= self.count {
            return [0.0; 3];
        }
        // SAFETY: within what the caller promised to `new`; every bit pattern is a float.
        unsafe { ptr::read_unaligned(self.start.add(i * self.stride).cast::<[f32; 3]>()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bad_pointers_are_answered_without_a_look() {
        // SAFETY: none of these is good, so none may be looked at.
        unsafe {
            assert_eq!(value::<u32>(ptr::null()).unwrap_err(), Code::TAUT_ERROR_NULL_POINTER);
            assert_eq!(value::<u32>(ptr::without_provenance(6)).unwrap_err(), Code::TAUT_ERROR_MISALIGNED);
            let end = ptr::without_provenance::<u32>(usize::MAX - 7);
            assert_eq!(array(end, 2).unwrap_err(), Code::TAUT_ERROR_OUT_OF_RANGE);
            assert_eq!(array::<u32>(ptr::dangling(), usize::MAX / 2).unwrap_err(), Code::TAUT_ERROR_OUT_OF_RANGE);
            assert!(Out::<u64>::optional(ptr::null_mut()).is_ok());
            assert!(Out::<u64>::new(ptr::null_mut()).is_err());
        }
    }

    #[test]
    fn lent_vectors_are_read_by_their_stride() {
        let bytes: [u8; 43] = core::array::from_fn(|i| i as u8);
        let start = bytes.as_ptr().wrapping_add(1);
        // SAFETY: (3 - 1) * 15 + 12 = 42 bytes from `start` on are ours.
        let vectors = unsafe { Vectors::new(start.cast(), 15, 3) }.unwrap();
        for i in 0..3 {
            let first = 1 + 15 * i as u8;
            let expected = [0, 4, 8].map(|a| f32::from_ne_bytes([0, 1, 2, 3].map(|b| first + a + b)));
            assert_eq!(vectors.get(i).map(f32::to_bits), expected.map(f32::to_bits));
        }
        assert_eq!(vectors.get(3), [0.0; 3]);
        // SAFETY: refused before anything is read.
        unsafe {
            assert_eq!(Vectors::new(start.cast(), 11, 3).err(), Some(Code::TAUT_ERROR_SHAPE));
            assert_eq!(Vectors::new(start.cast(), usize::MAX, 3).err(), Some(Code::TAUT_ERROR_OUT_OF_RANGE));
            assert_eq!(Vectors::new(start.cast(), usize::MAX / 4, 3).err(), Some(Code::TAUT_ERROR_OUT_OF_RANGE));
            assert_eq!(Vectors::new(ptr::null(), 12, 3).err(), Some(Code::TAUT_ERROR_NULL_POINTER));
        }
    }

    #[test]
    fn a_vertex_buffer_is_never_left() {
        let mut buffer = [0xffu8; 40];
        let at = buffer.as_mut_ptr().wrapping_add(1).cast();
        // SAFETY: 39 bytes from `at` on are ours.
        let make = |size, stride, count| unsafe { Vertices::new::<[f32; 3]>(at, size, stride, count) };
        assert_eq!(make(39, 11, 1).err(), Some(Code::TAUT_ERROR_SHAPE));
        assert_eq!(make(39, 14, 3).err(), Some(Code::TAUT_ERROR_BLOCK_TOO_SMALL));
        assert_eq!(make(39, usize::MAX, 3).err(), Some(Code::TAUT_ERROR_BLOCK_TOO_SMALL));
        make(39, 13, 3).unwrap().fill(|_| [0.0f32; 3]);
        for (i, b) in buffer.into_iter().enumerate() {
            let untouched = i == 0 || i == 13 || i == 26 || i > 38;
            assert_eq!(b, if untouched { 0xff } else { 0 }, "byte {i}");
        }
    }
}
