use std::fs;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::TrainError;

/// Where a run stands; the weights and the optimisers' states lie beside it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Checkpoint {
    /// Steps done.
    pub step: usize,
    /// Best score of the evaluation set so far and its step.
    pub best: Option<(f64, usize)>,
    /// Digest of the configuration that it belongs to.
    pub digest: String,
}

const STATE: &str = "state.json";

impl Checkpoint {
    /// The folder of a run's checkpoint.
    pub fn folder(run: &Path) -> PathBuf {
        run.join("checkpoint")
    }

    /// Reads the checkpoint of a run, if it has one. A checkpoint whose writing was cut short is made whole or dropped.
    pub fn read(run: &Path) -> Result<Option<Checkpoint>, TrainError> {
        let (folder, old) = (Checkpoint::folder(run), run.join("checkpoint.old"));
        if !folder.join(STATE).exists() && old.join(STATE).exists() {
            fs::rename(&old, &folder).map_err(|e| TrainError::file(&old, e))?;
        }
        let path = folder.join(STATE);
        if !path.exists() {
            return Ok(None);
        }
        let text = fs::read_to_string(&path).map_err(|e| TrainError::file(&path, e))?;
        serde_json::from_str(&text).map(Some).map_err(|e| TrainError::file(&path, e))
    }

    /// Writes a checkpoint: `weights` fills a new folder, which then takes the place of the former one.
    pub fn write(&self, run: &Path, weights: impl FnOnce(&Path) -> Result<(), TrainError>) -> Result<(), TrainError> {
        let (folder, new, old) = (Checkpoint::folder(run), run.join("checkpoint.new"), run.join("checkpoint.old"));
        let clear =
            |p: &Path| if p.exists() { fs::remove_dir_all(p).map_err(|e| TrainError::file(p, e)) } else { Ok(()) };
        clear(&new)?;
        fs::create_dir_all(&new).map_err(|e| TrainError::file(&new, e))?;
        weights(&new)?;
        let text = serde_json::to_string_pretty(self).map_err(TrainError::part)?;
        fs::write(new.join(STATE), text).map_err(|e| TrainError::file(&new, e))?;
        clear(&old)?;
        if folder.exists() {
            fs::rename(&folder, &old).map_err(|e| TrainError::file(&folder, e))?;
        }
        fs::rename(&new, &folder).map_err(|e| TrainError::file(&new, e))?;
        clear(&old)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_interrupted_write_loses_nothing() {
        let run = tempfile::tempdir().unwrap();
        assert_eq!(Checkpoint::read(run.path()).unwrap(), None);
        let c = Checkpoint { step: 5, best: Some((0.1, 4)), digest: "ab".into() };
        c.write(run.path(), |p| fs::write(p.join("w"), "5").map_err(|e| TrainError::file(p, e))).unwrap();
        assert_eq!(Checkpoint::read(run.path()).unwrap(), Some(c.clone()));
        // cut short while the new one is filled
        let cut = Checkpoint { step: 6, ..c.clone() }.write(run.path(), |_| Err(TrainError::Part("cut".into())));
        assert!(cut.is_err());
        assert_eq!(Checkpoint::read(run.path()).unwrap(), Some(c.clone()));
        // cut short between the two renames
        fs::rename(Checkpoint::folder(run.path()), run.path().join("checkpoint.old")).unwrap();
        assert_eq!(Checkpoint::read(run.path()).unwrap(), Some(c));
        assert_eq!(fs::read_to_string(Checkpoint::folder(run.path()).join("w")).unwrap(), "5");
    }
}
