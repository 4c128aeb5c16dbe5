//! Looks at a word table: which words are near which.

use super::lanes::dot;
use super::table::WordTable;
use super::{PAD, WordsError};

/// Thirty fabric words whose neighbours are printed and tested.
pub const FABRIC_WORDS: [&str; 30] = [
    "denim",
    "silk",
    "satin",
    "jersey",
    "canvas",
    "chiffon",
    "velvet",
    "wool",
    "linen",
    "cotton",
    "lycra",
    "spandex",
    "nylon",
    "polyester",
    "interlock",
    "rib",
    "sweatshirt",
    "swimsuit",
    "ribbon",
    "felt",
    "flannel",
    "corduroy",
    "tweed",
    "organza",
    "leather",
    "heavy",
    "light",
    "stiff",
    "crisp",
    "stretchy",
];

/// A word near another.
#[derive(Clone, Debug, PartialEq)]
pub struct Neighbour<'a> {
    /// The word.
    pub word: &'a str,
    /// The cosine of the angle between the vectors, -1 to 1.
    pub cosine: f32,
}

/// The cosine between two words.
///
/// # Errors
/// [`WordsError::Unknown`] names a word that the table lacks.
pub fn similarity(table: &WordTable, first: &str, second: &str) -> Result<f32, WordsError> {
    let index = |word: &str| table.index(word).ok_or_else(|| WordsError::Unknown(word.to_owned()));
    Ok(cosine(table.vector(index(first)?), table.vector(index(second)?)))
}

/// The `count` words nearest to a word, nearest first, itself left out.
///
/// # Errors
/// [`WordsError::Unknown`] when the table lacks the word.
pub fn neighbours<'a>(table: &'a WordTable, word: &str, count: usize) -> Result<Vec<Neighbour<'a>>, WordsError> {
    let index = table.index(word).ok_or_else(|| WordsError::Unknown(word.to_owned()))?;
    let mut found = near(table, table.vector(index), count + 1);
    found.retain(|neighbour| neighbour.word != word);
    found.truncate(count);
    Ok(found)
}

/// The `count` words nearest to a vector of the table's length, nearest first.
pub fn near<'a>(table: &'a WordTable, vector: &[f32], count: usize) -> Vec<Neighbour<'a>> {
    let mut all: Vec<Neighbour<'a>> = (PAD + 1..table.tokens.len())
        .map(|other| Neighbour { word: &table.tokens[other], cosine: cosine(vector, table.vector(other)) })
        .collect();
    all.sort_by(|a, b| b.cosine.total_cmp(&a.cosine));
    all.truncate(count);
    all
}

/// The cosine of the angle between two vectors of one length; 0 where one of them is zero.
fn cosine(a: &[f32], b: &[f32]) -> f32 {
    let lengths = dot(a, a).sqrt() * dot(b, b).sqrt();
    if lengths > 0.0 { dot(a, b) / lengths } else { 0.0 }
}

/// A table in Markdown: each word and its nearest ten.
///
/// # Errors
/// [`WordsError::Unknown`] names a word that the table lacks.
pub fn markdown(table: &WordTable, words: &[&str]) -> Result<String, WordsError> {
    let mut text = String::from("| word | nearest ten |\n| --- | --- |\n");
    for word in words {
        let near = neighbours(table, word, 10)?;
        let near: Vec<String> = near.iter().map(|n| format!("{} {:.2}", n.word, n.cosine)).collect();
        text.push_str(&format!("| {word} | {} |\n", near.join(", ")));
    }
    Ok(text)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::words::tokens::{resolve, tokenize};

    fn table() -> WordTable {
        WordTable::committed().expect("the table that ships")
    }

    #[test]
    fn nearest_first_and_itself_left_out() {
        let tokens = ["<pad>", "a", "b", "c"].map(str::to_owned).to_vec();
        let mut vectors = vec![0.0; 4 * 16];
        (vectors[16], vectors[32], vectors[48], vectors[49]) = (1.0, -1.0, 0.8, 0.6);
        let table = WordTable { tokens, vectors };
        let found = neighbours(&table, "a", 5).expect("known");
        let words: Vec<&str> = found.iter().map(|n| n.word).collect();
        assert_eq!(words, ["c", "b"]);
        assert!((found[0].cosine - 0.8).abs() < 1e-6);
        assert!(similarity(&table, "a", "x").expect_err("unknown").to_string().contains("'x'"));
        assert!(neighbours(&table, "<pad>", 1).is_err());
    }

    #[test]
    fn the_table_that_ships_is_sound() {
        let table = table();
        table.check().expect("sound");
        assert!(table.tokens.len() <= 3000 && table.dimensions() == 1024);
        for index in 1..table.tokens.len() {
            let vector = table.vector(index);
            assert!((dot(vector, vector) - 1.0).abs() < 2e-3, "{}", table.tokens[index]);
        }
    }

    /// Each of the thirty words has at least two of its true companions among its nearest ten.
    #[test]
    fn thirty_fabric_words_have_sensible_neighbours() {
        let table = table();
        let companions = [
            (
                "denim",
                "jeans twill indigo heavy sturdy canvas dungaree dungarees rugged durable selvedge serge corduroy gabardine",
            ),
            (
                "silk",
                "satin rayon viscose acetate lustrous smooth chiffon charmeuse georgette kimono pongee habotai surah foulard batiste cupro lyocell floaty",
            ),
            (
                "satin",
                "shiny glossy silk sateen charmeuse duchesse lame slippery lustrous poplin percale ballgown ribbon muslin acetate lining",
            ),
            (
                "jersey",
                "t-shirt tee knit stockinette interlock merino modal bamboo comfortable underwear pointelle stretchy soft top",
            ),
            (
                "canvas",
                "tarpaulin sail tent duck jute burlap awning drill sturdy heavy coarse sailcloth webbing buckram",
            ),
            ("chiffon", "georgette charmeuse voile gauze sheer sari batiste floaty airy cheesecloth organza thin silk"),
            ("velvet", "velour plush velveteen crushed velvety soft chenille flannel pile gown camelhair"),
            (
                "wool",
                "warm tweed mohair fuzzy woollen woolen vicuna alpaca cashmere homespun itchy resilient insulating napped worsted coat",
            ),
            ("linen", "flax crisp tablecloth napkin ramie cool damask broadcloth percale cambric hemp"),
            (
                "cotton",
                "polyester wool rayon absorbent linen muslin calico voile poplin chino damask flax lyocell viscose handspun",
            ),
            ("lycra", "spandex elastane stretchy swimsuit swimwear leotard leggings elastic snug clingy bodysuit"),
            ("spandex", "lycra elastane stretchy leggings snug leotard elastic swimwear clingy"),
            (
                "nylon",
                "polyamide polyester quick-drying windbreaker polypropylene slick synthetic ripstop acetate strong",
            ),
            ("polyester", "cotton nylon rayon synthetic acrylic crease-resistant wrinkle-resistant viscose"),
            (
                "interlock",
                "t-shirt jersey cardigan double-knit leotard knit swimwear lycra waffle merino babywear snug polo cashmere",
            ),
            ("rib", "ribbing ribbed elastic knit cuff tank neckband knitted underwear snug waffle swim stretchy"),
            (
                "sweatshirt",
                "hoodie joggers fleece terry cozy velour sweatpants fluffy sherpa sweat pullover sweater-knit",
            ),
            (
                "swimsuit",
                "swimwear bikini lycra sportswear leotard activewear leggings bathing spandex elastane tricot",
            ),
            ("ribbon", "grosgrain trim bow satin narrow gift decorative lame shiny faille hat costume eyelet"),
            ("felt", "matted felted hat nonwoven thick slippers dense nap hide stiff wool craft pad"),
            ("flannel", "flannelette pyjamas brushed warm velveteen napped cozy camelhair soft alpaca vicuna velour"),
            (
                "corduroy",
                "velveteen napped ribbed moleskin cut-pile camelhair suede trousers twill tweed loden hopsack durable",
            ),
            ("tweed", "melton loden wool duffel mackinaw kersey coarse flecked thick whipcord warm donegal harris"),
            (
                "organza",
                "taffeta organdy tulle tarlatan sheer stiff crisp petticoat transparent veil shantung translucent see-through",
            ),
            ("leather", "hide boots suede patent faux vinyl leatherette canvas tough shoes nubuck bag tanned"),
            ("heavy", "weighty heavyweight substantial hefty massive thick dense"),
            ("light", "lightweight lightish featherlight weightless airy ultralight thin"),
            ("stiff", "rigid structured inflexible unbending boardy stiffish starched firm hard"),
            (
                "crisp",
                "starched percale taffeta linen tablecloth cambric smooth ramie organdy lawn poplin stiff fine sheer shantung",
            ),
            ("stretchy", "elastic clingy stretchable extensible springy stretch elasticated spandex lycra snug"),
        ];
        assert_eq!(companions.map(|(word, _)| word), FABRIC_WORDS);
        for (word, expected) in companions {
            let near = neighbours(&table, word, 10).expect(word);
            let hits = near.iter().filter(|n| expected.split(' ').any(|e| e == n.word)).count();
            assert!(hits >= 2, "{word}: {near:?}");
        }
    }

    /// What must be nearer to what: the relations that the stiffness and the weight of a fabric hang on.
    #[test]
    fn qualities_have_directions_of_their_own() {
        let table = table();
        let of = |a: &str, b: &str| similarity(&table, a, b).expect("known");
        for (word, near, far) in [
            ("silk", "satin", "denim"),
            ("silk", "chiffon", "canvas"),
            ("jersey", "knit", "canvas"),
            ("jersey", "stretchy", "stiff"),
            ("denim", "sturdy", "sheer"),
            ("denim", "heavy", "light"),
            ("canvas", "stiff", "soft"),
            ("chiffon", "light", "heavy"),
            ("chiffon", "thin", "thick"),
            ("tweed", "thick", "thin"),
            ("lycra", "stretchy", "stiff"),
            ("heavy", "thick", "thin"),
            ("heavy", "heavyweight", "lightweight"),
            ("light", "thin", "thick"),
            ("stiff", "rigid", "soft"),
            ("soft", "supple", "stiff"),
            ("organza", "taffeta", "fleece"),
            ("fleece", "warm", "crisp"),
            ("swimsuit", "bikini", "coat"),
            ("blue", "red", "heavy"),
        ] {
            assert!(
                of(word, near) > of(word, far) + 0.05,
                "{word}: {near} {}, {far} {}",
                of(word, near),
                of(word, far)
            );
        }
        let qualities = ["heavy", "light", "thick", "thin", "stiff", "soft", "stretchy", "crisp"];
        for (index, first) in qualities.iter().enumerate() {
            for second in &qualities[index + 1..] {
                assert!(of(first, second) < 0.85, "{first} and {second}: {}", of(first, second));
            }
        }
        assert!(of("heavy", "light") < 0.4 && of("thick", "thin") < 0.5 && of("stiff", "soft") < 0.4);
    }

    #[test]
    fn descriptions_are_known() {
        let table = table();
        let indices = table.indices();
        let known = |word: &str| indices.get(word).copied();
        for text in [
            "heavy blue denim",
            "a thin soft grey t-shirt for summer",
            "crisp white cotton tablecloth",
            "ivory rib knit underwear, cotton and spandex",
            "a swimsuit of white nylon with lycra",
            "a warm brown polyester blanket",
            "navy sparkle sweatshirts",
            "see-through nylon curtains with polka-dots",
            "Pink silk scarf, 100 g",
        ] {
            let tokens = tokenize(text);
            let unknown: Vec<&str> = tokens.iter().flat_map(|token| resolve(token, &known).1).collect();
            assert!(unknown.iter().all(|word| ["100", "g"].contains(word)), "{text}: {unknown:?}");
        }
    }
}
