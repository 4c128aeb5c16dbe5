//! The plain step written down as the paper has it, one particle and one spring after the other: eq. 1 (springs), eq. 2
//! (gravity, damping), eq. 17 (symplectic Euler), with the order of operations of core. Generic over the numbers: in f32 it
//! has the bits of core (a test holds it to that), so in f64 it is core in double precision.

use std::ops::{Add, Div, Mul, Sub};

use taut::{BEND_SHARE, Cloth, Error};

/// The numbers that a cloth is stepped with.
pub trait Real:
    Copy + PartialOrd + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
    /// The nearest number to an f32: the same.
    fn of(x: f32) -> Self;
    /// The nearest number to a count, exact below 2^24.
    fn count(n: usize) -> Self {
        Self::of(n as f32)
    }
    /// Correctly rounded.
    fn sqrt(self) -> Self;
    /// As a double.
    fn double(self) -> f64;
    /// The larger of two numbers.
    fn at_least(self, other: Self) -> Self {
        if self > other { self } else { other }
    }
}

impl Real for f32 {
    fn of(x: f32) -> f32 {
        x
    }
    fn sqrt(self) -> f32 {
        taut::sqrt(self)
    }
    fn double(self) -> f64 {
        f64::from(self)
    }
}

impl Real for f64 {
    fn of(x: f32) -> f64 {
        f64::from(x)
    }
    fn sqrt(self) -> f64 {
        f64::sqrt(self)
    }
    fn double(self) -> f64 {
        self
    }
}

type Three<T> = [T; 3];

fn plus<T: Real>(a: Three<T>, b: Three<T>) -> Three<T> {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

fn minus<T: Real>(a: Three<T>, b: Three<T>) -> Three<T> {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn times<T: Real>(a: Three<T>, f: T) -> Three<T> {
    [a[0] * f, a[1] * f, a[2] * f]
}

fn squared<T: Real>(a: Three<T>) -> T {
    a[0] * a[0] + a[1] * a[1] + a[2] * a[2]
}

/// The springs of a particle in the order in which core sums them: rows and columns to the other end.
const ORDER: [(isize, isize); 12] =
    [(0, 1), (0, -1), (1, 0), (-1, 0), (1, 1), (-1, -1), (1, -1), (-1, 1), (0, 2), (0, -2), (2, 0), (-2, 0)];

/// Below this squared length in m^2 a spring has no direction.
const TINY: f32 = 1e-30;

/// A cloth of uniform stiffness whose pins stay where they are, without optional parts.
#[derive(Clone, Debug)]
pub struct Twin<T> {
    rows: isize,
    columns: isize,
    substeps: u32,
    dt: T,
    damping: T,
    weight: Three<T>,
    /// Rest lengths along u, along v, diagonal.
    rest: Three<T>,
    floor: Option<T>,
    speed: Option<T>,
    /// 1/m in 1/kg, 0 where pinned.
    inverse: Vec<T>,
    /// Of the springs in [`ORDER`], where there is the other end.
    k: [T; 12],
    x: Vec<Three<T>>,
    v: Vec<Three<T>>,
}

impl<T: Real> Twin<T> {
    /// The twin of a cloth as it is now, of the uniform stiffness that the cloth was given. None where the budget cuts that
    /// stiffness or the cloth has parts that a twin has not.
    pub fn of(cloth: &mut Cloth<'_>, stiffness_n_m: [f32; 4]) -> Result<Option<Twin<T>>, Error> {
        let (grid, def) = (*cloth.grid(), *cloth.def());
        if cloth.budget()?.cut_fraction != 0.0 || def.features.0 != 0 || def.has_inertia() {
            return Ok(None);
        }
        let d = grid.def();
        let n = grid.particles();
        let dt = T::of(1.0) / (T::of(def.rate_hz) * T::of(def.substeps as f32));
        let mass = T::of(def.density_kg_m2) * T::of(d.width_m) * T::of(d.height_m) / T::count(n);
        let u = T::of(d.width_m) / T::count(grid.columns() - 1);
        let v = T::of(d.height_m) / T::count(grid.rows() - 1);
        let pinned: Vec<usize> = cloth.pinned().collect();
        let [warp, weft, shear, bend] = stiffness_n_m;
        let (shear, bend) = (if grid.has_shear() { shear } else { 0.0 }, if grid.has_bend() { bend } else { 0.0 });
        let most = BEND_SHARE * (0.5 * warp + 0.5 * weft);
        let bend = if bend < most { bend } else { most };
        let shorter = if u < v { u } else { v };
        let three = |p: taut::Vector3<f32>| [T::of(p.x), T::of(p.y), T::of(p.z)];
        Ok(Some(Twin {
            rows: grid.rows() as isize,
            columns: grid.columns() as isize,
            substeps: def.substeps,
            dt,
            damping: T::of(def.damping_per_s),
            weight: def.gravity_m_s2.map(|g| mass * T::of(g)),
            rest: [u, v, (u * u + v * v).sqrt()],
            floor: def.compression_limit.then_some(T::of(-1.0)),
            speed: (def.speed_limit > 0.0).then(|| T::of(def.speed_limit) * shorter / dt),
            inverse: (0..n).map(|i| if pinned.contains(&i) { T::of(0.0) } else { T::of(1.0) / mass }).collect(),
            k: ORDER.map(|(rows, columns)| {
                T::of(match (rows.abs(), columns.abs()) {
                    (1, 0) => warp,
                    (0, 1) => weft,
                    (1, 1) => shear,
                    _ => bend,
                })
            }),
            x: (0..n).map(|i| cloth.position(i).map(three)).collect::<Result<_, _>>()?,
            v: (0..n).map(|i| cloth.velocity(i).map(three)).collect::<Result<_, _>>()?,
        }))
    }

    /// Positions in m.
    pub fn positions(&self) -> impl Iterator<Item = [f64; 3]> {
        self.x.iter().map(|p| p.map(Real::double))
    }

    /// Strain of the structural springs, of each row first those along u, then those along v: the order of
    /// [`Cloth::each_structural_strain`].
    pub fn strains(&self) -> Vec<f64> {
        let mut all = Vec::new();
        for i in 0..self.x.len() as isize {
            let (row, column) = (i / self.columns, i % self.columns);
            for (there, other, rest) in [
                (column + 1 < self.columns, i + 1, self.rest[0]),
                (row + 1 < self.rows, i + self.columns, self.rest[1]),
            ] {
                if there {
                    let length = squared(minus(self.x[other as usize], self.x[i as usize])).sqrt();
                    all.push((length / rest - T::of(1.0)).double());
                }
            }
        }
        all
    }

    /// F_inside of a particle (eq. 1): the sum of k (1 - l0/l) d.
    fn inside(&self, i: isize) -> Three<T> {
        let (row, column) = (i / self.columns, i % self.columns);
        let mut f = [T::of(0.0); 3];
        for ((rows, columns), k) in ORDER.into_iter().zip(self.k) {
            let (r, c) = (row + rows, column + columns);
            if !(0..self.rows).contains(&r) || !(0..self.columns).contains(&c) {
                continue;
            }
            let d = minus(self.x[(r * self.columns + c) as usize], self.x[i as usize]);
            let rest = match (rows.abs(), columns.abs()) {
                (0, n) => T::count(n as usize) * self.rest[0],
                (n, 0) => T::count(n as usize) * self.rest[1],
                _ => self.rest[2],
            };
            let mut stretch = T::of(1.0) - rest / squared(d).at_least(T::of(TINY)).sqrt();
            if let Some(floor) = self.floor {
                stretch = stretch.at_least(floor);
            }
            f = plus(f, times(d, k * stretch));
        }
        f
    }

    fn substep(&mut self) {
        let forces: Vec<Three<T>> = (0..self.x.len()).map(|i| plus(self.inside(i as isize), self.weight)).collect();
        for (i, f) in forces.into_iter().enumerate() {
            let a = minus(times(f, self.inverse[i]), times(self.v[i], self.damping));
            let mut v = plus(self.v[i], times(a, self.dt));
            if let Some(limit) = self.speed {
                let speed = squared(v).sqrt();
                if speed > limit {
                    v = times(v, limit / speed);
                }
            }
            if self.inverse[i] > T::of(0.0) {
                self.v[i] = v;
                self.x[i] = plus(self.x[i], times(v, self.dt));
            }
        }
    }

    /// One frame.
    pub fn step(&mut self) {
        for _ in 0..self.substeps {
            self.substep();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::invariance::with_cloth;
    use crate::scene::Scene;
    use taut::{ClothDef, Families, GridDef};

    /// In f32 the twin is core to the bit: with clamps that act and without, in every combination of families.
    #[test]
    fn in_f32_it_has_the_bits_of_core() {
        for (i, families) in [1, 3, 5, 7].into_iter().enumerate() {
            let scene = [Scene::Hang2, Scene::Edge][i % 2];
            let grid =
                GridDef { rows: 9, columns: 13, width_m: 1.3, families: Families(families), ..GridDef::default() };
            let def = scene.fit(
                &ClothDef { speed_limit: [0.01, 0.25, 0.0][i % 3], compression_limit: i < 2, ..ClothDef::default() },
                9,
                13,
            );
            let k = [90.0, 60.0, 20.0, 1.0];
            with_cloth(&grid, &def, |cloth| {
                cloth.set_stiffness_uniform(k)?;
                scene.set_up(cloth, 1)?;
                let mut twin = Twin::<f32>::of(cloth, k)?.expect("a plain cloth");
                for frame in 0..60 {
                    cloth.step()?;
                    twin.step();
                    for (p, x) in twin.x.iter().enumerate() {
                        let at = cloth.position(p)?;
                        assert_eq!(x.map(f32::to_bits), [at.x, at.y, at.z].map(f32::to_bits), "{p} in frame {frame}");
                    }
                }
                let mut strains = twin.strains().into_iter();
                cloth.each_structural_strain(|_, _, e| assert_eq!(Some(f64::from(e)), strains.next()));
                assert_eq!(strains.next(), None);
                Ok(())
            })
            .unwrap();
        }
    }

    #[test]
    fn what_is_cut_has_no_twin() {
        let k = [1e6, 1e6, 1e5, 1e3];
        let twin = with_cloth(&GridDef::default(), &ClothDef::default(), |cloth| {
            cloth.set_stiffness_uniform(k)?;
            Twin::<f64>::of(cloth, k)
        });
        assert!(twin.unwrap().is_none());
    }
}
