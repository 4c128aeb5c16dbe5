//! The operator of the conjugate gradients, A = M (1 + b c) + b^2 H, and the right side.
//!
//! A spring of stiffness k, length l and direction n has H = k (n n^T + a (1 - n n^T)), a = 1 - L0/l. Where it is
//! compressed a is negative and H indefinite; a is taken as 0 there (Choi and Ko 2002), which makes A positive definite for
//! every shape. With d = l n this is alpha + gamma d d^T, alpha = k a, gamma = (k - alpha) / l^2: two numbers a spring,
//! kept while the shape is; the vectors d come from the positions.

use crate::Error;
use crate::around::{Around3, LANES, Twelve};
use crate::force::{Planes, Springs, Substep, View};
use crate::layout::{Layout, take};
use crate::simd::{Pass, Three, Vector};

/// A spring shorter than this share of its rest length is linearised as if it had this length.
const SHORTEST: f32 = 1e-3;

/// Springs linearised at a shape. The planes are ordered as in [`Springs`]; those of a family that is off are empty.
pub(super) struct Linear<'a> {
    /// M (1 + b c) in kg, 0 for pinned ones and spare places.
    pub mass: &'a mut [f32],
    /// 1 for free particles, 0 for the others.
    pub free: &'a mut [f32],
    pub alpha: [&'a mut [f32]; 6],
    pub gamma: [&'a mut [f32]; 6],
}

impl<'a> Linear<'a> {
    pub fn new(l: &Layout, n: usize, block: &mut &'a mut [f32]) -> Result<Self, Error> {
        let six = |block: &mut &'a mut [f32]| -> Result<[&'a mut [f32]; 6], Error> {
            let (shear, bend) = (if l.shear { n } else { 0 }, if l.bend { n } else { 0 });
            Ok([
                take(block, n)?,
                take(block, n)?,
                take(block, shear)?,
                take(block, shear)?,
                take(block, bend)?,
                take(block, bend)?,
            ])
        };
        let (alpha, gamma) = (six(block)?, six(block)?);
        Ok(Linear { mass: take(block, n)?, free: take(block, n)?, alpha, gamma })
    }

    fn alphas(&self) -> [&[f32]; 6] {
        self.alpha.each_ref().map(|p| &**p)
    }

    fn gammas(&self) -> [&[f32]; 6] {
        self.gamma.each_ref().map(|p| &**p)
    }
}

/// Linearises the springs at the shape `x`. `alpha` becomes the force per vector d in N/m, negative where a spring pushes:
/// what [`Residual`] needs. [`Diagonal`] makes it that of the operator.
pub(super) struct Linearise<'p, 'a> {
    pub l: &'p Layout,
    pub c: &'p Substep,
    pub x: View<'p>,
    pub springs: &'p Springs<'a>,
    pub linear: &'p mut Linear<'a>,
}

impl Pass for Linearise<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self, zero: V) {
        let (l, c, k, s) = (self.l, self.c, self.springs, self.l.stride);
        let springs: [(&[f32], usize, f32); 6] = [
            (k.u, 1, c.rest_u),
            (k.v, s, c.rest_v),
            (k.right, s + 1, c.rest_diagonal),
            (k.left, s - 1, c.rest_diagonal),
            (k.bend_u, 2, 2.0 * c.rest_u),
            (k.bend_v, 2 * s, 2.0 * c.rest_v),
        ];
        let (one, floor) = (zero.all(1.0), zero.all(c.floor));
        for ((alpha, gamma), (k, to, rest)) in self.linear.alpha.iter_mut().zip(&mut self.linear.gamma).zip(springs) {
            if k.is_empty() {
                continue;
            }
            let least = zero.all(SHORTEST * rest * (SHORTEST * rest) + 1e-28);
            let rest = zero.all(rest);
            for row in 0..l.rows {
                let mut at = l.row(row);
                let end = at + l.width;
                while at < end {
                    let x = [self.x.x, self.x.y, self.x.z];
                    let d = Three::read(zero, x, at.wrapping_add(to)).minus(Three::read(zero, x, at));
                    let l2 = d.squared().max(least);
                    let factor = (one - rest / l2.sqrt()).max(floor);
                    let k = zero.read(k, at);
                    (k * factor).write(alpha, at);
                    (k * (one - factor.max(zero)) / l2).write(gamma, at);
                    at += V::LANES;
                }
            }
        }
    }
}

/// The right side b F - M (1 + b c) (v - known), known = v_bar / (1 + b c), for the shape x; 0 where nothing is free. `outer`
/// are the forces beside springs and weight, in N, none where they are empty.
pub(super) struct Residual<'p, 'a> {
    pub l: &'p Layout,
    pub b: f32,
    pub weight: [f32; 3],
    pub x: View<'p>,
    pub v: View<'p>,
    pub known: View<'p>,
    pub linear: &'p Linear<'a>,
    pub outer: [&'p [f32]; 3],
    pub residual: &'p mut Planes<'a>,
}

impl Pass for Residual<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self, zero: V) {
        let (l, linear) = (self.l, self.linear);
        let [wx, wy, wz] = self.weight;
        let (b, weight) = (zero.all(self.b), Three([zero.all(wx), zero.all(wy), zero.all(wz)]));
        let has_outer = !self.outer[0].is_empty();
        let Planes { x: rx, y: ry, z: rz } = self.residual;
        for row in 0..l.rows {
            for column in (0..l.width).step_by(LANES) {
                let at = l.at(row, column);
                let (x, alpha) = (Around3::new(self.x, at, l.stride), Twelve::new(linear.alphas(), at, l.stride));
                let (Some(x), Some(alpha)) = (x, alpha) else {
                    return;
                };
                let mut lane = 0;
                while lane < LANES {
                    let at = at.wrapping_add(lane);
                    let (x0, mut f) = (x.here(zero, lane), Three([zero; 3]));
                    macro_rules! spring {
                        ($($j:literal)*) => {$(
                            let d = x.other(zero, $j, lane).minus(x0);
                            f = f.plus(d.times(alpha.read(zero, $j, lane)));
                        )*};
                    }
                    spring!(1 2 3 4);
                    if alpha.shear.is_some() {
                        spring!(5 6 7 8);
                    }
                    if alpha.bend.is_some() {
                        spring!(9 10 11 12);
                    }
                    f = f.plus(weight);
                    if has_outer {
                        f = f.plus(Three::read(zero, self.outer, at));
                    }
                    let (m, free) = (zero.read(linear.mass, at), zero.read(linear.free, at));
                    let late = Three::read(zero, [self.v.x, self.v.y, self.v.z], at).minus(Three::read(
                        zero,
                        [self.known.x, self.known.y, self.known.z],
                        at,
                    ));
                    f.times(b).times(free).minus(late.times(m)).write([rx, ry, rz], at);
                    lane += V::LANES;
                }
            }
        }
    }
}

/// Makes alpha and gamma those of b^2 H, positive, and with them the diagonal blocks of A: xx, yy, zz, xy, xz, yz.
pub(super) struct Diagonal<'p, 'a> {
    pub l: &'p Layout,
    pub b: f32,
    pub x: View<'p>,
    pub linear: &'p mut Linear<'a>,
    pub blocks: &'p mut [&'a mut [f32]; 6],
}

impl Pass for Diagonal<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self, zero: V) {
        let (l, b2) = (self.l, zero.all(self.b * self.b));
        for row in 0..l.rows {
            for plane in self.linear.alpha.iter_mut().chain(&mut self.linear.gamma) {
                for column in (0..l.width).step_by(V::LANES) {
                    let at = l.at(row, column);
                    (zero.read(plane, at).max(zero) * b2).write(plane, at);
                }
            }
            // the springs of a row end in it or begin above
            for column in (0..l.width).step_by(LANES) {
                diagonal(zero, l.stride, l.at(row, column), self.x, self.linear, self.blocks);
            }
        }
    }
}

/// One block of the diagonal blocks, from a place on.
#[inline(always)]
fn diagonal<V: Vector>(
    zero: V,
    stride: usize,
    at: usize,
    x: View<'_>,
    linear: &Linear<'_>,
    blocks: &mut [&mut [f32]; 6],
) {
    let (x, alpha) = (Around3::new(x, at, stride), Twelve::new(linear.alphas(), at, stride));
    let (Some(x), Some(alpha), Some(gamma)) = (x, alpha, Twelve::new(linear.gammas(), at, stride)) else {
        return;
    };
    let mut lane = 0;
    while lane < LANES {
        let at = at.wrapping_add(lane);
        let x0 = x.here(zero, lane);
        // the products of equal axes, and those of different ones
        let (mut a, mut equal, mut mixed) = (zero.read(linear.mass, at), Three([zero; 3]), Three([zero; 3]));
        macro_rules! spring {
            ($($j:literal)*) => {$(
                let d = x.other(zero, $j, lane).minus(x0);
                let (Three([dx, dy, dz]), Three([gx, gy, gz])) = (d, d.times(gamma.read(zero, $j, lane)));
                a = a + alpha.read(zero, $j, lane);
                equal = equal.plus(Three([gx * dx, gy * dy, gz * dz]));
                mixed = mixed.plus(Three([gx * dy, gx * dz, gy * dz]));
            )*};
        }
        spring!(1 2 3 4);
        if alpha.shear.is_some() {
            spring!(5 6 7 8);
        }
        if alpha.bend.is_some() {
            spring!(9 10 11 12);
        }
        let [xx, yy, zz, xy, xz, yz] = blocks;
        equal.plus(Three([a, a, a])).write([xx, yy, zz], at);
        mixed.write([xy, xz, yz], at);
        lane += V::LANES;
    }
}
