//! The word table that travels inside the generator file.

use std::collections::HashSet;

use half::f16;

use super::{ExportError, MAX_VOCABULARY};
use crate::nets::DESCRIPTION;

/// Name of row 0, the padding.
pub const PADDING: &str = "<pad>";

/// Words and their vectors, in the order of the token indices.
#[derive(Debug, Clone, PartialEq)]
pub struct WordTable {
    /// Row i is the word of token i; row 0 is `<pad>`; the others are made of a-z, 0-9 and inner hyphens, each once.
    pub tokens: Vec<String>,
    /// [tokens, 1024], row-major; row 0 is all zeros.
    pub vectors: Vec<f32>,
}

impl WordTable {
    /// Checks every rule of the table: sizes, row 0, spelling, no word twice, every number within f16.
    ///
    /// # Errors
    /// [`ExportError::Words`] names the word and the rule; [`ExportError::NotHalf`] a number out of range.
    pub fn check(&self) -> Result<(), ExportError> {
        let bad = |what: String| Err(ExportError::Words(what));
        let n = self.tokens.len();
        if !(2..=MAX_VOCABULARY).contains(&n) {
            return bad(format!(
                "{n} words, 2 to {MAX_VOCABULARY} with the padding are possible"
            ));
        }
        if self.vectors.len() != n * DESCRIPTION {
            return bad(format!(
                "{} numbers for {n} words of {DESCRIPTION}",
                self.vectors.len()
            ));
        }
        if self.tokens[0] != PADDING {
            return bad(format!("word 0 is {:?}, not {PADDING:?}", self.tokens[0]));
        }
        if self.vectors[..DESCRIPTION].iter().any(|x| *x != 0.0) {
            return bad("the vector of the padding is not zero".into());
        }
        let mut seen = HashSet::new();
        for word in &self.tokens[1..] {
            let inner = word
                .bytes()
                .all(|b| b.is_ascii_lowercase() || b.is_ascii_digit() || b == b'-');
            if word.is_empty() || !inner || word.starts_with('-') || word.ends_with('-') {
                return bad(format!(
                    "{word:?} is not made of a-z, 0-9 and inner hyphens"
                ));
            }
            if !seen.insert(word) {
                return bad(format!("{word:?} stands in the table twice"));
            }
        }
        if self.vectors.iter().any(|x| !f16::from_f32(*x).is_finite()) {
            return Err(ExportError::NotHalf {
                tensor: "words".into(),
            });
        }
        Ok(())
    }
}
