//! The implicit solvers: implicit Euler (Baraff and Witkin 1998) and BDF2, for the stiffness as it is at a game's step.
//!
//! Both solve, with v_bar and x_bar = what is known, and b = dt (Euler) or 2/3 dt (BDF2),
//!
//! ```text
//! v = v_bar + b (F(x) / M - c v),   x = x_bar + b v
//! Euler: v_bar = v_n,                    x_bar = x_n
//! BDF2:  v_bar = (4 v_n - v_(n-1)) / 3,  x_bar = (4 x_n - x_(n-1)) / 3
//! ```
//!
//! by two Newton steps ([`integrate`]). Each linearises the springs at x_g = x_bar + b v_g and solves
//! (M (1 + b c) + b^2 H(x_g)) dv = b F(x_g) - M ((1 + b c) v_g - v_bar), the first at x_g = x_n, the second where that
//! leads. H is made positive ([`operator`]), so the matrix is symmetric and positive definite, and a fixed number of
//! conjugate gradients ([`gradients`]) solves it, preconditioned by the inverses of its diagonal blocks ([`blocks`]) on the
//! grid and on ever coarser ones ([`coarse`]). Pins are at their place of the end of the substep in x_g, so their way is
//! in the right side; their rows are filtered out. Forces beside the springs (air, hinges, pulls) are explicit: they are
//! those of x_n in the first Newton step and of its result in the second.

mod apply;
mod blocks;
mod coarse;
mod gradients;
mod integrate;
mod operator;
#[cfg(test)]
mod tests;

use crate::Error;
use crate::force::Planes;
use crate::layout::{Layout, take};
use operator::Linear;

/// Numbers before the planes of the history: whether there is one, then spare ones.
const FLAGS: usize = 16;

/// The memory of the implicit solvers.
pub(crate) struct Implicit<'a> {
    history: &'a mut [f32],
    /// What of the history is state, which depends on the solver.
    state: usize,
    /// The change of the velocities that is solved for, in m/s.
    change: Planes<'a>,
    /// What is known of the velocities, v_bar / (1 + b c), in m/s.
    known: Planes<'a>,
    /// Residual in N s, direction of search in m/s, and the operator times it in N s.
    residual: Planes<'a>,
    search: Planes<'a>,
    image: Planes<'a>,
    linear: Linear<'a>,
    /// The inverses of the diagonal blocks in 1/kg: xx, yy, zz, xy, xz, yz.
    blocks: [&'a mut [f32]; 6],
    /// The levels of the preconditioner.
    coarse: &'a mut [f32],
}

fn planes<'a>(block: &mut &'a mut [f32], n: usize) -> Result<Planes<'a>, Error> {
    Ok(Planes { x: take(block, n)?, y: take(block, n)?, z: take(block, n)? })
}

impl<'a> Implicit<'a> {
    /// f32 numbers that they need.
    pub fn numbers(l: &Layout) -> usize {
        // history 6, known 3, change 3, residual 3, search 3, image 3, mass 1, free 1, blocks 6, two of each spring
        if l.implicit { FLAGS + (29 + 2 * l.spring_planes()) * l.plane + coarse::numbers(l) } else { 0 }
    }

    pub fn new(l: &Layout, block: &mut &'a mut [f32]) -> Result<Self, Error> {
        let n = if l.implicit { l.plane } else { 0 };
        let flags = if l.implicit { FLAGS } else { 0 };
        Ok(Implicit {
            history: take(block, flags + 6 * n)?,
            state: if l.bdf2 { flags + 6 * n } else { 0 },
            change: planes(block, n)?,
            known: planes(block, n)?,
            residual: planes(block, n)?,
            search: planes(block, n)?,
            image: planes(block, n)?,
            linear: Linear::new(l, n, block)?,
            blocks: [
                take(block, n)?,
                take(block, n)?,
                take(block, n)?,
                take(block, n)?,
                take(block, n)?,
                take(block, n)?,
            ],
            coarse: take(block, if l.implicit { coarse::numbers(l) } else { 0 })?,
        })
    }

    /// Forgets what was before: the next substep of BDF2 is one of implicit Euler.
    pub fn reset(&mut self) {
        self.history.fill(0.0);
    }

    fn has_history(&self) -> bool {
        self.history.first().is_some_and(|flag| *flag != 0.0)
    }

    /// What a snapshot must hold.
    pub fn state(&self) -> &[f32] {
        self.history.get(..self.state).unwrap_or(&[])
    }

    pub fn state_mut(&mut self) -> &mut [f32] {
        self.history.get_mut(..self.state).unwrap_or(&mut [])
    }
}
