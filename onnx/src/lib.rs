//! The generator of taut: words, a seed and a scene in, a stiffness field out, run offline.
//!
//! A generator is one self-describing ONNX file: the word vectors, the network and, in its
//! metadata, the vocabulary, the channels and their ranges. [`Generator`] reads such a file, refuses
//! everything that is not one, and turns a [`Request`] into a [`Correction`]: the stiffness field
//! `[warp, weft, shear, bend][row][column]` in N/m at the particles of the wanted grid, and what
//! words also tell of a fabric: its density, its hinge rigidity and how far it can stretch.
//!
//! The field is a *target*. The budget of the cloth decides how much of it a step can carry.
//!
//! ```no_run
//! use taut_onnx::{Generator, Request};
//! let generator = Generator::load("generator.onnx")?;
//! let correction = generator.correct(&Request {
//!     pins: &[(0, 0), (0, 31)],
//!     ..Request::new("heavy blue denim")
//! })?;
//! println!("{} kg/m^2", correction.density_kg_m2);
//! for word in &correction.unknown_words {
//!     eprintln!("the generator does not know the word {word}");
//! }
//! # Ok::<(), taut_onnx::Error>(())
//! ```
//!
//! The same words, seed and scene give the same bytes on one machine, and fields within 1e-5 on
//! another (inference kernels differ): where lockstep matters, ship the baked file.
#![forbid(unsafe_code)]

mod call;
mod error;
mod field;
mod generator;
mod graph;
mod guard;
mod metadata;
mod plan;
mod scene;
mod shapes;
mod tokens;
mod vocabulary;
mod wire;

pub use error::Error;
pub use field::resample;
pub use generator::{Correction, Generator, MAX_FILE_BYTES, Request};
pub use metadata::{FABRIC, Info, Range};
pub use scene::pin_distance;
pub use vocabulary::{MAX_WORDS, Vocabulary};
