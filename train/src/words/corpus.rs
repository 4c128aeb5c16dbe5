//! Reads a corpus: WordNet's data files or plain text, as sentences of interned words.
//!
//! In a WordNet data file (wndb(5WN)) a line is one synset: fields, the words of the synset, pointers, a bar, the gloss.
//! The words and the definition make one sentence ("denim dungaree jean a coarse durable twill-weave cotton fabric"), so
//! that a word meets its definition within the window; each quoted example is a sentence of its own.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use super::WordsError;
use super::tokens::tokenize;

/// Sentences of interned words.
#[derive(Clone, Debug, Default)]
pub struct Corpus {
    words: Vec<String>,
    ids: HashMap<String, u32>,
    tokens: Vec<u32>,
    ends: Vec<usize>,
}

impl Corpus {
    /// Reads a file, or the files of a folder in the order of their names.
    ///
    /// In a folder that has WordNet's `data.*` files these are read; otherwise its `.txt` and `.md` files.
    ///
    /// # Errors
    /// [`WordsError::Io`], [`WordsError::NotText`], or [`WordsError::EmptyCorpus`] when no sentence was found.
    pub fn read(path: &Path) -> Result<Self, WordsError> {
        let mut corpus = Self::default();
        for file in files(path)? {
            let bytes = std::fs::read(&file).map_err(|source| WordsError::Io { path: file.clone(), source })?;
            let text = String::from_utf8(bytes).map_err(|_| WordsError::NotText { path: file.clone() })?;
            if is_wordnet(&text) {
                corpus.add_wordnet(&text);
            } else {
                corpus.add_text(&text);
            }
        }
        if corpus.ends.is_empty() {
            return Err(WordsError::EmptyCorpus { path: path.to_owned() });
        }
        Ok(corpus)
    }

    /// Adds plain text: a sentence ends at . ! ? or ; before white space, and at an empty line.
    pub fn add_text(&mut self, text: &str) {
        for paragraph in paragraphs(text) {
            for sentence in split_sentences(&paragraph) {
                self.add_sentence(&tokenize(sentence));
            }
        }
    }

    /// Adds the synsets of a WordNet data file; lines that are none (the licence at its head) are passed over.
    pub fn add_wordnet(&mut self, text: &str) {
        for line in text.lines() {
            let Some((words, gloss)) = synset(line) else {
                continue;
            };
            // Examples stand in quotes; the rest is the definition. Every second piece lies inside quotes.
            let mut head = words;
            let mut examples = Vec::new();
            for (index, piece) in gloss.split('"').enumerate() {
                if index % 2 == 0 {
                    head.extend(tokenize(piece));
                } else {
                    examples.push(tokenize(piece));
                }
            }
            self.add_sentence(&head);
            for example in examples {
                self.add_sentence(&example);
            }
        }
    }

    /// Adds one sentence; one of fewer than two words teaches nothing and is left out.
    pub fn add_sentence(&mut self, sentence: &[String]) {
        if sentence.len() < 2 {
            return;
        }
        for word in sentence {
            let id = match self.ids.get(word) {
                Some(id) => *id,
                None => {
                    let id = self.words.len() as u32;
                    self.words.push(word.clone());
                    self.ids.insert(word.clone(), id);
                    id
                }
            };
            self.tokens.push(id);
        }
        self.ends.push(self.tokens.len());
    }

    /// The distinct words in the order of their first appearance; a token is an index into them.
    pub fn words(&self) -> &[String] {
        &self.words
    }

    /// The number of a word, if it occurs.
    pub fn id(&self, word: &str) -> Option<u32> {
        self.ids.get(word).copied()
    }

    /// The sentences, each a list of indices into [`Corpus::words`].
    pub fn sentences(&self) -> impl Iterator<Item = &[u32]> {
        let starts = std::iter::once(0).chain(self.ends.iter().copied());
        starts.zip(&self.ends).map(|(start, end)| &self.tokens[start..*end])
    }

    /// How many sentences there are.
    pub fn sentence_count(&self) -> usize {
        self.ends.len()
    }

    /// How many words there are in all sentences.
    pub fn token_count(&self) -> usize {
        self.tokens.len()
    }
}

/// The files to read at a path, sorted.
fn files(path: &Path) -> Result<Vec<PathBuf>, WordsError> {
    let io = |source| WordsError::Io { path: path.to_owned(), source };
    if !std::fs::metadata(path).map_err(io)?.is_dir() {
        return Ok(vec![path.to_owned()]);
    }
    let mut all = Vec::new();
    for entry in std::fs::read_dir(path).map_err(io)? {
        let file = entry.map_err(io)?.path();
        if file.is_file() {
            all.push(file);
        }
    }
    all.sort();
    let named =
        |file: &PathBuf, wanted: &dyn Fn(&str) -> bool| file.file_name().and_then(|n| n.to_str()).is_some_and(wanted);
    let data = ["data.adj", "data.adv", "data.noun", "data.verb"];
    let wordnet: Vec<PathBuf> = all.iter().filter(|file| named(file, &|name| data.contains(&name))).cloned().collect();
    if !wordnet.is_empty() {
        return Ok(wordnet);
    }
    all.retain(|file| named(file, &|name| name.ends_with(".txt") || name.ends_with(".md")));
    Ok(all)
}

/// Whether a text looks like a WordNet data file: its first line that is not licence is a synset.
fn is_wordnet(text: &str) -> bool {
    text.lines().find(|line| !line.starts_with("  ")).is_some_and(|line| synset(line).is_some())
}

/// The words and the gloss of a line `offset lex_filenum ss_type w_cnt word lex_id [word lex_id...] ... | gloss`.
fn synset(line: &str) -> Option<(Vec<String>, &str)> {
    let (fields, gloss) = line.split_once(" | ")?;
    let mut fields = fields.split(' ');
    let offset = fields.next()?;
    if offset.len() != 8 || !offset.bytes().all(|b| b.is_ascii_digit()) {
        return None;
    }
    let kind = fields.nth(1)?;
    if !matches!(kind, "n" | "v" | "a" | "s" | "r") {
        return None;
    }
    let count = usize::from_str_radix(fields.next()?, 16).ok()?;
    let mut words = Vec::new();
    for _ in 0..count {
        // An adjective may carry its place in brackets: "afloat(p)".
        let word = fields.next()?.split('(').next()?;
        words.extend(tokenize(&word.replace('_', " ")));
        fields.next()?;
    }
    Some((words, gloss))
}

/// The paragraphs of a text, lines joined.
fn paragraphs(text: &str) -> Vec<String> {
    let mut all = Vec::new();
    let mut current = String::new();
    for line in text.lines() {
        if line.trim().is_empty() {
            all.push(std::mem::take(&mut current));
        } else {
            current.push_str(line);
            current.push(' ');
        }
    }
    all.push(current);
    all.retain(|paragraph| !paragraph.is_empty());
    all
}

/// The sentences of a paragraph.
fn split_sentences(paragraph: &str) -> Vec<&str> {
    let mut all = Vec::new();
    let mut start = 0;
    let mut ended = false;
    for (at, c) in paragraph.char_indices() {
        if ended && c.is_whitespace() {
            all.push(&paragraph[start..at]);
            start = at;
        }
        ended = matches!(c, '.' | '!' | '?' | ';') || (ended && matches!(c, '"' | '\'' | ')' | '\u{201d}'));
    }
    all.push(&paragraph[start..]);
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    const SYNSETS: &str = "  1 This software and database is being provided to you, the LICENSEE, by\n\
        03175189 06 n 03 denim 0 dungaree 0 blue_jean 0 001 @ 03309808 n 0000 | a coarse twill-weave fabric; \"she wore denim\"  \n\
        00015720 00 a 01 afloat(p) 0 000 | borne on the water\n";

    fn sentences(corpus: &Corpus) -> Vec<String> {
        let words = corpus.words();
        let join = |s: &[u32]| s.iter().map(|id| words[*id as usize].as_str()).collect::<Vec<_>>().join(" ");
        corpus.sentences().map(join).collect()
    }

    #[test]
    fn synsets_give_their_words_definition_and_examples() {
        assert!(is_wordnet(SYNSETS));
        let mut corpus = Corpus::default();
        corpus.add_wordnet(SYNSETS);
        let expected =
            ["denim dungaree blue jean a coarse twill-weave fabric", "she wore denim", "afloat borne on the water"];
        assert_eq!(sentences(&corpus), expected);
        assert_eq!(corpus.token_count(), 16);
    }

    #[test]
    fn plain_text_is_split_into_sentences() {
        let mut corpus = Corpus::default();
        let text = "Silk is light. It weighs 3.5 g; \"So soft!\" she said\nand wore it.\n\nEnd\n\nof text";
        assert!(!is_wordnet(text));
        corpus.add_text(text);
        let expected = ["silk is light", "it weighs 3 5 g", "so soft", "she said and wore it", "of text"];
        assert_eq!(sentences(&corpus), expected);
    }

    #[test]
    fn folders_are_read_in_order_and_errors_name_the_file() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path();
        assert!(matches!(Corpus::read(path), Err(WordsError::EmptyCorpus { .. })));
        std::fs::write(path.join("b.txt"), "second file").expect("written");
        std::fs::write(path.join("a.md"), "first file").expect("written");
        std::fs::write(path.join("c.bin"), [255, 254]).expect("written");
        assert_eq!(sentences(&Corpus::read(path).expect("read")), ["first file", "second file"]);
        let error = Corpus::read(&path.join("c.bin")).expect_err("not text").to_string();
        assert!(error.contains("c.bin") && error.contains("UTF-8"), "{error}");
        let error = Corpus::read(&path.join("none")).expect_err("absent").to_string();
        assert!(error.contains("none"), "{error}");
        std::fs::write(path.join("data.noun"), SYNSETS).expect("written");
        assert_eq!(Corpus::read(path).expect("read").sentence_count(), 3);
    }
}
