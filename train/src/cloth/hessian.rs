//! The sparse Hessian of the free particles: pattern, assembly and Cholesky factorisation.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymmetricOrdering, factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side, Spec};

use super::ClothError;
use super::law::Law;
use super::springs::Springs;

/// What depends on the grid and on which particles are pinned, but on no number: made once, used for every solve.
#[derive(Debug)]
pub(super) struct Pattern {
    /// Particles that are not pinned, in order.
    pub free: Vec<usize>,
    /// Position of each particle in `free`; `None` where pinned.
    slot: Vec<Option<usize>>,
    /// Lower triangle in compressed columns, 3 scalar columns per free particle.
    column_start: Vec<usize>,
    row_index: Vec<usize>,
    /// For each spring whose two ends are free, the rank of its 3 x 3 block below the diagonal block in its column.
    rank: Vec<usize>,
    cholesky: SymbolicCholesky<usize>,
}

impl Pattern {
    /// The pattern for the given pins (one entry per particle). Errors: [`ClothError::Pins`], [`ClothError::Factorisation`].
    pub fn new(springs: &Springs, pinned: &[bool]) -> Result<Pattern, ClothError> {
        let free: Vec<usize> = (0..pinned.len()).filter(|&i| !pinned[i]).collect();
        if free.is_empty() || free.len() == pinned.len() {
            return Err(ClothError::Pins);
        }
        let mut slot = vec![None; pinned.len()];
        for (f, &i) in free.iter().enumerate() {
            slot[i] = Some(f);
        }
        // Free neighbours with a larger index; a pair of particles has at most one spring.
        let mut below = vec![Vec::new(); free.len()];
        for s in springs.list() {
            if let (Some(a), Some(b)) = (slot[s.a], slot[s.b]) {
                below[a].push(b);
            }
        }
        below.iter_mut().for_each(|b| b.sort_unstable());
        let rank = springs
            .list()
            .iter()
            .map(|s| match (slot[s.a], slot[s.b]) {
                (Some(a), Some(b)) => below[a].partition_point(|&x| x < b),
                _ => 0,
            })
            .collect();
        let mut column_start = vec![0];
        let mut row_index = Vec::new();
        for (f, below) in below.iter().enumerate() {
            for axis in 0..3 {
                row_index.extend((axis..3).map(|r| 3 * f + r));
                row_index.extend(below.iter().flat_map(|&b| (0..3).map(move |r| 3 * b + r)));
                column_start.push(row_index.len());
            }
        }
        let n = 3 * free.len();
        let cholesky = factorize_symbolic_cholesky(
            SymbolicSparseColMatRef::new_checked(n, n, &column_start, None, &row_index),
            Side::Lower,
            SymmetricOrdering::Amd,
            // Blocks of columns pay from 8 x 8 particles on.
            CholeskySymbolicParams {
                supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
                ..Default::default()
            },
        )
        .map_err(|_| ClothError::Factorisation)?;
        Ok(Pattern { free, slot, column_start, row_index, rank, cholesky })
    }

    /// Whether a particle is pinned.
    pub fn is_pinned(&self, particle: usize) -> bool {
        self.slot[particle].is_none()
    }

    /// Number of scalar unknowns.
    pub fn unknowns(&self) -> usize {
        3 * self.free.len()
    }
}

/// Numbers in a [`Pattern`]: the matrix, its factor and the scratch memory, reused from one solve to the next.
pub(super) struct Hessian<'a> {
    pattern: &'a Pattern,
    values: Vec<f64>,
    factor: Vec<f64>,
    memory: MemBuffer,
}

impl<'a> Hessian<'a> {
    /// All zero.
    pub fn new(pattern: &'a Pattern) -> Hessian<'a> {
        let c = &pattern.cholesky;
        let need = c
            .factorize_numeric_llt_scratch::<f64>(Par::Seq, Spec::default())
            .or(c.solve_in_place_scratch::<f64>(1, Par::Seq));
        Hessian {
            pattern,
            values: vec![0.0; pattern.row_index.len()],
            factor: vec![0.0; c.len_val()],
            memory: MemBuffer::new(need),
        }
    }

    /// Fills in the second derivatives of the springs' energy at `x` (m, one entry per particle). `convex` takes the
    /// positive semidefinite part of every spring.
    pub fn assemble(&mut self, springs: &Springs, stiffness: &[f64], x: &[[f64; 3]], limit: bool, convex: bool) {
        let p = self.pattern;
        self.values.fill(0.0);
        for ((s, &k), &rank) in springs.list().iter().zip(stiffness).zip(&p.rank) {
            let (a, b) = (p.slot[s.a], p.slot[s.b]);
            if a.is_none() && b.is_none() {
                continue;
            }
            let d = std::array::from_fn(|c| x[s.b][c] - x[s.a][c]);
            let h = Law::new(d, s.rest_m, limit).hessian(convex).map(|h| k * h);
            for end in [a, b].into_iter().flatten() {
                let [c0, c1, c2] = [0, 1, 2].map(|axis| p.column_start[3 * end + axis]);
                self.values[c0] += h[0];
                self.values[c0 + 1] += h[1];
                self.values[c0 + 2] += h[2];
                self.values[c1] += h[3];
                self.values[c1 + 1] += h[4];
                self.values[c2] += h[5];
            }
            if let (Some(a), Some(_)) = (a, b) {
                let rows = [[h[0], h[1], h[2]], [h[1], h[3], h[4]], [h[2], h[4], h[5]]];
                for (axis, row) in rows.iter().enumerate() {
                    let at = p.column_start[3 * a + axis] + (3 - axis) + 3 * rank;
                    for (value, h) in self.values[at..at + 3].iter_mut().zip(row) {
                        *value = -h;
                    }
                }
            }
        }
    }

    /// Mean of the diagonal in N/m: the scale of the matrix.
    pub fn mean_diagonal(&self) -> f64 {
        let starts = &self.pattern.column_start[..self.pattern.unknowns()];
        starts.iter().map(|&s| self.values[s]).sum::<f64>() / starts.len() as f64
    }

    /// Adds `shift` (N/m) to the diagonal.
    pub fn shift(&mut self, shift: f64) {
        for &s in &self.pattern.column_start[..self.pattern.unknowns()] {
            self.values[s] += shift;
        }
    }

    /// Factorises; false where the matrix is not positive definite.
    pub fn factorise(&mut self) -> bool {
        let p = self.pattern;
        let n = p.unknowns();
        let symbolic = SymbolicSparseColMatRef::new_checked(n, n, &p.column_start, None, &p.row_index);
        p.cholesky
            .factorize_numeric_llt(
                &mut self.factor,
                SparseColMatRef::new(symbolic, &self.values),
                Side::Lower,
                LltRegularization::default(),
                Par::Seq,
                MemStack::new(&mut self.memory),
                Spec::default(),
            )
            .is_ok()
    }

    /// Solves with the last factor, which [`Hessian::factorise`] must have made, in place.
    pub fn solve(&mut self, right: &mut [f64]) {
        let n = right.len();
        LltRef::new(&self.pattern.cholesky, &self.factor).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(right, n, 1),
            Par::Seq,
            MemStack::new(&mut self.memory),
        );
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
        let at = |i: usize, c: usize| pattern.slot[i].map_or(0.0, |f| y[3 * f + c]);
        for (s, k) in springs.list().iter().zip(&k) {
            let d = std::array::from_fn(|c| x[s.b][c] - x[s.a][c]);
            let h = Law::new(d, s.rest_m, true).hessian(true);
            let rows = [[h[0], h[1], h[2]], [h[1], h[3], h[4]], [h[2], h[4], h[5]]];
            for c in 0..3 {
                let force: f64 = (0..3).map(|e| k * rows[c][e] * (at(s.b, e) - at(s.a, e))).sum();
                if let Some(f) = pattern.slot[s.b] {
                    back[3 * f + c] += force;
                }
                if let Some(f) = pattern.slot[s.a] {
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
