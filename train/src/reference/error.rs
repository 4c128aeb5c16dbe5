use std::fmt;

/// Why a reference cloth was refused or stopped. Each names what is wrong.
#[derive(Clone, Debug, PartialEq)]
pub enum ReferenceError {
    /// A number outside its range, or not finite.
    OutOfRange {
        /// What the number is, with its unit.
        what: &'static str,
        /// The number.
        value: f64,
    },
    /// Lengths that do not fit together.
    Length {
        /// What has the wrong length.
        what: &'static str,
        /// What it should be.
        expected: usize,
        /// What it is.
        found: usize,
    },
    /// A pin on a vertex that does not exist, or nothing but pins.
    Pins,
    /// No fabric of this name.
    Fabric(String),
    /// The matrix of a step is not positive definite, or there was no memory for it.
    Factorisation,
    /// A position became infinite or no number.
    NotFinite,
    /// No shape at rest was found in the steps that were allowed.
    NotAtRest {
        /// The largest force on a free vertex that was left, in N.
        residual_n: f64,
    },
}

impl fmt::Display for ReferenceError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ReferenceError::OutOfRange { what, value } => write!(f, "{what} is {value}, out of range"),
            ReferenceError::Length { what, expected, found } => {
                write!(f, "{what} has {found} entries, expected {expected}")
            }
            ReferenceError::Pins => write!(f, "a pin on a vertex that does not exist, or nothing but pins"),
            ReferenceError::Fabric(name) => write!(f, "no measured fabric is named `{name}`"),
            ReferenceError::Factorisation => write!(f, "the matrix of a step could not be factorised"),
            ReferenceError::NotFinite => write!(f, "the cloth blew up: a position is not finite"),
            ReferenceError::NotAtRest { residual_n } => {
                write!(f, "the cloth did not come to rest: a force of {residual_n:.1e} N is left")
            }
        }
    }
}

impl std::error::Error for ReferenceError {}
