//! The pictures of one real fabric in a folder: `sample-SS-capture-C.png`, several pictures of each of several samples.

use std::collections::BTreeMap;
use std::path::Path;

use super::silhouette::{Silhouette, SilhouetteError};

/// Most pictures of a folder.
const MOST: usize = 10_000;

/// All pictures of a folder by their sample, whose name is that of the file up to `-capture`.
#[derive(Clone, Debug)]
pub struct Photos {
    /// Samples in the order of their names.
    pub samples: BTreeMap<String, Vec<Silhouette>>,
}

impl Photos {
    /// Reads every file of a folder whose name ends in `.png`. Errors: no folder, no picture in it, one that cannot be used.
    pub fn load(folder: &Path) -> Result<Photos, SilhouetteError> {
        let wrong = |reason: String| SilhouetteError { path: folder.into(), reason };
        let entries = std::fs::read_dir(folder).map_err(|e| wrong(format!("cannot be read: {e}")))?;
        let mut samples: BTreeMap<String, Vec<Silhouette>> = BTreeMap::new();
        let mut paths = Vec::new();
        for entry in entries {
            let path = entry.map_err(|e| wrong(format!("cannot be read: {e}")))?.path();
            if path.extension().is_some_and(|e| e == "png") {
                paths.push(path);
            }
        }
        if paths.is_empty() || paths.len() > MOST {
            return Err(wrong(format!("has {} pictures (*.png), not 1 to {MOST}", paths.len())));
        }
        paths.sort();
        for path in paths {
            let stem = path.file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default();
            let sample = stem.split("-capture").next().unwrap_or(&stem).to_string();
            samples.entry(sample).or_default().push(Silhouette::load(&path)?);
        }
        Ok(Photos { samples })
    }

    /// All pictures.
    pub fn all(&self) -> impl Iterator<Item = &Silhouette> {
        self.samples.values().flatten()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_are_grouped_by_sample() {
        let home = tempfile::tempdir().unwrap();
        let none = Photos::load(home.path()).unwrap_err().to_string();
        assert!(none.contains("has 0 pictures"), "{none}");
        let mut pixels = vec![0u8; 65536];
        pixels[1000..9000].fill(255);
        for name in ["sample-02-capture-1", "sample-01-capture-2", "sample-01-capture-1", "other"] {
            image::save_buffer(home.path().join(format!("{name}.png")), &pixels, 256, 256, image::ColorType::L8)
                .unwrap();
        }
        std::fs::write(home.path().join("sample-01-capture-1.vertices.npy"), "x").unwrap();
        let photos = Photos::load(home.path()).unwrap();
        let sizes: Vec<(&str, usize)> = photos.samples.iter().map(|(k, v)| (k.as_str(), v.len())).collect();
        assert_eq!(sizes, [("other", 1), ("sample-01", 2), ("sample-02", 1)]);
        assert_eq!(photos.all().count(), 4);
        std::fs::write(home.path().join("bad.png"), "no picture").unwrap();
        assert!(Photos::load(home.path()).unwrap_err().to_string().contains("bad.png"));
        assert!(Photos::load(&home.path().join("no")).unwrap_err().to_string().contains("cannot be read"));
    }
}
