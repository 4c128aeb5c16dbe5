//! Where plots are drawn: pixels of a PNG or an SVG text, by the same code.

use std::sync::Once;

use image::{ExtendedColorType, ImageEncoder};
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::register_font;

use super::PlotError;

/// Family name under which the built-in font is registered; SVG falls back to what the reader has.
pub(super) const FONT: &str = "sans-serif";

/// Most pixels of a side.
const MOST: u32 = 8192;

static FONTS: Once = Once::new();

/// Something that draws itself on any of the backends.
pub trait Figure {
    /// Width and height in pixels.
    fn size(&self) -> (u32, u32);

    /// Draws it all.
    fn draw<B: DrawingBackend>(&self, root: &DrawingArea<B, Shift>) -> Result<(), PlotError>;

    /// As the bytes of a PNG file. The same figure gives the same bytes.
    fn png(&self) -> Result<Vec<u8>, PlotError> {
        register();
        let (width, height) = checked(self.size())?;
        let mut pixels = vec![0u8; 3 * width as usize * height as usize];
        {
            let root = BitMapBackend::with_buffer(&mut pixels, (width, height)).into_drawing_area();
            root.fill(&WHITE).map_err(drawing)?;
            self.draw(&root)?;
            root.present().map_err(drawing)?;
        }
        let mut png = Vec::new();
        image::codecs::png::PngEncoder::new(&mut png)
            .write_image(&pixels, width, height, ExtendedColorType::Rgb8)
            .map_err(drawing)?;
        Ok(png)
    }

    /// As an SVG text, for a page.
    fn svg(&self) -> Result<String, PlotError> {
        register();
        let mut text = String::new();
        {
            let root = SVGBackend::with_string(&mut text, checked(self.size())?).into_drawing_area();
            self.draw(&root)?;
            root.present().map_err(drawing)?;
        }
        Ok(text)
    }
}

fn checked(size: (u32, u32)) -> Result<(u32, u32), PlotError> {
    if [size.0, size.1].iter().all(|s| (1..=MOST).contains(s)) { Ok(size) } else { Err(PlotError::TooMuch) }
}

fn register() {
    // fails for a font that is none, which this one is
    FONTS.call_once(|| {
        let _ = register_font(FONT, FontStyle::Normal, epaint_default_fonts::UBUNTU_LIGHT);
    });
}

pub(super) fn drawing(e: impl std::fmt::Display) -> PlotError {
    PlotError::Drawing(e.to_string())
}
