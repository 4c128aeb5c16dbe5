use std::fmt;

/// Why a differentiable cloth was refused. Each names what is wrong.
#[derive(Clone, Debug, PartialEq)]
pub enum ClothError {
    /// Rows or columns outside 2 to 4096.
    GridSize {
        /// Rows asked for.
        rows: usize,
        /// Columns asked for.
        columns: usize,
    },
    /// A number outside its range, or not finite.
    OutOfRange {
        /// What the number is, with its unit.
        what: &'static str,
        /// The number.
        value: f64,
    },
    /// A pin on a particle that does not exist, or a second pin on one particle.
    Pin {
        /// Index of the particle.
        particle: usize,
    },
    /// No pin at all (the cloth would fall for ever), or nothing but pins.
    Pins,
    /// A stiffness that is negative or not finite.
    Stiffness {
        /// Item of the batch.
        item: usize,
        /// Channel: 0 warp, 1 weft, 2 shear, 3 bend.
        channel: usize,
        /// Row of the particle.
        row: usize,
        /// Column of the particle.
        column: usize,
    },
    /// Lengths or shapes that do not fit together.
    Shape {
        /// What has the wrong shape.
        what: &'static str,
        /// What it should be.
        expected: Vec<usize>,
        /// What it is.
        found: Vec<usize>,
    },
    /// The sparse factorisation could not be prepared (out of memory).
    Factorisation,
}

impl fmt::Display for ClothError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ClothError::GridSize { rows, columns } => {
                write!(f, "a grid of {rows} x {columns} particles: each side must have 2 to 4096")
            }
            ClothError::OutOfRange { what, value } => write!(f, "{what} is {value}, out of range"),
            ClothError::Pin { particle } => {
                write!(f, "the pin on particle {particle}: no such particle, or it is pinned already")
            }
            ClothError::Pins => write!(f, "a cloth at rest needs at least one pinned and one free particle"),
            ClothError::Stiffness { item, channel, row, column } => write!(
                f,
                "the stiffness of item {item}, channel {channel}, row {row}, column {column} is negative or not finite"
            ),
            ClothError::Shape { what, expected, found } => {
                write!(f, "{what} has the shape {found:?}, expected {expected:?}")
            }
            ClothError::Factorisation => write!(f, "the sparse factorisation could not be prepared: out of memory"),
        }
    }
}

impl std::error::Error for ClothError {}
