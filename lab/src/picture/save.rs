//! PNG files that are there whole or not at all.

use std::ffi::OsString;
use std::fs;
use std::path::Path;
use std::sync::atomic::{AtomicU32, Ordering};

use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder, RgbImage};

use super::error::PictureError;

/// Tells apart the temporary files of one process.
static SERIAL: AtomicU32 = AtomicU32::new(0);

/// Encodes a picture as PNG.
///
/// # Errors
/// [`PictureError::Encode`] when the encoder refuses it (a picture without pixels).
pub fn encode_png(image: &RgbImage) -> Result<Vec<u8>, PictureError> {
    let mut bytes = Vec::new();
    PngEncoder::new_with_quality(&mut bytes, CompressionType::Default, FilterType::Adaptive)
        .write_image(image.as_raw(), image.width(), image.height(), ExtendedColorType::Rgb8)
        .map_err(|error| PictureError::Encode { reason: error.to_string() })?;
    Ok(bytes)
}

/// Writes a picture as PNG: first to a temporary file beside it, then renamed, so that no half file is ever seen.
///
/// # Errors
/// [`PictureError::Write`] names the path when the folder is missing or cannot be written; a file that was there stays.
pub fn save_png(image: &RgbImage, path: &Path) -> Result<(), PictureError> {
    let bytes = encode_png(image)?;
    let failed = |source| PictureError::Write { path: path.to_owned(), source };
    let Some(name) = path.file_name() else {
        return Err(failed(std::io::Error::new(std::io::ErrorKind::InvalidInput, "not a file name")));
    };
    let mut temporary_name = OsString::from(".");
    temporary_name.push(name);
    temporary_name.push(format!(".{}.{}.part", std::process::id(), SERIAL.fetch_add(1, Ordering::Relaxed)));
    let temporary = path.with_file_name(temporary_name);
    fs::write(&temporary, bytes).and_then(|()| fs::rename(&temporary, path)).map_err(|error| {
        // Best effort: the error to report is the first one.
        let _ = fs::remove_file(&temporary);
        failed(error)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn writes_whole_files_and_nothing_else() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("a.png");
        let image = RgbImage::from_pixel(3, 2, image::Rgb([10, 20, 30]));
        save_png(&image, &path).expect("written");
        save_png(&image, &path).expect("written again");
        assert_eq!(image::open(&path).expect("a PNG").to_rgb8(), image);
        assert_eq!(fs::read_dir(folder.path()).expect("listed").count(), 1);
    }

    #[test]
    fn errors_name_the_path_and_leave_nothing() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let image = RgbImage::new(2, 2);
        let missing = folder.path().join("missing").join("a.png");
        let error = save_png(&image, &missing).expect_err("no such folder").to_string();
        assert!(error.contains("missing") && !error.contains('\n'), "{error}");
        let taken = folder.path().join("taken.png");
        fs::create_dir(&taken).expect("made");
        fs::write(taken.join("x"), b"x").expect("filled");
        assert!(save_png(&image, &taken).is_err());
        assert!(save_png(&image, Path::new("..")).is_err());
        assert_eq!(fs::read_dir(folder.path()).expect("listed").count(), 1, "only the folder that was in the way");
    }
}
