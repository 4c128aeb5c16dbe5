//! Arrays of NumPy's `.npz` files. A file that is cut off, swollen or not what it says ends in an error that names the file
//! and the array.

use std::fmt;
use std::fs::File;
use std::io::{BufReader, Read, Write};
use std::path::{Path, PathBuf};

use zip::ZipArchive;

/// Most bytes of one array once it is unpacked: a minute of a 65 x 65 mesh at 60 frames per second has 180 MB.
const MOST_BYTES: u64 = 256 << 20;

/// Longest header of an array: NumPy writes 118 bytes.
const LONGEST_HEADER: usize = 1024;

/// Why an array cannot be had.
#[derive(Debug)]
pub struct NpzError {
    /// The file.
    pub path: PathBuf,
    /// The array, where the file itself could be read.
    pub array: Option<String>,
    /// What is wrong.
    pub reason: String,
}

impl fmt::Display for NpzError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.path.display())?;
        if let Some(array) = &self.array {
            write!(f, ", array `{array}`")?;
        }
        write!(f, ": {}", self.reason)
    }
}

impl std::error::Error for NpzError {}

/// An array in row-major order.
#[derive(Clone, Debug, PartialEq)]
pub struct Array<T> {
    /// Length along each axis.
    pub shape: Vec<usize>,
    /// All numbers.
    pub values: Vec<T>,
}

/// An open file.
pub struct Npz {
    path: PathBuf,
    archive: ZipArchive<BufReader<File>>,
}

impl Npz {
    /// Opens a file. Error: it cannot be read or is no zip archive.
    pub fn open(path: &Path) -> Result<Npz, NpzError> {
        let wrong = |reason: String| NpzError { path: path.into(), array: None, reason };
        let file = File::open(path).map_err(|e| wrong(format!("cannot be read: {e}")))?;
        if file.metadata().is_ok_and(|m| m.is_dir()) {
            return Err(wrong("is a folder".into()));
        }
        let archive = ZipArchive::new(BufReader::new(file)).map_err(|e| wrong(format!("is no .npz file: {e}")))?;
        Ok(Npz { path: path.into(), archive })
    }

    /// The path that it was opened by.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Whether the file has an array of this name.
    pub fn has(&self, array: &str) -> bool {
        self.archive.file_names().any(|name| name.strip_suffix(".npy") == Some(array))
    }

    /// An error about an array of this file.
    pub fn wrong(&self, array: &str, reason: impl Into<String>) -> NpzError {
        NpzError { path: self.path.clone(), array: Some(array.into()), reason: reason.into() }
    }

    /// An array of float32 or float64, as float32. Errors: it is not there, is of another type, cut off, larger than
    /// 256 MiB, or has a number that is not finite.
    pub fn floats(&mut self, array: &str) -> Result<Array<f32>, NpzError> {
        let bytes = self.bytes(array)?;
        let all = Header::parse(&bytes).and_then(|h| match h.kind {
            "<f4" => h.numbers(f32::from_le_bytes),
            "<f8" => h.numbers(|b| f64::from_le_bytes(b) as f32),
            kind => Err(format!("float32 or float64 (<f4, <f8) expected, not {kind:?}")),
        });
        let all = all.map_err(|reason| self.wrong(array, reason))?;
        match all.values.iter().position(|x: &f32| !x.is_finite()) {
            Some(i) => Err(self.wrong(array, format!("number {i} is not finite"))),
            None => Ok(all),
        }
    }

    /// An array of uint8. Errors as [`Npz::floats`].
    pub fn levels(&mut self, array: &str) -> Result<Array<u8>, NpzError> {
        let bytes = self.bytes(array)?;
        let all = Header::parse(&bytes).and_then(|h| match h.kind {
            "|u1" => h.numbers(|[b]: [u8; 1]| b),
            kind => Err(format!("uint8 (|u1) expected, not {kind:?}")),
        });
        all.map_err(|reason| self.wrong(array, reason))
    }

    /// An array of int32 or int64 whose numbers are indices: 0 to 2^31 - 1. Errors as [`Npz::floats`].
    pub fn indices(&mut self, array: &str) -> Result<Array<usize>, NpzError> {
        let bytes = self.bytes(array)?;
        let all = Header::parse(&bytes).and_then(|h| match h.kind {
            "<i4" => h.numbers(|b| i64::from(i32::from_le_bytes(b))),
            "<i8" => h.numbers(i64::from_le_bytes),
            kind => Err(format!("int32 or int64 (<i4, <i8) expected, not {kind:?}")),
        });
        let all: Array<i64> = all.map_err(|reason| self.wrong(array, reason))?;
        let values = all.values.iter().map(|i| usize::try_from(i32::try_from(*i).ok()?).ok()).collect::<Option<_>>();
        match values {
            Some(values) => Ok(Array { shape: all.shape, values }),
            None => Err(self.wrong(array, "a number is no index")),
        }
    }

    /// The unpacked bytes of an array's file.
    fn bytes(&mut self, array: &str) -> Result<Vec<u8>, NpzError> {
        let path = self.path.clone();
        let wrong = |reason: String| NpzError { path: path.clone(), array: Some(array.into()), reason };
        let entry = self.archive.by_name(&format!("{array}.npy")).map_err(|e| match e {
            zip::result::ZipError::FileNotFound => wrong("is not there".into()),
            e => wrong(e.to_string()),
        })?;
        let mut bytes = Vec::new();
        entry.take(MOST_BYTES + 1).read_to_end(&mut bytes).map_err(|e| wrong(format!("cannot be unpacked: {e}")))?;
        if bytes.len() as u64 > MOST_BYTES {
            return Err(wrong(format!("is larger than {} MiB", MOST_BYTES >> 20)));
        }
        Ok(bytes)
    }
}

/// The header of a `.npy` file (NumPy's format, versions 1 to 3) and the numbers behind it.
struct Header<'b> {
    /// The type, such as `<f4`.
    kind: &'b str,
    shape: Vec<usize>,
    data: &'b [u8],
}

impl<'b> Header<'b> {
    /// Reads `{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3), }`.
    fn parse(bytes: &'b [u8]) -> Result<Header<'b>, String> {
        let (start, length) = match bytes {
            [0x93, b'N', b'U', b'M', b'P', b'Y', 1, _, a, b, ..] => (10, usize::from(u16::from_le_bytes([*a, *b]))),
            [0x93, b'N', b'U', b'M', b'P', b'Y', 2 | 3, _, a, b, c, d, ..] => {
                (12, u32::from_le_bytes([*a, *b, *c, *d]) as usize)
            }
            _ => return Err("is no .npy file".into()),
        };
        if length > LONGEST_HEADER {
            return Err(format!("its header has {length} bytes"));
        }
        let (Some(header), Some(data)) = (bytes.get(start..start + length), bytes.get(start + length..)) else {
            return Err("is cut off in its header".into());
        };
        let fields = std::str::from_utf8(header).ok().and_then(|text| {
            let after = |key: &str| text.split_once(key).map(|(_, rest)| rest.trim_start());
            let kind = after("'descr':")?.strip_prefix('\'')?.split_once('\'')?.0;
            let order = after("'fortran_order':")?.split([',', '}']).next()?.trim();
            let shape = after("'shape':")?.strip_prefix('(')?.split_once(')')?.0;
            Some((kind, order, shape))
        });
        let Some((kind, order, shape)) = fields else {
            return Err("its header cannot be read".into());
        };
        if order != "False" {
            return Err("is in Fortran's order".into());
        }
        let sides = shape.split(',').map(str::trim).filter(|s| !s.is_empty());
        let shape: Result<Vec<usize>, _> = sides.map(str::parse).collect();
        let shape = shape.map_err(|_| "its shape cannot be read".to_string())?;
        Ok(Header { kind, shape, data })
    }

    /// The numbers of N bytes each.
    fn numbers<const N: usize, T>(self, number: impl Fn([u8; N]) -> T) -> Result<Array<T>, String> {
        let count = self.shape.iter().try_fold(1usize, |n, &side| n.checked_mul(side));
        let Some(count) = count.filter(|n| n.checked_mul(N).is_some()) else {
            return Err("its shape is too large".into());
        };
        let (given, rest) = self.data.as_chunks::<N>();
        if given.len() < count {
            return Err(format!("is cut off: {} of {count} numbers", given.len()));
        }
        if given.len() > count || !rest.is_empty() {
            return Err(format!("has more than its {count} numbers"));
        }
        Ok(Array { shape: self.shape, values: given.iter().map(|b| number(*b)).collect() })
    }
}

/// Numbers to write.
#[derive(Clone, Copy, Debug)]
pub enum Numbers<'a> {
    /// As float32.
    Floats(&'a [f32]),
    /// As int32.
    Indices(&'a [i32]),
    /// As uint8.
    Levels(&'a [u8]),
}

/// Writes arrays by their names and shapes, compressed as NumPy's `savez_compressed` does. Errors: the file, a shape that
/// does not hold as many numbers as there are.
pub fn write(path: &Path, arrays: &[(&str, &[usize], Numbers<'_>)]) -> Result<(), NpzError> {
    let wrong =
        |array: Option<&str>, reason: String| NpzError { path: path.into(), array: array.map(Into::into), reason };
    let file = File::create(path).map_err(|e| wrong(None, format!("cannot be written: {e}")))?;
    let mut zip = zip::ZipWriter::new(file);
    let options = zip::write::FileOptions::default().compression_method(zip::CompressionMethod::Deflated);
    for (name, shape, numbers) in arrays {
        let (descr, count, data): (_, _, Vec<u8>) = match numbers {
            Numbers::Floats(all) => ("<f4", all.len(), all.iter().flat_map(|x| x.to_le_bytes()).collect()),
            Numbers::Indices(all) => ("<i4", all.len(), all.iter().flat_map(|x| x.to_le_bytes()).collect()),
            Numbers::Levels(all) => ("|u1", all.len(), all.to_vec()),
        };
        if shape.iter().product::<usize>() != count {
            return Err(wrong(Some(name), format!("has {count} numbers, which is not the shape {shape:?}")));
        }
        let axes: String = shape.iter().map(|n| format!("{n}, ")).collect();
        let bytes = npy(descr, &format!("({})", axes.trim_end()), &data);
        let put = zip.start_file(format!("{name}.npy"), options).map_err(|e| e.to_string());
        put.and_then(|()| zip.write_all(&bytes).map_err(|e| e.to_string())).map_err(|e| wrong(Some(name), e))?;
    }
    zip.finish().map(|_| ()).map_err(|e| wrong(None, e.to_string()))
}

/// The bytes of a `.npy` file of a type such as `<f4`.
pub(crate) fn npy(descr: &str, shape: &str, data: &[u8]) -> Vec<u8> {
    let mut header = format!("{{'descr': '{descr}', 'fortran_order': False, 'shape': {shape}, }}");
    while !(header.len() + 11).is_multiple_of(64) {
        header.push(' ');
    }
    header.push('\n');
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((header.len() as u16).to_le_bytes());
    bytes.extend(header.as_bytes());
    bytes.extend(data);
    bytes
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    pub(crate) use super::npy;

    /// Writes an archive of arrays, deflated as NumPy's `savez_compressed` does.
    pub fn write(path: &Path, arrays: &[(&str, Vec<u8>)]) {
        let mut zip = zip::ZipWriter::new(File::create(path).expect("made"));
        let options = zip::write::FileOptions::default().compression_method(zip::CompressionMethod::Deflated);
        for (name, bytes) in arrays {
            zip.start_file(format!("{name}.npy"), options).expect("started");
            zip.write_all(bytes).expect("written");
        }
        zip.finish().expect("finished");
    }

    /// float32 numbers as the bytes of an array.
    pub fn f4(shape: &str, values: &[f32]) -> Vec<u8> {
        npy("<f4", shape, &values.iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<u8>>())
    }

    /// int32 numbers as the bytes of an array.
    pub fn i4(shape: &str, values: &[i32]) -> Vec<u8> {
        npy("<i4", shape, &values.iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<u8>>())
    }

    #[test]
    fn what_is_written_comes_back() {
        let home = tempfile::tempdir().unwrap();
        let path = home.path().join("w.npz");
        let (x, i) = ([1.0, 2.0, 3.0, 4.0, 5.0, 6.5], [7, 0, 9]);
        let arrays: [(&str, &[usize], Numbers<'_>); 3] = [
            ("x", &[2, 3], Numbers::Floats(&x)),
            ("i", &[3], Numbers::Indices(&i)),
            ("l", &[2, 1], Numbers::Levels(&[0, 255])),
        ];
        super::write(&path, &arrays).unwrap();
        let mut npz = Npz::open(&path).unwrap();
        assert_eq!(npz.levels("l").unwrap(), Array { shape: vec![2, 1], values: vec![0, 255] });
        assert!(npz.levels("i").unwrap_err().to_string().contains("uint8 (|u1) expected"));
        assert_eq!(npz.floats("x").unwrap(), Array { shape: vec![2, 3], values: x.to_vec() });
        assert_eq!(npz.indices("i").unwrap(), Array { shape: vec![3], values: vec![7, 0, 9] });
        let e = super::write(&path, &[("x", &[2, 2], Numbers::Floats(&x))]).unwrap_err().to_string();
        assert!(e.contains("array `x`: has 6 numbers"), "{e}");
    }

    #[test]
    fn arrays_come_back() {
        let home = tempfile::tempdir().unwrap();
        let path = home.path().join("a.npz");
        let f8: Vec<u8> = [1.5f64, -2.0].iter().flat_map(|x| x.to_le_bytes()).collect();
        write(
            &path,
            &[
                ("x", f4("(2, 3)", &[1.0, 2.0, 3.0, 4.0, 5.0, 6.5])),
                ("y", npy("<f8", "(2,)", &f8)),
                ("i", i4("(1, 2)", &[7, 0])),
                ("j", i4("(2,)", &[7, -1])),
            ],
        );
        let mut npz = Npz::open(&path).unwrap();
        assert!(npz.has("x") && !npz.has("z"));
        let x = npz.floats("x").unwrap();
        assert_eq!((x.shape, x.values), (vec![2, 3], vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.5]));
        assert_eq!(npz.floats("y").unwrap().values, [1.5, -2.0]);
        assert_eq!(npz.indices("i").unwrap().values, [7, 0]);
        for (array, named) in [("z", "not there"), ("i", "float32 or float64")] {
            let e = npz.floats(array).unwrap_err().to_string();
            assert!(e.contains("a.npz") && e.contains(&format!("`{array}`")) && e.contains(named), "{e}");
        }
        assert!(npz.indices("j").unwrap_err().to_string().contains("no index"));
        assert!(npz.indices("x").unwrap_err().to_string().contains("int32 or int64"));
    }

    #[test]
    fn what_is_wrong_is_named() {
        let home = tempfile::tempdir().unwrap();
        let path = home.path().join("b.npz");
        let fails = |bytes: Vec<u8>, named: &str| {
            write(&path, &[("x", bytes)]);
            let e = Npz::open(&path).unwrap().floats("x").unwrap_err().to_string();
            assert!(e.contains("b.npz") && e.contains("`x`") && e.contains(named), "{e}");
        };
        fails(f4("(2, 3)", &[1.0; 5]), "cut off: 5 of 6 numbers");
        fails(f4("(2, 3)", &[1.0; 7]), "more than its 6 numbers");
        fails(f4("(2, x)", &[1.0; 7]), "shape cannot be read");
        fails(f4("(-2,)", &[1.0; 7]), "shape cannot be read");
        fails(npy(">f4", "(1,)", &[0; 4]), "float32 or float64 (<f4, <f8) expected");
        fails(f4("(1000000, 1000000, 1000000, 100)", &[1.0; 5]), "too large");
        fails(f4("(100000000, 1000)", &[1.0; 5]), "cut off");
        fails(f4("(2,)", &[1.0, f32::NAN]), "number 1 is not finite");
        fails(b"\x93NUMPY".to_vec(), "no .npy");
        fails(b"hello".to_vec(), "no .npy");
        fails(b"\x93NUMPY\x02\x00\xff\xff\xff\xff{".to_vec(), "header");
        fails(npy("<f4", &"(".repeat(900), &[]), "header");
        let folder = Npz::open(home.path()).err().unwrap().to_string();
        assert!(folder.contains("folder"), "{folder}");
        assert!(Npz::open(&home.path().join("no")).err().unwrap().to_string().contains("cannot be read"));
    }

    #[test]
    fn a_file_that_is_cut_or_spoilt_anywhere_is_an_error_or_itself() {
        let home = tempfile::tempdir().unwrap();
        let path = home.path().join("c.npz");
        let values: Vec<f32> = (0..60).map(|i| i as f32).collect();
        write(&path, &[("x", f4("(60,)", &values))]);
        let whole = std::fs::read(&path).unwrap();
        let read = |bytes: &[u8]| {
            std::fs::write(&path, bytes).unwrap();
            Npz::open(&path).and_then(|mut npz| npz.floats("x"))
        };
        assert_eq!(read(&whole).unwrap().values, values);
        for cut in 0..whole.len() {
            assert!(read(&whole[..cut]).is_err(), "cut at {cut}");
        }
        for i in 0..whole.len() {
            let mut spoilt = whole.clone();
            spoilt[i] ^= 0x55;
            // a bit of a date or a version is nobody's business; numbers are guarded by the checksum
            if let Ok(x) = read(&spoilt) {
                assert_eq!(x.values, values, "byte {i}");
            }
        }
    }
}
