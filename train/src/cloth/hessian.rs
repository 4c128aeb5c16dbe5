//! The sparse Hessian of the free particles: assembly and Cholesky factorisation.

use super::ClothError;
use super::law::Law;
use super::springs::Springs;
use crate::sparse::{self, Matrix, Place};

/// What depends on the grid and on which particles are pinned, but on no number: made once, used for every solve.
#[derive(Debug)]
pub(super) struct Pattern {
    blocks: sparse::Pattern,
    /// Of each particle with itself.
    diagonal: Vec<Option<Place>>,
    /// Of the two ends of each spring.
    across: Vec<Option<Place>>,
}

impl Pattern {
    /// The pattern for the given pins (one entry per particle). Errors: [`ClothError::Pins`], [`ClothError::Factorisation`].
    pub fn new(springs: &Springs, pinned: &[bool]) -> Result<Pattern, ClothError> {
        if pinned.iter().all(|p| *p == pinned[0]) {
            return Err(ClothError::Pins);
        }
        let blocks =
            sparse::Pattern::new(pinned, springs.list().iter().map(|s| [s.a, s.b])).ok_or(ClothError::Factorisation)?;
        let diagonal = (0..pinned.len()).map(|i| blocks.place(i, i)).collect();
        let across = springs.list().iter().map(|s| blocks.place(s.a, s.b)).collect();
        Ok(Pattern { blocks, diagonal, across })
    }

    /// Particles that are not pinned, in order.
    pub fn free(&self) -> &[usize] {
        self.blocks.free()
    }

    /// Whether a particle is pinned.
    pub fn is_pinned(&self, particle: usize) -> bool {
        self.blocks.is_pinned(particle)
    }
}

/// Numbers in a [`Pattern`], reused from one solve to the next.
pub(super) struct Hessian<'a> {
    pattern: &'a Pattern,
    matrix: Matrix,
}

impl<'a> Hessian<'a> {
    /// All zero.
    pub fn new(pattern: &'a Pattern) -> Hessian<'a> {
        Hessian { pattern, matrix: Matrix::new(&pattern.blocks) }
    }

    /// Fills in the second derivatives of the springs' energy at `x` (m, one entry per particle). `convex` takes the
    /// positive semidefinite part of every spring.
    pub fn assemble(&mut self, springs: &Springs, stiffness: &[f64], x: &[[f64; 3]], limit: bool, convex: bool) {
        let p = self.pattern;
        self.matrix.clear();
        for ((s, &k), &across) in springs.list().iter().zip(stiffness).zip(&p.across) {
            let (a, b) = (p.diagonal[s.a], p.diagonal[s.b]);
            if a.is_none() && b.is_none() {
                continue;
            }
            let d = std::array::from_fn(|c| x[s.b][c] - x[s.a][c]);
            let h = Law::new(d, s.rest_m, limit).hessian(convex).map(|h| k * h);
            let rows = [[h[0], h[1], h[2]], [h[1], h[3], h[4]], [h[2], h[4], h[5]]];
            for place in [a, b].into_iter().flatten() {
                self.matrix.add(place, &rows);
            }
            if let Some(place) = across {
                self.matrix.add(place, &rows.map(|row| row.map(|h| -h)));
            }
        }
    }

    /// Mean of the diagonal in N/m: the scale of the matrix.
    pub fn mean_diagonal(&self) -> f64 {
        self.matrix.mean_diagonal(&self.pattern.blocks)
    }

    /// Adds `shift` (N/m) to the diagonal.
    pub fn shift(&mut self, shift: f64) {
        self.matrix.shift(&self.pattern.blocks, shift);
    }

    /// Factorises; false where the matrix is not positive definite.
    pub fn factorise(&mut self) -> bool {
        self.matrix.factorise(&self.pattern.blocks)
    }

    /// Solves with the last factor, which [`Hessian::factorise`] must have made, in place.
    pub fn solve(&mut self, right: &mut [f64]) {
        self.matrix.solve(&self.pattern.blocks, right);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solves_what_it_assembles() {
        let springs = Springs::new(4, 5, 1.0, 1.0).unwrap();
        let mut pinned = vec![false; 20];
        pinned[0] = true;
        pinned[4] = true;
        let pattern = Pattern::new(&springs, &pinned).unwrap();
        let mut hessian = Hessian::new(&pattern);
        let x: Vec<[f64; 3]> = (0..20)
            .map(|i| {
                let [u, v, _] = springs.hung_flat(i);
                [1.1 * u, 1.2 * v, 0.02 * ((i * i) as f64).sin()]
            })
            .collect();
        let k: Vec<f64> = springs.list().iter().enumerate().map(|(j, _)| 100.0 + j as f64).collect();
        hessian.assemble(&springs, &k, &x, true, true);
        hessian.shift(1.0);
        assert!(hessian.factorise());
        let right: Vec<f64> = (0..54).map(|i| (i as f64).cos()).collect();
        let mut y = right.clone();
        hessian.solve(&mut y);
        // The product, spring by spring.
        let mut back: Vec<f64> = y.clone();
        let slot = |i: usize| pattern.free().iter().position(|f| *f == i);
        let at = |i: usize, c: usize| slot(i).map_or(0.0, |f| y[3 * f + c]);
        for (s, k) in springs.list().iter().zip(&k) {
            let d = std::array::from_fn(|c| x[s.b][c] - x[s.a][c]);
            let h = Law::new(d, s.rest_m, true).hessian(true);
            let rows = [[h[0], h[1], h[2]], [h[1], h[3], h[4]], [h[2], h[4], h[5]]];
            for c in 0..3 {
                let force: f64 = (0..3).map(|e| k * rows[c][e] * (at(s.b, e) - at(s.a, e))).sum();
                if let Some(f) = slot(s.b) {
                    back[3 * f + c] += force;
                }
                if let Some(f) = slot(s.a) {
                    back[3 * f + c] -= force;
                }
            }
        }
        assert!(back.iter().zip(&right).all(|(a, b)| (a - b).abs() < 1e-9));
        hessian.shift(-2000.0);
        assert!(!hessian.factorise());
    }

    #[test]
    fn wants_pinned_and_free_particles() {
        let springs = Springs::new(2, 2, 1.0, 1.0).unwrap();
        assert_eq!(Pattern::new(&springs, &[false; 4]).unwrap_err(), ClothError::Pins);
        assert_eq!(Pattern::new(&springs, &[true; 4]).unwrap_err(), ClothError::Pins);
    }
}
