//! The cloth written down as the paper has it, one particle and one spring after the other, in f32: eq. 1 (springs), eq. 2
//! (outer forces), eq. 17 (symplectic Euler). No padding, no lanes, no rows; the order of the sums is that of core.

use super::Random;
use super::lattice::{Family, Lattice};
use taut::{Cloth, ClothDef, Grid, Vector3};

/// The springs of a particle in the order in which they are summed: rows and columns to the other end.
pub const ORDER: [(isize, isize); 12] =
    [(0, 1), (0, -1), (1, 0), (-1, 0), (1, 1), (-1, -1), (1, -1), (-1, 1), (0, 2), (0, -2), (2, 0), (-2, 0)];

#[derive(Clone, Debug)]
pub struct Pin {
    pub particle: usize,
    pub from: Vector3<f32>,
    pub to: Vector3<f32>,
}

#[derive(Clone, Debug)]
pub struct Twin {
    pub grid: Grid,
    pub def: ClothDef,
    pub dt: f32,
    pub mass: f32,
    pub x: Vec<Vector3<f32>>,
    pub v: Vec<Vector3<f32>>,
    /// 1/M, 0 for pinned ones.
    pub inverse: Vec<f32>,
    /// k of the twelve springs of each particle in [`ORDER`], 0 where there is none.
    pub k: Vec<[f32; 12]>,
    pub pull: Vec<Vector3<f32>>,
    pub pins: Vec<Pin>,
}

impl Twin {
    /// Puts cloth and twin alike at random places near where they are, at random speeds; pins move along.
    pub fn crumple(&mut self, c: &mut Cloth<'_>, r: &mut Random) {
        for i in 0..self.x.len() {
            let at = self.x[i] + r.vector(0.03);
            c.set_position(i, at).expect("a particle");
            self.x[i] = at;
            if self.inverse[i] > 0.0 {
                let v = r.vector(0.5);
                c.set_velocity(i, v).expect("a particle");
                self.v[i] = v;
            }
        }
        for p in &mut self.pins {
            p.from = self.x[p.particle];
            p.to = p.from;
        }
    }

    /// A flat sheet at rest whose springs have the mean of the field at their two ends; `field` is
    /// `[channel][row][column]` of the grid's size: warp, weft, shear, bend. Nothing is cut.
    pub fn new(grid: &Grid, def: &ClothDef, x: Vec<Vector3<f32>>, field: &[f32]) -> Twin {
        let (m, n) = (grid.rows() as isize, grid.columns() as isize);
        let k = (0..m * n).map(|i| {
            let (row, column) = (i / n, i % n);
            ORDER.map(|(rows, columns)| {
                let (r, c) = (row + rows, column + columns);
                if !(0..m).contains(&r) || !(0..n).contains(&c) {
                    return 0.0;
                }
                let (channel, on) = match (rows.abs(), columns.abs()) {
                    (1, 0) => (0, true),
                    (0, 1) => (1, true),
                    (1, 1) => (2, grid.has_shear()),
                    _ => (3, grid.has_bend()),
                };
                let at = |place: isize| field[(channel * m * n + place) as usize];
                if on { 0.5 * (at(i) + at(r * n + c)) } else { 0.0 }
            })
        });
        let mass = {
            let d = grid.def();
            def.density_kg_m2 * d.width_m * d.height_m / grid.particles() as f32
        };
        Twin {
            grid: *grid,
            def: *def,
            dt: 1.0 / (def.rate_hz * def.substeps as f32),
            mass,
            v: vec![Vector3::zeros(); x.len()],
            inverse: vec![1.0 / mass; x.len()],
            k: k.collect(),
            pull: vec![Vector3::zeros(); x.len()],
            pins: Vec::new(),
            x,
        }
    }

    /// The twin of a measured lattice, to be stepped at any dt.
    pub fn of_lattice(grid: &Grid, def: &ClothDef, lattice: &Lattice, dt: f32) -> Twin {
        let none = vec![0.0; 4 * grid.particles()];
        let flat = lattice.flat.iter().map(|p| p.cast()).collect();
        let mut twin = Twin::new(grid, def, flat, &none);
        twin.dt = dt;
        twin.inverse = lattice.inverse.iter().map(|w| *w as f32).collect();
        let n = grid.columns() as isize;
        for s in &lattice.springs {
            for (from, to) in [(s.a, s.b), (s.b, s.a)] {
                let (from_row, to_row) = (from as isize / n, to as isize / n);
                let step = (to_row - from_row, to as isize % n - from as isize % n);
                let place = ORDER.iter().position(|o| *o == step).expect("a spring");
                debug_assert!((s.family == Family::Bend) == (place >= 8));
                twin.k[from][place] = s.k as f32;
            }
        }
        twin
    }

    /// Pins a particle where it is.
    pub fn pin(&mut self, particle: usize) {
        self.inverse[particle] = 0.0;
        let here = self.x[particle];
        self.pins.push(Pin { particle, from: here, to: here });
    }

    /// F_inside of a particle (eq. 1): sum of k (l - l0) d / l, written as k (1 - l0 / l) d.
    fn inside(&self, i: usize) -> Vector3<f32> {
        let n = self.grid.columns() as isize;
        let (u, v) = (self.grid.rest_u(), self.grid.rest_v());
        let diagonal = (u * u + v * v).sqrt();
        let floor = if self.def.compression_limit { -1.0 } else { f32::NEG_INFINITY };
        let mut f = Vector3::zeros();
        for ((rows, columns), k) in ORDER.into_iter().zip(self.k[i]) {
            if k == 0.0 {
                continue;
            }
            let d = self.x[(i as isize + rows * n + columns) as usize] - self.x[i];
            let l0 = match (rows.abs(), columns.abs()) {
                (0, c) => c as f32 * u,
                (r, 0) => r as f32 * v,
                _ => diagonal,
            };
            let l = (d.x * d.x + d.y * d.y + d.z * d.z).max(1e-30).sqrt();
            let factor = k * (1.0 - l0 / l).max(floor);
            f += Vector3::new(factor * d.x, factor * d.y, factor * d.z);
        }
        f
    }

    /// One substep; afterwards the pins are at `share` of their way.
    pub fn substep(&mut self, share: f32) {
        let dt = self.dt;
        let g = Vector3::from(self.def.gravity_m_s2.map(|g| self.mass * g));
        let forces: Vec<_> = (0..self.x.len()).map(|i| self.inside(i) + g + self.pull[i]).collect();
        let limit = if self.def.speed_limit > 0.0 {
            self.def.speed_limit * self.grid.rest_u().min(self.grid.rest_v()) / dt
        } else {
            f32::INFINITY
        };
        for (i, f) in forces.into_iter().enumerate() {
            let (w, c) = (self.inverse[i], self.def.damping_per_s);
            let a = f * w - self.v[i] * c;
            let mut v = self.v[i] + a * dt;
            let speed = (v.x * v.x + v.y * v.y + v.z * v.z).sqrt();
            if speed > limit {
                v *= limit / speed;
            }
            self.v[i] = v;
            self.x[i] += v * dt;
        }
        for p in &self.pins {
            let way = p.to - p.from;
            self.x[p.particle] = if share < 1.0 { p.from + way * share } else { p.to };
            self.v[p.particle] = way * self.def.rate_hz;
        }
    }

    /// One frame; the pulls are gone afterwards.
    pub fn step(&mut self) {
        for s in 1..=self.def.substeps {
            self.substep(s as f32 / self.def.substeps as f32);
        }
        for p in &mut self.pins {
            p.from = p.to;
        }
        self.pull.fill(Vector3::zeros());
    }

    pub fn bits(&self) -> Vec<u32> {
        let all = self.x.iter().chain(&self.v);
        all.flat_map(|p| p.iter().map(|n| n.to_bits()).collect::<Vec<_>>()).collect()
    }
}
