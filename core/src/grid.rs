use crate::{Error, Hash64, math};

/// Spring families of a grid, as bits. A family that is switched off has no memory and no cost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Families(pub u32);

impl Families {
    /// Structural springs to the four neighbours: warp along v, weft along u. Always on.
    pub const STRUCTURAL: Families = Families(1);
    /// Shear springs to the four diagonal neighbours.
    pub const SHEAR: Families = Families(2);
    /// Bend springs to the particles two cells away.
    pub const BEND: Families = Families(4);
    /// All three families.
    pub const ALL: Families = Families(7);

    /// Whether every family of `other` is on.
    pub const fn contains(self, other: Families) -> bool {
        self.0 & other.0 == other.0
    }
}

/// What a grid is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GridDef {
    /// Particles along v (m of the paper), 2 to 4096. Default 32.
    pub rows: u32,
    /// Particles along u (n of the paper), 2 to 4096. Default 32.
    pub columns: u32,
    /// Side length along u in m, 1e-6 to 10,000. Default 1.
    pub width_m: f32,
    /// Side length along v in m, 1e-6 to 10,000. Default 1.
    pub height_m: f32,
    /// Spring families; the structural ones must be on. Default all.
    pub families: Families,
}

impl Default for GridDef {
    fn default() -> Self {
        GridDef { rows: 32, columns: 32, width_m: 1.0, height_m: 1.0, families: Families::ALL }
    }
}

/// The topology of a cloth: which particles exist and which springs join them. Immutable, and shared by as many cloths as
/// one likes. Particle (row, column) has the index `row * columns + column`; u runs along the columns, v along the rows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    def: GridDef,
}

impl Grid {
    /// Most particles of a side.
    pub const MAX_SIDE: u32 = 4096;

    /// Checks a definition. Errors: [`Error::GridSize`], [`Error::SideLength`], [`Error::OutOfRange`] (families).
    pub fn new(def: &GridDef) -> Result<Grid, Error> {
        let side = |n: u32| (2..=Grid::MAX_SIDE).contains(&n);
        if !side(def.rows) || !side(def.columns) {
            return Err(Error::GridSize);
        }
        // below, squared lengths and masses would underflow
        let length = |l: f32| (1e-6..=10_000.0).contains(&l);
        if !length(def.width_m) || !length(def.height_m) {
            return Err(Error::SideLength);
        }
        if def.families.0 > Families::ALL.0 || !def.families.contains(Families::STRUCTURAL) {
            return Err(Error::OutOfRange);
        }
        Ok(Grid { def: *def })
    }

    /// The definition it was made from.
    pub fn def(&self) -> &GridDef {
        &self.def
    }

    /// Particles along v.
    pub fn rows(&self) -> usize {
        self.def.rows as usize
    }

    /// Particles along u.
    pub fn columns(&self) -> usize {
        self.def.columns as usize
    }

    /// Number of particles, rows times columns.
    pub fn particles(&self) -> usize {
        self.rows() * self.columns()
    }

    /// Number of springs of all families that are on.
    pub fn springs(&self) -> usize {
        let (m, n) = (self.rows(), self.columns());
        let structural = m * (n - 1) + (m - 1) * n;
        let shear = if self.has_shear() { 2 * (m - 1) * (n - 1) } else { 0 };
        let bend = if self.has_bend() { m * (n - 2) + (m - 2) * n } else { 0 };
        structural + shear + bend
    }

    /// Whether the shear family is on.
    pub fn has_shear(&self) -> bool {
        self.def.families.contains(Families::SHEAR)
    }

    /// Whether the bend family is on.
    pub fn has_bend(&self) -> bool {
        self.def.families.contains(Families::BEND)
    }

    /// Rest length of the springs along u in m.
    pub fn rest_u(&self) -> f32 {
        self.def.width_m / (self.def.columns - 1) as f32
    }

    /// Rest length of the springs along v in m.
    pub fn rest_v(&self) -> f32 {
        self.def.height_m / (self.def.rows - 1) as f32
    }

    /// The smaller one of [`Grid::rest_u`] and [`Grid::rest_v`] in m.
    pub(crate) fn least_rest(&self) -> f32 {
        math::min(self.rest_u(), self.rest_v())
    }

    /// Rest length of the diagonal springs in m.
    pub fn rest_diagonal(&self) -> f32 {
        let (u, v) = (self.rest_u(), self.rest_v());
        math::sqrt(u * u + v * v)
    }

    /// 64-bit digest of the definition: two grids are the same topology when their digests agree.
    pub fn digest(&self) -> u64 {
        let d = &self.def;
        let mut h = Hash64::new();
        h.words(&[d.rows, d.columns, d.width_m.to_bits(), d.height_m.to_bits(), d.families.0]);
        h.finish()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn refuses_bad_definitions() {
        let d = GridDef::default();
        let err = |d: GridDef| Grid::new(&d).unwrap_err();
        assert_eq!(err(GridDef { rows: 1, columns: 1, ..d }), Error::GridSize);
        assert_eq!(err(GridDef { rows: 70_000, columns: 2, ..d }), Error::GridSize);
        assert_eq!(err(GridDef { width_m: 0.0, ..d }), Error::SideLength);
        assert_eq!(err(GridDef { height_m: f32::NAN, ..d }), Error::SideLength);
        assert_eq!(err(GridDef { height_m: f32::INFINITY, ..d }), Error::SideLength);
        assert_eq!(err(GridDef { families: Families(2), ..d }), Error::OutOfRange);
        assert_eq!(err(GridDef { families: Families(8), ..d }), Error::OutOfRange);
    }

    #[test]
    fn counts_springs() {
        let g = Grid::new(&GridDef { rows: 3, columns: 4, ..GridDef::default() }).unwrap();
        // structural 3*3 + 2*4, shear 2*2*3, bend 3*2 + 1*4
        assert_eq!(g.springs(), 17 + 12 + 10);
        let g = Grid::new(&GridDef { rows: 2, columns: 2, ..GridDef::default() }).unwrap();
        assert_eq!(g.springs(), 4 + 2);
    }
}
