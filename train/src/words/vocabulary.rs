//! Chooses the words that get a vector, and turns the text into their numbers.
//!
//! First every word of the generated sentences; then the words of the corpus that keep company with textiles; then the
//! most frequent ones. Words that may stand as context are more: what stands around a word tells its meaning whether or
//! not it has a row in the table.

use std::collections::{HashMap, HashSet};

use super::catalogue::fabrics;
use super::corpus::Corpus;
use super::scales::THINGS;
use super::tokens::resolve;
use super::{PAD, PAD_TOKEN};

/// Words that make a sentence of the corpus one about textiles, on their own.
const TEXTILE_NOUNS: &[&str] = &[
    "fabric",
    "fabrics",
    "cloth",
    "textile",
    "textiles",
    "garment",
    "garments",
    "clothing",
    "yarn",
    "weave",
    "woven",
    "knit",
    "knitted",
    "knitting",
    "cotton",
    "wool",
    "woolen",
    "silk",
    "linen",
    "velvet",
    "denim",
    "upholstery",
    "curtain",
    "curtains",
    "skirt",
    "trousers",
    "sleeve",
    "sleeves",
    "sewing",
    "stitch",
    "lace",
];
/// A word of the corpus must occur so often, and so often among textiles, to be chosen for its company.
const LEAST_COUNT: u64 = 6;
/// Of the rows left after the generated sentences, the share that goes to the words nearest to textiles.
const TEXTILE_SHARE: f64 = 0.5;

/// The words with a vector, and after them those that only stand as context.
#[derive(Clone, Debug)]
pub struct Vocabulary {
    words: Vec<String>,
    ids: HashMap<String, usize>,
    rows: usize,
}

impl Vocabulary {
    /// Chooses at most `rows` words with a vector (the padding row counted) and at most `contexts` words in all.
    ///
    /// When the generated sentences alone hold more words, their most frequent ones are kept.
    pub fn choose(corpus: &Corpus, generated: &[Vec<String>], rows: usize, contexts: usize) -> Self {
        let own = own_words(generated);
        let kept: HashSet<&str> = own.iter().map(|(word, _)| *word).collect();
        let counts = Counts::new(corpus, &kept);
        let mut chosen = Self { words: Vec::new(), ids: HashMap::new(), rows };
        chosen.push(PAD_TOKEN);
        for (word, _) in &own {
            if chosen.words.len() < rows {
                chosen.push(word);
            }
        }
        let near = chosen.words.len() + ((rows - chosen.words.len()) as f64 * TEXTILE_SHARE) as usize;
        for id in counts.by_company() {
            if chosen.words.len() >= near {
                break;
            }
            chosen.push(&corpus.words()[id]);
        }
        for id in counts.by_frequency() {
            if chosen.words.len() >= contexts {
                break;
            }
            chosen.push(&corpus.words()[id]);
        }
        chosen.rows = rows.min(chosen.words.len());
        chosen
    }

    /// Adds a word that is not there yet.
    fn push(&mut self, word: &str) {
        if !self.ids.contains_key(word) {
            self.ids.insert(word.to_owned(), self.words.len());
            self.words.push(word.to_owned());
        }
    }

    /// The words with a vector; the first is the padding.
    pub fn tokens(&self) -> &[String] {
        &self.words[..self.rows]
    }

    /// How many words have a vector, the padding counted.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// How many words there are in all, those that are only context counted.
    pub fn contexts(&self) -> usize {
        self.words.len()
    }

    /// The number of a word; numbers below [`Vocabulary::rows`] have a vector. The padding is no word.
    pub fn id(&self, word: &str) -> Option<usize> {
        self.ids.get(word).copied().filter(|id| *id != PAD)
    }
}

/// The words of the generated sentences, frequent ones first.
fn own_words(generated: &[Vec<String>]) -> Vec<(&str, u64)> {
    let mut counts: HashMap<&str, u64> = HashMap::new();
    for word in generated.iter().flatten() {
        *counts.entry(word.as_str()).or_default() += 1;
    }
    let mut own: Vec<(&str, u64)> = counts.into_iter().collect();
    own.sort_by(|a, b| b.1.cmp(&a.1).then(a.0.cmp(b.0)));
    own
}

/// How often each word of the corpus occurs, and how often in sentences about textiles.
struct Counts {
    all: Vec<u64>,
    textile: Vec<u64>,
    candidate: Vec<bool>,
}

impl Counts {
    fn new(corpus: &Corpus, kept: &HashSet<&str>) -> Self {
        let words = corpus.words();
        let seeds = Seeds::new(corpus);
        let mut all = vec![0u64; words.len()];
        let mut textile = vec![0u64; words.len()];
        // A hyphenated word that is not one of ours counts as its parts, as the tokenizer will split it.
        let parts: Vec<Vec<usize>> = (0..words.len())
            .map(|id| match words[id].contains('-') && !kept.contains(words[id].as_str()) {
                true => words[id].split('-').filter_map(|part| corpus.id(part)).map(|part| part as usize).collect(),
                false => vec![id],
            })
            .collect();
        for sentence in corpus.sentences() {
            let about = seeds.about_textiles(sentence);
            for part in sentence.iter().flat_map(|id| &parts[*id as usize]) {
                all[*part] += 1;
                textile[*part] += u64::from(about);
            }
        }
        let mut candidate: Vec<bool> = words.iter().map(|word| is_plain(word)).collect();
        // A plural is found through its singular, where that is a word of some standing ("does" is no plural of "doe").
        for id in 0..words.len() {
            let Some(stem) = words[id].strip_suffix('s').filter(|word| word.len() > 2) else {
                continue;
            };
            if kept.contains(stem) && !kept.contains(words[id].as_str()) {
                candidate[id] = false;
            }
            let singular = corpus.id(stem);
            if let Some(singular) = singular.map(|singular| singular as usize)
                && 4 * all[singular] > all[id]
                && !kept.contains(words[id].as_str())
            {
                candidate[id] = false;
                all[singular] += all[id];
                textile[singular] += textile[id];
            }
        }
        Self { all, textile, candidate }
    }

    /// The candidates by how much oftener than chance they stand among textiles, weighted by how often they do.
    fn by_company(&self) -> Vec<usize> {
        let base = self.textile.iter().sum::<u64>().max(1) as f64 / self.all.iter().sum::<u64>().max(1) as f64;
        let score = |id: usize| {
            let (textile, all) = (self.textile[id] as f64, self.all[id] as f64);
            textile * (textile / (all + 5.0) / base).ln()
        };
        let mut ids: Vec<(usize, f64)> = (0..self.all.len())
            .filter(|id| self.candidate[*id] && self.all[*id] >= LEAST_COUNT && self.textile[*id] >= LEAST_COUNT)
            .map(|id| (id, score(id)))
            .filter(|(_, score)| *score > 0.0)
            .collect();
        ids.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
        ids.into_iter().map(|(id, _)| id).collect()
    }

    /// The candidates, frequent ones first.
    fn by_frequency(&self) -> Vec<usize> {
        let mut ids: Vec<usize> = (0..self.all.len()).filter(|id| self.candidate[*id] && self.all[*id] > 1).collect();
        ids.sort_by(|a, b| self.all[*b].cmp(&self.all[*a]).then(a.cmp(b)));
        ids
    }
}

/// Which words of a corpus speak of textiles.
struct Seeds {
    strong: Vec<bool>,
    weak: Vec<bool>,
}

impl Seeds {
    fn new(corpus: &Corpus) -> Self {
        let mut seeds = Self { strong: vec![false; corpus.words().len()], weak: vec![false; corpus.words().len()] };
        for word in TEXTILE_NOUNS {
            if let Some(id) = corpus.id(word) {
                seeds.strong[id as usize] = true;
            }
        }
        let names = fabrics().iter().flat_map(|fabric| fabric.names.iter().chain(&fabric.fibres).chain(&fabric.uses));
        // Of names of several words each alone may mean anything ("crepe de chine").
        for word in names.chain(THINGS.iter()).filter(|name| !name.contains('_')) {
            if let Some(id) = corpus.id(word) {
                seeds.weak[id as usize] = true;
            }
        }
        seeds
    }

    /// One strong word, or two different weak ones ("duck" alone is a bird).
    fn about_textiles(&self, sentence: &[u32]) -> bool {
        let mut first = None;
        sentence.iter().any(|id| {
            let index = *id as usize;
            let second = self.weak[index] && first.is_some_and(|other| other != index);
            if self.weak[index] {
                first = Some(index);
            }
            self.strong[index] || second
        })
    }
}

/// Whether a word of the corpus may have a row: two letters at least (or "a"), no hyphen, no digit.
fn is_plain(word: &str) -> bool {
    (word.len() > 1 || word == "a") && word.bytes().all(|b| b.is_ascii_lowercase())
}

/// Text as numbers of a [`Vocabulary`], in sentences.
#[derive(Clone, Debug, Default)]
pub struct Stream {
    /// The numbers of all sentences, one after the other.
    pub ids: Vec<u32>,
    /// The end of each sentence in `ids`.
    pub ends: Vec<usize>,
}

impl Stream {
    /// Adds a sentence; one of fewer than two known words is left out.
    fn push(&mut self, ids: &[u32]) {
        if ids.len() > 1 {
            self.ids.extend_from_slice(ids);
            self.ends.push(self.ids.len());
        }
    }
}

/// The corpus and the generated sentences as numbers; unknown words are left out, so that windows reach over them.
/// Sentences of the corpus about textiles stand `textile_repeat` times.
pub fn encode(corpus: &Corpus, generated: &[Vec<String>], vocabulary: &Vocabulary, textile_repeat: usize) -> Stream {
    let known = |word: &str| vocabulary.id(word);
    let numbers = |word: &str| resolve(word, &known).0.into_iter().map(|id| id as u32).collect::<Vec<u32>>();
    let words: Vec<Vec<u32>> = corpus.words().iter().map(|word| numbers(word)).collect();
    let seeds = Seeds::new(corpus);
    let mut stream = Stream::default();
    let mut ids = Vec::new();
    for sentence in corpus.sentences() {
        ids.clear();
        ids.extend(sentence.iter().flat_map(|id| &words[*id as usize]));
        let times = if seeds.about_textiles(sentence) { textile_repeat } else { 1 };
        for _ in 0..times {
            stream.push(&ids);
        }
    }
    for sentence in generated {
        ids.clear();
        ids.extend(sentence.iter().flat_map(|word| numbers(word)));
        stream.push(&ids);
    }
    stream
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::words::sentences::fabric_sentences;

    fn text() -> Corpus {
        let mut corpus = Corpus::default();
        for _ in 0..6 {
            corpus
                .add_text("The tailor hemmed the fabric. The dog sleeps. Dogs sleep on the carpets of well-lit rooms.");
            corpus.add_text("A duck swims. A well is lit. Does the doe sleep?");
        }
        corpus
    }

    #[test]
    fn own_words_come_first_and_limits_hold() {
        let generated = fabric_sentences(2000, 1);
        let chosen = Vocabulary::choose(&text(), &generated, 3000, 6000);
        assert_eq!(chosen.tokens()[PAD], PAD_TOKEN);
        assert_eq!(chosen.id(PAD_TOKEN), None);
        for word in ["denim", "t-shirt", "heavy", "tailor", "hemmed", "dog", "well", "lit"] {
            assert!(chosen.id(word).is_some_and(|id| id < chosen.rows()), "{word}");
        }
        assert_eq!(chosen.id("dogs"), None);
        assert_eq!(chosen.id("well-lit"), None);
        assert!(chosen.id("denim") < chosen.id("tailor"));
        let small = Vocabulary::choose(&text(), &generated, 50, 80);
        assert_eq!((small.rows(), small.contexts()), (50, 50.max(small.contexts()).min(80)));
    }

    #[test]
    fn sentences_become_numbers() {
        let chosen = Vocabulary::choose(&text(), &[], 100, 100);
        let once = encode(&text(), &[], &chosen, 1);
        let thrice = encode(&text(), &[], &chosen, 3);
        // Six of the sentences, "the tailor hemmed the fabric", are about textiles; "a duck swims" is not.
        assert_eq!(thrice.ends.len() - once.ends.len(), 12);
        let words =
            |ids: &[u32]| ids.iter().map(|id| chosen.words[*id as usize].as_str()).collect::<Vec<_>>().join(" ");
        assert_eq!(words(&once.ids[once.ends[1]..once.ends[2]]), "dog sleep on the carpets of well lit rooms");
    }
}
