//! The gradient of the renderer: the exact vector-Jacobian product of `splat.rs`, written by hand.
//!
//! Treated as constant, without any error: the pixel a point falls into (the B-spline is twice continuously differentiable across
//! pixels) and the depth that weights are relative to (the picture does not depend on it). Treated as constant with an
//! error too small to see: the depth weight of a point more than 600 softnesses (12 m) behind the nearest particle, and the points
//! outside the picture (their splats do not reach it). Coverage above one layer has no slope in alpha, as in the forward pass.
//!
//! The forward pass is repeated instead of stored: it costs less than keeping every point of a batch in memory.

use super::renderer::Renderer;
use super::splat::{self, EDGE_ON, Point, Scratch, Sums, alpha, alpha_slope, cross, triple};
use super::upsample::Surface;
use super::{Channel, SIDE};

/// Scratch memory of the backward pass of one cloth.
#[derive(Debug, Default)]
pub(super) struct GradientScratch {
    forward: Scratch,
    /// d loss / d sums, with margins of zeros.
    by_sums: Vec<Sums>,
    /// Gradients by the surface.
    by_surface: Surface,
}

/// d loss / d what a point carries: see [`Point`].
struct ByPoint {
    area: f64,
    depth: f64,
    shade: f64,
    px: f64,
    py: f64,
}

impl Renderer {
    /// `by_image` (d loss / d picture) to `by_position` (d loss / d positions, overwritten).
    pub(super) fn vjp(
        &self,
        positions: &[f64],
        by_image: &[f64],
        scratch: &mut GradientScratch,
        by_position: &mut [f64],
    ) {
        let GradientScratch { forward, by_sums, by_surface } = scratch;
        self.splat(positions, forward);
        self.compose_adjoint(&forward.sums, by_image, by_sums);
        by_surface.clear(&self.axis_u, &self.axis_v);
        for (j, checker) in self.checker.chunks_exact(self.config.samples).enumerate() {
            forward.surface.row(&self.axis_u, &self.axis_v, j);
            for (i, checker) in checker.iter().enumerate() {
                let gradients = match self.point(&forward.surface, forward.nearest, i) {
                    Some(point) => {
                        let by_point = gather(&point, *checker, by_sums);
                        self.point_adjoint(&point, &by_point, &forward.surface, i)
                    }
                    None => [[0.0; 3]; 3],
                };
                let range = i * 3..i * 3 + 3;
                by_surface.position[range.clone()].copy_from_slice(&gradients[0]);
                by_surface.tangent_u[range.clone()].copy_from_slice(&gradients[1]);
                by_surface.tangent_v[range].copy_from_slice(&gradients[2]);
            }
            by_surface.row_adjoint(&self.axis_u, &self.axis_v, j);
        }
        by_position.fill(0.0);
        by_surface.load_adjoint(&self.axis_u, by_position);
    }

    /// Adjoint of `compose`.
    fn compose_adjoint(&self, sums: &[Sums], by_image: &[f64], by_sums: &mut Vec<Sums>) {
        by_sums.clear();
        by_sums.resize(splat::buffer_stride().1, [0.0; 4]);
        for (channel, by_image) in self.config.channels.iter().zip(by_image.chunks_exact(SIDE * SIDE)) {
            for (row, by_image) in by_image.chunks_exact(SIDE).enumerate() {
                let range = splat::row_start(row)..splat::row_start(row) + SIDE;
                for ((by, sums), g) in by_sums[range.clone()].iter_mut().zip(&sums[range]).zip(by_image) {
                    let [coverage, near, ..] = *sums;
                    // without weights there is no cloth, and alpha has no slope either
                    if near <= 0.0 {
                        continue;
                    }
                    let g = 2.0 * g;
                    let which = match channel {
                        Channel::Silhouette => {
                            by[0] += g * alpha_slope(coverage);
                            continue;
                        }
                        Channel::Shading => 2,
                        Channel::Checker => 3,
                    };
                    let colour = sums[which] / near;
                    let by_colour = g * alpha(coverage) / near;
                    by[0] += g * alpha_slope(coverage) * colour;
                    by[1] -= by_colour * colour;
                    by[which] += by_colour;
                }
            }
        }
    }

    /// Adjoint of `point`: gradients by position, tangent along u, tangent along v.
    #[inline(always)]
    fn point_adjoint(&self, point: &Point, by: &ByPoint, surface: &Surface, i: usize) -> [[f64; 3]; 3] {
        let Point { normal, length, facing, lit, .. } = *point;
        // cosine = normal_z lit / (facing length)
        let by_cosine = by.shade * point.shade_slope;
        let per = by_cosine / (facing * length);
        let cosine = normal[2] * lit / (facing * length);
        let by_lit = per * normal[2];
        let by_facing = by.area * point.area_scale - by_cosine * cosine / facing;
        // facing^2 = normal_z^2 + EDGE_ON^2 length^2
        let by_length = -by_cosine * cosine / length + by_facing * EDGE_ON * EDGE_ON * length / facing;
        let mut by_normal = [0.0; 3];
        for ((out, n), light) in by_normal.iter_mut().zip(normal).zip(self.light) {
            *out = by_length * n / length + by_lit * light;
        }
        by_normal[2] += per * lit + by_facing * normal[2] / facing;
        // normal = tangent_v x tangent_u
        let by_u = cross(by_normal, triple(&surface.tangent_v, i));
        let by_v = cross(triple(&surface.tangent_u, i), by_normal);
        [[by.px * self.scale[0], -by.py * self.scale[1], by.depth], by_u, by_v]
    }
}

/// Adjoint of the 4 x 4 splat of one point.
#[inline(always)]
fn gather(point: &Point, checker: f64, by_sums: &[Sums]) -> ByPoint {
    let stride = splat::buffer_stride().0;
    // of each of the four sums: the value under the splat, and its slopes by the place of the splat
    let (mut value, mut slope_x, mut slope_y) = ([0.0; 4], [0.0; 4], [0.0; 4]);
    for k in 0..4 {
        let start = point.corner + k * stride;
        let (mut along, mut along_slope) = ([0.0; 4], [0.0; 4]);
        for ((by, wx), dx) in by_sums[start..start + 4].iter().zip(point.wx).zip(point.dx) {
            for c in 0..4 {
                along[c] += wx * by[c];
                along_slope[c] += dx * by[c];
            }
        }
        for c in 0..4 {
            value[c] += point.wy[k] * along[c];
            slope_x[c] += point.wy[k] * along_slope[c];
            slope_y[c] += point.dy[k] * along[c];
        }
    }
    let Point { area, weight, shade, .. } = *point;
    // what the sums get is area * carried[c]
    let carried = [1.0, weight, weight * shade, weight * shade * checker];
    let total = |s: [f64; 4]| s[0] * carried[0] + s[1] * carried[1] + s[2] * carried[2] + s[3] * carried[3];
    let by_shade = value[2] + value[3] * checker;
    ByPoint {
        area: total(value),
        depth: area * point.weight_slope * (value[1] + shade * by_shade),
        shade: area * weight * by_shade,
        px: area * total(slope_x),
        py: area * total(slope_y),
    }
}
