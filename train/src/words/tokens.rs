//! How text becomes words: the same rule for the corpus, for our own sentences and for a user's description.
//!
//! Lower case; split at everything that is not a-z, 0-9 or an inner hyphen. A hyphenated word that is unknown is split
//! at its hyphens; a plural 's' that is unknown falls back to the singular.

/// The words of a text, in order, hyphenated ones whole.
pub fn tokenize(text: &str) -> Vec<String> {
    let lower = text.to_ascii_lowercase();
    lower
        .split(|c: char| !(c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-'))
        // Two hyphens are a dash, not an inner hyphen.
        .flat_map(|piece| piece.split("--"))
        .map(|piece| piece.trim_matches('-'))
        .filter(|piece| !piece.is_empty())
        .map(str::to_owned)
        .collect()
}

/// Looks one token up: as it stands, without its plural 's', or as the parts between its hyphens, each likewise.
///
/// `known` answers with the index of a word. The indices come in order; the parts that are not known come second.
pub fn resolve<'a>(token: &'a str, known: &dyn Fn(&str) -> Option<usize>) -> (Vec<usize>, Vec<&'a str>) {
    if let Some(index) = whole(token, known) {
        return (vec![index], Vec::new());
    }
    if !token.contains('-') {
        return (Vec::new(), vec![token]);
    }
    let mut found = Vec::new();
    let mut unknown = Vec::new();
    for part in token.split('-').filter(|part| !part.is_empty()) {
        match whole(part, known) {
            Some(index) => found.push(index),
            None => unknown.push(part),
        }
    }
    (found, unknown)
}

/// A word as it stands or without its plural 's'.
fn whole(token: &str, known: &dyn Fn(&str) -> Option<usize>) -> Option<usize> {
    known(token).or_else(|| token.strip_suffix('s').filter(|singular| !singular.is_empty()).and_then(known))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn splits_as_the_contract_says() {
        assert_eq!(tokenize("Heavy, BLUE denim!"), ["heavy", "blue", "denim"]);
        assert_eq!(tokenize("a T-shirt -- men's 11oz"), ["a", "t-shirt", "men", "s", "11oz"]);
        assert_eq!(tokenize("-rib- --knit a--b caf\u{e9}s"), ["rib", "knit", "a", "b", "caf", "s"]);
        assert!(tokenize(" ?! - -- ").is_empty());
    }

    #[test]
    fn falls_back_to_parts_and_singulars() {
        let words = ["curtain", "rib", "knit", "t-shirt", "jeans"];
        let known = |word: &str| words.iter().position(|w| *w == word);
        assert_eq!(resolve("curtains", &known), (vec![0], vec![]));
        assert_eq!(resolve("rib-knits", &known), (vec![1, 2], vec![]));
        assert_eq!(resolve("t-shirts", &known), (vec![3], vec![]));
        assert_eq!(resolve("jeans", &known), (vec![4], vec![]));
        assert_eq!(resolve("wide-rib", &known), (vec![1], vec!["wide"]));
        assert_eq!(resolve("plasma", &known), (vec![], vec!["plasma"]));
        assert_eq!(resolve("s", &known), (vec![], vec!["s"]));
    }
}
