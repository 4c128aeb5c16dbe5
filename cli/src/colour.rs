//! The colour of the fabric in the picture, from the colour words of its description.

use taut_lab::fabric::words_of;
use taut_lab::picture::{Ramp, Srgb, Style};

/// Without a colour word the cloth is the grey of unbleached wool in the shade.
const NEUTRAL: Srgb = [118, 122, 128];

/// Colours by their words, muted: stretch is shown by bright colours on top. Warm ones would be taken for stretch by the
/// yellow-to-magenta ramp, so they come with the one that ends in near black.
const COLOURS: [(&[&str], Srgb, Ramp); 15] = [
    (&["blue", "azure"], [66, 98, 158], Ramp::Heat),
    (&["indigo"], [58, 72, 132], Ramp::Heat),
    (&["navy"], [48, 62, 104], Ramp::Heat),
    (&["black", "charcoal"], [76, 79, 87], Ramp::Heat),
    (&["grey", "gray", "silver"], [126, 130, 136], Ramp::Heat),
    (&["white"], [208, 210, 212], Ramp::Heat),
    (&["ivory", "cream", "ecru", "beige"], [200, 192, 172], Ramp::Heat),
    (&["green", "olive", "khaki"], [76, 112, 84], Ramp::Heat),
    (&["teal", "turquoise", "cyan"], [58, 118, 124], Ramp::Heat),
    (&["purple", "violet", "lilac"], [98, 82, 138], Ramp::Heat),
    (&["brown", "tan"], [108, 86, 70], Ramp::Heat),
    (&["red", "scarlet", "crimson", "burgundy"], [142, 74, 76], Ramp::ColorBlindSafe),
    (&["pink", "rose"], [172, 124, 134], Ramp::ColorBlindSafe),
    (&["orange", "rust"], [158, 104, 70], Ramp::ColorBlindSafe),
    (&["yellow", "gold", "golden", "mustard"], [158, 142, 84], Ramp::ColorBlindSafe),
];

/// How the cloth of a description is drawn: by its first colour word, made darker or lighter by a word just before it.
pub fn style(description: &str) -> Style {
    let words = words_of(description);
    // "sky-blue" is blue
    let parts: Vec<&str> = words.iter().flat_map(|w| w.split('-')).collect();
    let colour_of = |word: &str| COLOURS.iter().find(|(names, ..)| names.contains(&word));
    for (i, word) in parts.iter().enumerate() {
        let Some((_, colour, ramp)) = colour_of(word) else {
            continue;
        };
        let before = i.checked_sub(1).and_then(|i| parts.get(i)).copied();
        let fabric = match before {
            Some("dark" | "deep") => colour.map(|c| (f32::from(c) * 0.68) as u8),
            Some("light" | "pale" | "sky") => colour.map(|c| c + (255 - c) / 3),
            _ => *colour,
        };
        return Style { fabric, ramp: *ramp };
    }
    Style { fabric: NEUTRAL, ramp: Ramp::Heat }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_colour_the_cloth() {
        let colour = |d: &str| style(d).fabric;
        let [r, g, b] = colour("heavy BLUE denim");
        assert!(b > g && g > r);
        assert_eq!(colour("denim"), NEUTRAL);
        assert_eq!(colour(""), NEUTRAL);
        assert_eq!(colour("light denim"), NEUTRAL, "light is a weight here");
        assert!(colour("dark blue wool")[2] < b && colour("light blue wool")[2] > b);
        assert_eq!(colour("blue and red plaid"), colour("blue"));
        assert!(style("sky-blue silk").fabric[2] > b);
        assert_eq!(style("red velvet").ramp, Ramp::ColorBlindSafe);
    }
}
