//! Fabrics: constants of real ones, and what words make of them.
//!
//! Seven were measured by Wang, O'Brien and Ramamoorthi ("Data-Driven Elastic Models for Cloth", 2011) and are used as
//! ARCSim 0.2.1 uses them: the membrane energy per area is
//! k_uu/2 Euu^2 + k_vv/2 Evv^2 + k_uv Euu Evv + k_shear Euv^2. A square grid with both diagonals has
//! C11 = weft + shear + 4 bend, C22 = warp + shear + 4 bend and the shear term 2 shear Euv^2, so shear = k_shear / 2 and
//! warp, weft follow. A woven is taken at small strain. A knit stiffens as it stretches (a jersey fivefold along v), and a
//! linear spring must stand for the stretch that it works at: its k_uu and k_vv are the tension at 10 % uniaxial stretch
//! over that stretch, its k_shear that at 5 %. The others are estimates of ours by construction and weight, for words that
//! nobody measured; they are marked as such. Silk is thought as a light plain weave of 15 momme: half as stiff as denim in
//! either direction at a fifth of its weight.
//!
//! The bending rigidity of an estimate is rho g c^3 (Peirce, "The handle of cloth as a measurable quantity", 1930) with a
//! bending length c of 1.6 cm (chiffon) to 4 cm (canvas), which drapes as textbooks say: cotton 2.6, linen 2.9, wool as in flannel and tweed 3 cm.
//! Among pieces of one kind it goes with the mass per area to the power [`RIGIDITY_EXPONENT`].

use taut::noise;

/// Stiffness in N/m of the four families: warp, weft, shear, bend.
pub type Stiffness = [f32; 4];

/// What a fabric is made of.
#[derive(Clone, Debug, PartialEq)]
pub struct Fabric {
    /// Name of the kind it comes from.
    pub kind: &'static str,
    /// Physical stiffness in N/m: warp, weft, shear, bend.
    pub stiffness: Stiffness,
    /// Mass per area in kg/m^2.
    pub density_kg_m2: f32,
    /// Bending rigidity in N m.
    pub hinge_rigidity_n_m: f32,
    /// Whether the kind was measured (else it is an estimate).
    pub measured: bool,
    /// Stiffness at small strain over that above, of warp and weft: below 1 for what stiffens as it stretches.
    pub softness: [f32; 2],
}

/// A kind of fabric and the words that speak of it.
#[derive(Clone, Copy, Debug)]
pub struct Kind {
    /// Its name.
    pub name: &'static str,
    /// Where its constants come from.
    pub source: &'static str,
    /// Words that name it, the most telling first.
    pub names: &'static [&'static str],
    /// Fibres, constructions and uses that go with it.
    pub words: &'static [&'static str],
    /// k_uu, k_vv, k_shear in N/m.
    pub membrane: [f32; 3],
    /// Mass per area in kg/m^2.
    pub density_kg_m2: f32,
    /// Mean bending rigidity in N m.
    pub hinge_rigidity_n_m: f32,
    /// k_uu, k_vv in N/m at small strain, where those of `membrane` are larger.
    pub small_strain: Option<[f32; 2]>,
}

const WANG: &str = "Wang, O'Brien, Ramamoorthi 2011";
const ESTIMATE: &str = "estimate";

macro_rules! kind {
    ($name:literal, $source:expr, $names:expr, $words:expr, $membrane:expr, $density:literal, $rigidity:literal $(, $small:expr)?) => {
        Kind {
            name: $name,
            source: $source,
            names: &$names,
            words: &$words,
            membrane: $membrane,
            density_kg_m2: $density,
            hinge_rigidity_n_m: $rigidity,
            small_strain: [$($small)?].first().copied(),
        }
    };
}

/// All kinds; the first seven are measured. u is the first number of the membrane, v the second.
#[rustfmt::skip]
pub const KINDS: [Kind; 17] = [
    kind!("denim", WANG, ["denim", "jeans"], ["cotton", "twill", "woven", "indigo", "trousers", "workwear"], [414.36, 2033.5, 108.84], 0.324, 1.95e-5),
    kind!("jersey", WANG, ["jersey", "interlock", "t-shirt"], ["cotton", "polyester", "knit", "shirt", "top"], [79.5, 593.9, 33.8], 0.187, 5.2e-6, [41.6, 109.8]),
    kind!("rib knit", WANG, ["rib", "ribbed", "underwear"], ["cotton", "spandex", "knit", "tank", "cuff"], [112.3, 412.8, 97.79], 0.276, 9.0e-6, [89.8, 157.6]),
    kind!("sweatshirt knit", WANG, ["sweatshirt", "sweater", "sweat"], ["polyester", "spandex", "knit", "sparkle", "pullover"], [56.1, 339.9, 23.2], 0.224, 1.2e-5, [30.9, 46.2]),
    kind!("blanket", WANG, ["blanket", "ribbon", "throw"], ["polyester", "plush", "woven", "bedding"], [301.55, 497.68, 60.49], 0.228, 2.2e-5),
    kind!("tablecloth", WANG, ["tablecloth", "taffeta"], ["polyester", "woven", "plain", "table", "napkin"], [4019.82, 4075.38, 39.07], 0.128, 1.03e-5),
    kind!("swimwear knit", WANG, ["swimsuit", "swimwear", "swim", "lycra"], ["nylon", "spandex", "elastane", "knit", "sport"], [100.3, 269.1, 70.29], 0.204, 1.42e-5, [96.2, 216.7]),
    kind!("silk", ESTIMATE, ["silk", "habotai"], ["woven", "plain", "scarf", "blouse", "lining"], [205.0, 1000.0, 24.0], 0.065, 5.9e-6),
    kind!("satin", ESTIMATE, ["satin", "sateen"], ["polyester", "woven", "gown", "lining", "dress"], [500.0, 1100.0, 26.0], 0.125, 8.4e-6),
    kind!("chiffon", ESTIMATE, ["chiffon", "georgette", "voile", "gauze"], ["polyester", "woven", "veil", "scarf", "curtain"], [180.0, 230.0, 8.0], 0.045, 1.8e-6),
    kind!("cotton", ESTIMATE, ["poplin", "broadcloth", "percale", "muslin", "cotton"], ["woven", "plain", "shirt", "sheet", "dress"], [1500.0, 2200.0, 60.0], 0.125, 2.2e-5),
    kind!("linen", ESTIMATE, ["linen", "flax"], ["woven", "plain", "summer", "suit", "napkin"], [2000.0, 2600.0, 60.0], 0.175, 4.2e-5),
    kind!("canvas", ESTIMATE, ["canvas", "duck", "sailcloth"], ["cotton", "woven", "plain", "tent", "bag", "sail"], [2800.0, 3600.0, 200.0], 0.400, 2.5e-4),
    kind!("wool", ESTIMATE, ["wool", "tweed", "flannel", "worsted"], ["woven", "twill", "coat", "suit", "winter"], [550.0, 800.0, 60.0], 0.260, 6.9e-5),
    kind!("felt", ESTIMATE, ["felt"], ["wool", "nonwoven", "hat", "craft"], [700.0, 700.0, 260.0], 0.300, 1.6e-4),
    kind!("velvet", ESTIMATE, ["velvet", "velour", "corduroy"], ["pile", "woven", "curtain", "upholstery"], [400.0, 650.0, 50.0], 0.330, 3.4e-5),
    kind!("fleece", ESTIMATE, ["fleece"], ["polyester", "knit", "jacket", "pile"], [110.0, 330.0, 60.0], 0.240, 1.9e-5, [80.0, 200.0]),
];

/// Power of the mass per area with which the bending rigidity goes among fabrics of one kind: that of "heavy" and "light"
/// below. Free fibres would give 1, a solid sheet 3.
pub const RIGIDITY_EXPONENT: f32 = 1.8;

/// The bending rigidity in N m of a fabric that has one of `rigidity_n_m` at `told_kg_m2`, in a piece of another mass per area.
pub fn rigidity_at(rigidity_n_m: f32, told_kg_m2: f32, density_kg_m2: f32) -> f32 {
    rigidity_n_m * (density_kg_m2 / told_kg_m2).powf(RIGIDITY_EXPONENT)
}

/// Words that change a fabric: (word, factor on the density, factor on the stiffness, factor on the rigidity).
#[rustfmt::skip]
pub const MODIFIERS: [(&str, f32, f32, f32); 22] = [
    ("heavy", 1.30, 1.20, 1.6), ("heavyweight", 1.35, 1.25, 1.7), ("thick", 1.25, 1.20, 1.8), ("dense", 1.20, 1.20, 1.3),
    ("light", 0.75, 0.85, 0.6), ("lightweight", 0.75, 0.85, 0.6), ("thin", 0.75, 0.80, 0.5), ("sheer", 0.65, 0.75, 0.5),
    ("fine", 0.85, 0.95, 0.7), ("airy", 0.75, 0.80, 0.6), ("stiff", 1.05, 1.35, 1.8), ("crisp", 1.00, 1.25, 1.5),
    ("starched", 1.02, 1.35, 2.0), ("sturdy", 1.15, 1.25, 1.4), ("rigid", 1.05, 1.40, 2.0), ("soft", 0.95, 0.80, 0.6),
    ("supple", 0.95, 0.80, 0.6), ("limp", 0.90, 0.70, 0.5), ("loose", 0.90, 0.75, 0.7), ("stretchy", 1.00, 0.65, 0.9),
    ("elastic", 1.00, 0.65, 0.9), ("smooth", 0.97, 1.00, 0.9),
];

/// Words that change nothing but how it looks.
pub const COLOURS: [&str; 16] = [
    "blue", "black", "white", "red", "green", "grey", "navy", "brown", "pink", "ivory", "yellow", "dark", "pale",
    "striped", "plain", "printed",
];

/// Bend stiffness in N/m: Provot's bend springs resist stretch too, so they are kept small.
const BEND: f32 = 1.0;

impl Kind {
    /// The fabric as it is without further words.
    pub fn fabric(&self) -> Fabric {
        let [uu, vv, shear] = self.membrane;
        let shear = 0.5 * shear;
        let rest = |c: f32| (c - shear - 4.0 * BEND).max(0.25 * c);
        let (warp, weft) = (rest(vv), rest(uu));
        Fabric {
            kind: self.name,
            stiffness: [warp, weft, shear, BEND.min(taut::BEND_SHARE * 0.5 * (warp + weft))],
            density_kg_m2: self.density_kg_m2,
            hinge_rigidity_n_m: self.hinge_rigidity_n_m,
            measured: self.source == WANG,
            softness: self.small_strain.map_or([1.0; 2], |[small_u, small_v]| [small_v / vv, small_u / uu]),
        }
    }
}

/// Tension of a hanging sheet of 1 m, in weights of the sheet for each m of its width. Along the warp, which hangs down: half
/// of the sheet's weight on the quarter circle 10 cm about a corner that it is hung by, 1/(0.1 pi). Along the weft two thirds
/// of that, since it lies across the load; along the diagonal nearly all.
const LOADS: [f32; 3] = [3.18, 2.0, 3.0];

impl Fabric {
    /// How far the fabric stretches in use along warp, weft and diagonal, as fractions of the rest length: the strain at which
    /// it carries the tension of a hanging sheet. A knit's stiffness grows linearly from that at small strain to that at 10 %.
    /// Along the diagonal it is that of the lattice at 45 degrees. 0.001 to 0.29.
    pub fn stretch_limits(&self) -> [f32; 3] {
        let [warp, weft, shear, bend] = self.stiffness;
        let weight = self.density_kg_m2 * 9.81;
        // the lattice turned by 45 degrees, warp and weft averaged: C11' = a/2 + 3 s/2, C12' = a/2 - s/2
        let a = 0.5 * (warp + weft) + 4.0 * bend;
        let (along, across) = (0.5 * a + 1.5 * shear, 0.5 * (a - shear));
        let diagonal = along - across * across / along;
        let [soft_warp, soft_weft] = self.softness;
        let stiffness =
            [(warp + shear + 4.0 * bend, soft_warp), (weft + shear + 4.0 * bend, soft_weft), (diagonal, 1.0)];
        std::array::from_fn(|i| {
            let ((c, soft), tension) = (stiffness[i], LOADS[i] * weight);
            // tension = (small + grows strain) strain
            let (small, grows) = (soft * c, (1.0 - soft) * c / 0.1);
            let strain = 2.0 * tension / (small + (small * small + 4.0 * grows * tension).sqrt());
            strain.clamp(0.001, 0.29)
        })
    }

    /// The fabric with the effect of the modifying words of a description.
    pub fn modified(mut self, words: &[String]) -> Fabric {
        for (word, density, stiffness, rigidity) in MODIFIERS {
            if words.iter().any(|w| w == word) {
                self.density_kg_m2 *= density;
                self.hinge_rigidity_n_m *= rigidity;
                for k in &mut self.stiffness {
                    *k *= stiffness;
                }
            }
        }
        self
    }

    /// The fabric that a description names by the words of the tables above, if it names one.
    pub fn named(description: &str) -> Option<Fabric> {
        let words = words_of(description);
        let has = |w: &str| words.iter().any(|x| x == w || x.strip_suffix('s') == Some(w));
        // A name counts more the earlier it stands in its kind's list, the other words break ties.
        let score = |k: &Kind| {
            let name = k.names.iter().position(|w| has(w)).map_or(0, |i| 100 - 10 * i);
            name + k.words.iter().filter(|w| has(w)).count()
        };
        let best = KINDS.iter().rev().max_by_key(|k| score(k))?;
        (score(best) > 0).then(|| best.fabric().modified(&words))
    }
}

/// Lower-case words of a text.
pub fn words_of(text: &str) -> Vec<String> {
    text.to_lowercase()
        .split(|c: char| !(c.is_ascii_alphanumeric() || c == '-'))
        .filter(|w| !w.is_empty())
        .map(str::to_string)
        .collect()
}

/// A fabric near a kind with a description that fits it, drawn by (seed, index): the words that modify it act, and what is
/// left (up to 10 % of the stiffness, 5 % of the density) is the difference between two bolts of the same cloth.
pub fn sample(seed: u64, index: u32) -> (Fabric, String) {
    let draw = |i: u32| noise::uniform(seed, index.wrapping_mul(16).wrapping_add(i));
    let pick = |i: u32, n: usize| ((draw(i) * n as f32) as usize).min(n - 1);
    let kind = &KINDS[pick(0, KINDS.len())];
    let name = kind.names[pick(1, kind.names.len())];
    let mut words: Vec<String> = Vec::new();
    if draw(2) < 0.6 {
        words.push(MODIFIERS[pick(3, MODIFIERS.len())].0.to_string());
    }
    if draw(4) < 0.5 {
        words.push(COLOURS[pick(5, COLOURS.len())].to_string());
    }
    if draw(6) < 0.35 {
        words.push(kind.words[pick(7, kind.words.len())].to_string());
    }
    words.push(name.to_string());
    // two names of one kind are that kind and not twice of it
    let second = kind.names[pick(12, kind.names.len())];
    if draw(13) < 0.25 && second != name {
        words.push(second.to_string());
    }
    if draw(8) < 0.25 {
        words.push(kind.words[pick(9, kind.words.len())].to_string());
    }
    let mut fabric = kind.fabric().modified(&words);
    let common = (0.20 * (draw(10) - 0.5)).exp();
    for k in &mut fabric.stiffness {
        *k *= common;
    }
    fabric.density_kg_m2 *= (0.10 * (draw(11) - 0.5)).exp();
    (fabric, words.join(" "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_name_fabrics() {
        let kind = |d: &str| Fabric::named(d).map(|f| f.kind);
        assert_eq!(kind("heavy blue denim"), Some("denim"));
        assert_eq!(kind("a thin soft grey T-shirt for summer"), Some("jersey"));
        assert_eq!(kind("light silk"), Some("silk"));
        assert_eq!(kind("cotton jersey knit"), Some("jersey"));
        assert_eq!(kind("crisp white cotton shirt"), Some("cotton"));
        assert_eq!(kind("quantum foam"), None);
        let (heavy, plain) = (Fabric::named("heavy denim").unwrap(), Fabric::named("denim").unwrap());
        assert!(heavy.density_kg_m2 > plain.density_kg_m2 && heavy.stiffness[0] > plain.stiffness[0]);
    }

    #[test]
    fn stiffness_gives_back_the_measured_membrane() {
        let f = KINDS[0].fabric();
        let [warp, weft, shear, bend] = f.stiffness;
        assert!((weft + shear + 4.0 * bend - 414.36).abs() < 0.1, "C11");
        assert!((warp + shear + 4.0 * bend - 2033.5).abs() < 0.1, "C22");
        assert!((2.0 * shear - 108.84).abs() < 0.1);
    }

    #[test]
    fn stretch_limits_carry_the_tension_of_a_hanging_sheet() {
        for kind in &KINDS {
            let f = kind.fabric();
            let [warp, weft, diagonal] = f.stretch_limits();
            let c = f.stiffness[0] + f.stiffness[2] + 4.0 * f.stiffness[3];
            let k = f.softness[0] * c + (1.0 - f.softness[0]) * c * warp / 0.1;
            let tension = LOADS[0] * f.density_kg_m2 * 9.81;
            assert!(warp <= 0.001 || (k * warp / tension - 1.0).abs() < 1e-3, "{}: {warp}", kind.name);
            assert!(f.softness.iter().all(|s| *s > 0.0 && *s <= 1.0), "{}", kind.name);
            assert!([warp, weft, diagonal].iter().all(|l| (0.001..=0.29).contains(l)));
        }
        // a knit gives more than one as stiff from the start
        let knit = Fabric::named("jersey").unwrap();
        let stiff = Fabric { softness: [1.0; 2], ..knit.clone() };
        assert!(knit.stretch_limits()[0] > 2.0 * stiff.stretch_limits()[0]);
    }

    #[test]
    fn estimates_bend_as_cloth_of_their_weight_does() {
        for kind in KINDS.iter().filter(|k| k.source == ESTIMATE) {
            let length_m = (kind.hinge_rigidity_n_m / (kind.density_kg_m2 * 9.81)).cbrt();
            assert!((0.0155..0.0405).contains(&length_m), "{}: {length_m}", kind.name);
        }
        for (word, density, _, rigidity) in MODIFIERS.iter().filter(|m| ["heavy", "light"].contains(&m.0)) {
            let exponent = rigidity.ln() / density.ln();
            assert!((exponent - RIGIDITY_EXPONENT).abs() < 0.05, "{word}: {exponent}");
        }
    }

    #[test]
    fn samples_are_named_as_what_they_are() {
        for i in 0..500 {
            let (fabric, words) = sample(3, i);
            assert_eq!(sample(3, i), (fabric.clone(), words.clone()));
            assert!(fabric.stiffness.iter().all(|k| k.is_finite() && *k > 0.0));
            assert!((0.02..0.8).contains(&fabric.density_kg_m2), "{words}: {}", fabric.density_kg_m2);
        }
    }
}
