//! The baked field file: what the generator said about a fabric on a grid, small, exact, and loaded from bytes.
//!
//! Little-endian:
//!
//! | bytes | content |
//! |---|---|
//! | 0..8 | `TAUTFELD` |
//! | 8..12, 12..16 | version 1, number of bytes of the whole file |
//! | 16..20, 20..24 | rows, columns |
//! | 24..28 | density in kg/m^2, f32 |
//! | 28..32 | hinge rigidity in N m, f32 |
//! | 32..44 | stretch limits warp, weft, diagonal, f32 |
//! | 44..48 | 0 |
//! | 48..56 | seed |
//! | 56..64 | hash of the description's UTF-8 bytes |
//! | then | stiffness field in N/m, f32 `[4][rows][columns]`: warp, weft, shear, bend |
//! | last 8 | hash of all bytes before |
//!
//! The field is the one before the budget, so one file serves every step and every pin.

use crate::field::FieldView;
use crate::snapshot::{u32_at, u64_at};
use crate::{Cloth, Error, Grid, Hash64, in_default_environment};

const MAGIC: &[u8; 8] = b"TAUTFELD";
const VERSION: u32 = 1;
const HEADER: usize = 64;

/// What words tell about a fabric beside its stiffness field.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Fabric {
    /// Mass per area in kg/m^2.
    pub density_kg_m2: f32,
    /// Bending rigidity of a hinge in N m.
    pub hinge_rigidity_n_m: f32,
    /// Largest stretch of the fabric in use as a fraction: warp, weft, diagonal. To be limits ([`crate::Features::LEVELS`]) where the
    /// budget takes more than three quarters of the field ([`crate::BudgetReport::cut_fraction`]); below, a field stretches like
    /// its fabric by itself, and limits hold it too tight (docs/evaluation.md).
    pub stretch_limits: [f32; 3],
}

/// A baked field file that was checked.
#[derive(Clone, Copy, Debug)]
pub struct Baked<'a> {
    /// Rows of the field.
    pub rows: usize,
    /// Columns of the field.
    pub columns: usize,
    /// What the words told beside the field.
    pub fabric: Fabric,
    /// The seed it was generated with.
    pub seed: u64,
    /// Hash of the description it was generated from.
    pub description_hash: u64,
    numbers: &'a [[u8; 4]],
}

/// Bytes of a file for a rows x columns grid. Error: [`Error::GridSize`].
pub fn size(rows: usize, columns: usize) -> Result<usize, Error> {
    let side = |n: usize| (2..=Grid::MAX_SIDE as usize).contains(&n);
    if !side(rows) || !side(columns) {
        return Err(Error::GridSize);
    }
    Ok(HEADER + 16 * rows * columns + 8)
}

/// Writes a file into `out` and returns its size in bytes.
///
/// `field` is `[4][rows][columns]` in N/m. Errors: [`Error::GridSize`], [`Error::Shape`], [`Error::NotFinite`],
/// [`Error::Negative`], [`Error::BlockTooSmall`]; then nothing is written.
pub fn write(
    rows: usize,
    columns: usize,
    field: &[f32],
    fabric: &Fabric,
    seed: u64,
    description: &str,
    out: &mut [u8],
) -> Result<usize, Error> {
    let size = size(rows, columns)?;
    FieldView::new(4, rows, columns, field)?;
    check_fabric(fabric)?;
    let out = out.get_mut(..size).ok_or(Error::BlockTooSmall)?;
    let mut d = Hash64::new();
    d.bytes(description.as_bytes());
    let [warp, weft, diagonal] = fabric.stretch_limits;
    let words: [u32; 12] = [
        u32::from_le_bytes([MAGIC[0], MAGIC[1], MAGIC[2], MAGIC[3]]),
        u32::from_le_bytes([MAGIC[4], MAGIC[5], MAGIC[6], MAGIC[7]]),
        VERSION,
        size as u32,
        rows as u32,
        columns as u32,
        fabric.density_kg_m2.to_bits(),
        fabric.hinge_rigidity_n_m.to_bits(),
        warp.to_bits(),
        weft.to_bits(),
        diagonal.to_bits(),
        0,
    ];
    let (seeds, hash) = (seed.to_le_bytes(), d.finish().to_le_bytes());
    let bytes = words
        .iter()
        .flat_map(|w| w.to_le_bytes())
        .chain(seeds)
        .chain(hash)
        .chain(field.iter().flat_map(|k| k.to_le_bytes()));
    let (body, tail) = out.split_at_mut_checked(size - 8).ok_or(Error::BlockTooSmall)?;
    for (to, from) in body.iter_mut().zip(bytes) {
        *to = from;
    }
    let mut h = Hash64::new();
    h.bytes(body);
    tail.copy_from_slice(&h.finish().to_le_bytes());
    Ok(size)
}

fn check_fabric(f: &Fabric) -> Result<(), Error> {
    let all = [f.density_kg_m2, f.hinge_rigidity_n_m].into_iter().chain(f.stretch_limits);
    for x in all {
        if !x.is_finite() {
            return Err(Error::NotFinite);
        }
        if x < 0.0 {
            return Err(Error::Negative);
        }
    }
    Ok(())
}

impl<'a> Baked<'a> {
    /// Checks a file whole.
    ///
    /// Errors: [`Error::Truncated`], [`Error::WrongKind`], [`Error::UnsupportedVersion`], [`Error::GridSize`],
    /// [`Error::Shape`], [`Error::Checksum`], [`Error::NotFinite`], [`Error::Negative`].
    pub fn parse(bytes: &'a [u8]) -> Result<Baked<'a>, Error> {
        in_default_environment(|| Baked::check(bytes))
    }

    fn check(bytes: &'a [u8]) -> Result<Baked<'a>, Error> {
        if bytes.len() >= 8 && !bytes.starts_with(MAGIC) {
            return Err(Error::WrongKind);
        }
        let (header, _) = bytes.split_at_checked(HEADER).ok_or(Error::Truncated)?;
        if u32_at(header, 8) != VERSION {
            return Err(Error::UnsupportedVersion);
        }
        let (rows, columns) = (u32_at(header, 16) as usize, u32_at(header, 20) as usize);
        let size = size(rows, columns)?;
        if size != u32_at(header, 12) as usize {
            return Err(Error::Shape);
        }
        let bytes = bytes.get(..size).ok_or(Error::Truncated)?;
        let (body, tail) = bytes.split_at_checked(size - 8).ok_or(Error::Truncated)?;
        let mut h = Hash64::new();
        h.bytes(body);
        if h.finish() != u64_at(tail, 0) {
            return Err(Error::Checksum);
        }
        let float = |at: usize| f32::from_bits(u32_at(header, at));
        let fabric = Fabric {
            density_kg_m2: float(24),
            hinge_rigidity_n_m: float(28),
            stretch_limits: [float(32), float(36), float(40)],
        };
        check_fabric(&fabric)?;
        let (numbers, _) = body.get(HEADER..).unwrap_or(&[]).as_chunks::<4>();
        for b in numbers {
            let k = f32::from_le_bytes(*b);
            if !k.is_finite() {
                return Err(Error::NotFinite);
            }
            if k < 0.0 {
                return Err(Error::Negative);
            }
        }
        Ok(Baked { rows, columns, fabric, seed: u64_at(header, 48), description_hash: u64_at(header, 56), numbers })
    }

    /// Stiffness in N/m of a channel at a place; 0 outside.
    pub fn stiffness(&self, channel: usize, row: usize, column: usize) -> f32 {
        if channel >= 4 || row >= self.rows || column >= self.columns {
            return 0.0;
        }
        self.numbers.get((channel * self.rows + row) * self.columns + column).map_or(0.0, |b| f32::from_le_bytes(*b))
    }
}

impl Cloth<'_> {
    /// Sets the stiffness from the bytes of a baked field file, resampled where its grid is another.
    /// All or nothing. Returns what the file tells beside the field (the density is the caller's to use at creation).
    ///
    /// Errors: those of [`Baked::parse`].
    pub fn load_stiffness(&mut self, bytes: &[u8]) -> Result<Fabric, Error> {
        let baked = Baked::parse(bytes)?;
        self.set_stiffness_by(baked.rows, baked.columns, |c, row, column| baked.stiffness(c, row, column));
        Ok(baked.fabric)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file() -> ([u8; 64 + 16 * 6 + 8], [f32; 24]) {
        let field: [f32; 24] = core::array::from_fn(|i| i as f32 + 0.25);
        let mut out = [0u8; 64 + 16 * 6 + 8];
        let fabric = Fabric { density_kg_m2: 0.3, hinge_rigidity_n_m: 1e-5, stretch_limits: [0.01, 0.02, 0.03] };
        let n = write(2, 3, &field, &fabric, 9, "heavy blue denim", &mut out).unwrap();
        assert_eq!(n, out.len());
        (out, field)
    }

    #[test]
    fn round_trip() {
        let (bytes, field) = file();
        let b = Baked::parse(&bytes).unwrap();
        assert_eq!((b.rows, b.columns, b.seed), (2, 3, 9));
        assert_eq!(b.fabric.stretch_limits, [0.01, 0.02, 0.03]);
        for (i, k) in field.iter().enumerate() {
            assert_eq!(b.stiffness(i / 6, i / 3 % 2, i % 3), *k);
        }
    }

    #[test]
    fn every_damage_is_named() {
        let (bytes, _) = file();
        for n in 0..bytes.len() {
            assert_eq!(Baked::parse(&bytes[..n]).unwrap_err(), Error::Truncated, "{n}");
        }
        for i in 0..bytes.len() {
            let mut b = bytes;
            b[i] ^= 0x10;
            assert!(Baked::parse(&b).is_err(), "byte {i}");
        }
        let mut b = bytes;
        b[70] ^= 1;
        assert_eq!(Baked::parse(&b).unwrap_err(), Error::Checksum);
        assert_eq!(Baked::parse(b"\x08\x08\x12\x04taut and more").unwrap_err(), Error::WrongKind);
    }

    #[test]
    fn refuses_what_it_could_not_read_back() {
        let mut out = [0u8; 256];
        let f = Fabric::default();
        let mut field = [1.0f32; 24];
        assert_eq!(write(1, 3, &field, &f, 0, "", &mut out).unwrap_err(), Error::GridSize);
        assert_eq!(write(3, 3, &field, &f, 0, "", &mut out).unwrap_err(), Error::Shape);
        assert_eq!(write(2, 3, &field, &f, 0, "", &mut out[..100]).unwrap_err(), Error::BlockTooSmall);
        field[3] = f32::NAN;
        assert_eq!(write(2, 3, &field, &f, 0, "", &mut out).unwrap_err(), Error::NotFinite);
        let f = Fabric { density_kg_m2: -1.0, ..f };
        assert_eq!(write(2, 3, &[1.0; 24], &f, 0, "", &mut out).unwrap_err(), Error::Negative);
    }
}
