//! The forward renderer of one cloth: splats of surface samples, soft in x, y and depth.
//!
//! The surface is sampled at `samples x samples` points (`upsample.rs`). A point carries the projected area of its patch
//! and spreads it with a cubic B-spline, 4 x 4 pixels wide. B-splines sum to one over the pixels, so that
//!
//! * coverage `c` of a pixel = number of layers of cloth over it, whatever the stretch, tilt and sampling;
//! * alpha = smoothstep(c), which keeps the area inside an outline (it is symmetric about 1/2) and ends flat at one layer;
//! * colour = mean of the colours of its points, weighted by area and by `exp(z / depth_softness)`: the nearest layer wins.
//!
//! picture = 2 alpha colour - 1 in `[-1, 1]`; the silhouette has colour 1.
//!
//! Light is wrapped ("half Lambert"): `ambient + (1 - ambient) ((1 + t) / 2)^2`, `t` = cosine between the light and the
//! normal of the side that faces the camera. The change of the facing side, where a patch is seen edge-on, is smoothed
//! over [`EDGE_ON`]. Everything is at least once continuously differentiable in the positions.
//! Where two layers end together, as at a fold, alpha rises twice as fast and the outline is wider by half a pixel or less.

use super::renderer::Renderer;
use super::upsample::Surface;
use super::{Channel, SIDE};

/// Cosine to the camera below which a patch counts as edge-on.
pub(super) const EDGE_ON: f64 = 0.03;
/// Area (m^2 per unit of u and v) below which a patch has no direction; a 1 m cloth has 1.
pub(super) const DEGENERATE: f64 = 1e-6;
/// Bound of `|z - nearest| / depth_softness` in the weights, so that they stay far from overflow and underflow.
const DEPTH_BOUND: f64 = 600.0;
/// Pixels around the picture, into which the splats of border points may fall.
const MARGIN: usize = 3;
/// Side of the buffers with their margins.
const STRIDE: usize = SIDE + 2 * MARGIN;

/// Sums of one pixel: coverage; and weighted by depth: coverage, shading, shaded checker.
pub(super) type Sums = [f64; 4];

/// Scratch memory of the forward pass of one cloth.
#[derive(Debug, Default)]
pub(super) struct Scratch {
    pub surface: Surface,
    /// `[STRIDE][STRIDE]`.
    pub sums: Vec<Sums>,
    /// The largest z of the particles, m: weights are relative to it. The picture does not depend on it, hence constant.
    pub nearest: f64,
}

/// One point of the surface, as the camera sees it.
pub(super) struct Point {
    /// Column and row of the first of the 4 x 4 pixels, in the buffer with margins.
    pub corner: usize,
    /// B-spline weights of the columns and rows, and their slopes by the position in pixels.
    pub wx: [f64; 4],
    pub wy: [f64; 4],
    pub dx: [f64; 4],
    pub dy: [f64; 4],
    /// Projected area in pixels.
    pub area: f64,
    /// Pixels of projected area per unit of `facing`.
    pub area_scale: f64,
    /// Weight by depth, and its slope by z.
    pub weight: f64,
    pub weight_slope: f64,
    /// Light, and its slope by the cosine.
    pub shade: f64,
    pub shade_slope: f64,
    /// Normal times area (not projected) per unit of u and v, towards the camera where the rest cloth faces it; m^2.
    pub normal: [f64; 3],
    /// Length of `normal`, smoothed at 0.
    pub length: f64,
    /// |normal_z|, smoothed at 0.
    pub facing: f64,
    /// normal . light
    pub lit: f64,
}

/// The cubic B-spline at the four pixels around a point a fraction `f` right of the second of them, and its slope by `f`.
fn bspline(f: f64) -> ([f64; 4], [f64; 4]) {
    let g = 1.0 - f;
    let (f2, g2) = (f * f, g * g);
    (
        [g2 * g / 6.0, (3.0 * f2 * f - 6.0 * f2 + 4.0) / 6.0, (3.0 * g2 * g - 6.0 * g2 + 4.0) / 6.0, f2 * f / 6.0],
        [-0.5 * g2, 1.5 * f2 - 2.0 * f, 2.0 * g - 1.5 * g2, 0.5 * f2],
    )
}

/// `a x b`
pub(super) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The three values of sample `i` of a row.
pub(super) fn triple(row: &[f64], i: usize) -> [f64; 3] {
    [row[i * 3], row[i * 3 + 1], row[i * 3 + 2]]
}

impl Renderer {
    /// Point `i` of the current row of the surface; none when it is outside the picture or not finite.
    #[inline(always)]
    pub(super) fn point(&self, surface: &Surface, nearest: f64, i: usize) -> Option<Point> {
        let [x, y, z] = triple(&surface.position, i);
        let camera = &self.config.camera;
        let px = (x - camera.left) * self.scale[0] - 0.5;
        let py = (camera.top - y) * self.scale[1] - 0.5;
        let inside = -2.0..(SIDE + 1) as f64;
        if !inside.contains(&px) || !inside.contains(&py) {
            return None;
        }
        // rows run downwards, so v x u, not u x v, points to the camera of a cloth at rest
        let normal = cross(triple(&surface.tangent_v, i), triple(&surface.tangent_u, i));
        let length2 = dot(normal, normal) + DEGENERATE * DEGENERATE;
        let length = length2.sqrt();
        let facing = (normal[2] * normal[2] + EDGE_ON * EDGE_ON * length2).sqrt();
        let lit = dot(normal, self.light);
        if !(facing + z).is_finite() {
            return None;
        }
        let samples = self.config.samples as f64;
        let area_scale = self.scale[0] * self.scale[1] / (samples * samples * (1.0 + EDGE_ON * EDGE_ON).sqrt());
        let half = 0.5 * (1.0 + normal[2] * lit / (facing * length));
        let depth = (z - nearest) / self.config.depth_softness_m;
        let weight = depth.clamp(-DEPTH_BOUND, DEPTH_BOUND).exp();
        let bounded = depth.abs() > DEPTH_BOUND;
        // truncation is floor here: with the margin added both are positive
        let (px, py) = (px + MARGIN as f64, py + MARGIN as f64);
        let (column, row) = (px as usize, py as usize);
        let (wx, dx) = bspline(px - column as f64);
        let (wy, dy) = bspline(py - row as f64);
        Some(Point {
            corner: (row - 1) * STRIDE + column - 1,
            wx,
            wy,
            dx,
            dy,
            area: area_scale * facing,
            area_scale,
            weight,
            weight_slope: if bounded { 0.0 } else { weight / self.config.depth_softness_m },
            shade: self.config.ambient + (1.0 - self.config.ambient) * half * half,
            shade_slope: (1.0 - self.config.ambient) * half,
            normal,
            length,
            facing,
            lit,
        })
    }

    /// Sums over the pixels of one cloth `[rows * columns * 3]`, into `scratch.sums`.
    pub(super) fn splat(&self, positions: &[f64], scratch: &mut Scratch) {
        let Scratch { surface, sums, nearest } = scratch;
        sums.clear();
        sums.resize(STRIDE * STRIDE, [0.0; 4]);
        *nearest =
            positions.iter().skip(2).step_by(3).filter(|z| z.is_finite()).fold(f64::NEG_INFINITY, |a, z| a.max(*z));
        surface.load(&self.axis_u, &self.axis_v, positions);
        let samples = self.config.samples;
        for (j, checker) in self.checker.chunks_exact(samples).enumerate() {
            surface.row(&self.axis_u, &self.axis_v, j);
            for (i, checker) in checker.iter().enumerate() {
                let Some(point) = self.point(surface, *nearest, i) else {
                    continue;
                };
                let near = point.area * point.weight;
                let lit = near * point.shade;
                let carried = [point.area, near, lit, lit * checker];
                for (k, wy) in point.wy.iter().enumerate() {
                    let start = point.corner + k * STRIDE;
                    for (sum, wx) in sums[start..start + 4].iter_mut().zip(point.wx) {
                        let w = wx * wy;
                        for (sum, carried) in sum.iter_mut().zip(carried) {
                            *sum += w * carried;
                        }
                    }
                }
            }
        }
    }

    /// The picture `[channel][row][column]` in `[-1, 1]` from the sums.
    pub(super) fn compose(&self, scratch: &Scratch, image: &mut [f64]) {
        for (channel, out) in self.config.channels.iter().zip(image.chunks_exact_mut(SIDE * SIDE)) {
            for (row, out) in out.chunks_exact_mut(SIDE).enumerate() {
                let sums = &scratch.sums[row_start(row)..row_start(row) + SIDE];
                for (out, sums) in out.iter_mut().zip(sums) {
                    let colour = match channel {
                        Channel::Silhouette => 1.0,
                        Channel::Shading => mean(sums[2], sums[1]),
                        Channel::Checker => mean(sums[3], sums[1]),
                    };
                    // the clamp only takes back what rounding may add
                    *out = (2.0 * alpha(sums[0]) * colour - 1.0).clamp(-1.0, 1.0);
                }
            }
        }
    }
}

/// Where the pixels of a row of the picture begin in the buffers with margins.
pub(super) fn row_start(row: usize) -> usize {
    (row + MARGIN) * STRIDE + MARGIN
}

/// Offset of the row below, in the buffers with margins; and their length.
pub(super) const fn buffer_stride() -> (usize, usize) {
    (STRIDE, STRIDE * STRIDE)
}

/// Weighted mean from its two sums; 0 where nothing was summed.
fn mean(sum: f64, weights: f64) -> f64 {
    if weights > 0.0 { sum / weights } else { 0.0 }
}

/// Smoothstep of the coverage.
pub(super) fn alpha(coverage: f64) -> f64 {
    let c = coverage.min(1.0);
    c * c * (3.0 - 2.0 * c)
}

/// Its slope.
pub(super) fn alpha_slope(coverage: f64) -> f64 {
    let c = coverage.min(1.0);
    6.0 * c * (1.0 - c)
}
