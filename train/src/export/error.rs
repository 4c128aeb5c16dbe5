//! Why a generator cannot be exported.

use std::fmt;

/// What is wrong with the parts of a generator file; nothing is written then.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ExportError {
    /// The word table breaks a rule; the text says which.
    Words(String),
    /// The metadata breaks a rule; the text says which.
    Meta(String),
    /// A number of the named tensor is not finite, or beyond the largest f16 (65504).
    NotHalf {
        /// Name of the tensor in the file.
        tensor: String,
    },
    /// A number of the named tensor, which stays f32, is not finite.
    NotFinite {
        /// Name of the tensor in the file.
        tensor: String,
    },
    /// The named tensor of the network has a shape that the file cannot have, or could not be read.
    Tensor {
        /// Name of the tensor in the file.
        tensor: String,
    },
    /// The inputs of a parity run do not fit each other or the word table; the text says how.
    Input(String),
    /// A file that cannot be read back; the text says why.
    File(String),
    /// The file would have this many bytes, [`MAX_FILE_BYTES`](super::MAX_FILE_BYTES) or more.
    TooLarge(usize),
}

impl fmt::Display for ExportError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Words(what) => write!(f, "word table: {what}"),
            Self::Meta(what) => write!(f, "metadata: {what}"),
            Self::NotHalf { tensor } => {
                write!(f, "tensor {tensor} holds a number that f16 cannot: not finite or beyond 65504")
            }
            Self::NotFinite { tensor } => write!(f, "tensor {tensor} holds a number that is not finite"),
            Self::Tensor { tensor } => write!(f, "tensor {tensor} has an unexpected shape or could not be read"),
            Self::Input(what) => write!(f, "inputs of the generator: {what}"),
            Self::File(what) => write!(f, "not a generator file of ours: {what}"),
            Self::TooLarge(bytes) => {
                write!(f, "the file would have {bytes} bytes, the limit is {}", super::MAX_FILE_BYTES)
            }
        }
    }
}

impl std::error::Error for ExportError {}
