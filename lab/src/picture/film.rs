//! Films: pictures of one size as an animated GIF that every browser and forge shows.

use std::collections::HashMap;

use color_quant::NeuQuant;
use gif::{DisposalMethod, Encoder, Frame, Repeat};
use image::RgbImage;

use super::color::Srgb;
use super::error::PictureError;

/// Colours of the palette; one index more stands for "as before".
const COLOURS: usize = 255;
const AS_BEFORE: u8 = 255;

/// About so many pixels of all pictures choose the palette.
const SAMPLES: usize = 200_000;

/// How thoroughly the palette is chosen, 1 (best) to 30.
const PALETTE_SPEED: i32 = 3;

/// Encodes pictures of one size as a GIF that repeats for ever. One palette serves all, and a picture holds only what has
/// changed since the one before.
///
/// # Errors
/// [`PictureError::Empty`] without pictures; [`PictureError::Encode`] where their sizes differ, a side is 0 or over 65535, or
/// the rate is not 1 to 50 a second (a GIF counts in hundredths of a second, browsers slow down what is faster).
pub fn encode_gif(pictures: &[RgbImage], pictures_per_s: f32) -> Result<Vec<u8>, PictureError> {
    let refused = |reason: String| PictureError::Encode { reason };
    let first = pictures.first().ok_or(PictureError::Empty)?;
    let size = first.dimensions();
    if let Some(other) = pictures.iter().find(|p| p.dimensions() != size) {
        return Err(refused(format!("pictures of {size:?} and {:?} pixels in one film", other.dimensions())));
    }
    let (Ok(width), Ok(height)) = (u16::try_from(size.0), u16::try_from(size.1)) else {
        return Err(refused(format!("{size:?} pixels are too many for a GIF")));
    };
    if width == 0 || height == 0 || !(1.0..=50.0).contains(&pictures_per_s) {
        return Err(refused(format!("{size:?} pixels at {pictures_per_s} pictures a second")));
    }
    let mut palette = Palette::new(pictures);
    let failed = |e: gif::EncodingError| PictureError::Encode { reason: e.to_string() };
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, width, height, &palette.colours()).map_err(failed)?;
    encoder.set_repeat(Repeat::Infinite).map_err(failed)?;
    let mut before: Option<Vec<u8>> = None;
    for picture in pictures {
        let indices: Vec<u8> = picture.pixels().map(|p| palette.index(p.0)).collect();
        let mut frame = changed(before.as_deref(), &indices, usize::from(width));
        frame.delay = (100.0 / pictures_per_s).round() as u16;
        encoder.write_frame(&frame).map_err(failed)?;
        before = Some(indices);
    }
    drop(encoder);
    Ok(bytes)
}

/// The box of what differs, with "as before" where nothing does.
fn changed(before: Option<&[u8]>, now: &[u8], width: usize) -> Frame<'static> {
    let differs = |i: usize| before.is_none_or(|b| b.get(i) != now.get(i));
    let (mut left, mut top, mut right, mut bottom) = (usize::MAX, usize::MAX, 0, 0);
    for i in (0..now.len()).filter(|i| differs(*i)) {
        let (x, y) = (i % width, i / width);
        (left, right) = (left.min(x), right.max(x));
        (top, bottom) = (top.min(y), bottom.max(y));
    }
    if left > right {
        // a picture like the one before still takes its time
        (left, right, top, bottom) = (0, 0, 0, 0);
    }
    let buffer: Vec<u8> = (top..=bottom)
        .flat_map(|y| (left..=right).map(move |x| y * width + x))
        .map(|i| if differs(i) { now[i] } else { AS_BEFORE })
        .collect();
    Frame {
        left: left as u16,
        top: top as u16,
        width: (right - left + 1) as u16,
        height: (bottom - top + 1) as u16,
        transparent: before.map(|_| AS_BEFORE),
        dispose: DisposalMethod::Keep,
        buffer: buffer.into(),
        ..Frame::default()
    }
}

/// The colours that all pictures share.
struct Palette {
    quantizer: NeuQuant,
    known: HashMap<Srgb, u8>,
}

impl Palette {
    fn new(pictures: &[RgbImage]) -> Palette {
        let pixels: usize = pictures.iter().map(|p| p.pixels().len()).sum();
        // a prime stride does not run along the columns
        let strides = [1, 2, 3, 5, 7, 11, 23, 47, 97, 197, 397, 797, 1597];
        let stride = strides.into_iter().find(|s| pixels / s <= SAMPLES).unwrap_or(3203);
        let samples: Vec<u8> = pictures
            .iter()
            .flat_map(|p| p.pixels())
            .step_by(stride)
            .flat_map(|p| [p.0[0], p.0[1], p.0[2], u8::MAX])
            .collect();
        Palette { quantizer: NeuQuant::new(PALETTE_SPEED, COLOURS, &samples), known: HashMap::new() }
    }

    /// The colours as a GIF stores them, 256 of three bytes.
    fn colours(&self) -> Vec<u8> {
        let mut colours = self.quantizer.color_map_rgb();
        colours.resize(3 * 256, 0);
        colours
    }

    /// The nearest colour.
    fn index(&mut self, colour: Srgb) -> u8 {
        let [r, g, b] = colour;
        let quantizer = &self.quantizer;
        *self.known.entry(colour).or_insert_with(|| quantizer.index_of(&[r, g, b, u8::MAX]).min(COLOURS - 1) as u8)
    }
}

#[cfg(test)]
mod tests {
    use image::Rgb;

    use super::*;

    /// A square that goes to the right, in 200 colours.
    fn pictures() -> Vec<RgbImage> {
        let square = |t: u32| {
            RgbImage::from_fn(40, 30, |x, y| {
                if (x >= t && x < t + 10) && (8..20).contains(&y) {
                    Rgb([200, (10 * y) as u8, 40])
                } else {
                    Rgb([240, 240, 240])
                }
            })
        };
        vec![square(0), square(6), square(6), square(25)]
    }

    #[test]
    fn a_film_shows_its_pictures() {
        let pictures = pictures();
        let bytes = encode_gif(&pictures, 20.0).expect("a film");
        assert_eq!(bytes, encode_gif(&pictures, 20.0).expect("a film"), "the same bytes");
        let mut options = gif::DecodeOptions::new();
        options.set_color_output(gif::ColorOutput::RGBA);
        let mut decoder = options.read_info(bytes.as_slice()).expect("a GIF");
        assert_eq!((decoder.width(), decoder.height()), (40, 30));
        let mut screen = vec![0u8; 40 * 30 * 3];
        let mut shown = 0;
        while let Some(frame) = decoder.read_next_frame().expect("a picture") {
            assert_eq!(frame.delay, 5);
            for y in 0..usize::from(frame.height) {
                for x in 0..usize::from(frame.width) {
                    let pixel = &frame.buffer[4 * (y * usize::from(frame.width) + x)..][..4];
                    let at = 3 * ((y + usize::from(frame.top)) * 40 + x + usize::from(frame.left));
                    if pixel[3] != 0 {
                        screen[at..at + 3].copy_from_slice(&pixel[..3]);
                    }
                }
            }
            let farthest = screen.iter().zip(pictures[shown].as_raw()).map(|(a, b)| a.abs_diff(*b)).max();
            assert!(farthest < Some(24), "picture {shown} is off by {farthest:?}");
            shown += 1;
        }
        assert_eq!(shown, pictures.len());
    }

    #[test]
    fn what_is_no_film_is_refused() {
        let pictures = pictures();
        assert!(matches!(encode_gif(&[], 20.0), Err(PictureError::Empty)));
        let odd = [pictures[0].clone(), RgbImage::new(41, 30)];
        let e = encode_gif(&odd, 20.0).expect_err("two sizes").to_string();
        assert!(e.contains("41"), "{e}");
        for rate in [0.0, 51.0, f32::NAN, f32::INFINITY] {
            assert!(encode_gif(&pictures, rate).is_err(), "{rate}");
        }
        assert!(encode_gif(&[RgbImage::new(0, 0)], 20.0).is_err());
        assert!(encode_gif(&[RgbImage::new(70_000, 1)], 20.0).is_err());
    }
}
