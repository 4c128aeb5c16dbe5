use crate::{Error, Vocabulary};

/// Longest description in bytes. A description has at most some ten words that count.
pub(crate) const MAX_DESCRIPTION_BYTES: usize = 16 * 1024;

/// The words of a description as rows of the word table.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Tokens {
    /// Known words as they stand in the vocabulary, in the order of the description.
    pub words: Vec<String>,
    /// Their rows of the word table, 1 and up.
    pub rows: Vec<usize>,
    /// Words that the vocabulary lacks, each once, in the order of the description. They are skipped.
    pub unknown: Vec<String>,
    /// Known words beyond what the generator takes. They are skipped too.
    pub dropped: Vec<String>,
}

impl Tokens {
    /// Splits and looks up a description; at most `limit` words count.
    ///
    /// Upper case is lowered; everything that is not a-z, 0-9 or a hyphen between two of these
    /// separates words. A word that the vocabulary lacks is tried without its plural s; a hyphenated
    /// one that is still unknown is split at its hyphens. Errors: [`Error::NoKnownWord`],
    /// [`Error::LongDescription`].
    pub(crate) fn of(description: &str, vocabulary: &Vocabulary, limit: usize) -> Result<Tokens, Error> {
        if description.len() > MAX_DESCRIPTION_BYTES {
            let (bytes, limit) = (description.len(), MAX_DESCRIPTION_BYTES);
            return Err(Error::LongDescription { bytes, limit });
        }
        let mut tokens = Tokens::default();
        for word in split(description) {
            if tokens.know(&word, vocabulary, limit) {
                continue;
            }
            // a word without a hyphen is its own only part
            for part in word.split('-') {
                let hyphenated = part.len() < word.len();
                let known = hyphenated && tokens.know(part, vocabulary, limit);
                if !known && !tokens.unknown.iter().any(|u| u == part) {
                    tokens.unknown.push(part.into());
                }
            }
        }
        if tokens.rows.is_empty() {
            return Err(Error::NoKnownWord { unknown: tokens.unknown });
        }
        Ok(tokens)
    }

    /// Takes a word if the vocabulary has it, as it is or without a plural s.
    fn know(&mut self, word: &str, vocabulary: &Vocabulary, limit: usize) -> bool {
        let singular = word.strip_suffix('s');
        let found = std::iter::once(word).chain(singular).find_map(|w| vocabulary.index(w).map(|row| (w, row)));
        let Some((word, row)) = found else {
            return false;
        };
        if self.rows.len() < limit {
            self.words.push(word.into());
            self.rows.push(row);
        } else {
            self.dropped.push(word.into());
        }
        true
    }
}

/// The words of a text in lower case: runs of letters, digits and inner hyphens.
fn split(text: &str) -> Vec<String> {
    let bytes = text.as_bytes();
    // bytes of characters beyond ASCII are no letters here, so they separate, as punctuation does
    let letter = |i: usize| bytes.get(i).is_some_and(u8::is_ascii_alphanumeric);
    let mut words = Vec::new();
    let mut word = String::new();
    for (i, &byte) in bytes.iter().enumerate() {
        let inner_hyphen = byte == b'-' && i > 0 && letter(i - 1) && letter(i + 1);
        if letter(i) || inner_hyphen {
            word.push(byte.to_ascii_lowercase() as char);
        } else if !word.is_empty() {
            words.push(std::mem::take(&mut word));
        }
    }
    if !word.is_empty() {
        words.push(word);
    }
    words
}

#[cfg(test)]
mod tests {
    use super::*;

    fn vocabulary() -> Vocabulary {
        Vocabulary::parse("<pad>\nheavy\nblue\ndenim\nnon-woven\nstretch\ncotton\nglass\njean").unwrap()
    }

    fn of(text: &str) -> Result<Tokens, Error> {
        Tokens::of(text, &vocabulary(), 16)
    }

    #[test]
    fn splits_and_lowers() {
        assert_eq!(split("Heavy, BLUE denim!"), ["heavy", "blue", "denim"]);
        assert_eq!(split("a--b -c- d-e 11oz/12 caf\u{e9}s\u{212a}"), ["a", "b", "c", "d-e", "11oz", "12", "caf", "s"]);
        assert!(split(" -- \u{2014}\n").is_empty());
    }

    #[test]
    fn known_words_become_rows() {
        let t = of("Heavy blue DENIM").unwrap();
        assert_eq!(t.rows, [1, 2, 3]);
        assert_eq!(t.words, ["heavy", "blue", "denim"]);
        assert!(t.unknown.is_empty() && t.dropped.is_empty());
    }

    #[test]
    fn plurals_fall_back_to_the_singular() {
        let t = of("jeans, denims and glass").unwrap();
        assert_eq!(t.words, ["jean", "denim", "glass"]);
        assert_eq!(t.unknown, ["and"]);
    }

    #[test]
    fn hyphens_split_only_when_needed() {
        assert_eq!(of("non-woven").unwrap().words, ["non-woven"]);
        assert_eq!(of("non-wovens").unwrap().words, ["non-woven"]);
        let t = of("stretch-denims").unwrap();
        assert_eq!(t.words, ["stretch", "denim"]);
        let t = of("blue-ish denim").unwrap();
        assert_eq!((t.words, t.unknown), (vec!["blue".into(), "denim".into()], vec!["ish".into()]));
    }

    #[test]
    fn unknown_words_are_named_once() {
        let t = of("foo denim bar foo").unwrap();
        assert_eq!(t.unknown, ["foo", "bar"]);
        assert_eq!(
            of("foo bar-baz"),
            Err(Error::NoKnownWord { unknown: vec!["foo".into(), "bar".into(), "baz".into()] })
        );
        assert_eq!(of(""), Err(Error::NoKnownWord { unknown: vec![] }));
        assert_eq!(of("<pad>"), Err(Error::NoKnownWord { unknown: vec!["pad".into()] }));
    }

    #[test]
    fn words_beyond_the_limit_are_dropped() {
        let text = format!("{}cotton jeans", "denim ".repeat(16));
        let t = of(&text).unwrap();
        assert_eq!(t.rows, [3; 16]);
        assert_eq!(t.dropped, ["cotton", "jean"]);
    }

    #[test]
    fn a_book_is_no_description() {
        let text = "denim ".repeat(10_000);
        assert!(matches!(of(&text), Err(Error::LongDescription { bytes: 60_000, .. })));
    }
}
