//! The two networks of the paper (section V): the generator of Fig. 4 and the discriminator of Fig. 5.
//!
//! Both are plain burn modules: they train on an autodiff device, and `valid()` gives the copy that infers with the
//! running statistics. Their first weights come from a seed through a counter-free stream of our own, not from the
//! global generator of the backend, so that two threads that build networks at once cannot disturb each other.

pub mod description;
pub mod discriminator;
pub mod error;
pub mod generator;
pub mod init;

pub use description::{DESCRIPTION_EPSILON, SHARES_EPSILON, normalise};
pub use discriminator::{Discriminator, DiscriminatorConfig};
pub use error::NetError;
pub use generator::{Generator, GeneratorConfig, GeneratorOutput, HEAD_INPUT, HEAD_SCALE, head_input};

/// Length of the description vector: the sum of the word vectors, of which the paper takes the mean (section V.A.1).
pub const DESCRIPTION: usize = 1024;
/// Length of the Gaussian noise vector (paper, section V.A.1).
pub const NOISE: usize = 128;
/// Side of the generated field, in particles.
pub const GRID: usize = 32;
/// Channels of the generated field: warp, weft, shear, bend.
pub const CHANNELS: usize = 4;
/// Numbers told of the fabric as a whole: density, hinge rigidity, stretch limit of warp, weft and diagonal.
pub const FABRIC: usize = 5;
/// Side of the pictures that the discriminator sees, in pixels (paper, section VI.A).
pub const PICTURE: usize = 64;
/// Largest base width that a configuration may ask for; 64 is the widest that was ever measured.
pub const MAX_WIDTH: usize = 256;
