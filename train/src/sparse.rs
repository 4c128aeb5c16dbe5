//! Symmetric sparse matrices of 3 x 3 blocks, one row of blocks per free node, and their Cholesky factorisation.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymmetricOrdering, factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side, Spec};

/// A block: row of the first node, column of the second.
pub(crate) type Block = [[f64; 3]; 3];

/// What depends on which nodes are coupled and which are pinned, but on no number: made once, used for every solve.
#[derive(Debug)]
pub(crate) struct Pattern {
    /// Nodes that are not pinned, in order.
    free: Vec<usize>,
    /// Position of each node in `free`; `None` where pinned.
    slot: Vec<Option<usize>>,
    /// Lower triangle in compressed columns, 3 scalar columns per free node.
    column_start: Vec<usize>,
    row_index: Vec<usize>,
    /// For each free node the free nodes after it that it is coupled with.
    below: Vec<Vec<usize>>,
    cholesky: SymbolicCholesky<usize>,
}

/// Where a block of two free nodes lies. A block of a node with itself has its lower triangle only.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place {
    columns: [usize; 3],
    kind: Kind,
}

#[derive(Clone, Copy, Debug)]
enum Kind {
    Diagonal,
    Below,
    /// The first node comes before the second: the block lies there transposed.
    Above,
}

impl Pattern {
    /// The pattern of the nodes (one entry of `pinned` each) whose coupled pairs are given, each as often and in either
    /// order as it likes. `None` where every node is pinned or the factorisation cannot be prepared (out of memory).
    pub fn new(pinned: &[bool], pairs: impl IntoIterator<Item = [usize; 2]>) -> Option<Pattern> {
        let free: Vec<usize> = (0..pinned.len()).filter(|&i| !pinned[i]).collect();
        if free.is_empty() {
            return None;
        }
        let mut slot = vec![None; pinned.len()];
        for (f, &i) in free.iter().enumerate() {
            slot[i] = Some(f);
        }
        let mut below = vec![Vec::new(); free.len()];
        for [a, b] in pairs {
            if let (Some(a), Some(b)) = (slot[a], slot[b])
                && a != b
            {
                below[a.min(b)].push(a.max(b));
            }
        }
        for b in &mut below {
            b.sort_unstable();
            b.dedup();
        }
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
            // Blocks of columns pay from 8 x 8 nodes on.
            CholeskySymbolicParams {
                supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
                ..Default::default()
            },
        )
        .ok()?;
        Some(Pattern { free, slot, column_start, row_index, below, cholesky })
    }

    /// Nodes that are not pinned, in order: unknown 3 i + c is axis c of the i-th of them.
    pub fn free(&self) -> &[usize] {
        &self.free
    }

    /// Whether a node is pinned.
    pub fn is_pinned(&self, node: usize) -> bool {
        self.slot[node].is_none()
    }

    /// Number of scalar unknowns.
    pub fn unknowns(&self) -> usize {
        3 * self.free.len()
    }

    /// Where the block of two nodes lies; `None` where one of them is pinned or they are not coupled.
    pub fn place(&self, row: usize, column: usize) -> Option<Place> {
        let (a, b) = (self.slot[row]?, self.slot[column]?);
        let (first, last) = (a.min(b), a.max(b));
        if first == last {
            let columns = std::array::from_fn(|c| self.column_start[3 * first + c] - c);
            return Some(Place { columns, kind: Kind::Diagonal });
        }
        let rank = self.below[first].binary_search(&last).ok()?;
        let columns = std::array::from_fn(|c| self.column_start[3 * first + c] + (3 - c) + 3 * rank);
        Some(Place { columns, kind: if a == last { Kind::Below } else { Kind::Above } })
    }
}

/// Numbers in a [`Pattern`]: the matrix, its factor and the scratch memory, reused from one solve to the next.
pub(crate) struct Matrix {
    values: Vec<f64>,
    factor: Vec<f64>,
    memory: MemBuffer,
}

impl Matrix {
    /// All zero.
    pub fn new(pattern: &Pattern) -> Matrix {
        let c = &pattern.cholesky;
        let need = c
            .factorize_numeric_llt_scratch::<f64>(Par::Seq, Spec::default())
            .or(c.solve_in_place_scratch::<f64>(1, Par::Seq));
        Matrix {
            values: vec![0.0; pattern.row_index.len()],
            factor: vec![0.0; c.len_val()],
            memory: MemBuffer::new(need),
        }
    }

    /// Makes it zero.
    pub fn clear(&mut self) {
        self.values.fill(0.0);
    }

    /// Adds a block.
    #[inline]
    pub fn add(&mut self, place: Place, block: &Block) {
        for (c, &at) in place.columns.iter().enumerate() {
            match place.kind {
                Kind::Diagonal => (c..3).for_each(|r| self.values[at + r] += block[r][c]),
                Kind::Below => (0..3).for_each(|r| self.values[at + r] += block[r][c]),
                Kind::Above => (0..3).for_each(|r| self.values[at + r] += block[c][r]),
            }
        }
    }

    /// Mean of the diagonal: the scale of the matrix.
    pub fn mean_diagonal(&self, pattern: &Pattern) -> f64 {
        let starts = &pattern.column_start[..pattern.unknowns()];
        starts.iter().map(|&s| self.values[s]).sum::<f64>() / starts.len() as f64
    }

    /// Adds `shift` to the diagonal.
    pub fn shift(&mut self, pattern: &Pattern, shift: f64) {
        for &s in &pattern.column_start[..pattern.unknowns()] {
            self.values[s] += shift;
        }
    }

    /// Factorises; false where the matrix is not positive definite.
    pub fn factorise(&mut self, pattern: &Pattern) -> bool {
        let n = pattern.unknowns();
        let symbolic = SymbolicSparseColMatRef::new_checked(n, n, &pattern.column_start, None, &pattern.row_index);
        pattern
            .cholesky
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

    /// Solves with the last factor, which [`Matrix::factorise`] must have made, in place.
    pub fn solve(&mut self, pattern: &Pattern, right: &mut [f64]) {
        let n = right.len();
        LltRef::new(&pattern.cholesky, &self.factor).solve_in_place_with_conj(
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
    fn solves_what_was_added() {
        // a ring of 7 nodes, the third pinned; blocks k(a, b) as from a potential: b b^T with b of six numbers
        let mut pinned = [false; 7];
        pinned[2] = true;
        let pairs: Vec<[usize; 2]> = (0..7).map(|i| [i, (i + 1) % 7]).collect();
        let pattern = Pattern::new(&pinned, pairs.iter().copied()).unwrap();
        assert_eq!(pattern.free(), [0, 1, 3, 4, 5, 6]);
        assert!(pattern.is_pinned(2) && pattern.place(2, 3).is_none() && pattern.place(0, 4).is_none());
        let mut matrix = Matrix::new(&pattern);
        let mut dense = vec![vec![0.0; 21]; 21];
        let part = |i: usize, end: usize, c: usize| ((7 * i + 3 * end + c) as f64).sin();
        for (i, pair) in pairs.iter().enumerate() {
            // either order of a pair must do
            let ends = if i % 2 == 0 { [0, 1] } else { [1, 0] };
            for (e, f) in [(ends[0], ends[0]), (ends[1], ends[1]), (ends[0], ends[1])] {
                let block = std::array::from_fn(|r| std::array::from_fn(|c| part(i, e, r) * part(i, f, c)));
                if let Some(place) = pattern.place(pair[e], pair[f]) {
                    matrix.add(place, &block);
                }
            }
            for (e, f) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                for (r, c) in (0..9).map(|k| (k / 3, k % 3)) {
                    dense[3 * pair[e] + r][3 * pair[f] + c] += part(i, e, r) * part(i, f, c);
                }
            }
        }
        matrix.shift(&pattern, 0.5);
        (0..21).for_each(|i| dense[i][i] += 0.5);
        let trace: f64 = pattern.free().iter().flat_map(|i| 3 * i..3 * i + 3).map(|i| dense[i][i]).sum();
        assert!((matrix.mean_diagonal(&pattern) - trace / 18.0).abs() < 1e-12);
        assert!(matrix.factorise(&pattern));
        let right: Vec<f64> = (0..18).map(|i| (i as f64).cos()).collect();
        let mut y = right.clone();
        matrix.solve(&pattern, &mut y);
        for (i, &a) in pattern.free().iter().enumerate() {
            for r in 0..3 {
                let columns = pattern.free().iter().enumerate().flat_map(|(j, b)| (0..3).map(move |c| (j, *b, c)));
                let product: f64 = columns.map(|(j, b, c)| dense[3 * a + r][3 * b + c] * y[3 * j + c]).sum();
                assert!((product - right[3 * i + r]).abs() < 1e-9);
            }
        }
        matrix.shift(&pattern, -100.0);
        assert!(!matrix.factorise(&pattern));
        assert!(Pattern::new(&[true; 3], []).is_none());
    }
}
