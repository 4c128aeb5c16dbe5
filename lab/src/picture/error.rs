//! What can be wrong with a picture.

use std::fmt;
use std::path::PathBuf;

/// Why a picture could not be made or written; each prints as one line that names what is wrong.
#[derive(Debug)]
#[non_exhaustive]
pub enum PictureError {
    /// A sheet holds no panel, or a plot no series: there is nothing to draw.
    Empty,
    /// A sheet holds more panels than [`MAX_PANELS`](super::MAX_PANELS).
    TooManyPanels {
        /// How many it holds.
        panels: usize,
    },
    /// A grid has fewer than two rows or columns, or more than 4096.
    Grid {
        /// Rows asked for.
        rows: usize,
        /// Columns asked for.
        columns: usize,
    },
    /// The number of positions is not rows * columns.
    Positions {
        /// Rows of the grid.
        rows: usize,
        /// Columns of the grid.
        columns: usize,
        /// Positions given.
        given: usize,
    },
    /// A rest side length is not a positive, finite number of metres.
    RestSize {
        /// Width given, metres.
        width_m: f32,
        /// Height given, metres.
        height_m: f32,
    },
    /// A pin names a particle that the grid does not have.
    Pin {
        /// Particle named.
        pin: usize,
        /// Particles of the grid.
        particles: usize,
    },
    /// The PNG or GIF could not be encoded.
    Encode {
        /// What the encoder said.
        reason: String,
    },
    /// The file could not be written; nothing is left behind under its name.
    Write {
        /// The file asked for.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
}

impl fmt::Display for PictureError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Empty => write!(f, "nothing to draw: the picture has no panel or series"),
            Self::TooManyPanels { panels } => {
                write!(f, "a sheet holds at most {} panels, not {panels}", super::MAX_PANELS)
            }
            Self::Grid { rows, columns } => {
                write!(f, "a grid to draw has 2 to 4096 rows and columns, not {rows} x {columns}")
            }
            Self::Positions { rows, columns, given } => {
                write!(f, "a {rows} x {columns} grid has {} positions, not {given}", rows * columns)
            }
            Self::RestSize { width_m, height_m } => {
                write!(f, "the rest size must be positive, not {width_m} m x {height_m} m")
            }
            Self::Pin { pin, particles } => {
                write!(f, "pin {pin} is outside the grid of {particles} particles")
            }
            Self::Encode { reason } => write!(f, "the picture could not be encoded: {reason}"),
            Self::Write { path, source } => {
                write!(f, "cannot write \"{}\": {source}", path.display())
            }
        }
    }
}

impl std::error::Error for PictureError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Write { source, .. } => Some(source),
            _ => None,
        }
    }
}
