//! The shape at rest: damped Newton iterations on the energy, in f64.

use super::hessian::{Hessian, Pattern};
use super::law::Law;
use super::springs::Springs;

/// A cloth at given stiffness, for which the energy is to be least.
pub(super) struct Cloth<'a> {
    pub springs: &'a Springs,
    pub pattern: &'a Pattern,
    /// Of every spring in N/m.
    pub stiffness: &'a [f64],
    /// Weight of a particle in N, a vector.
    pub weight_n: [f64; 3],
    /// Whether compressed springs are limited as in core.
    pub limit: bool,
}

/// How a solve ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Outcome {
    /// Largest component of the force that is left on a free particle in N.
    pub residual_n: f64,
    /// Newton iterations.
    pub iterations: usize,
    /// Whether the residual is within the tolerance and the energy has a minimum there, not a saddle.
    pub settled: bool,
}

impl Cloth<'_> {
    /// Energy in J at `x`, and the sum of the absolute values of its parts, which tells how far rounding reaches.
    pub fn energy(&self, x: &[[f64; 3]]) -> (f64, f64) {
        let (mut energy, mut size) = (0.0, 0.0);
        for (s, &k) in self.springs.list().iter().zip(self.stiffness) {
            let part = k * Law::new(vector(x, s.a, s.b), s.rest_m, self.limit).energy;
            energy += part;
            size += part;
        }
        for &i in self.pattern.free() {
            let part = dot(self.weight_n, x[i]);
            energy -= part;
            size += part.abs();
        }
        (energy, size)
    }

    /// Gradient of the energy in N with respect to the free particles, 3 numbers each, and its largest component.
    pub fn gradient(&self, x: &[[f64; 3]]) -> (Vec<f64>, f64) {
        let mut all = vec![self.weight_n.map(|w| -w); x.len()];
        for (s, &k) in self.springs.list().iter().zip(self.stiffness) {
            let d = vector(x, s.a, s.b);
            let factor = k * Law::new(d, s.rest_m, self.limit).factor;
            for c in 0..3 {
                all[s.a][c] -= factor * d[c];
                all[s.b][c] += factor * d[c];
            }
        }
        let gradient: Vec<f64> = self.pattern.free().iter().flat_map(|&i| all[i]).collect();
        // A number that is not finite must not be lost in the maximum.
        let larger = |most: f64, g: &f64| {
            if g.is_nan() { f64::INFINITY } else { most.max(g.abs()) }
        };
        let largest = gradient.iter().fold(0.0, larger);
        (gradient, largest)
    }

    /// Moves the free particles of `x` (m) to a minimum of the energy, where no component of the force on a particle is
    /// larger than `tolerance_n`. Damped Newton iterations: the exact Hessian where it is positive definite, else with a
    /// shift that adapts; steps are clipped to a tenth of the sheet and must lower the energy.
    pub fn settle(&self, x: &mut [[f64; 3]], tolerance_n: f64, most_iterations: usize) -> Outcome {
        let mut hessian = Hessian::new(self.pattern);
        let mut here = self.place(x.to_vec());
        let mut shift = 1e-3;
        // Whether the Hessian was positive definite where it was last looked at.
        let mut minimum = false;
        let mut kicks = 0;
        let mut iterations = 0;
        while iterations < most_iterations {
            // One step at least, so that a small change of the field is not lost in the tolerance.
            if here.residual <= tolerance_n && iterations > 0 {
                minimum = minimum || self.factorise_shifted(&mut hessian, &here.x, TINY);
                if minimum || kicks == 3 {
                    break;
                }
                // A saddle: leave it by a small push out of the plane, the same in every run.
                kicks += 1;
                self.kick(&mut here.x, kicks);
                here = self.place(here.x);
            }
            iterations += 1;
            let Some(used) = self.factorise(&mut hessian, &here.x, shift) else {
                break;
            };
            minimum = used == TINY;
            let mut step: Vec<f64> = here.gradient.iter().map(|g| -g).collect();
            hessian.solve(&mut step);
            let (halvings, clipped, next) = self.search(&here, &step, minimum);
            match next {
                Some(next) => here = next,
                // Even the smallest step along the exact Newton direction gains nothing: rounding.
                None if minimum => break,
                None => {}
            }
            if !minimum {
                shift = match halvings {
                    0 if !clipped => (0.1 * used).max(1e-7),
                    0 | 1 => used,
                    _ => 4.0 * used,
                };
            }
        }
        let settled = here.residual <= tolerance_n && minimum;
        if settled {
            // The factor at hand is that of a place nearby: further steps with it are cheap, and the gradient is as exact
            // as the shape is.
            for _ in 0..3 {
                let mut step: Vec<f64> = here.gradient.iter().map(|g| -g).collect();
                hessian.solve(&mut step);
                let next = self.place(self.moved(&here.x, &step, 1.0));
                if next.residual >= here.residual {
                    break;
                }
                here = next;
            }
        }
        x.copy_from_slice(&here.x);
        Outcome { residual_n: here.residual, iterations, settled }
    }

    /// The free particles of `x` moved by `length` times `step`.
    fn moved(&self, x: &[[f64; 3]], step: &[f64], length: f64) -> Vec<[f64; 3]> {
        let mut x = x.to_vec();
        for (step, &i) in step.chunks_exact(3).zip(self.pattern.free()) {
            for (x, s) in x[i].iter_mut().zip(step) {
                *x += length * s;
            }
        }
        x
    }

    fn place(&self, x: Vec<[f64; 3]>) -> Place {
        let (energy, size) = self.energy(&x);
        let (gradient, residual) = self.gradient(&x);
        Place { x, energy, size, gradient, residual }
    }

    /// Line search from `here` along `step`: the number of halvings, whether the step was clipped, and the place found.
    fn search(&self, here: &Place, step: &[f64], minimum: bool) -> (usize, bool, Option<Place>) {
        let longest_m = 0.1 * self.springs.width_m().max(self.springs.height_m());
        let slope: f64 = step.iter().zip(&here.gradient).map(|(s, g)| s * g).sum();
        let longest = step.chunks_exact(3).map(|s| s[0].hypot(s[1]).hypot(s[2])).fold(0.0, f64::max);
        let clipped = longest > longest_m;
        let mut length = if clipped { longest_m / longest } else { 1.0 };
        for halvings in 0..30 {
            let next = self.place(self.moved(&here.x, step, length));
            // Near the minimum the energy no longer resolves a step; the force does.
            let level = next.energy <= here.energy + 1e-13 * here.size && next.residual < here.residual;
            if (minimum && level) || next.energy <= here.energy + 1e-4 * length * slope {
                return (halvings, clipped, Some(next));
            }
            length *= 0.5;
        }
        (30, clipped, None)
    }

    /// Factorises the Hessian at `x` with the smallest shift (relative to its mean diagonal) of [`TINY`], `shift`, 8
    /// `shift`, ... that makes it positive definite, and returns it. None where the numbers are not finite.
    fn factorise(&self, hessian: &mut Hessian, x: &[[f64; 3]], shift: f64) -> Option<f64> {
        let mut next = TINY;
        while next < 1e3 {
            if self.factorise_shifted(hessian, x, next) {
                return Some(next);
            }
            next = if next == TINY { shift } else { 8.0 * next };
        }
        None
    }

    fn factorise_shifted(&self, hessian: &mut Hessian, x: &[[f64; 3]], shift: f64) -> bool {
        hessian.assemble(self.springs, self.stiffness, x, self.limit, shift >= LARGE);
        hessian.shift(shift * hessian.mean_diagonal());
        hessian.factorise()
    }

    /// Moves the free particles, mostly out of the plane, by up to 1e-3 of a cell.
    fn kick(&self, x: &mut [[f64; 3]], number: usize) {
        let size = 1e-3 * self.springs.rest_u_m().min(self.springs.rest_v_m());
        for &i in self.pattern.free() {
            let t = (i * 7 + number * 13) as f64;
            x[i][2] += size * (0.9 * t).sin();
            x[i][0] += 0.3 * size * (1.7 * t).sin();
        }
    }
}

/// A shape and what is known of it.
struct Place {
    x: Vec<[f64; 3]>,
    energy: f64,
    /// See [`Cloth::energy`].
    size: f64,
    gradient: Vec<f64>,
    /// Largest component of the gradient.
    residual: f64,
}

/// Relative shift from which on the compressive part of the springs is dropped instead: a shift that outweighs it would
/// also drown all that is soft.
const LARGE: f64 = 1e-2;

/// Shift of the exact Hessian relative to its mean diagonal: makes the free turn of a sheet on a single pin solvable, and
/// does not move the minimum.
pub(super) const TINY: f64 = 1e-11;

/// From particle `a` to particle `b`.
#[inline]
pub(super) fn vector(x: &[[f64; 3]], a: usize, b: usize) -> [f64; 3] {
    [x[b][0] - x[a][0], x[b][1] - x[a][1], x[b][2] - x[a][2]]
}

#[inline]
pub(super) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gradient_is_that_of_the_energy() {
        let springs = Springs::new(4, 3, 0.5, 1.0).unwrap();
        let pinned: Vec<bool> = (0..12).map(|i| i == 0 || i == 2).collect();
        let pattern = Pattern::new(&springs, &pinned).unwrap();
        let stiffness: Vec<f64> = (0..springs.list().len()).map(|j| 10.0 + j as f64).collect();
        let weight_n = [0.1, -0.5, 0.2];
        let cloth = Cloth { springs: &springs, pattern: &pattern, stiffness: &stiffness, weight_n, limit: true };
        let bent = |i: usize| springs.hung_flat(i).map(|x| 1.1 * x + 0.05 * (3.0 * x + i as f64).sin());
        let x: Vec<[f64; 3]> = (0..12).map(bent).collect();
        let (gradient, largest) = cloth.gradient(&x);
        assert_eq!(largest, gradient.iter().fold(0.0, |m, g| g.abs().max(m)));
        for (j, g) in gradient.iter().enumerate() {
            let at = |h: f64| {
                let mut y = x.clone();
                y[pattern.free()[j / 3]][j % 3] += h;
                cloth.energy(&y).0
            };
            assert!(((at(1e-6) - at(-1e-6)) / 2e-6 - g).abs() < 1e-6);
        }
    }

    #[test]
    fn leaves_a_saddle() {
        // A chain of compressed springs stands upright, perfectly straight: at rest, but not for long.
        let springs = Springs::new(3, 2, 0.5, 1.0).unwrap();
        let pinned: Vec<bool> = (0..6).map(|i| i < 2).collect();
        let pattern = Pattern::new(&springs, &pinned).unwrap();
        let stiffness: Vec<f64> = springs.list().iter().map(|s| if s.channel == 3 { 0.0 } else { 100.0 }).collect();
        let weight_n = [0.0, -0.1, 0.0];
        let cloth = Cloth { springs: &springs, pattern: &pattern, stiffness: &stiffness, weight_n, limit: true };
        let mut x: Vec<[f64; 3]> = (0..6).map(|i| springs.hung_flat(i).map(|x| -x)).collect();
        let outcome = cloth.settle(&mut x, 1e-9, 300);
        assert!(outcome.settled, "{outcome:?}");
        assert!(x[4][1] < -0.9 && x[5][1] < -0.9, "{x:?}");
    }
}
