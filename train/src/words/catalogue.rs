//! The catalogue of fabrics behind the generated sentences: `train/data/fabrics.txt`, one fabric a line.

use std::sync::LazyLock;

use super::scales::Quality;

/// The catalogue's text, which is part of the program.
const TEXT: &str = include_str!("../../data/fabrics.txt");

/// What the catalogue says about one fabric. Names and uses of several words hold an underscore between them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fabric {
    /// Whether it is a common fabric, which sentences name three times as often.
    pub common: bool,
    /// Its names.
    pub names: Vec<&'static str>,
    /// The fibres that it is made of.
    pub fibres: Vec<&'static str>,
    /// Its weave, knit and finish.
    pub construction: Vec<&'static str>,
    /// Weight, thickness, stiffness, stretch, each 1 (least) to 5 (most).
    pub grades: [u8; 4],
    /// Words of feel and look.
    pub hand: Vec<&'static str>,
    /// What is made of it.
    pub uses: Vec<&'static str>,
    /// Its usual colours and patterns.
    pub colours: Vec<&'static str>,
}

impl Fabric {
    /// The grade of a quality, 1 to 5.
    pub fn grade(&self, quality: Quality) -> u8 {
        self.grades[quality as usize]
    }

    /// How unlike two fabrics are: the squared differences of their grades, and 4 where only one of them is a knit.
    pub fn distance(&self, other: &Self) -> u32 {
        let grades = self.grades.iter().zip(&other.grades).map(|(a, b)| u32::from(a.abs_diff(*b)).pow(2)).sum::<u32>();
        let knit = |fabric: &Self| fabric.construction.contains(&"knit");
        grades + if knit(self) == knit(other) { 0 } else { 4 }
    }
}

/// The catalogue, in the order of its file.
pub fn fabrics() -> &'static [Fabric] {
    static FABRICS: LazyLock<Vec<Fabric>> = LazyLock::new(|| TEXT.lines().filter_map(parse).collect());
    &FABRICS
}

/// One line: seven fields between bars. A comment, or a line that does not hold them, gives nothing (a test counts).
fn parse(line: &'static str) -> Option<Fabric> {
    if line.starts_with('#') {
        return None;
    }
    let fields: Vec<&str> = line.split('|').collect();
    let [names, fibres, construction, grades, hand, uses, colours] = fields[..] else {
        return None;
    };
    let list = |field: &'static str| field.split_whitespace().collect::<Vec<_>>();
    let common = names.starts_with('*');
    let grades: Vec<u8> = grades.split_whitespace().filter_map(|grade| grade.parse().ok()).collect();
    Some(Fabric {
        common,
        names: list(names.trim_start_matches('*')),
        fibres: list(fibres),
        construction: list(construction),
        grades: grades.try_into().ok()?,
        hand: list(hand),
        uses: list(uses),
        colours: list(colours),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_line_is_a_fabric() {
        let lines = TEXT.lines().filter(|line| !line.starts_with('#')).count();
        assert_eq!(fabrics().len(), lines);
        assert!(lines >= 200);
        for fabric in fabrics() {
            assert!(fabric.grades.iter().all(|grade| (1..=5).contains(grade)), "{fabric:?}");
            for field in
                [&fabric.names, &fabric.fibres, &fabric.construction, &fabric.hand, &fabric.uses, &fabric.colours]
            {
                assert!(!field.is_empty(), "{fabric:?}");
                let plain = |word: &str| word.bytes().all(|b| b.is_ascii_lowercase() || b"_-0123456789".contains(&b));
                assert!(field.iter().all(|word| plain(word)), "{fabric:?}");
            }
        }
    }

    #[test]
    fn denim_is_heavy_and_chiffon_light() {
        let of = |name: &str| fabrics().iter().find(|fabric| fabric.names[0] == name).expect(name);
        assert!(of("denim").grade(Quality::Weight) > of("chiffon").grade(Quality::Weight));
        assert!(of("jersey").grade(Quality::Stretch) > of("canvas").grade(Quality::Stretch));
        assert!(of("denim").distance(of("canvas")) < of("denim").distance(of("silk")));
    }
}
