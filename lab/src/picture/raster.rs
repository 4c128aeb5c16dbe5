//! A z-buffered triangle rasteriser with 3 x 3 supersampling.
//!
//! Everything is plain f32 in a fixed order on one thread: the same triangles give the same pixels.

use super::color::Linear;

/// Samples per pixel along each axis.
pub const SAMPLES: usize = 3;

/// A corner of a triangle: pixel coordinates (x right, y down, depth larger = nearer) and what to interpolate.
#[derive(Debug, Clone, Copy)]
pub struct Vertex<const N: usize> {
    /// x and y in pixels from the top left corner, depth in any unit.
    pub screen: [f32; 3],
    /// Values interpolated linearly over the triangle (exact, since the projection is parallel).
    pub values: [f32; N],
}

/// Colour and depth samples of one view.
#[derive(Debug, Clone)]
pub struct Raster {
    width: usize,
    height: usize,
    /// Row-major samples; depth is -infinity where nothing was drawn.
    depth: Vec<f32>,
    color: Vec<Linear>,
}

impl Raster {
    /// An empty view of `width` x `height` pixels.
    pub fn new(width: usize, height: usize) -> Self {
        let samples = width * height * SAMPLES * SAMPLES;
        Self { width, height, depth: vec![f32::NEG_INFINITY; samples], color: vec![[0.0; 3]; samples] }
    }

    /// Width in pixels.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Height in pixels.
    pub fn height(&self) -> usize {
        self.height
    }

    /// Draws a triangle, seen from both sides; `shade` turns interpolated values into a colour.
    ///
    /// Shared edges are covered by both triangles, so that a mesh has no cracks; of equal depths the first stays.
    /// A triangle with a coordinate that is not finite, or without area, draws nothing.
    pub fn triangle<const N: usize>(&mut self, corners: [&Vertex<N>; 3], mut shade: impl FnMut(&[f32; N]) -> Linear) {
        let scale = SAMPLES as f32;
        let [a, b, c] = corners.map(|v| [v.screen[0] * scale, v.screen[1] * scale, v.screen[2]]);
        let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        if !area.is_finite() || area == 0.0 || !(a[2] + b[2] + c[2]).is_finite() {
            return;
        }
        let Some(xs) = span(a[0], b[0], c[0], self.width * SAMPLES) else {
            return;
        };
        let Some(ys) = span(a[1], b[1], c[1], self.height * SAMPLES) else {
            return;
        };
        let inverse = 1.0 / area;
        for y in ys {
            let py = y as f32 + 0.5;
            for x in xs.clone() {
                let px = x as f32 + 0.5;
                let wa = ((b[0] - px) * (c[1] - py) - (b[1] - py) * (c[0] - px)) * inverse;
                let wb = ((c[0] - px) * (a[1] - py) - (c[1] - py) * (a[0] - px)) * inverse;
                let wc = 1.0 - wa - wb;
                if wa < 0.0 || wb < 0.0 || wc < 0.0 {
                    continue;
                }
                let depth = wa * a[2] + wb * b[2] + wc * c[2];
                let sample = y * self.width * SAMPLES + x;
                if depth > self.depth[sample] {
                    self.depth[sample] = depth;
                    let values = std::array::from_fn(|i| {
                        wa * corners[0].values[i] + wb * corners[1].values[i] + wc * corners[2].values[i]
                    });
                    self.color[sample] = shade(&values);
                }
            }
        }
    }

    /// The pixel's mean colour over its covered samples and the share of them that is covered, in [0, 1].
    pub fn pixel(&self, x: usize, y: usize) -> (Linear, f32) {
        let mut sum = [0.0; 3];
        let mut covered = 0.0;
        for row in 0..SAMPLES {
            let first = (y * SAMPLES + row) * self.width * SAMPLES + x * SAMPLES;
            for sample in first..first + SAMPLES {
                if self.depth[sample] > f32::NEG_INFINITY {
                    covered += 1.0;
                    for (total, value) in sum.iter_mut().zip(self.color[sample]) {
                        *total += value;
                    }
                }
            }
        }
        if covered == 0.0 {
            return ([0.0; 3], 0.0);
        }
        (sum.map(|total| total / covered), covered / (SAMPLES * SAMPLES) as f32)
    }
}

/// The samples whose middle may lie between three coordinates, cut to `0..limit`; none when they miss the view.
fn span(a: f32, b: f32, c: f32, limit: usize) -> Option<std::ops::Range<usize>> {
    let low = a.min(b).min(c).floor().max(0.0);
    let high = a.max(b).max(c).ceil().min(limit as f32);
    (low < high).then_some(low as usize..high as usize)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corner(x: f32, y: f32, depth: f32) -> Vertex<1> {
        Vertex { screen: [x, y, depth], values: [x] }
    }

    #[test]
    fn covers_what_it_should_and_the_nearer_wins() {
        let mut raster = Raster::new(8, 8);
        let (a, b, c) = (corner(0.0, 0.0, 1.0), corner(8.0, 0.0, 1.0), corner(0.0, 8.0, 1.0));
        raster.triangle([&a, &b, &c], |_| [1.0, 0.0, 0.0]);
        let (d, e, f) = (corner(0.0, 0.0, 0.0), corner(8.0, 0.0, 0.0), corner(8.0, 8.0, 0.0));
        raster.triangle([&d, &e, &f], |_| [0.0, 1.0, 0.0]);
        assert_eq!(raster.pixel(1, 1), ([1.0, 0.0, 0.0], 1.0));
        assert_eq!(raster.pixel(7, 4), ([0.0, 1.0, 0.0], 1.0));
        assert_eq!(raster.pixel(4, 7).1, 0.0);
        // The first triangle's slanted edge runs through this pixel and nothing lies behind it.
        assert!(raster.pixel(3, 4).1 > 0.3 && raster.pixel(3, 4).1 < 0.8);
    }

    #[test]
    fn interpolates_linearly() {
        let mut raster = Raster::new(8, 8);
        let (a, b, c) = (corner(0.0, 0.0, 1.0), corner(8.0, 0.0, 1.0), corner(0.0, 8.0, 1.0));
        raster.triangle([&a, &b, &c], |values| [values[0] / 8.0; 3]);
        assert!((raster.pixel(2, 2).0[0] - 2.5 / 8.0).abs() < 1e-5);
    }

    #[test]
    fn degenerate_and_absurd_triangles_draw_nothing_or_stay_inside() {
        let mut raster = Raster::new(4, 4);
        let good = corner(0.0, 0.0, 0.0);
        for bad in [corner(f32::NAN, 0.0, 0.0), corner(f32::INFINITY, 1.0, 0.0), corner(3.0, 3.0, f32::NAN), good] {
            raster.triangle([&good, &bad, &corner(4.0, 0.0, 0.0)], |_| [1.0; 3]);
        }
        raster.triangle([&corner(-1e30, -1e30, 0.0), &corner(1e30, 0.0, 0.0), &corner(0.0, 1e30, 0.0)], |_| [1.0; 3]);
        assert_eq!(raster.pixel(2, 1).1, 0.0);
    }
}
