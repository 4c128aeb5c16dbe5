//! Preconditioned conjugate gradients (Hestenes and Stiefel 1952) with a fixed number of iterations.
//!
//! Sums over the particles have one order at every width of vector: in each row 16 lanes of f32 (lane = column modulo 16)
//! for x, y and z one after the other, added to 16 lanes of f64 after the row, and those to one number by a tree.

use super::operator::{Linear, apply_row};
use crate::force::{Planes, View};
use crate::layout::{Layout, span};

/// The 16 lanes of a sum.
struct Sum([f64; 16]);

impl Sum {
    fn new() -> Sum {
        Sum([0.0; 16])
    }

    /// Adds a row of a.b.
    #[inline(always)]
    fn add_row(&mut self, l: &Layout, row: usize, a: View<'_>, b: View<'_>) {
        let at = l.row(row);
        let mut lanes = [0.0f32; 16];
        for (a, b) in [(a.x, b.x), (a.y, b.y), (a.z, b.z)] {
            let (a, b) = (span(a, at, l.width).as_chunks::<16>().0, span(b, at, l.width).as_chunks::<16>().0);
            for (a, b) in a.iter().zip(b) {
                for ((lane, a), b) in lanes.iter_mut().zip(a).zip(b) {
                    *lane += a * b;
                }
            }
        }
        for (sum, lane) in self.0.iter_mut().zip(lanes) {
            *sum += f64::from(lane);
        }
    }

    fn total(self) -> f64 {
        let [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p] = self.0;
        let low = ((a + b) + (c + d)) + ((e + f) + (g + h));
        let high = ((i + j) + (k + l)) + ((m + n) + (o + p));
        low + high
    }
}

/// What the iterations work on.
pub(super) struct System<'a, 'b> {
    pub l: &'a Layout,
    /// The shape of the linearisation.
    pub x: View<'a>,
    pub linear: &'a Linear<'b>,
    /// Inverse diagonal blocks.
    pub blocks: [&'a [f32]; 6],
}

/// a / b, 0 where that is not a positive number: a residual of exactly 0 has nothing left to do.
fn ratio(a: f64, b: f64) -> f32 {
    let q = (a / b) as f32;
    if q > 0.0 && q < f32::INFINITY { q } else { 0.0 }
}

impl System<'_, '_> {
    /// Adds to `change` what `iterations` find: A change = residual. The residual is used up; `image` holds the
    /// preconditioned residual or A search, whichever is needed next.
    pub fn solve<const SHEAR: bool, const BEND: bool>(
        &self,
        iterations: u32,
        change: &mut Planes<'_>,
        residual: &mut Planes<'_>,
        search: &mut Planes<'_>,
        image: &mut Planes<'_>,
        coarse: &mut [f32],
    ) {
        let l = self.l;
        let mut sum = Sum::new();
        self.precondition(residual.view(), image, coarse, &mut sum);
        let (mut energy, mut share) = (sum.total(), 0.0);
        for _ in 0..iterations {
            let mut sum = Sum::new();
            // the directions are two rows ahead of the operator, which reads them
            for row in 0..l.rows + 2 {
                if row < l.rows {
                    each(l, row, image.view(), search, |z, p| z + share * p);
                }
                if row >= 2 {
                    apply_row::<SHEAR, BEND>(l, row - 2, self.x, self.linear, search.view(), image);
                    sum.add_row(l, row - 2, search.view(), image.view());
                }
            }
            let way = ratio(energy, sum.total());
            let mut sum = Sum::new();
            for row in 0..l.rows {
                each(l, row, search.view(), change, |p, v| v + way * p);
                each(l, row, image.view(), residual, |q, r| r - way * q);
            }
            self.precondition(residual.view(), image, coarse, &mut sum);
            let next = sum.total();
            share = ratio(next, energy);
            energy = next;
        }
    }

    fn precondition(&self, r: View<'_>, z: &mut Planes<'_>, coarse: &mut [f32], sum: &mut Sum) {
        let l = self.l;
        for row in 0..l.rows {
            self.precondition_row(row, r, z);
        }
        if LEVELS.load(core::sync::atomic::Ordering::Relaxed) > 0 {
        super::coarse::add(l, [r.x, r.y, r.z], [&mut *z.x, &mut *z.y, &mut *z.z], coarse);
        }
        for row in 0..l.rows {
            let at = l.row(row);
            for z in [&mut *z.x, &mut *z.y, &mut *z.z] {
                for (z, free) in z.get_mut(at..at + l.width).unwrap_or(&mut []).iter_mut().zip(span(self.linear.free, at, l.width)) {
                    *z *= free;
                }
            }
            sum.add_row(l, row, r, z.view());
        }
    }

    /// One row of z = inverse blocks * r.
    #[inline(never)]
    fn precondition_row(&self, row: usize, r: View<'_>, z: &mut Planes<'_>) {
        let (at, n) = (self.l.row(row), self.l.width);
        let cut = |p| span(p, at, n);
        let [xx, yy, zz, xy, xz, yz] = self.blocks.map(cut);
        let (rx, ry, rz) = (cut(r.x), cut(r.y), cut(r.z));
        let [zx, zy, zz_out] = [&mut *z.x, &mut *z.y, &mut *z.z].map(|p| p.get_mut(at..at + n).unwrap_or(&mut []));
        let r = rx.iter().zip(ry).zip(rz);
        let outs = zx.iter_mut().zip(zy).zip(zz_out);
        let diagonal = xx.iter().zip(yy).zip(zz);
        let rest = xy.iter().zip(xz).zip(yz);
        for (((((x, y), z), ((a, b), c)), ((d, e), f)), ((rx, ry), rz)) in outs.zip(diagonal).zip(rest).zip(r) {
            *x = a * rx + d * ry + e * rz;
            *y = d * rx + b * ry + f * rz;
            *z = e * rx + f * ry + c * rz;
        }
    }
}

/// b = f(a, b) for one row of three planes.
#[inline(always)]
fn each(l: &Layout, row: usize, a: View<'_>, b: &mut Planes<'_>, f: impl Fn(f32, f32) -> f32) {
    let (at, n) = (l.row(row), l.width);
    for (a, b) in [(a.x, &mut *b.x), (a.y, &mut *b.y), (a.z, &mut *b.z)] {
        for (a, b) in span(a, at, n).iter().zip(b.get_mut(at..at + n).unwrap_or(&mut [])) {
            *b = f(*a, *b);
        }
    }
}

pub static LEVELS: core::sync::atomic::AtomicU32 = core::sync::atomic::AtomicU32::new(1);
