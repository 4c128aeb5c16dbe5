//! From the particles of a grid to many points on the surface: a Catmull-Rom surface and its tangents.
//!
//! The surface interpolates the particles, is continuously differentiable (hence continuous normals), and reproduces
//! planes exactly, at the border too: beyond the border it continues with the ghost particle `2 p0 - p1`.
//! It is linear in the particles, so its adjoint is exact.

/// One direction of the grid: for every sample, which particles it is made of, with which weights.
#[derive(Debug)]
pub(super) struct Axis {
    taps: Vec<Taps>,
    particles: usize,
}

#[derive(Debug)]
struct Taps {
    first: usize,
    count: usize,
    value: [f64; 4],
    slope: [f64; 4],
}

impl Axis {
    /// `samples` points at `(i + 1/2) / samples` of the way along `particles` (>= 2) particles.
    /// Slopes are per unit of that way, i.e. from the first particle to the last.
    pub fn new(particles: usize, samples: usize) -> Self {
        let cells = particles - 1;
        let taps = (0..samples)
            .map(|i| {
                let s = (i as f64 + 0.5) / samples as f64 * cells as f64;
                let cell = (s.floor() as usize).min(cells - 1);
                let t = s - cell as f64;
                let (t2, t3) = (t * t, t * t * t);
                let value = [
                    -0.5 * t3 + t2 - 0.5 * t,
                    1.5 * t3 - 2.5 * t2 + 1.0,
                    -1.5 * t3 + 2.0 * t2 + 0.5 * t,
                    0.5 * t3 - 0.5 * t2,
                ];
                let slope = [-1.5 * t2 + 2.0 * t - 0.5, 4.5 * t2 - 5.0 * t, -4.5 * t2 + 4.0 * t + 0.5, 1.5 * t2 - t]
                    .map(|w| w * cells as f64);
                Taps {
                    first: cell.saturating_sub(1),
                    count: 4.min(particles - cell.saturating_sub(1)),
                    value: fold_ghosts(value, cell, particles),
                    slope: fold_ghosts(slope, cell, particles),
                }
            })
            .collect();
        Self { taps, particles }
    }
}

/// Moves the weights of the four particles `cell - 1 ..= cell + 2` to those that exist, counted from the first of them.
fn fold_ghosts(weights: [f64; 4], cell: usize, particles: usize) -> [f64; 4] {
    let first = cell.saturating_sub(1);
    let mut folded = [0.0; 4];
    for (k, w) in weights.into_iter().enumerate() {
        if cell + k == 0 {
            folded[0] += 2.0 * w;
            folded[1] -= w;
        } else if cell + k > particles {
            folded[particles - 1 - first] += 2.0 * w;
            folded[particles - 2 - first] -= w;
        } else {
            folded[cell + k - 1 - first] += w;
        }
    }
    folded
}

/// Scratch memory for one surface: positions sampled along u, and one row of samples.
#[derive(Debug, Default)]
pub(super) struct Surface {
    /// `[rows][samples][3]`: positions sampled along u only, and their slopes along u (or the gradients by them).
    along_u: Vec<f64>,
    along_u_slope: Vec<f64>,
    /// `[samples][3]`: the positions of the current row of samples (or the gradients by them).
    pub position: Vec<f64>,
    /// The tangents d position / du of the row.
    pub tangent_u: Vec<f64>,
    /// The tangents d position / dv of the row.
    pub tangent_v: Vec<f64>,
}

impl Surface {
    /// Zeroes everything, with room for these axes.
    pub fn clear(&mut self, u: &Axis, v: &Axis) {
        let width = u.taps.len() * 3;
        for buffer in [&mut self.along_u, &mut self.along_u_slope] {
            buffer.clear();
            buffer.resize(v.particles * width, 0.0);
        }
        for buffer in [&mut self.position, &mut self.tangent_u, &mut self.tangent_v] {
            buffer.clear();
            buffer.resize(width, 0.0);
        }
    }

    /// Samples the particles `[rows * columns * 3]` along u; rows of samples can then be asked for.
    pub fn load(&mut self, u: &Axis, v: &Axis, particles: &[f64]) {
        self.clear(u, v);
        let width = u.taps.len() * 3;
        let rows = particles.chunks_exact(u.particles * 3);
        let outs = self.along_u.chunks_exact_mut(width).zip(self.along_u_slope.chunks_exact_mut(width));
        for (row, (value, slope)) in rows.zip(outs) {
            for (taps, (value, slope)) in u.taps.iter().zip(value.chunks_exact_mut(3).zip(slope.chunks_exact_mut(3))) {
                for (k, x) in row[taps.first * 3..(taps.first + taps.count) * 3].chunks_exact(3).enumerate() {
                    for c in 0..3 {
                        value[c] += taps.value[k] * x[c];
                        slope[c] += taps.slope[k] * x[c];
                    }
                }
            }
        }
    }

    /// Fills `position`, `tangent_u` and `tangent_v` with row `j` of the samples.
    pub fn row(&mut self, u: &Axis, v: &Axis, j: usize) {
        let width = u.taps.len() * 3;
        self.position.fill(0.0);
        self.tangent_u.fill(0.0);
        self.tangent_v.fill(0.0);
        let taps = &v.taps[j];
        for k in 0..taps.count {
            let from = (taps.first + k) * width;
            let (w, d) = (taps.value[k], taps.slope[k]);
            let value = &self.along_u[from..from + width];
            let slope = &self.along_u_slope[from..from + width];
            for (out, x) in self.position.iter_mut().zip(value) {
                *out += w * x;
            }
            for (out, x) in self.tangent_v.iter_mut().zip(value) {
                *out += d * x;
            }
            for (out, x) in self.tangent_u.iter_mut().zip(slope) {
                *out += w * x;
            }
        }
    }

    /// The adjoint of [`Surface::row`]: adds the gradients that stand in `position`, `tangent_u`, `tangent_v`.
    pub fn row_adjoint(&mut self, u: &Axis, v: &Axis, j: usize) {
        let width = u.taps.len() * 3;
        let taps = &v.taps[j];
        for k in 0..taps.count {
            let from = (taps.first + k) * width;
            let (w, d) = (taps.value[k], taps.slope[k]);
            let value = self.along_u[from..from + width].iter_mut();
            for (out, (p, t)) in value.zip(self.position.iter().zip(&self.tangent_v)) {
                *out += w * p + d * t;
            }
            for (out, t) in self.along_u_slope[from..from + width].iter_mut().zip(&self.tangent_u) {
                *out += w * t;
            }
        }
    }

    /// The adjoint of [`Surface::load`]: adds to `gradient` `[rows * columns * 3]`.
    pub fn load_adjoint(&self, u: &Axis, gradient: &mut [f64]) {
        let width = u.taps.len() * 3;
        let ins = self.along_u.chunks_exact(width).zip(self.along_u_slope.chunks_exact(width));
        for (row, (value, slope)) in gradient.chunks_exact_mut(u.particles * 3).zip(ins) {
            for (taps, (value, slope)) in u.taps.iter().zip(value.chunks_exact(3).zip(slope.chunks_exact(3))) {
                let range = taps.first * 3..(taps.first + taps.count) * 3;
                for (k, x) in row[range].chunks_exact_mut(3).enumerate() {
                    for c in 0..3 {
                        x[c] += taps.value[k] * value[c] + taps.slope[k] * slope[c];
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row_of(columns: usize, rows: usize, samples: usize, j: usize, particles: &[f64]) -> Surface {
        let (u, v) = (Axis::new(columns, samples), Axis::new(rows, samples));
        let mut surface = Surface::default();
        surface.load(&u, &v, particles);
        surface.row(&u, &v, j);
        surface
    }

    #[test]
    fn a_plane_is_reproduced_with_its_tangents_on_every_small_grid() {
        for (columns, rows) in [(2, 2), (2, 5), (3, 2), (4, 3), (7, 6)] {
            let mut particles = Vec::new();
            for r in 0..rows {
                for c in 0..columns {
                    let (s, t) = (c as f64 / (columns - 1) as f64, r as f64 / (rows - 1) as f64);
                    particles.extend([2.0 * s + 0.5 * t + 1.0, -3.0 * t, s - t]);
                }
            }
            for j in 0..9 {
                let surface = row_of(columns, rows, 9, j, &particles);
                let t = (j as f64 + 0.5) / 9.0;
                for i in 0..9 {
                    let s = (i as f64 + 0.5) / 9.0;
                    let expected = [2.0 * s + 0.5 * t + 1.0, -3.0 * t, s - t];
                    for c in 0..3 {
                        assert!((surface.position[i * 3 + c] - expected[c]).abs() < 1e-12);
                        assert!((surface.tangent_u[i * 3 + c] - [2.0, 0.0, 1.0][c]).abs() < 1e-12);
                        assert!((surface.tangent_v[i * 3 + c] - [0.5, -3.0, -1.0][c]).abs() < 1e-12);
                    }
                }
            }
        }
    }

    #[test]
    fn the_surface_goes_through_the_particles() {
        // no sample lies on a particle: with very many, the two beside one come close to it
        let (columns, fine) = (5, 20_000);
        let particles: Vec<f64> = (0..columns * 3 * 3).map(|i| ((i * i) as f64 * 0.37).sin()).collect();
        let surface = row_of(columns, 3, fine, fine / 2, &particles);
        for c in 1..columns - 1 {
            let i = c * fine / (columns - 1);
            for k in 0..3 {
                // the row lies half a sample below particle row 1
                let mean = 0.5 * (surface.position[(i - 1) * 3 + k] + surface.position[i * 3 + k]);
                assert!((mean - particles[(columns + c) * 3 + k]).abs() < 1e-3);
            }
        }
    }
}
