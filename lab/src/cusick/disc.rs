//! taut's disc on the pedestal, until it rests.

use taut::field::FieldView;
use taut::{Budget, Cloth, ClothDef, Error, Families, Grid, GridDef, noise};

use super::{DISC_M, PEDESTAL_M, Silhouette};
use crate::metrics;
use crate::scene::Scene;

/// Frames per second; a frame has as many substeps as the hinges need.
const RATE_HZ: f32 = 60.0;
const MOST_SUBSTEPS: u32 = 1024;

/// Damping in 1/s: the overhang swings at some 10 Hz and is at rest within a second or two.
const DAMPING_PER_S: f32 = 8.0;

/// How far from flat the disc is laid, at its rim in m: no hand lays it flat, and the folds come from there.
const LAID_M: f32 = 0.006;

/// The drape is done when it is slower than this (root mean square of what hangs), not before the shortest time, and not
/// waited for beyond the longest.
const REST_M_S: f64 = 0.001;
const SHORTEST_S: f32 = 1.0;
const LONGEST_S: f32 = 6.0;

/// A disc of fabric.
#[derive(Clone, Debug, PartialEq)]
pub struct Disc {
    /// Particles along its diameter.
    pub side: u32,
    /// Mass per area in kg/m^2.
    pub density_kg_m2: f32,
    /// Bending rigidity in N m.
    pub rigidity_n_m: f32,
    /// Stiffness `[4][side][side]` in N/m, of which the bend channel is not used: hinges bend.
    pub field: Vec<f32>,
}

/// A disc that has draped.
#[derive(Clone, Debug)]
pub struct Draped {
    /// What the camera sees.
    pub silhouette: Silhouette,
    /// Substeps of a frame.
    pub substeps: u32,
    /// Largest structural strain at rest in percent.
    pub stretch_max_pct: f64,
    /// Root mean square speed of what hangs at the end in m/s.
    pub rms_speed_m_s: f64,
    /// Mean height of the rim under the pedestal's top in m.
    pub rim_below_m: f64,
    /// Simulated time in s.
    pub seconds: f32,
}

impl Disc {
    /// Drapes the disc from flat. The seed is that of its first bump, which chooses the folds. Errors: those of the cloth,
    /// [`Error::StepSize`] where even 1024 substeps of a frame cannot carry the rigidity, [`Error::NotFinite`] for a run that
    /// blew up.
    pub fn drape(&self, seed: u64) -> Result<Draped, Error> {
        let n = self.side as usize;
        let grid = Grid::new(&GridDef {
            rows: self.side,
            columns: self.side,
            width_m: 2.0 * DISC_M,
            height_m: 2.0 * DISC_M,
            families: Families(Families::STRUCTURAL.0 | Families::SHEAR.0),
        })?;
        let scene = Scene::Cusick;
        let mut def = scene.fit(
            &ClothDef {
                rate_hz: RATE_HZ,
                substeps: 16,
                density_kg_m2: self.density_kg_m2,
                hinge_rigidity_n_m: self.rigidity_n_m,
                damping_per_s: DAMPING_PER_S,
                budget: Budget::Tuned,
                ..ClothDef::default()
            },
            n,
            n,
        );
        let mut block = vec![0.0; Cloth::memory(&grid, &def)?];
        let field = FieldView::new(4, n, n, &self.field)?;
        // the substeps at which the budget cuts nothing off the hinges
        loop {
            let mut cloth = Cloth::create(&grid, &def, &mut block)?;
            cloth.set_stiffness_field(&field);
            scene.set_up(&mut cloth, seed)?;
            if cloth.budget()?.hinge_fraction >= 1.0 {
                break;
            }
            def.substeps += def.substeps.div_ceil(4);
            if def.substeps > MOST_SUBSTEPS {
                return Err(Error::StepSize);
            }
        }
        let mut cloth = Cloth::create(&grid, &def, &mut block)?;
        cloth.set_stiffness_field(&field);
        scene.set_up(&mut cloth, seed)?;
        for i in (0..n * n).filter(|i| scene.has(*i, n, n)) {
            let at = cloth.position(i)?;
            let wave = laid_by_hand(at.x - DISC_M, at.z - DISC_M, seed);
            cloth.set_position(i, at + taut::Vector3::new(0.0, wave, 0.0))?;
        }
        let pinned = cloth.pin_count();
        let hanging = (0..n * n).filter(|i| scene.has(*i, n, n)).count().saturating_sub(pinned).max(1);
        let mass = f64::from(cloth.particle_mass_kg()) * hanging as f64;
        let speed = |cloth: &Cloth<'_>| (2.0 * cloth.kinetic_energy_j() / mass).sqrt();
        let mut frames = 0;
        loop {
            if cloth.step()?.contains(taut::StepFlags::NON_FINITE) {
                return Err(Error::NotFinite);
            }
            frames += 1;
            let seconds = frames as f32 / RATE_HZ;
            if seconds >= LONGEST_S || (seconds >= SHORTEST_S && speed(&cloth) < REST_M_S) {
                break;
            }
        }
        let x: Vec<[f32; 3]> = (0..n * n)
            .map(|i| cloth.position(i).map(|p| [p.x - DISC_M, p.y, p.z - DISC_M]))
            .collect::<Result<_, _>>()?;
        let surface = Surface::new(x, n, |i| scene.has(i, n, n));
        let rim = (0..360).map(|i| {
            let (sin, cos) = (std::f32::consts::TAU * i as f32 / 360.0).sin_cos();
            -f64::from(surface.at(DISC_M * cos, DISC_M * sin)[1])
        });
        Ok(Draped {
            rim_below_m: rim.sum::<f64>() / 360.0,
            silhouette: Silhouette::of_disc(|x, z| surface.at(x, z)),
            substeps: def.substeps,
            stretch_max_pct: metrics::stretch(&cloth).max,
            rms_speed_m_s: speed(&cloth),
            seconds: frames as f32 / RATE_HZ,
        })
    }
}

/// How far a hand lays the disc out of flat at (x, z) in m: waves of [`LAID_M`] at the rim (root mean square) that fall to 0
/// at the pedestal, whose strengths and places the seed draws.
fn laid_by_hand(x: f32, z: f32, seed: u64) -> f32 {
    const WAVES: std::ops::RangeInclusive<u32> = 1..=9;
    let out = ((x.hypot(z) - PEDESTAL_M) / (DISC_M - PEDESTAL_M)).max(0.0);
    if out == 0.0 {
        return 0.0;
    }
    let angle = z.atan2(x);
    // uniform in -1 to 1, so 1/3 in the square, and half of that around the circle
    let each = LAID_M / (WAVES.count() as f32 / 6.0).sqrt();
    let wave = |k: u32| {
        let (strength, phase) = (noise::uniform(seed, 1000 + 2 * k), noise::uniform(seed, 1001 + 2 * k));
        (2.0 * strength - 1.0) * (k as f32 * angle + std::f32::consts::TAU * phase).cos()
    };
    out * each * WAVES.map(wave).sum::<f32>()
}

/// The disc as a surface up to its very rim, which runs between the particles: absent particles next to it are put where
/// the cloth would go on straight.
struct Surface {
    x: Vec<[f32; 3]>,
    n: usize,
}

impl Surface {
    fn new(mut x: Vec<[f32; 3]>, n: usize, has: impl Fn(usize) -> bool) -> Surface {
        let mut known: Vec<bool> = (0..n * n).map(has).collect();
        // cells that the rim cuts have corners up to two cells outside
        for _ in 0..2 {
            let before = known.clone();
            for i in (0..n * n).filter(|i| !before[*i]) {
                let (row, column) = ((i / n) as isize, (i % n) as isize);
                let place = |row: isize, column: isize| {
                    let inside = (0..n as isize).contains(&row) && (0..n as isize).contains(&column);
                    inside.then(|| row as usize * n + column as usize).filter(|i| before[*i])
                };
                let (mut sum, mut count) = ([0.0f32; 3], 0.0f32);
                for (dr, dc) in [(0, 1), (0, -1), (1, 0), (-1, 0), (1, 1), (1, -1), (-1, 1), (-1, -1)] {
                    if let (Some(a), Some(b)) = (place(row + dr, column + dc), place(row + 2 * dr, column + 2 * dc)) {
                        for axis in 0..3 {
                            sum[axis] += 2.0 * x[a][axis] - x[b][axis];
                        }
                        count += 1.0;
                    }
                }
                if count > 0.0 {
                    x[i] = sum.map(|s| s / count);
                    known[i] = true;
                }
            }
        }
        Surface { x, n }
    }

    /// The place of the point of the flat disc at (x, z) in m from its middle, bilinear between particles.
    fn at(&self, x: f32, z: f32) -> [f32; 3] {
        let split = |c: f32| {
            let at = ((c / DISC_M + 1.0) * 0.5 * (self.n - 1) as f32).clamp(0.0, (self.n - 1) as f32);
            let first = (at as usize).min(self.n - 2);
            (first, at - first as f32)
        };
        let ((column, s), (row, t)) = (split(x), split(z));
        let corner = |r: usize, c: usize| self.x[(row + r) * self.n + column + c];
        let [a, b, c, d] = [corner(0, 0), corner(0, 1), corner(1, 0), corner(1, 1)];
        std::array::from_fn(|i| {
            let (top, bottom) = (a[i] + (b[i] - a[i]) * s, c[i] + (d[i] - c[i]) * s);
            top + (bottom - top) * t
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    /// Deflection of the rim of a plate ring of Poisson ratio 0, clamped at `a` and free at `b`, under a load q per area
    /// with rigidity D: w = q r^4 / 64 D + c1 + c2 ln r + c3 r^2 + c4 r^2 ln r (Timoshenko). The shear force is 0 at b, which
    /// gives c4 = -q b^2 / 8 D; w'' = 0 at b and w = w' = 0 at a give the others.
    fn rim(q_over_d: f64, a: f64, b: f64) -> f64 {
        let q = q_over_d;
        let c4 = -q * b * b / 8.0;
        // w''(b): -c2/b^2 + 2 c3 = -(12 q b^2/64 + c4 (2 ln b + 3)); w'(a): c2/a + 2 a c3 = -(4 q a^3/64 + c4 a (2 ln a + 1))
        let (r1, r2) = (
            -(12.0 * q * b * b / 64.0 + c4 * (2.0 * b.ln() + 3.0)),
            -(4.0 * q * a.powi(3) / 64.0 + c4 * a * (2.0 * a.ln() + 1.0)),
        );
        let (m11, m12, m21, m22) = (-1.0 / (b * b), 2.0, 1.0 / a, 2.0 * a);
        let det = m11 * m22 - m12 * m21;
        let (c2, c3) = ((r1 * m22 - m12 * r2) / det, (m11 * r2 - m21 * r1) / det);
        let w = |r: f64| q * r.powi(4) / 64.0 + c2 * r.ln() + c3 * r * r + c4 * r * r * r.ln();
        w(b) - w(a)
    }

    #[test]
    fn a_stiff_disc_sags_as_a_plate_ring() {
        // a narrow ring is a beam clamped at one end: w = q L^4 / 8 D
        let (narrow, beam) = (rim(1.0, 1.0, 1.01), 0.01f64.powi(4) / 8.0);
        assert!((narrow / beam - 1.0).abs() < 0.01, "{narrow} {beam}");

        let density = 0.2f32;
        let q = f64::from(density) * 9.81;
        // 2 mm, a thirtieth of the overhang: still linear
        let rigidity = rim(q, f64::from(PEDESTAL_M), f64::from(DISC_M)) / 0.002;
        // half a cell more or less of the overhang counts with its fourth power
        for (side, within) in [(25, 0.35), (33, 0.3)] {
            let n = side as usize;
            let disc =
                Disc { side, density_kg_m2: density, rigidity_n_m: rigidity as f32, field: vec![1e5; 4 * n * n] };
            let draped = disc.drape(1).unwrap();
            let share = draped.rim_below_m / 0.002;
            assert!((share - 1.0).abs() < within, "{side}: {share}");
            assert!(draped.silhouette.drape_coefficient() > 0.97);
        }
    }

    #[test]
    fn hands_lay_discs_by_their_seeds() {
        let rim = |seed: u64| -> Vec<f32> {
            (0..360)
                .map(|i| (i as f32).to_radians().sin_cos())
                .map(|(s, c)| laid_by_hand(DISC_M * c, DISC_M * s, seed))
                .collect()
        };
        let squares: f32 = (1..=200).flat_map(rim).map(|w| w * w).sum();
        assert!(((squares / 72_000.0).sqrt() / LAID_M - 1.0).abs() < 0.1);
        assert!(rim(1) == rim(1) && rim(1) != rim(2));
        assert_eq!(laid_by_hand(PEDESTAL_M * 0.99, 0.0, 1), 0.0);
    }

    #[test]
    fn softer_discs_hang_lower_and_rest() {
        let n = 33;
        let drape = |rigidity_n_m: f32| {
            let disc = Disc {
                side: 33,
                density_kg_m2: 0.15,
                rigidity_n_m,
                field: [[300.0; 33 * 33], [300.0; 33 * 33], [40.0; 33 * 33], [1.0; 33 * 33]].concat(),
            };
            assert_eq!(disc.field.len(), 4 * n * n);
            let draped = disc.drape(1).unwrap();
            assert!(
                draped.rms_speed_m_s < 0.01 && draped.stretch_max_pct < 5.0,
                "{rigidity_n_m}: {} m/s, {} %",
                draped.rms_speed_m_s,
                draped.stretch_max_pct
            );
            draped.silhouette.drape_coefficient()
        };
        let found = [3e-6, 3e-5, 3e-4].map(drape);
        assert!(
            0.0 < found[0] && found[0] + 0.1 < found[1] && found[1] + 0.1 < found[2] && found[2] < 1.0,
            "{found:?}"
        );
    }
}
