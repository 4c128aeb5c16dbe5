//! Sheets of pictures: real and generated side by side, in one grey PNG.

use std::path::Path;

use super::{ImageError, PIXELS, SIDE, expect_len};

/// How a sheet is laid out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SheetLayout {
    /// Channels of each picture, shown side by side; 1 to 16.
    pub channels: usize,
    /// Pairs in each row of the sheet; 1 to 64.
    pub pairs_per_row: usize,
    /// Pixels of the sheet per pixel of a picture; 1 to 8.
    pub zoom: usize,
}

/// Pixels (before the zoom) between the channels of a picture, between the real and the generated, between pairs.
const GAPS: [usize; 3] = [1, 3, 8];
/// Grey of the gaps.
const PAPER: u8 = 255;

/// Writes a sheet: each pair is a real picture and, right of it, the generated one, in rows from the top left.
///
/// `real` and `generated` hold the same number (1 or more) of pictures `[channel][row][column]` in `[-1, 1]`.
///
/// # Errors
/// [`ImageError::Setting`] and [`ImageError::Size`] for the arguments, [`ImageError::File`] when `path` cannot be written.
pub fn write_sheet(path: &Path, real: &[f32], generated: &[f32], layout: SheetLayout) -> Result<(), ImageError> {
    let (grey, width, height) = sheet(real, generated, layout)?;
    ::image::save_buffer_with_format(
        path,
        &grey,
        width as u32,
        height as u32,
        ::image::ExtendedColorType::L8,
        ::image::ImageFormat::Png,
    )
    .map_err(|error| ImageError::File { path: path.display().to_string(), reason: error.to_string() })
}

/// The sheet as grey pixels, with its width and height.
fn sheet(real: &[f32], generated: &[f32], layout: SheetLayout) -> Result<(Vec<u8>, usize, usize), ImageError> {
    let SheetLayout { channels, pairs_per_row, zoom } = layout;
    let rules: [(bool, &str, &str); 3] = [
        ((1..=16).contains(&channels), "channels", "1 to 16"),
        ((1..=64).contains(&pairs_per_row), "pairs_per_row", "1 to 64"),
        ((1..=8).contains(&zoom), "zoom", "1 to 8"),
    ];
    if let Some((_, name, allowed)) = rules.into_iter().find(|(good, ..)| !good) {
        return Err(ImageError::Setting { name, allowed });
    }
    let pairs = real.len().div_ceil(channels * PIXELS).max(1);
    expect_len("real pictures", pairs * channels * PIXELS, real.len())?;
    expect_len("generated pictures", real.len(), generated.len())?;

    let [between_channels, between_kinds, between_pairs] = GAPS;
    let picture_width = channels * SIDE + (channels - 1) * between_channels;
    let pair_width = 2 * picture_width + between_kinds;
    let across = pairs_per_row.min(pairs);
    let down = pairs.div_ceil(across);
    let width = across * (pair_width + between_pairs) + between_pairs;
    let height = down * (SIDE + between_pairs) + between_pairs;
    let mut grey = vec![PAPER; width * zoom * height * zoom];
    for (kind, pictures) in [real, generated].into_iter().enumerate() {
        for (n, plane) in pictures.chunks_exact(PIXELS).enumerate() {
            let (pair, channel) = (n / channels, n % channels);
            let left = between_pairs
                + pair % across * (pair_width + between_pairs)
                + kind * (picture_width + between_kinds)
                + channel * (SIDE + between_channels);
            let top = between_pairs + pair / across * (SIDE + between_pairs);
            for row in 0..SIDE * zoom {
                let start = (top * zoom + row) * width * zoom + left * zoom;
                let values = &plane[row / zoom * SIDE..][..SIDE];
                for (pixels, value) in grey[start..start + SIDE * zoom].chunks_exact_mut(zoom).zip(values) {
                    pixels.fill(shade(*value));
                }
            }
        }
    }
    Ok((grey, width * zoom, height * zoom))
}

/// `[-1, 1]` to `[0, 255]`; what is not finite is black.
fn shade(value: f32) -> u8 {
    // the cast saturates, and takes what is not a number to 0
    ((value + 1.0) * 127.5).round() as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    const LAYOUT: SheetLayout = SheetLayout { channels: 2, pairs_per_row: 2, zoom: 2 };

    fn pictures(values: [f32; 6]) -> Vec<f32> {
        values.iter().flat_map(|v| [*v; PIXELS]).collect()
    }

    #[test]
    fn every_channel_lands_in_its_place_and_survives_the_file() {
        let real = pictures([-1.0, -0.8, -0.6, -0.4, -0.2, 0.0]);
        let generated = pictures([0.2, 0.4, 0.6, 0.8, 1.0, 0.1]);
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("sheet.png");
        write_sheet(&path, &real, &generated, LAYOUT).unwrap();
        let read = ::image::open(&path).unwrap().into_luma8();
        // pair: 2 * (64 + 1 + 64) + 3 = 261; two across: 2 * (261 + 8) + 8 = 546; two down: 2 * 72 + 8 = 152
        assert_eq!(read.dimensions(), (1092, 304));
        let at = |x: u32, y: u32| read.get_pixel(2 * (x + 32), 2 * (y + 32)).0[0];
        let grey = |v: f32| ((v + 1.0) * 127.5).round() as u8;
        assert_eq!([at(8, 8), at(73, 8), at(140, 8), at(205, 8)], [-1.0, -0.8, 0.2, 0.4].map(grey));
        assert_eq!([at(277, 8), at(342, 8), at(409, 8), at(474, 8)], [-0.6, -0.4, 0.6, 0.8].map(grey));
        assert_eq!([at(8, 80), at(73, 80), at(140, 80), at(205, 80)], [-0.2, 0.0, 1.0, 0.1].map(grey));
        assert_eq!(at(277, 80), PAPER);
    }

    #[test]
    fn mistakes_are_named() {
        let ok = pictures([0.0; 6]);
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("sheet.png");
        let size = write_sheet(&path, &ok, &ok[PIXELS..], LAYOUT);
        assert!(matches!(size, Err(ImageError::Size { name: "generated pictures", .. })));
        let zoom = write_sheet(&path, &ok, &ok, SheetLayout { zoom: 0, ..LAYOUT });
        assert!(matches!(zoom, Err(ImageError::Setting { name: "zoom", .. })));
        assert!(matches!(write_sheet(&path, &[], &[], LAYOUT), Err(ImageError::Size { .. })));
        assert!(!path.exists());
        let missing = folder.path().join("no-such-folder").join("sheet.png");
        let message = write_sheet(&missing, &ok, &ok, LAYOUT).unwrap_err().to_string();
        assert!(message.contains("no-such-folder"), "{message}");
    }
}
