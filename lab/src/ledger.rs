//! Rows of a long measurement, kept as they come: an interrupted run goes on where it stopped.

use std::collections::BTreeMap;
use std::fs::{File, OpenOptions};
use std::io::{self, BufRead, BufReader, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

/// Why a ledger cannot be used.
#[derive(Debug)]
pub enum LedgerError {
    /// The file cannot be read or written.
    Io(PathBuf, io::Error),
    /// The file holds rows of another measurement.
    Foreign(PathBuf),
    /// A row other than the last one is not readable.
    Corrupt(PathBuf, usize),
}

impl std::fmt::Display for LedgerError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            LedgerError::Io(path, e) => write!(f, "cannot use {}: {e}", path.display()),
            LedgerError::Foreign(path) => {
                write!(f, "{} holds rows of another measurement: move it away or choose another folder", path.display())
            }
            LedgerError::Corrupt(path, line) => write!(f, "{}, line {line}: not a row", path.display()),
        }
    }
}

impl std::error::Error for LedgerError {}

#[derive(Serialize, Deserialize)]
struct Entry<R> {
    key: String,
    row: R,
}

/// A file of one JSON value a line: what is measured (the header), then rows with their keys.
pub struct Ledger<R> {
    path: PathBuf,
    file: File,
    rows: BTreeMap<String, R>,
}

impl<R: Serialize + DeserializeOwned> Ledger<R> {
    /// Opens a ledger or makes one. The rows of an earlier run with the same header are there; a last line that was cut off
    /// is dropped.
    ///
    /// Errors: [`LedgerError`]; a file of another header is left as it is.
    pub fn open(path: &Path, header: &impl Serialize) -> Result<Ledger<R>, LedgerError> {
        let io = |e| LedgerError::Io(path.into(), e);
        let header = serde_json::to_string(header).map_err(|e| io(e.into()))? + "\n";
        let mut file = OpenOptions::new().read(true).write(true).create(true).truncate(false).open(path).map_err(io)?;
        let mut rows = BTreeMap::new();
        let (mut good, mut number) = (0, 0);
        let mut reader = BufReader::new(&file);
        let mut line = Vec::new();
        loop {
            line.clear();
            let read = reader.read_until(b'\n', &mut line).map_err(io)?;
            // a line without its end was cut off, the header included
            if read == 0 || line.last() != Some(&b'\n') {
                if number == 0 && !header.as_bytes().starts_with(&line) {
                    return Err(LedgerError::Foreign(path.into()));
                }
                break;
            }
            number += 1;
            if number == 1 {
                if line != header.as_bytes() {
                    return Err(LedgerError::Foreign(path.into()));
                }
            } else {
                let entry: Entry<R> =
                    serde_json::from_slice(&line).map_err(|_| LedgerError::Corrupt(path.into(), number))?;
                rows.insert(entry.key, entry.row);
            }
            good += read as u64;
        }
        drop(reader);
        file.set_len(good).map_err(io)?;
        file.seek(SeekFrom::End(0)).map_err(io)?;
        if good == 0 {
            file.write_all(header.as_bytes()).map_err(io)?;
        }
        Ok(Ledger { path: path.into(), file, rows })
    }

    /// The row of a key, if it was measured.
    pub fn get(&self, key: &str) -> Option<&R> {
        self.rows.get(key)
    }

    /// How many rows there are.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Whether there is no row.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// Writes a row down.
    pub fn add(&mut self, key: &str, row: R) -> Result<(), LedgerError> {
        let io = |e| LedgerError::Io(self.path.clone(), e);
        let entry = Entry { key: key.to_string(), row };
        let line = serde_json::to_string(&entry).map_err(|e| io(e.into()))? + "\n";
        self.file.write_all(line.as_bytes()).and_then(|()| self.file.flush()).map_err(io)?;
        self.rows.insert(entry.key, entry.row);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_outlive_the_run() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("rows.jsonl");
        let mut ledger: Ledger<f64> = Ledger::open(&path, &"front 1").unwrap();
        assert!(ledger.is_empty());
        ledger.add("a", 1.5).unwrap();
        ledger.add("b", 2.5).unwrap();
        drop(ledger);
        let whole = std::fs::read(&path).unwrap();

        // cut anywhere: whole rows stay, and what is added afterwards is readable
        for cut in 0..whole.len() {
            std::fs::write(&path, &whole[..cut]).unwrap();
            let mut ledger: Ledger<f64> = Ledger::open(&path, &"front 1").unwrap();
            assert!(ledger.len() <= 2 && ledger.get("a").is_none_or(|a| *a == 1.5));
            ledger.add("c", 3.5).unwrap();
            drop(ledger);
            let again: Ledger<f64> = Ledger::open(&path, &"front 1").unwrap();
            assert_eq!(again.get("c"), Some(&3.5), "cut at {cut}");
        }

        std::fs::write(&path, &whole).unwrap();
        assert!(matches!(Ledger::<f64>::open(&path, &"front 2"), Err(LedgerError::Foreign(_))));
        std::fs::write(&path, "something else").unwrap();
        assert!(matches!(Ledger::<f64>::open(&path, &"front 1"), Err(LedgerError::Foreign(_))));
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "something else");
        std::fs::write(&path, [&whole[..10], b"{}\n{\"key\":\"d\",\"row\":1}\n"].concat()).unwrap();
        assert!(matches!(Ledger::<f64>::open(&path, &"front 1"), Err(LedgerError::Corrupt(_, 2))));
    }
}
