//! Text in Noto Sans Mono, rasterised beforehand with smooth edges.

use noto_sans_mono_bitmap::{FontWeight, RasterHeight, get_raster, get_raster_width};

use super::canvas::{Area, Canvas};
use super::color::Srgb;

/// Size and weight of a line of text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Face {
    /// 32 pixels, bold.
    Title,
    /// 24 pixels, bold.
    Heading,
    /// 20 pixels.
    Body,
    /// 16 pixels.
    Small,
}

impl Face {
    fn font(self) -> (FontWeight, RasterHeight) {
        match self {
            Self::Title => (FontWeight::Bold, RasterHeight::Size32),
            Self::Heading => (FontWeight::Bold, RasterHeight::Size24),
            Self::Body => (FontWeight::Regular, RasterHeight::Size20),
            Self::Small => (FontWeight::Regular, RasterHeight::Size16),
        }
    }

    /// Height of a line, pixels.
    pub fn height(self) -> i32 {
        self.font().1.val() as i32
    }

    /// Width of every character, pixels.
    pub fn advance(self) -> i32 {
        let (weight, height) = self.font();
        get_raster_width(weight, height) as i32
    }

    /// Width of a line of text, pixels.
    pub fn width(self, text: &str) -> i32 {
        let characters = i32::try_from(text.chars().count()).unwrap_or(i32::MAX);
        characters.saturating_mul(self.advance())
    }

    /// The text, cut with two dots where it is wider than `width` pixels.
    pub fn fitted(self, text: &str, width: i32) -> String {
        let room = (width.max(0) / self.advance()) as usize;
        if text.chars().count() <= room {
            return text.to_owned();
        }
        let kept: String = text.chars().take(room.saturating_sub(2)).collect();
        let mut cut = kept.trim_end().to_owned();
        cut.extend(std::iter::repeat_n('.', 2.min(room)));
        cut
    }
}

/// Where a line stands in its box.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Align {
    /// At the left edge.
    Left,
    /// In the middle.
    Center,
}

/// Writes one line at the top of `area`, cut to its width; characters the font lacks show as `?`.
pub fn write(canvas: &mut Canvas, area: Area, text: &str, face: Face, align: Align, color: Srgb) {
    let text = face.fitted(text, area.width);
    let free = area.width - face.width(&text);
    let left = area.x
        + match align {
            Align::Left => 0,
            Align::Center => free / 2,
        };
    let (weight, height) = face.font();
    for (i, character) in text.chars().enumerate() {
        let Some(glyph) = get_raster(character, weight, height).or_else(|| get_raster('?', weight, height)) else {
            continue;
        };
        let x0 = left + i as i32 * face.advance();
        for (dy, row) in glyph.rows().enumerate() {
            for (dx, &opacity) in row.iter().enumerate() {
                canvas.blend(x0 + dx as i32, area.y + dy as i32, color, f32::from(opacity) / 255.0);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_text_is_cut_and_never_leaves_its_box() {
        let area = Area { x: 10, y: 4, width: 100, height: 24 };
        for align in [Align::Left, Align::Center] {
            for face in [Face::Title, Face::Heading, Face::Body, Face::Small] {
                let mut canvas = Canvas::new(200, 60, [255; 3]);
                write(&mut canvas, area, &"a heavy blue WWW".repeat(20), face, align, [0; 3]);
                let image = canvas.into_image();
                let mut dark = 0;
                for y in 0..60 {
                    for x in 0..200 {
                        let inside = (10..110).contains(&x) && (4..4 + face.height() as u32).contains(&y);
                        let drawn = image.get_pixel(x, y).0 != [255; 3];
                        assert!(inside || !drawn, "{face:?} {align:?} at {x} {y}");
                        dark += i32::from(drawn);
                    }
                }
                assert!(dark > 50);
            }
        }
    }

    #[test]
    fn fitting() {
        assert_eq!(Face::Body.fitted("denim", 1000), "denim");
        let cut = Face::Body.fitted("heavy blue denim", 10 * Face::Body.advance());
        assert_eq!(cut, "heavy bl..");
        assert_eq!(Face::Body.fitted("denim", 0), "");
        assert_eq!(Face::Body.fitted("denim", -5), "");
        assert_eq!(Face::Body.fitted("denim", Face::Body.advance()), ".");
    }

    #[test]
    fn unknown_characters_show_as_a_question_mark() {
        let draw = |text: &str| {
            let mut canvas = Canvas::new(40, 24, [255; 3]);
            let area = Area { x: 0, y: 0, width: 40, height: 24 };
            write(&mut canvas, area, text, Face::Body, Align::Left, [0; 3]);
            canvas.into_image()
        };
        assert_eq!(draw("布"), draw("?"));
        assert_ne!(draw("é"), draw("?"));
    }
}
