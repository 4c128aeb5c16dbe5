//! Files that are there whole or not at all, also when the program is interrupted.

use std::fs::{self, OpenOptions};
use std::io::{self, IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::failure::{self, Failure, complain};

/// Folders that this run has made and not yet filled, the deepest first. Whoever writes holds the lock, so that an
/// interrupt waits until all files of a result are in place.
static UNFILLED: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// Exit code after Ctrl-C, as shells expect it.
const INTERRUPTED: i32 = 130;

fn unfilled() -> MutexGuard<'static, Vec<PathBuf>> {
    // the list is whole at any time, so a panic of another holder does not spoil it
    UNFILLED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Removes the folders that are still empty.
fn remove_unfilled(folders: &mut Vec<PathBuf>) {
    for folder in folders.drain(..) {
        // fails where something is in it by now, which then is not ours
        let _ = fs::remove_dir(folder);
    }
}

/// From now on Ctrl-C ends the program between two writes and leaves nothing half written.
pub fn clean_up_on_interrupt() {
    // Without a handler the system ends the program, which is no worse before the first write.
    let _ = ctrlc::set_handler(|| {
        let mut folders = unfilled();
        remove_unfilled(&mut folders);
        if io::stderr().is_terminal() {
            // the progress bar stands in this line
            failure::print_aside("\n");
        }
        complain("interrupted");
        std::process::exit(INTERRUPTED);
    });
}

fn cannot_write(path: &Path, e: &io::Error) -> Failure {
    Failure::new(format_args!("cannot write {}: {e}", path.display()))
}

/// The temporary neighbour of a file.
fn temporary(path: &Path) -> PathBuf {
    let mut name = std::ffi::OsString::from(".");
    name.push(path.file_name().unwrap_or_default());
    name.push(format!(".{}.part", std::process::id()));
    path.with_file_name(name)
}

/// Writes files whole or not at all: all of them beside their places first, then each is renamed into its place.
fn write_all(files: &[(PathBuf, &[u8])]) -> Result<(), Failure> {
    let mut done = Ok(());
    for (path, bytes) in files {
        let new = OpenOptions::new().write(true).create(true).truncate(true).open(temporary(path));
        let written = new.and_then(|mut f| f.write_all(bytes));
        if let Err(e) = written {
            done = Err(cannot_write(path, &e));
            break;
        }
    }
    for (path, _) in files.iter().filter(|_| done.is_ok()) {
        if let Err(e) = fs::rename(temporary(path), path) {
            done = Err(cannot_write(path, &e));
            break;
        }
    }
    if done.is_err() {
        for (path, _) in files {
            let _ = fs::remove_file(temporary(path));
        }
    }
    done
}

/// Writes one file, whole or not at all.
pub fn write(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    check_name(path)?;
    let _writing = unfilled();
    write_all(&[(path.into(), bytes)])
}

fn check_name(path: &Path) -> Result<(), Failure> {
    if path.file_name().is_none() {
        return Err(Failure::new(format_args!("cannot write {}: not a file name", path.display())));
    }
    if path.is_dir() {
        return Err(Failure::new(format_args!("cannot write {}: it is a folder", path.display())));
    }
    Ok(())
}

/// A folder for results. One that this run made and never filled goes away with this value.
#[derive(Debug)]
pub struct Folder {
    path: PathBuf,
    files: Vec<String>,
}

impl Folder {
    /// Makes the folder if it is not there, and checks that the files of these names can be written into it. Call it
    /// before the work whose result it is for.
    pub fn open(path: &Path, files: &[impl AsRef<str>]) -> Result<Folder, Failure> {
        let mut made = unfilled();
        let missing = |p: &&Path| !p.as_os_str().is_empty() && !p.exists();
        let new: Vec<PathBuf> = path.ancestors().take_while(missing).map(Path::to_path_buf).collect();
        let folder = Folder { path: path.into(), files: files.iter().map(|f| f.as_ref().to_string()).collect() };
        let created = fs::create_dir_all(path);
        made.extend(new);
        drop(made);
        created.map_err(|e| cannot_write(path, &e))?;
        for file in &folder.files {
            check_name(&path.join(file))?;
        }
        let probe = temporary(&path.join("probe"));
        let probed = OpenOptions::new().write(true).create(true).truncate(true).open(&probe);
        probed.map_err(|e| cannot_write(path, &e))?;
        fs::remove_file(&probe).map_err(|e| cannot_write(path, &e))?;
        Ok(folder)
    }

    /// Writes all files of the folder, in the order of their names in [`Folder::open`], and returns their paths.
    pub fn fill(&self, contents: &[&[u8]]) -> Result<Vec<PathBuf>, Failure> {
        let mut made = unfilled();
        let paths: Vec<PathBuf> = self.files.iter().map(|f| self.path.join(f)).collect();
        let files: Vec<(PathBuf, &[u8])> = paths.iter().cloned().zip(contents.iter().copied()).collect();
        write_all(&files)?;
        made.clear();
        Ok(paths)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        remove_unfilled(&mut unfilled());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    // One test, as the list of folders is the program's.
    #[test]
    fn results_are_whole_or_not_there() {
        let home = tempfile::tempdir().expect("a temporary folder");
        let entries = |p: &Path| fs::read_dir(p).expect("listed").count();

        // made, not filled, gone
        let deep = home.path().join("a/b/c");
        let folder = Folder::open(&deep, &["x", "y"]).expect("made");
        assert_eq!(entries(&deep), 0, "the probe is gone");
        drop(folder);
        assert_eq!(entries(home.path()), 0);

        // filled, and filled again
        for text in ["first", "second"] {
            let folder = Folder::open(&deep, &["x", "y"]).expect("made");
            let paths = folder.fill(&[text.as_bytes(), b"2"]).expect("filled");
            assert_eq!(paths, [deep.join("x"), deep.join("y")]);
            drop(folder);
            assert_eq!(fs::read_to_string(deep.join("x")).expect("read"), text);
            assert_eq!(entries(&deep), 2);
        }

        // a file in the way, of the folder or of a result
        let file = deep.join("x");
        for bad in [file.clone(), file.join("z")] {
            let e = Folder::open(&bad, &["x"]).expect_err("a file is in the way");
            assert!(matches!(e, Failure::User(t) if t.starts_with("cannot write")));
        }
        fs::create_dir(deep.join("taken")).expect("made");
        assert!(Folder::open(&deep, &["taken"]).is_err());
        assert!(write(&deep, b"1").is_err() && write(Path::new(".."), b"1").is_err());
        assert!(write(&deep.join("no/such"), b"1").is_err());
        write(&deep.join("one"), b"1").expect("written");
        assert_eq!(entries(&deep), 4, "x, y, taken, one and no leftovers");
    }
}
