//! The words for the grades of a fabric's four qualities, and for colours, patterns, folds and everyday descriptions.
//!
//! A quality has five grades. Its ends have words of their own; the middle has few, because people seldom name it.

use std::sync::LazyLock;

/// The words of a list.
fn list(text: &'static str) -> Vec<&'static str> {
    text.split_whitespace().collect()
}

/// The four graded qualities of a fabric.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quality {
    /// Mass per area: light to heavy.
    Weight,
    /// Thin to thick.
    Thickness,
    /// Resistance to bending: limp to stiff.
    Stiffness,
    /// Give in the plane: inextensible to elastic.
    Stretch,
}

/// All qualities, in the order of a catalogue line.
pub const QUALITIES: [Quality; 4] = [Quality::Weight, Quality::Thickness, Quality::Stiffness, Quality::Stretch];

impl Quality {
    /// The words for a grade from 1 (least) to 5 (most); any other grade has none. Frequent words stand twice.
    pub fn words(self, grade: u8) -> &'static [&'static str] {
        match (self, grade) {
            (Self::Weight, 1) => &["light", "light", "lightweight", "featherlight", "weightless", "ultralight", "airy"],
            (Self::Weight, 2) => &["light", "light", "lightweight", "lightish"],
            (Self::Weight, 3) => &["medium", "midweight", "medium-weight", "moderate"],
            (Self::Weight, 4) => &["heavy", "heavy", "heavyweight", "weighty", "substantial"],
            (Self::Weight, 5) => &["heavy", "heavy", "heavyweight", "weighty", "hefty", "massive"],
            (Self::Thickness, 1) => &["thin", "thin", "fine", "wispy", "filmy", "flimsy"],
            (Self::Thickness, 2) => &["thin", "thin", "fine", "slim"],
            (Self::Thickness, 3) => &["medium", "moderate", "average"],
            (Self::Thickness, 4) => &["thick", "thick", "dense", "substantial"],
            (Self::Thickness, 5) => &["thick", "thick", "bulky", "chunky", "voluminous"],
            (Self::Stiffness, 1) => {
                &["soft", "limp", "supple", "fluid", "drapey", "flowing", "floppy", "flexible", "slouchy"]
            }
            (Self::Stiffness, 2) => &["soft", "supple", "pliable", "pliant", "flexible", "yielding"],
            (Self::Stiffness, 3) => &["medium", "moderate"],
            (Self::Stiffness, 4) => &["stiff", "firm", "structured", "stiffish", "solid"],
            (Self::Stiffness, 5) => {
                &["stiff", "stiff", "rigid", "inflexible", "boardy", "structured", "hard", "unbending"]
            }
            (Self::Stretch, 1) => {
                &["inelastic", "non-stretch", "inextensible", "stable", "stretchless", "unstretchable"]
            }
            (Self::Stretch, 3) => &["stretch", "give", "stretchable"],
            (Self::Stretch, 4) => &["stretchy", "stretchy", "stretch", "elastic", "extensible", "stretchable"],
            (Self::Stretch, 5) => &["stretchy", "stretchy", "elastic", "elasticated", "springy", "stretch", "clingy"],
            _ => &[],
        }
    }

    /// The words of one end of the scale, 0 the low one and 1 the high one: sentences that gather synonyms use them.
    pub fn end(self, high: bool) -> [&'static [&'static str]; 2] {
        if high { [self.words(4), self.words(5)] } else { [self.words(1), self.words(2)] }
    }

    /// Words that speak of the quality itself, at one end of its scale.
    pub fn meaning(self, high: bool) -> &'static [&'static str] {
        match (self, high) {
            (Self::Weight, false) => {
                &["weighs little", "low weight", "few grams", "floats", "for summer", "easy to carry"]
            }
            (Self::Weight, true) => {
                &["weighs much", "great weight", "many grams", "hangs down", "for winter", "many ounces"]
            }
            (Self::Thickness, false) => &["little thickness", "of fine yarn", "lets light through", "a single layer"],
            (Self::Thickness, true) => {
                &["great thickness", "of thick yarn", "keeps warm", "several layers", "much loft"]
            }
            (Self::Stiffness, false) => {
                &["bends easily", "drapes in soft folds", "clings to the body", "low rigidity", "flows"]
            }
            (Self::Stiffness, true) => {
                &["resists bending", "holds its shape", "stands away from the body", "high rigidity", "starched"]
            }
            (Self::Stretch, false) => &["does not give", "keeps its length", "no stretch", "low extension"],
            (Self::Stretch, true) => {
                &["gives and recovers", "extends far", "great stretch", "follows the body", "high extension"]
            }
        }
    }
}

/// How a fabric of a stiffness grade falls: the words of its folds.
pub fn folds(stiffness: u8) -> &'static [&'static str] {
    match stiffness {
        0..=2 => &["soft folds", "deep folds", "many small folds", "flowing folds", "gentle ripples", "liquid drape"],
        3 => &["even folds", "rounded folds", "moderate folds"],
        _ => &["few large folds", "sharp creases", "angular folds", "wide stiff folds", "hardly any folds"],
    }
}

/// Colours of cloth.
pub static COLOURS: LazyLock<Vec<&str>> = LazyLock::new(|| {
    list(
        "white black grey gray red blue green yellow orange purple pink brown beige \
         ivory cream navy turquoise teal cyan magenta violet lilac lavender mauve maroon \
         burgundy crimson scarlet vermilion coral salmon peach apricot rose fuchsia plum \
         indigo cobalt azure ultramarine aqua mint olive khaki emerald jade lime mustard \
         gold golden silver bronze copper ochre amber rust terracotta tan camel taupe \
         sand charcoal slate ecru wine cherry lemon chocolate coffee sapphire ruby pearl \
         blond sepia chestnut caramel nude champagne sage moss sky",
    )
});

/// Words that stand before a colour.
pub static SHADES: LazyLock<Vec<&str>> = LazyLock::new(|| {
    list(
        "dark pale bright deep pastel vivid faded dusty rich dull muted neon light warm \
         cool washed bleached dyed undyed",
    )
});

/// Patterns and finishes of the surface.
pub static PATTERNS: LazyLock<Vec<&str>> = LazyLock::new(|| {
    list(
        "striped checked plaid tartan dotted spotted floral printed plain solid \
         patterned polka-dot checkered paisley flowered embroidered sparkle glitter \
         matte shiny metallic camouflage geometric zigzag tie-dyed quilted pleated \
         ruffled gathered monochrome two-tone multicoloured colourful unicolour leopard \
         stripes dots",
    )
});

/// Everyday words of descriptions that say little about mechanics: they must be known, and stay near the middle.
pub static EVERYDAY: LazyLock<Vec<&str>> = LazyLock::new(|| {
    list(
        "old new big large small little long short wide narrow tight loose fitted \
         oversized simple elegant fancy formal casual modern vintage antique classic \
         cheap expensive good best quality premium ordinary everyday beautiful pretty \
         lovely nice ugly clean dirty dry wet damp worn torn used ironed pressed \
         wrinkled creased washed handmade homemade industrial medical military royal \
         rustic summer winter spring autumn outdoor indoor home kitchen bathroom bedroom \
         hotel beach garden travel school office work party wedding evening holiday \
         sports men women children boy girl baby dog doll double single folded hanging \
         square round rectangular piece sheet length swatch sample layer material fabric \
         cloth textile garment clothing clothes quality ethnic traditional oriental french \
         english italian scottish indian japanese chinese organic recycled natural \
         synthetic blend blended mixed pure real imitation fake genuine comfortable \
         practical decorative delicate strong weak crumpled frayed ripped patched \
         stained shabby luxury designer street city country mountain sea night day \
         warm-weather cold-weather theatre theater stage window door table bed wall tea \
         dish bath hand face hair head neck waist long-sleeved short-sleeved sleeveless \
         knee-length superhero pirate princess nurse chef soldier dancer runner worker \
         sailor color colored coloured fibre fiber woollen woolen cuddly favourite \
         favorite festive rainy sunny windy made very slightly extra super",
    )
});

/// Garments and other things made of cloth, beyond the uses that the catalogue names.
pub static THINGS: LazyLock<Vec<&str>> = LazyLock::new(|| {
    list(
        "apron backpack bandana bathrobe beanie bedspread belt beret bib bikini blazer \
         blouse bodice bonnet bra cape cap cardigan cloak collar corset costume coverlet \
         cravat curtain cushion duvet drape drapes dress dressing-gown flag frock gloves \
         gown handkerchief hat headscarf hood hoodie jacket jumper kaftan kilt kimono \
         leggings mat mattress mitten napkin necktie overalls overcoat pants parka \
         pillow pillowcase pinafore placemat pocket poncho pullover pyjamas quilt robe \
         romper rug sack sail sarong sash scarf shawl sheet shirt shorts skirt sleeve \
         slip smock socks stockings stole suit sweater sweatpants swimsuit tablecloth \
         tabard tapestry tent tie toga towel trousers tunic turban underpants underwear \
         uniform upholstery veil vest waistcoat wrap yoga_pants tracksuit jumpsuit polo \
         bedsheet banner",
    )
});

/// Parts, making and care of cloth: words that a description may hold, with a sentence of their own.
pub const CRAFT: &[&str] = &[
    "woven on a loom from warp and weft yarn",
    "the warp runs along the selvage and the weft across the width",
    "knitted with needles in rows of loops and wales and courses",
    "weft-knit and warp-knit fabrics have loops and stretch more than woven cloth",
    "plain weave passes one thread over and one thread under",
    "twill weave shows diagonal lines on a dense durable cloth",
    "satin weave has long floats and a smooth shiny face",
    "nonwoven felt is matted fibre without yarn",
    "fibre is spun into yarn and yarn is woven or knitted into fabric",
    "fiber is spun into thread and thread is woven or knit into cloth",
    "natural fibres are cotton linen hemp wool and silk",
    "synthetic fibres are polyester nylon acrylic polypropylene and elastane",
    "lycra and spandex are trade names of elastane an elastic fibre",
    "elastane spandex and lycra make a fabric stretchy",
    "viscose rayon modal and lyocell are fibres made from wood cellulose",
    "polyamide is another name of nylon",
    "a worsted yarn is combed smooth and a woollen yarn is carded and fuzzy",
    "wool comes from sheep and cashmere and mohair come from goats",
    "silk comes from the cocoon of the silkworm and is fine and lustrous",
    "linen comes from flax and cotton from the boll",
    "cut on the bias a woven cloth shears and drapes",
    "shear across the weave is easier than stretch along warp or weft",
    "hem seam stitch pleat gather dart fold crease and drape",
    "the nap is brushed and the pile is raised",
    "pile cloth such as velvet corduroy and terry has raised loops or cut tufts",
    "starch makes cotton crisp and stiff",
    "ironing presses wrinkles out of linen and cotton",
    "coated laminated and waxed cloth is waterproof and stiffer",
    "a high thread count means fine yarn and a dense smooth sheet",
    "gsm means grams per square metre and oz means ounces per square yard",
    "grams per square metre and ounces per square yard tell the weight of a fabric",
    "denier and tex tell how thick a yarn is",
    "the hand of a fabric is how it feels soft smooth crisp or harsh",
    "wovens hold their length and knits give",
    "a heavy fabric weighs more per square metre than a light fabric",
    "a thick fabric is heavier and warmer than a thin fabric",
];
