//! What can be wrong with a network's configuration.

use std::fmt;

/// A configuration that no network can be built from.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum NetError {
    /// The base width lies outside 1 to [`MAX_WIDTH`](super::MAX_WIDTH).
    Width(usize),
    /// The pictures would have no channel, or more than four.
    PictureChannels(usize),
    /// A conditional discriminator needs a projection of at least one number.
    Projection(usize),
    /// Levels tell each channel its own, one matrix is the same for all.
    OneMatrix,
}

impl fmt::Display for NetError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Width(w) => write!(f, "base width {w} is not between 1 and {}", super::MAX_WIDTH),
            Self::PictureChannels(c) => write!(f, "pictures of {c} channels: 1 to 4 are possible"),
            Self::Projection(p) => write!(
                f,
                "a conditional discriminator cannot project the description to {p} numbers: 1 to {} are possible",
                super::DESCRIPTION
            ),
            Self::OneMatrix => f.write_str("levels tell each family its own stiffness, one matrix has none of its own"),
        }
    }
}

impl std::error::Error for NetError {}
