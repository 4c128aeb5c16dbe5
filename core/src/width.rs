use crate::{Cloth, Error, simd};

/// The vectors that a cloth is stepped in. Each gives the same bits; only the time differs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u32)]
#[non_exhaustive]
pub enum Width {
    /// One number at a time: every processor.
    Scalar = 0,
    /// 4 numbers: every x86_64.
    Sse2 = 1,
    /// 8 numbers: x86_64 with AVX2.
    Avx2 = 2,
    /// 16 numbers: x86_64 with AVX-512F.
    Avx512 = 3,
    /// 4 numbers: every aarch64.
    Neon = 4,
}

impl Width {
    /// Every width, the narrow ones first.
    pub const ALL: [Width; 5] = [Width::Scalar, Width::Sse2, Width::Neon, Width::Avx2, Width::Avx512];

    /// The name in tables: scalar, sse2, avx2, avx512, neon.
    pub const fn name(self) -> &'static str {
        match self {
            Width::Scalar => "scalar",
            Width::Sse2 => "sse2",
            Width::Avx2 => "avx2",
            Width::Avx512 => "avx512",
            Width::Neon => "neon",
        }
    }

    /// Numbers of a vector.
    pub const fn lanes(self) -> usize {
        match self {
            Width::Scalar => 1,
            Width::Sse2 | Width::Neon => 4,
            Width::Avx2 => 8,
            Width::Avx512 => 16,
        }
    }

    /// Whether this processor has the instructions and the operating system keeps their registers.
    pub fn is_supported(self) -> bool {
        simd::has(self)
    }

    /// The widest one of this machine.
    pub fn best() -> Width {
        Supported::best().get()
    }
}

/// A width that this machine has: where one exists, its instructions may run.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Supported(Width);

impl Supported {
    pub fn new(width: Width) -> Option<Supported> {
        if simd::has(width) { Some(Supported(width)) } else { None }
    }

    pub fn best() -> Supported {
        Width::ALL.into_iter().rev().find_map(Supported::new).unwrap_or(Supported(Width::Scalar))
    }

    #[inline(always)]
    pub fn get(self) -> Width {
        self.0
    }
}

impl Cloth<'_> {
    /// The vectors that the cloth is stepped in, [`Width::best`] from the start.
    pub fn width(&self) -> Width {
        self.width.get()
    }

    /// Steps in other vectors from now on, to time or test them: the bits stay the same. This is no part of the state: no
    /// snapshot holds it, and [`Cloth::reset`] keeps it.
    ///
    /// Error: [`Error::UnsupportedWidth`] where the machine lacks them.
    pub fn set_width(&mut self, width: Width) -> Result<(), Error> {
        self.width = Supported::new(width).ok_or(Error::UnsupportedWidth)?;
        Ok(())
    }
}
