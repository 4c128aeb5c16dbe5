//! Preconditioned conjugate gradients (Hestenes and Stiefel 1952) with a fixed number of iterations.
//!
//! Sums over the particles have one order at every width of vector: in each row 16 lanes of f32 (lane = column modulo 16)
//! for x, y and z one after the other, added to 16 lanes of f64 after the row, and those to one number by a tree.

use super::apply::apply_row;
use super::coarse;
use super::operator::Linear;
use crate::force::{Planes, View};
use crate::layout::{Layout, span};
use crate::simd::{self, Pass, Three, Vector};
use crate::width::Supported;

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
    pub width: Supported,
    pub l: &'a Layout,
    /// The shape of the linearisation.
    pub x: View<'a>,
    pub linear: &'a Linear<'b>,
    /// Inverse diagonal blocks.
    pub blocks: [&'a [f32]; 6],
    /// Whether nothing holds the sheet.
    pub floating: bool,
}

#[inline(always)]
fn pairs<'a>(a: View<'a>, b: View<'a>) -> [(&'a [f32], &'a [f32]); 3] {
    [(a.x, b.x), (a.y, b.y), (a.z, b.z)]
}

/// a / b, 0 where that is not a positive number: a residual of exactly 0 has nothing left to do.
fn ratio(a: f64, b: f64) -> f32 {
    let q = (a / b) as f32;
    if q > 0.0 && q < f32::INFINITY { q } else { 0.0 }
}

/// What the iterations need of the memory.
pub(super) struct Work<'p, 'a> {
    pub change: &'p mut Planes<'a>,
    pub residual: &'p mut Planes<'a>,
    pub search: &'p mut Planes<'a>,
    pub image: &'p mut Planes<'a>,
    pub levels: &'p mut [f32],
    /// Scratch, [`Layout::carry`].
    pub carry: &'p mut [f32],
}

/// image = A search, after the search has taken the preconditioned residual, in `image`, on: that plus `share` times what it
/// was. Answers with the sum of search.image.
pub(super) struct Image<'p, 'a, 'b> {
    pub l: &'p Layout,
    pub x: View<'p>,
    pub linear: &'p Linear<'b>,
    /// None: the search stays as it is.
    pub share: Option<f32>,
    pub search: &'p mut Planes<'a>,
    pub image: &'p mut Planes<'a>,
    pub carry: &'p mut [f32],
}

impl Pass for Image<'_, '_, '_> {
    type Output = f64;

    #[inline(always)]
    fn run<V: Vector>(self, zero: V) -> f64 {
        let (l, mut sum) = (self.l, Sum::new());
        self.carry.fill(0.0);
        // the directions are two rows ahead of the operator, which reads them
        for row in 0..l.rows + 2 {
            if row < l.rows
                && let Some(share) = self.share
            {
                let factor = zero.all(share);
                for column in (0..l.width).step_by(V::LANES) {
                    let at = l.at(row, column);
                    let mut p = Three::read(zero, axes(self.image.view()), at);
                    // the directions of an earlier solve are not multiplied by 0: they may be no numbers
                    if share > 0.0 {
                        p = p.plus(Three::read(zero, axes(self.search.view()), at).times(factor));
                    }
                    p.write([&mut *self.search.x, &mut *self.search.y, &mut *self.search.z], at);
                }
            }
            if row >= 2 {
                let search = self.search.view();
                apply_row(zero, l, row - 2, self.x, self.linear, search, self.image, self.carry);
                sum.add_row(l, row - 2, pairs(self.search.view(), self.image.view()));
            }
        }
        sum.total()
    }
}

/// Goes a way along the search, if any, and puts the residual, multiplied by the inverse blocks, into `image`.
struct Advance<'p, 'a> {
    l: &'p Layout,
    blocks: [&'p [f32]; 6],
    way: Option<f32>,
    change: &'p mut Planes<'a>,
    residual: &'p mut Planes<'a>,
    search: View<'p>,
    image: &'p mut Planes<'a>,
}

impl Pass for Advance<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self, zero: V) {
        let l = self.l;
        let [xx, yy, zz, xy, xz, yz] = self.blocks;
        for row in 0..l.rows {
            for column in (0..l.width).step_by(V::LANES) {
                let at = l.at(row, column);
                let mut r = Three::read(zero, axes(self.residual.view()), at);
                if let Some(way) = self.way {
                    let way = zero.all(way);
                    let p = Three::read(zero, axes(self.search), at);
                    let v = Three::read(zero, axes(self.change.view()), at).plus(p.times(way));
                    v.write([&mut *self.change.x, &mut *self.change.y, &mut *self.change.z], at);
                    r = r.minus(Three::read(zero, axes(self.image.view()), at).times(way));
                    r.write([&mut *self.residual.x, &mut *self.residual.y, &mut *self.residual.z], at);
                }
                let (a, b, c) = (zero.read(xx, at), zero.read(yy, at), zero.read(zz, at));
                let (d, e, f) = (zero.read(xy, at), zero.read(xz, at), zero.read(yz, at));
                let Three([x, y, z]) = r;
                let z = Three([a * x + d * y + e * z, d * x + b * y + f * z, e * x + f * y + c * z]);
                z.write([&mut *self.image.x, &mut *self.image.y, &mut *self.image.z], at);
            }
        }
    }
}

/// Takes the way of the centre of mass off z, 0 where nothing is free. Answers with the sum of r.z.
struct Finish<'p, 'a> {
    l: &'p Layout,
    free: &'p [f32],
    centre: [f32; 3],
    residual: View<'p>,
    z: &'p mut Planes<'a>,
}

impl Pass for Finish<'_, '_> {
    type Output = f64;

    #[inline(always)]
    fn run<V: Vector>(self, zero: V) -> f64 {
        let (l, mut sum) = (self.l, Sum::new());
        let [x, y, z] = self.centre;
        let centre = Three([zero.all(x), zero.all(y), zero.all(z)]);
        for row in 0..l.rows {
            for column in (0..l.width).step_by(V::LANES) {
                let at = l.at(row, column);
                let z = Three::read(zero, axes(self.z.view()), at).minus(centre).times(zero.read(self.free, at));
                z.write([&mut *self.z.x, &mut *self.z.y, &mut *self.z.z], at);
            }
            sum.add_row(l, row, pairs(self.residual, self.z.view()));
        }
        sum.total()
    }
}

#[inline(always)]
fn axes(view: View<'_>) -> [&[f32]; 3] {
    [view.x, view.y, view.z]
}

impl System<'_, '_> {
    /// Adds to the change what `iterations` find: A change = residual. The residual is used up; `image` holds the
    /// preconditioned residual or A search, whichever is needed next.
    pub fn solve(&self, iterations: u32, work: &mut Work<'_, '_>) {
        if self.floating {
            self.carry(work.change, work.residual);
        }
        let (mut energy, mut share) = (self.advance(None, work), 0.0);
        for _ in 0..iterations {
            let image = Image {
                l: self.l,
                x: self.x,
                linear: self.linear,
                share: Some(share),
                search: work.search,
                image: work.image,
                carry: work.carry,
            };
            let way = ratio(energy, simd::run(self.width, image));
            let next = self.advance(Some(way), work);
            share = ratio(next, energy);
            energy = next;
        }
    }

    /// Goes a way along the search; then z, in `image`, is the preconditioned residual. Answers with the sum of r.z.
    fn advance(&self, way: Option<f32>, work: &mut Work<'_, '_>) -> f64 {
        let Work { change, residual, search, image, levels, .. } = work;
        let (l, blocks) = (self.l, self.blocks);
        let advance = Advance { l, blocks, way, change, residual, search: search.view(), image };
        simd::run(self.width, advance);
        let r = residual.view();
        coarse::add(self.width, l, axes(r), [&mut *image.x, &mut *image.y, &mut *image.z], levels);
        let centre = if self.floating { self.centre(image.view()) } else { [0.0; 3] };
        simd::run(self.width, Finish { l, free: self.linear.free, centre, residual: r, z: image })
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
}
