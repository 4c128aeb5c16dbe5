//! Preconditioned conjugate gradients (Hestenes and Stiefel 1952) with a fixed number of iterations.
//!
//! Sums over the particles have one order at every width of vector: in each row 16 lanes of f32 (lane = column modulo 16)
//! for x, y and z one after the other, added to 16 lanes of f64 after the row, and those to one number by a tree.

use super::coarse;
use super::operator::{Linear, apply_row};
use crate::force::{Planes, View};
use crate::layout::{Layout, span};

/// The 16 lanes of a sum.
struct Sum([f64; 16]);

impl Sum {
    fn new() -> Sum {
        Sum([0.0; 16])
    }

    /// Adds a row of the products of some pairs of planes.
    #[inline(always)]
    fn add_row<const N: usize>(&mut self, l: &Layout, row: usize, pairs: [(&[f32], &[f32]); N]) {
        let at = l.row(row);
        let mut lanes = [0.0f32; 16];
        for (a, b) in pairs {
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
    /// Whether nothing holds the sheet.
    pub floating: bool,
}

fn pairs<'a>(a: View<'a>, b: View<'a>) -> [(&'a [f32], &'a [f32]); 3] {
    [(a.x, b.x), (a.y, b.y), (a.z, b.z)]
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
        levels: &mut [f32],
    ) {
        let l = self.l;
        if self.floating {
            self.carry(change, residual);
        }
        let (mut energy, mut share) = (self.precondition(residual.view(), image, levels), 0.0);
        for _ in 0..iterations {
            let mut sum = Sum::new();
            // the directions are two rows ahead of the operator, which reads them
            for row in 0..l.rows + 2 {
                if row < l.rows {
                    // the directions of an earlier solve are not multiplied by 0: they may be no numbers
                    each(l, row, image.view(), search, |z, p| if share > 0.0 { z + share * p } else { z });
                }
                if row >= 2 {
                    apply_row::<SHEAR, BEND>(l, row - 2, self.x, self.linear, search.view(), image);
                    sum.add_row(l, row - 2, pairs(search.view(), image.view()));
                }
            }
            let way = ratio(energy, sum.total());
            for row in 0..l.rows {
                each(l, row, search.view(), change, |p, v| v + way * p);
                each(l, row, image.view(), residual, |q, r| r - way * q);
            }
            let next = self.precondition(residual.view(), image, levels);
            share = ratio(next, energy);
            energy = next;
        }
    }

    /// z = the preconditioned residual, and the sum of r.z.
    fn precondition(&self, r: View<'_>, z: &mut Planes<'_>, levels: &mut [f32]) -> f64 {
        let (l, mut sum) = (self.l, Sum::new());
        for row in 0..l.rows {
            self.precondition_row(row, r, z);
        }
        coarse::add(l, [r.x, r.y, r.z], [&mut *z.x, &mut *z.y, &mut *z.z], levels);
        let centre = if self.floating { self.centre(z.view()) } else { [0.0; 3] };
        for row in 0..l.rows {
            let at = l.row(row);
            let free = span(self.linear.free, at, l.width);
            for (z, centre) in [&mut *z.x, &mut *z.y, &mut *z.z].into_iter().zip(centre) {
                for (z, free) in z.get_mut(at..at + l.width).unwrap_or(&mut []).iter_mut().zip(free) {
                    *z = free * (*z - centre);
                }
            }
            sum.add_row(l, row, pairs(r, z.view()));
        }
        sum.total()
    }

    /// The mean of a velocity, weighted by the masses of the operator.
    fn centre(&self, v: View<'_>) -> [f32; 3] {
        let (l, mass) = (self.l, &*self.linear.mass);
        let (mut sums, mut all) = ([Sum::new(), Sum::new(), Sum::new()], Sum::new());
        for row in 0..l.rows {
            for (sum, v) in sums.iter_mut().zip([v.x, v.y, v.z]) {
                sum.add_row(l, row, [(mass, v)]);
            }
            all.add_row(l, row, [(mass, &*self.linear.free)]);
        }
        let all = all.total();
        sums.map(|sum| if all > 0.0 { (sum.total() / all) as f32 } else { 0.0 })
    }

    /// Moves a sheet that nothing holds as a whole, so that what is left of the residual adds up to 0. Directions of
    /// search that leave the centre of mass alone ([`System::centre`]) keep it so: momentum is conserved, and a fall is
    /// exact, however few the iterations.
    fn carry(&self, change: &mut Planes<'_>, residual: &mut Planes<'_>) {
        let (l, mass, free) = (self.l, &*self.linear.mass, &*self.linear.free);
        let mut all = Sum::new();
        for row in 0..l.rows {
            all.add_row(l, row, [(mass, free)]);
        }
        let all = all.total();
        let axes = [
            (&mut *change.x, &mut *residual.x),
            (&mut *change.y, &mut *residual.y),
            (&mut *change.z, &mut *residual.z),
        ];
        for (change, residual) in axes {
            let mut sum = Sum::new();
            for row in 0..l.rows {
                sum.add_row(l, row, [(&*residual, free)]);
            }
            let way = if all > 0.0 { (sum.total() / all) as f32 } else { 0.0 };
            for row in 0..l.rows {
                let at = l.row(row);
                let to = change.get_mut(at..at + l.width).unwrap_or(&mut []).iter_mut();
                let to = to.zip(residual.get_mut(at..at + l.width).unwrap_or(&mut []));
                for ((change, residual), (mass, free)) in
                    to.zip(span(mass, at, l.width).iter().zip(span(free, at, l.width)))
                {
                    *change += way * free;
                    *residual -= way * mass;
                }
            }
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
