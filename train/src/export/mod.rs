//! From a trained generator to the one `.onnx` file that the runtime reads.
//!
//! The file holds the network of [`crate::nets::generator`] with the word table in front of it, weights and words as f16
//! behind a Cast to f32, and describes itself by metadata: vocabulary, channels, ranges, sizes, training digest.
//! [`export`] writes it, [`round_to_f16`] gives the network with exactly the numbers of the file, and [`run_rounded`]
//! runs that network on the file's own inputs, so that other runtimes can be compared with it. [`import`] reads a file back.

pub mod error;
pub mod fixture;
pub mod half_precision;
pub mod meta;
pub mod parity;
pub mod proto;
pub mod reader;
pub mod words;
pub mod writer;

mod graph;

pub use error::ExportError;
pub use half_precision::round_to_f16;
pub use meta::ExportMeta;
pub use parity::{ParityInput, ParitySample, run_rounded};
pub use reader::import;
pub use words::WordTable;
pub use writer::export;

/// Tokens of one description; the rest is padding.
pub const TOKENS: usize = 16;
/// Largest number of words in a file, the padding word included.
pub const MAX_VOCABULARY: usize = 3500;
/// A file is smaller than this, in bytes.
pub const MAX_FILE_BYTES: usize = 16_000_000;
