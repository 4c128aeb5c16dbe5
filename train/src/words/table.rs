//! The word table and its file: tokens, and their vectors as f16.
//!
//! The file is a text head, each line ended by a newline, and then the numbers:
//! ```text
//! taut-words 1
//! words 3000
//! dimensions 1024
//! origin one line that says how the table was made
//! checksum 16 hexadecimal digits: FNV-1a 64 of everything after this line
//! <pad>
//! ... one token a line ...
//! words * dimensions numbers, f16, little-endian, row by row
//! ```

use std::collections::HashMap;
use std::io::Write;
use std::path::Path;

use half::f16;

use super::{PAD, PAD_TOKEN, WordsError};

/// The first line of the file.
const MAGIC: &str = "taut-words 1";
/// Limits that a file must keep: rows, dimensions, bytes of a token.
const MOST_WORDS: usize = 65_536;
const MOST_DIMENSIONS: usize = 4096;
const MOST_TOKEN_BYTES: usize = 64;
/// The table that ships with the project.
const COMMITTED: &[u8] = include_bytes!("../../data/words.f16");

/// Words and their vectors.
#[derive(Clone, Debug, PartialEq)]
pub struct WordTable {
    /// The words; a word's place is its index, and place 0 is the padding.
    pub tokens: Vec<String>,
    /// The vectors, [word][dimension], of length 1; the padding is all zeros.
    pub vectors: Vec<f32>,
}

impl WordTable {
    /// The table that ships with the project: trained as `docs/words.md` says.
    ///
    /// # Errors
    /// [`WordsError::Table`] when the built-in bytes are damaged.
    pub fn committed() -> Result<Self, WordsError> {
        Self::from_bytes(COMMITTED)
    }

    /// Length of a vector; 0 for a table without words.
    pub fn dimensions(&self) -> usize {
        self.vectors.len().checked_div(self.tokens.len()).unwrap_or(0)
    }

    /// The vector of a word; `index` must be below the number of tokens, else the slice is empty.
    pub fn vector(&self, index: usize) -> &[f32] {
        let width = self.dimensions();
        self.vectors.get(index * width..(index + 1) * width).unwrap_or(&[])
    }

    /// The index of a word, as it stands. The padding is no word.
    pub fn index(&self, word: &str) -> Option<usize> {
        self.tokens.iter().position(|token| token == word).filter(|index| *index != PAD)
    }

    /// All words and their indices, for many look-ups. The padding is no word.
    pub fn indices(&self) -> HashMap<&str, usize> {
        self.tokens.iter().enumerate().skip(PAD + 1).map(|(index, token)| (token.as_str(), index)).collect()
    }

    /// Checks that the table is sound: a padding row of zeros first, distinct tokens, finite numbers, the right count.
    ///
    /// # Errors
    /// [`WordsError::Table`] with what is wrong.
    pub fn check(&self) -> Result<(), WordsError> {
        let fail = |what: String| Err(WordsError::Table(what));
        let width = self.dimensions();
        if self.tokens.is_empty() || self.tokens.len() > MOST_WORDS || width == 0 || width > MOST_DIMENSIONS {
            return fail(format!("{} words of {width} dimensions", self.tokens.len()));
        }
        if self.vectors.len() != width * self.tokens.len() {
            return fail(format!("{} numbers for {} words", self.vectors.len(), self.tokens.len()));
        }
        if self.tokens[PAD] != PAD_TOKEN {
            return fail(format!("the first token is '{}', not '{PAD_TOKEN}'", self.tokens[PAD].escape_debug()));
        }
        if self.vector(PAD).iter().any(|x| *x != 0.0) {
            return fail("the padding row is not zero".to_owned());
        }
        if let Some(at) = self.vectors.iter().position(|x| !x.is_finite()) {
            return fail(format!("the vector of '{}' is not finite", self.tokens[at / width].escape_debug()));
        }
        let plain = |token: &str| {
            (1..=MOST_TOKEN_BYTES).contains(&token.len())
                && token.bytes().all(|b| b.is_ascii_lowercase() || b.is_ascii_digit() || b == b'-')
        };
        if let Some(token) = self.tokens[PAD + 1..].iter().find(|token| !plain(token)) {
            return fail(format!("'{}' is not a token", token.escape_debug()));
        }
        if self.indices().len() + 1 != self.tokens.len() {
            return fail("a token stands twice".to_owned());
        }
        Ok(())
    }

    /// The bytes of the file. `origin` says in one line how the table was made; newlines in it become spaces.
    ///
    /// # Errors
    /// [`WordsError::Table`] when the table is not sound.
    pub fn to_bytes(&self, origin: &str) -> Result<Vec<u8>, WordsError> {
        self.check()?;
        let mut body = Vec::with_capacity(self.vectors.len() * 2 + self.tokens.len() * 10);
        for token in &self.tokens {
            body.extend_from_slice(token.as_bytes());
            body.push(b'\n');
        }
        for x in &self.vectors {
            body.extend_from_slice(&f16::from_f32(*x).to_le_bytes());
        }
        let mut bytes = format!(
            "{MAGIC}\nwords {}\ndimensions {}\norigin {}\nchecksum {:016x}\n",
            self.tokens.len(),
            self.dimensions(),
            origin.replace(['\n', '\r'], " "),
            fnv1a(&body)
        )
        .into_bytes();
        bytes.extend_from_slice(&body);
        Ok(bytes)
    }

    /// Reads the bytes of a file.
    ///
    /// # Errors
    /// [`WordsError::Table`] with what is wrong: not such a file, another version, too short or long, damaged.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, WordsError> {
        let fail = |what: &str| WordsError::Table(what.to_owned());
        let mut rest = bytes;
        if line(&mut rest, 64) != Some(MAGIC) {
            return Err(fail("not a word table of version 1"));
        }
        let words = number(line(&mut rest, 64), "words ").filter(|n| (1..=MOST_WORDS).contains(n));
        let words = words.ok_or_else(|| fail("the line 'words' is missing or out of range"))?;
        let width = number(line(&mut rest, 64), "dimensions ").filter(|n| (1..=MOST_DIMENSIONS).contains(n));
        let width = width.ok_or_else(|| fail("the line 'dimensions' is missing or out of range"))?;
        line(&mut rest, 4096)
            .filter(|line| line.starts_with("origin "))
            .ok_or_else(|| fail("the line 'origin' is missing"))?;
        let checksum = line(&mut rest, 64)
            .and_then(|line| line.strip_prefix("checksum "))
            .and_then(|digits| u64::from_str_radix(digits, 16).ok())
            .ok_or_else(|| fail("the line 'checksum' is missing"))?;
        if fnv1a(rest) != checksum {
            return Err(fail("damaged or cut short: the checksum differs"));
        }
        let mut tokens = Vec::with_capacity(words);
        for _ in 0..words {
            tokens.push(line(&mut rest, MOST_TOKEN_BYTES + 1).ok_or_else(|| fail("too few tokens"))?.to_owned());
        }
        if rest.len() != words * width * 2 {
            return Err(fail(&format!("{} bytes of numbers, but {} are needed", rest.len(), words * width * 2)));
        }
        let vectors = rest.as_chunks::<2>().0.iter().map(|pair| f16::from_le_bytes(*pair).to_f32()).collect();
        let table = Self { tokens, vectors };
        table.check()?;
        Ok(table)
    }

    /// Writes the file; an older one stays whole until the new one is complete.
    ///
    /// # Errors
    /// [`WordsError::Table`] for an unsound table, [`WordsError::Io`] when it cannot be written.
    pub fn save(&self, path: &Path, origin: &str) -> Result<(), WordsError> {
        let bytes = self.to_bytes(origin)?;
        let mut part = path.as_os_str().to_owned();
        part.push(".part");
        let write = || {
            let mut file = std::fs::File::create(&part)?;
            file.write_all(&bytes)?;
            file.sync_all()?;
            std::fs::rename(&part, path)
        };
        write().map_err(|source| WordsError::Io { path: path.to_owned(), source })
    }

    /// Reads a file.
    ///
    /// # Errors
    /// [`WordsError::Io`] when it cannot be read, [`WordsError::Table`] when it is no sound table.
    pub fn load(path: &Path) -> Result<Self, WordsError> {
        let bytes = std::fs::read(path).map_err(|source| WordsError::Io { path: path.to_owned(), source })?;
        Self::from_bytes(&bytes).map_err(|error| match error {
            WordsError::Table(what) => WordsError::Table(format!("{}: {what}", path.display())),
            other => other,
        })
    }
}

/// Takes one line of text of at most `most` bytes from the front; nothing when there is none.
fn line<'a>(rest: &mut &'a [u8], most: usize) -> Option<&'a str> {
    let end = rest.iter().take(most + 1).position(|b| *b == b'\n')?;
    let text = std::str::from_utf8(&rest[..end]).ok()?;
    *rest = &rest[end + 1..];
    Some(text)
}

/// The whole number after a name.
fn number(line: Option<&str>, name: &str) -> Option<usize> {
    line?.strip_prefix(name)?.parse().ok()
}

/// The 64-bit hash of Fowler, Noll and Vo, variant 1a.
fn fnv1a(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xCBF2_9CE4_8422_2325, |hash, byte| (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01B3))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table() -> WordTable {
        let tokens = ["<pad>", "silk", "t-shirt"].map(str::to_owned).to_vec();
        WordTable { tokens, vectors: vec![0.0, 0.0, 0.6, 0.8, -1.0, 0.0] }
    }

    #[test]
    fn files_come_back() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("words.f16");
        table().save(&path, "a test\nof two lines").expect("saved");
        let back = WordTable::load(&path).expect("loaded");
        assert_eq!(back.tokens, table().tokens);
        assert!(back.vectors.iter().zip(&table().vectors).all(|(a, b)| (a - b).abs() < 1e-3));
        assert_eq!(
            back.to_bytes("x").expect("bytes"),
            WordTable::from_bytes(&back.to_bytes("y").expect("bytes")).and_then(|t| t.to_bytes("x")).expect("bytes")
        );
        assert_eq!((back.index("silk"), back.index("<pad>"), back.dimensions()), (Some(1), None, 2));
        assert_eq!(back.vector(9), [0.0f32; 0]);
    }

    #[test]
    fn damage_is_found_and_told() {
        let bytes = table().to_bytes("test").expect("bytes");
        assert!(WordTable::from_bytes(&bytes).is_ok());
        for length in 0..bytes.len() {
            assert!(WordTable::from_bytes(&bytes[..length]).is_err(), "{length}");
        }
        for place in 0..bytes.len() {
            let mut changed = bytes.clone();
            changed[place] ^= 4;
            // The origin is a remark and not guarded; all else is.
            let remark = bytes.windows(8).position(|w| w == b"origin t").expect("there") + 7;
            assert_eq!(WordTable::from_bytes(&changed).is_ok(), (remark..remark + 4).contains(&place), "{place}");
        }
        let mut longer = bytes;
        longer.push(0);
        assert!(WordTable::from_bytes(&longer).is_err());
    }

    #[test]
    fn unsound_tables_are_refused() {
        let with = |change: &dyn Fn(&mut WordTable)| {
            let mut changed = table();
            change(&mut changed);
            changed.to_bytes("test").expect_err("refused").to_string()
        };
        assert!(with(&|t| t.vectors[0] = 1.0).contains("padding"));
        assert!(with(&|t| t.vectors[3] = f32::NAN).contains("silk"));
        assert!(with(&|t| t.tokens[2] = "silk".to_owned()).contains("twice"));
        assert!(with(&|t| t.tokens[2] = "no token".to_owned()).contains("no token"));
        assert!(with(&|t| t.tokens[0] = "pad".to_owned()).contains("first token"));
        assert!(with(&|t| t.vectors.truncate(5)).contains("5 numbers"));
        let error = WordTable::load(Path::new("no-such-table.f16")).expect_err("absent").to_string();
        assert!(error.contains("no-such-table.f16"));
    }
}
