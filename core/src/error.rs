use core::fmt;

/// Why a call was refused. Nothing is changed by a call that answers with an error.
///
/// The numbers are the C result codes: negative, and only ever appended to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(i32)]
#[non_exhaustive]
pub enum Error {
    /// A pointer is NULL.
    NullPointer = -1,
    /// The block of memory is not aligned as was asked for.
    Misaligned = -2,
    /// The block of memory is smaller than was asked for.
    BlockTooSmall = -3,
    /// A definition was not made by its default function, or belongs to another version.
    BadDefinition = -4,
    /// A grid side has fewer than 2 or more than 4096 particles.
    GridSize = -5,
    /// A side length is not finite, below 1e-6 m, or above 10 km.
    SideLength = -6,
    /// The frame rate is not within 1 to 10,000 Hz, or the substeps are not within 1 to 1,024: the step would be 0 or endless.
    StepSize = -7,
    /// A number that must be finite is NaN or infinite.
    NotFinite = -8,
    /// A number that must not be negative is negative.
    Negative = -9,
    /// A number is outside the range that its documentation gives.
    OutOfRange = -10,
    /// There is no particle of this index.
    NoSuchParticle = -11,
    /// The particle is not pinned.
    NotPinned = -12,
    /// More pins than `max_pins` of the definition.
    TooManyPins = -13,
    /// The feature was not asked for in the definition, so it has no memory.
    FeatureOff = -14,
    /// The stiffness was never set.
    NoStiffness = -15,
    /// An array has another shape than the call needs.
    Shape = -16,
    /// The bytes end early.
    Truncated = -17,
    /// The bytes are not of the expected kind (their magic number is another).
    WrongKind = -18,
    /// The bytes were written by a version that this one cannot read.
    UnsupportedVersion = -19,
    /// The bytes were changed: their checksum does not match.
    Checksum = -20,
    /// The snapshot belongs to a cloth of another grid or definition.
    Foreign = -21,
    /// The damping is too strong for the step: damping times dt must stay below 1.
    Damping = -22,
    /// The caller and the library are of different versions.
    VersionMismatch = -23,
    /// This machine lacks the vector width.
    UnsupportedWidth = -24,
    /// The particle is absent: the mask says so.
    Absent = -25,
    /// There is no collider of this id (any more).
    NoSuchCollider = -26,
    /// There are [`crate::MAX_COLLIDERS`] colliders already.
    TooManyColliders = -27,
    /// Not even the cheapest settings fit the time.
    NoPlan = -28,
}

impl Error {
    /// Every error, in the order of the codes.
    pub const ALL: [Error; 28] = [
        Error::NullPointer,
        Error::Misaligned,
        Error::BlockTooSmall,
        Error::BadDefinition,
        Error::GridSize,
        Error::SideLength,
        Error::StepSize,
        Error::NotFinite,
        Error::Negative,
        Error::OutOfRange,
        Error::NoSuchParticle,
        Error::NotPinned,
        Error::TooManyPins,
        Error::FeatureOff,
        Error::NoStiffness,
        Error::Shape,
        Error::Truncated,
        Error::WrongKind,
        Error::UnsupportedVersion,
        Error::Checksum,
        Error::Foreign,
        Error::Damping,
        Error::VersionMismatch,
        Error::UnsupportedWidth,
        Error::Absent,
        Error::NoSuchCollider,
        Error::TooManyColliders,
        Error::NoPlan,
    ];

    /// The C result code: negative.
    pub const fn code(self) -> i32 {
        self as i32
    }

    /// One line that names what is wrong.
    pub const fn message(self) -> &'static str {
        match self {
            Error::NullPointer => "a pointer is NULL",
            Error::Misaligned => "the memory block is not aligned as asked for",
            Error::BlockTooSmall => "the memory block is smaller than asked for",
            Error::BadDefinition => "the definition was not made by its default function or is of another version",
            Error::GridSize => "each grid side needs 2 to 4096 particles",
            Error::SideLength => "a side length must be 0.000001 to 10000 m",
            Error::StepSize => "the rate must be 1 to 10000 Hz and the substeps 1 to 1024",
            Error::NotFinite => "a number is NaN or infinite",
            Error::Negative => "a number that must not be negative is negative",
            Error::OutOfRange => "a number is outside its documented range",
            Error::NoSuchParticle => "there is no particle of this index",
            Error::NotPinned => "the particle is not pinned",
            Error::TooManyPins => "more pins than max_pins of the definition",
            Error::FeatureOff => "the feature was not asked for in the definition",
            Error::NoStiffness => "the stiffness was never set",
            Error::Shape => "an array has another shape than the call needs",
            Error::Truncated => "the bytes end early",
            Error::WrongKind => "the bytes are not of the expected kind",
            Error::UnsupportedVersion => "the bytes are of a version that this library cannot read",
            Error::Checksum => "the bytes were changed: the checksum does not match",
            Error::Foreign => "the snapshot belongs to another grid or definition",
            Error::Damping => "damping times dt must stay below 1",
            Error::VersionMismatch => "the caller was compiled against another version",
            Error::UnsupportedWidth => "this machine lacks the vector width",
            Error::Absent => "the particle is absent: the mask says so",
            Error::NoSuchCollider => "there is no collider of this id",
            Error::TooManyColliders => "there are 32 colliders already",
            Error::NoPlan => "not even the cheapest settings fit the time",
        }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.message())
    }
}

impl core::error::Error for Error {}
