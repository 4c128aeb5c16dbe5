use std::fmt;

/// Why a generator file or a request was refused. The text is one line and names what is wrong.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Error {
    /// The file cannot be opened or read.
    Io {
        /// The path as it was given.
        path: String,
        /// What the system says.
        reason: String,
    },
    /// The file is larger than a generator file may be.
    TooLarge {
        /// Most bytes that are read.
        limit: usize,
    },
    /// The file ends in the middle of a field.
    Truncated {
        /// Where that field begins.
        offset: usize,
        /// Bytes that are missing.
        missing: u64,
    },
    /// The bytes are not an ONNX model.
    NotOnnx {
        /// What they break.
        reason: String,
    },
    /// A metadata key of a generator file is not there.
    MetadataMissing {
        /// The key.
        key: &'static str,
    },
    /// A metadata value is not what a generator file may hold.
    Metadata {
        /// The key.
        key: String,
        /// What is wrong with its value.
        reason: String,
    },
    /// The graph uses an operation that no generator uses.
    Op {
        /// The operation.
        op: String,
        /// The tensor that it writes.
        node: String,
    },
    /// The graph is not put together as a generator is.
    Graph {
        /// What is wrong.
        reason: String,
    },
    /// A tensor has another shape than the metadata or the operation needs.
    TensorShape {
        /// The tensor.
        tensor: String,
        /// The shape it must have, in words or numbers.
        expected: String,
        /// The shape it has.
        found: Vec<usize>,
    },
    /// A weight of the file is NaN or infinite.
    Weights {
        /// The tensor that holds it.
        tensor: String,
    },
    /// The inference engine refused the graph.
    Inference {
        /// Which of its stages.
        stage: &'static str,
        /// What it says.
        reason: String,
    },
    /// The network wrote NaN, or a number that tanh cannot write.
    Output {
        /// The output.
        output: &'static str,
        /// The number.
        value: f32,
    },
    /// No word of the description is in the vocabulary.
    NoKnownWord {
        /// The words of the description; empty when it has none.
        unknown: Vec<String>,
    },
    /// The description is longer than any description needs to be.
    LongDescription {
        /// Its bytes.
        bytes: usize,
        /// Most bytes.
        limit: usize,
    },
    /// A correction cannot be baked as it is.
    Baked(taut::Error),
    /// A side of the grid has fewer than 2 or more than 4096 particles.
    GridSize {
        /// Rows asked for.
        rows: usize,
        /// Columns asked for.
        columns: usize,
    },
    /// A side length is not finite, not above 0, or above 10 km.
    SideLength {
        /// Side along u in m.
        width_m: f32,
        /// Side along v in m.
        height_m: f32,
    },
    /// A pin is not a particle of the grid.
    Pin {
        /// Its row.
        row: usize,
        /// Its column.
        column: usize,
        /// Rows of the grid.
        rows: usize,
        /// Columns of the grid.
        columns: usize,
    },
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Error::Io { path, reason } => {
                write!(f, "cannot read {}: {}", one_line(path), one_line(reason))
            }
            Error::TooLarge { limit } => {
                write!(f, "the generator file is larger than {limit} bytes")
            }
            Error::Truncated { offset, missing } => {
                write!(f, "the generator file is truncated: the field at byte {offset} lacks {missing} bytes")
            }
            Error::NotOnnx { reason } => write!(f, "not an ONNX file: {}", one_line(reason)),
            Error::MetadataMissing { key } => {
                write!(f, "not a generator file: the metadata has no {key}")
            }
            Error::Metadata { key, reason } => {
                write!(f, "bad metadata {}: {}", one_line(key), one_line(reason))
            }
            Error::Op { op, node } => write!(
                f,
                "the operation {} (of {}) does not belong into a generator file",
                one_line(op),
                one_line(node)
            ),
            Error::Graph { reason } => write!(f, "bad generator graph: {}", one_line(reason)),
            Error::TensorShape { tensor, expected, found } => {
                write!(f, "tensor {} has the shape {found:?}, expected {}", one_line(tensor), one_line(expected))
            }
            Error::Weights { tensor } => {
                write!(f, "tensor {} holds a weight that is not finite", one_line(tensor))
            }
            Error::Inference { stage, reason } => {
                write!(f, "the inference engine failed to {stage} the graph: {}", one_line(reason))
            }
            Error::Output { output, value } => write!(
                f,
                "the generator wrote {value} to {output}, which must be within -1 and 1: its weights are broken"
            ),
            Error::NoKnownWord { unknown } if unknown.is_empty() => {
                write!(f, "the description has no words")
            }
            Error::NoKnownWord { unknown } => {
                write!(f, "the generator knows no word of the description: ")?;
                list(f, unknown)
            }
            Error::LongDescription { bytes, limit } => {
                write!(f, "the description has {bytes} bytes, the limit is {limit}")
            }
            Error::Baked(reason) => write!(f, "the field cannot be baked: {reason}"),
            Error::GridSize { rows, columns } => {
                write!(f, "a grid of {rows} x {columns} particles: each side must have 2 to 4096")
            }
            Error::SideLength { width_m, height_m } => {
                write!(f, "sides of {width_m} m and {height_m} m: each must be above 0 and at most 10000 m")
            }
            Error::Pin { row, column, rows, columns } => {
                write!(f, "the pin at row {row}, column {column} is not on the grid of {rows} x {columns}")
            }
        }
    }
}

impl std::error::Error for Error {}

/// At most eight words, each cut at 40 letters, then how many more there are.
fn list(f: &mut fmt::Formatter<'_>, words: &[String]) -> fmt::Result {
    const SHOWN: usize = 8;
    for (i, word) in words.iter().take(SHOWN).enumerate() {
        let separator = if i == 0 { "" } else { ", " };
        write!(f, "{separator}{}", word.chars().take(40).collect::<String>())?;
    }
    match words.len().checked_sub(SHOWN) {
        Some(more) if more > 0 => write!(f, " and {more} more"),
        _ => Ok(()),
    }
}

/// Text from a file made fit for one line: control characters escaped, cut at 240 characters.
fn one_line(text: &str) -> String {
    let mut line = String::new();
    for (i, c) in text.chars().enumerate() {
        if i == 240 {
            line.push_str("...");
            break;
        }
        if c.is_control() || matches!(c, '\u{2028}' | '\u{2029}') {
            line.extend(c.escape_default());
        } else {
            line.push(c);
        }
    }
    line
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_are_one_short_line() {
        let unknown = (0..100).map(|i| format!("{}{i}", "x".repeat(1000))).collect();
        let errors = [
            Error::NotOnnx { reason: "a\nb\u{1b}[31m\r".repeat(1000) },
            Error::NoKnownWord { unknown },
            Error::Io { path: "\n".into(), reason: "no\nsuch".into() },
        ];
        for error in errors {
            let text = error.to_string();
            assert!(text.len() < 1200 && !text.chars().any(char::is_control), "{text}");
        }
    }

    #[test]
    fn unknown_words_are_named() {
        let text = Error::NoKnownWord { unknown: vec!["foo".into(), "bar".into()] }.to_string();
        assert_eq!(text, "the generator knows no word of the description: foo, bar");
    }
}
