//! The word table that travels inside the generator file.

use std::collections::HashSet;

use half::f16;

use super::{ExportError, MAX_VOCABULARY};
use crate::nets::DESCRIPTION;

/// Name of row 0, the padding.
pub const PADDING: &str = "<pad>";

pub use crate::words::WordTable;

/// Checks every rule of the table: sizes, row 0, spelling, no word twice, every number within f16.
///
/// # Errors
/// [`ExportError::Words`] names the word and the rule; [`ExportError::NotHalf`] a number out of range.
pub fn check_words(table: &WordTable) -> Result<(), ExportError> {
    let bad = |what: String| Err(ExportError::Words(what));
    let n = table.tokens.len();
    if !(2..=MAX_VOCABULARY).contains(&n) {
        return bad(format!("{n} words, 2 to {MAX_VOCABULARY} with the padding are possible"));
    }
    if table.vectors.len() != n * DESCRIPTION {
        return bad(format!("{} numbers for {n} words of {DESCRIPTION}", table.vectors.len()));
    }
    if table.tokens[0] != PADDING {
        return bad(format!("word 0 is {:?}, not {PADDING:?}", table.tokens[0]));
    }
    if table.vectors[..DESCRIPTION].iter().any(|x| *x != 0.0) {
        return bad("the vector of the padding is not zero".into());
    }
    let mut seen = HashSet::new();
    for word in &table.tokens[1..] {
        let inner = word.bytes().all(|b| b.is_ascii_lowercase() || b.is_ascii_digit() || b == b'-');
        if word.is_empty() || !inner || word.starts_with('-') || word.ends_with('-') {
            return bad(format!("{word:?} is not made of a-z, 0-9 and inner hyphens"));
        }
        if !seen.insert(word) {
            return bad(format!("{word:?} stands in the table twice"));
        }
    }
    if table.vectors.iter().any(|x| !f16::from_f32(*x).is_finite()) {
        return Err(ExportError::NotHalf { tensor: "words".into() });
    }
    Ok(())
}
