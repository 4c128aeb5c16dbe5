//! Generated sentences about fabrics: true statements from the catalogue, in many forms, seeded.
//!
//! A dictionary hardly mentions modern fibres and mixes the senses of "light". These sentences set each fabric beside
//! its fibre, construction, weight, hand, use and colour, and each quality beside its synonyms.

use super::catalogue::{Fabric, fabrics};
use super::random::Random;
use super::scales::{COLOURS, CRAFT, EVERYDAY, PATTERNS, QUALITIES, Quality, SHADES, THINGS, folds};
use super::tokens::tokenize;

/// Forms of a sentence about one fabric. A word in braces is filled in, or left out where the fabric has none.
const FORMS: &[&str] = &[
    "{weight} {colour} {name}",
    "{weight} {hand} {name}",
    "{stiffness} {name} for {use}",
    "a {weight} {stiffness} {name} for {use}",
    "a {hand} {colour} {use} in {name}",
    "{name} is a {weight} {construction} fabric of {fibre}",
    "{name} is {weight} and {stiffness}",
    "{name} is {thickness} and {hand}",
    "{name} is {degree} {weight} {thickness} and {stretch}",
    "{name} is a {hand} {hand} cloth made from {fibre}",
    "the {use} is cut from {weight} {thickness} {name}",
    "{thickness} {hand} {name} falls in {folds}",
    "{stiffness} {name} hangs in {folds}",
    "{name} feels {hand} and {hand}",
    "{construction} {fibre} {name} feels {hand} and {stiffness}",
    "a {weight} {construction} cloth that is {stiffness} and {stretch} such as {name}",
    "{stretch} {construction} {fibre} used for {use}",
    "{shade} {colour} {pattern} {name} {use}",
    "{weight} {thickness} {stiffness} {stretch} {name}",
    "like {peer} {name} is {weight} {hand} and {stiffness}",
    "{name} or {peer} for a {weight} {use}",
    "a {thickness} {hand} {colour} {use} of {fibre} {name}",
    "{weight} {construction} {fibre} {use}",
    "{use} fabric such as {name} or {peer} is {hand} {weight} {thickness}",
    "{fibre} {name} {construction} {stretch} {hand}",
    "{construction} {name} of {fibre} and {fibre}",
    "a {colour} {fibre} {name} {use} is {weight} and {hand}",
    "{name} {use}",
    "{hand} {hand} {thickness} {weight} {fibre}",
];

/// Makes `count` sentences, each a list of tokens as [`tokenize`] gives them; the same seed gives the same sentences.
///
/// About three quarters tell of a fabric, a tenth of a quality and its synonyms, the rest of colours, everyday words
/// and the craft.
pub fn fabric_sentences(count: usize, seed: u64) -> Vec<Vec<String>> {
    let mut random = Random::new(seed, 1);
    let all = fabrics();
    // Common fabrics are drawn three times as often.
    let draw: Vec<usize> =
        (0..all.len()).flat_map(|index| std::iter::repeat_n(index, if all[index].common { 3 } else { 1 })).collect();
    let peers: Vec<Vec<usize>> = (0..all.len()).map(|index| peers_of(all, index)).collect();
    (0..count)
        .map(|_| {
            let text = match random.below(100) {
                0..78 => {
                    let index = random.pick(&draw).copied().unwrap_or(0);
                    about_fabric(&mut random, &all[index], &peers[index])
                }
                78..90 => about_quality(&mut random),
                90..95 => about_colour(&mut random),
                95..98 => everyday(&mut random),
                _ => one(&mut random, CRAFT).to_owned(),
            };
            tokenize(&text)
        })
        .filter(|sentence| sentence.len() > 1)
        .collect()
}

/// The six fabrics most like one, by their grades.
fn peers_of(all: &[Fabric], index: usize) -> Vec<usize> {
    let mut others: Vec<usize> = (0..all.len()).filter(|other| *other != index).collect();
    others.sort_by_key(|other| (all[index].distance(&all[*other]), *other));
    others.truncate(6);
    others
}

/// One of some words; an empty string from an empty list, which the tokenizer drops.
fn one(random: &mut Random, words: &[&'static str]) -> &'static str {
    random.pick(words).copied().unwrap_or("")
}

/// A sentence about a fabric, from one of the forms.
fn about_fabric(random: &mut Random, fabric: &Fabric, peers: &[usize]) -> String {
    let form = one(random, FORMS);
    let mut text = String::new();
    let mut used: Vec<&str> = Vec::new();
    for part in form.split(' ') {
        let fill = |random: &mut Random| match part {
            "{name}" => one(random, &fabric.names),
            "{fibre}" => one(random, &fabric.fibres),
            "{construction}" => one(random, &fabric.construction),
            "{weight}" => one(random, Quality::Weight.words(fabric.grade(Quality::Weight))),
            "{thickness}" => one(random, Quality::Thickness.words(fabric.grade(Quality::Thickness))),
            "{stiffness}" => one(random, Quality::Stiffness.words(fabric.grade(Quality::Stiffness))),
            "{stretch}" => one(random, Quality::Stretch.words(fabric.grade(Quality::Stretch))),
            "{degree}" => one(random, degrees(fabric.grade(Quality::Weight))),
            "{hand}" => one(random, &fabric.hand),
            "{use}" => one(random, &fabric.uses),
            "{folds}" => one(random, folds(fabric.grade(Quality::Stiffness))),
            "{peer}" => peers.get(random.below(peers.len())).map_or("", |peer| fabrics()[*peer].names[0]),
            // Half the time its usual colour, else any.
            "{colour}" if random.below(2) == 0 => one(random, &fabric.colours),
            "{colour}" => one(random, &COLOURS),
            "{shade}" => one(random, &SHADES),
            "{pattern}" => one(random, &PATTERNS),
            plain => plain,
        };
        let mut word = fill(random);
        // A second try keeps a sentence from saying a thing twice.
        if word.len() > 3 && used.contains(&word) {
            word = fill(random);
        }
        if word.len() > 3 && used.contains(&word) {
            continue;
        }
        used.push(word);
        text.push_str(&word.replace('_', " "));
        text.push(' ');
    }
    text
}

/// Words of degree that go with a grade.
fn degrees(grade: u8) -> &'static [&'static str] {
    match grade {
        1 | 5 => &["very", "extremely", "extra"],
        2 | 4 => &["fairly", "rather", "quite"],
        _ => &[],
    }
}

/// A sentence that gathers synonyms of one end of a quality.
fn about_quality(random: &mut Random) -> String {
    let quality = QUALITIES[random.below(QUALITIES.len())];
    let high = random.below(2) == 1;
    let mut words: Vec<&str> = quality.end(high).concat();
    words.sort_unstable();
    words.dedup();
    random.shuffle(&mut words);
    words.truncate(2 + random.below(2));
    let meaning = one(random, quality.meaning(high));
    let noun = one(random, &["fabric", "cloth", "material", "textile"]);
    match random.below(3) {
        0 => format!("{} {noun} {meaning}", words.join(" ")),
        1 => format!("a {noun} that is {} {meaning}", words.join(" and ")),
        _ => format!("{} {noun}", words.join(" ")),
    }
}

/// A sentence about colours and patterns, which say nothing about mechanics.
fn about_colour(random: &mut Random) -> String {
    let thing = one(random, &THINGS).replace('_', " ");
    let (first, second) = (one(random, &COLOURS), one(random, &COLOURS));
    let (shade, pattern) = (one(random, &SHADES), one(random, &PATTERNS));
    match random.below(4) {
        0 => format!("{shade} {first} and {second} {pattern} {thing}"),
        1 => format!("{pattern} {shade} {first} {thing}"),
        2 => format!("colours {first} {second} {} {}", one(random, &COLOURS), one(random, &COLOURS)),
        _ => format!("a {thing} in {shade} {first} with {second} {pattern}"),
    }
}

/// A sentence of everyday words around a thing made of cloth.
fn everyday(random: &mut Random) -> String {
    let thing = one(random, &THINGS).replace('_', " ");
    let (first, second) = (one(random, &EVERYDAY), one(random, &EVERYDAY));
    match random.below(3) {
        0 => format!("a {first} {second} {thing}"),
        1 => format!("{first} {thing} for {second} {}", plural(one(random, &THINGS)).replace('_', " ")),
        _ => format!("{first} {} {second} {thing}", one(random, &COLOURS)),
    }
}

/// The plural of a thing where it is more than an added s, such as "dresses": a word of its own, because the fallback of
/// [`super::tokens`] takes away no more than an s. Any other thing stays in the singular.
fn plural(word: &str) -> String {
    if let Some(stem) = word.strip_suffix("rf") {
        return format!("{stem}rves");
    }
    if let Some(stem) = word.strip_suffix('y').filter(|stem| !stem.ends_with(['a', 'e', 'o', 'u'])) {
        return format!("{stem}ies");
    }
    if ["ss", "sh", "ch", "x"].iter().any(|end| word.ends_with(end)) { format!("{word}es") } else { word.to_owned() }
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use super::*;

    #[test]
    fn sentences_repeat_with_the_seed() {
        let first = fabric_sentences(500, 3);
        assert!(first.len() > 490);
        assert_eq!(first, fabric_sentences(500, 3));
        assert_ne!(first, fabric_sentences(500, 4));
        assert!(first.iter().flatten().all(|word| tokenize(word) == [word.clone()]));
    }

    #[test]
    fn they_hold_the_modern_fibres_and_many_words() {
        let sentences = fabric_sentences(20_000, 1);
        let words: HashSet<&str> = sentences.iter().flatten().map(String::as_str).collect();
        assert!(words.len() > 700, "{}", words.len());
        for word in "lycra spandex elastane nylon polyester denim jersey interlock rib knit sweatshirt swimsuit ribbon satin \
                     twill canvas felt silk chiffon organza velvet wool linen flannel corduroy tweed leather t-shirt viscose"
            .split_whitespace()
        {
            assert!(words.contains(word), "{word}");
        }
    }

    #[test]
    fn what_they_say_is_true_to_the_catalogue() {
        let opposite = |sentence: &[String], name: &str, wrong: &[&str]| {
            sentence.len() < 8
                && sentence.iter().any(|w| w == name)
                && sentence.iter().any(|w| wrong.contains(&w.as_str()))
        };
        for sentence in fabric_sentences(20_000, 2) {
            assert!(!opposite(&sentence, "chiffon", &["heavy", "thick", "stiff"]), "{sentence:?}");
            assert!(!opposite(&sentence, "duck", &["lightweight", "thin", "limp", "stretchy"]), "{sentence:?}");
        }
    }

    #[test]
    fn plurals() {
        for (word, many) in
            [("dress", "dresses"), ("scarf", "scarves"), ("jeans", "jeans"), ("sash", "sashes"), ("hat", "hat")]
        {
            assert_eq!(plural(word), many);
        }
    }
}
