use std::collections::HashMap;

use crate::Error;

/// Most words of a vocabulary, the padding not counted.
pub const MAX_WORDS: usize = 3500;
/// Line 0 of the metadata value: the row of zeros that fills up a short description.
const PADDING: &str = "<pad>";
const MAX_WORD_BYTES: usize = 64;

/// The words that a generator knows, and their rows in its table of word vectors.
#[derive(Clone, Debug, PartialEq)]
pub struct Vocabulary {
    words: Vec<String>,
    rows: HashMap<String, usize>,
}

impl Vocabulary {
    /// Reads the value of `taut.vocabulary`: one word a line, line 0 is the padding. A word is made
    /// of a-z and 0-9, with single hyphens inside: nothing else could ever be looked up.
    pub(crate) fn parse(value: &str) -> Result<Vocabulary, Error> {
        let bad = |reason: String| Error::Metadata { key: "taut.vocabulary".into(), reason };
        let mut lines = value.split('\n');
        if lines.next() != Some(PADDING) {
            return Err(bad(format!("line 0 is not {PADDING}")));
        }
        let mut words = Vec::new();
        let mut rows = HashMap::new();
        for (line, word) in (1..).zip(lines) {
            if line > MAX_WORDS {
                return Err(bad(format!("more than {MAX_WORDS} words")));
            }
            if !is_word(word) {
                let word: String = word.chars().take(40).collect();
                return Err(bad(format!(
                    "line {line} is \"{word}\": a word has 1 to {MAX_WORD_BYTES} of a-z, 0-9 and inner hyphens"
                )));
            }
            if rows.insert(word.to_owned(), line).is_some() {
                return Err(bad(format!("line {line} repeats the word {word}")));
            }
            words.push(word.to_owned());
        }
        if words.is_empty() {
            return Err(bad("it has no words".into()));
        }
        Ok(Vocabulary { words, rows })
    }

    /// Number of words, the padding not counted.
    pub fn words(&self) -> usize {
        self.words.len()
    }

    /// The words in the order of the table, beginning with row 1.
    pub fn iter(&self) -> impl Iterator<Item = &str> {
        self.words.iter().map(String::as_str)
    }

    /// Row of a word (1 and up), exactly as it is written. None: not in the vocabulary.
    pub fn index(&self, word: &str) -> Option<usize> {
        self.rows.get(word).copied()
    }
}

fn is_word(word: &str) -> bool {
    let letters = word.bytes().all(|b| matches!(b, b'a'..=b'z' | b'0'..=b'9' | b'-'));
    letters && (1..=MAX_WORD_BYTES).contains(&word.len()) && word.split('-').all(|part| !part.is_empty())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_follow_the_lines() {
        let v = Vocabulary::parse("<pad>\ncotton\nnon-woven\n11oz").unwrap();
        assert_eq!(v.words(), 3);
        assert_eq!([v.index("cotton"), v.index("11oz"), v.index("<pad>")], [Some(1), Some(3), None]);
        assert_eq!(v.iter().collect::<Vec<_>>(), ["cotton", "non-woven", "11oz"]);
    }

    #[test]
    fn refuses_bad_tables() {
        let many = |n: usize| {
            let words: Vec<_> = (0..n).map(|i| format!("w{i}")).collect();
            format!("<pad>\n{}", words.join("\n"))
        };
        assert!(Vocabulary::parse(&many(MAX_WORDS)).is_ok());
        let long = format!("<pad>\n{}", "x".repeat(65));
        let bad = [
            &many(MAX_WORDS + 1),
            "",
            "<pad>",
            "<pad>\n",
            "cotton\ndenim",
            "<pad>\ncotton\ncotton",
            "<pad>\nCotton",
            "<pad>\ncotton\r",
            "<pad>\n-cotton",
            "<pad>\nnon--woven",
            "<pad>\n<pad>",
            "<pad>\ncaf\u{e9}",
            &long,
        ];
        for value in bad {
            assert!(Vocabulary::parse(value).is_err(), "{:?}", &value[..value.len().min(40)]);
        }
    }
}
