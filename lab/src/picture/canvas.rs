//! Flat drawing on the finished picture: boxes, lines, discs.

use image::{Rgb, RgbImage};

use super::color::Srgb;

/// A picture to draw on; everything outside of it is cut off.
#[derive(Debug, Clone)]
pub struct Canvas {
    image: RgbImage,
}

impl Canvas {
    /// A canvas filled with one colour.
    pub fn new(width: u32, height: u32, background: Srgb) -> Self {
        Self { image: RgbImage::from_pixel(width, height, Rgb(background)) }
    }

    /// Width and height in pixels.
    pub fn size(&self) -> (i32, i32) {
        (self.image.width() as i32, self.image.height() as i32)
    }

    /// The finished picture.
    pub fn into_image(self) -> RgbImage {
        self.image
    }

    /// Lays a colour over a pixel with opacity in [0, 1]; mixed in sRGB, which keeps the weight of thin type.
    pub fn blend(&mut self, x: i32, y: i32, color: Srgb, opacity: f32) {
        let (width, height) = self.size();
        if x < 0 || y < 0 || x >= width || y >= height || opacity <= 0.0 {
            return;
        }
        let pixel = self.image.get_pixel_mut(x as u32, y as u32);
        for (old, new) in pixel.0.iter_mut().zip(color) {
            let (a, b) = (f32::from(*old), f32::from(new));
            *old = (a + (b - a) * opacity.min(1.0) + 0.5) as u8;
        }
    }

    /// Fills a box.
    pub fn fill(&mut self, area: Area, color: Srgb) {
        for y in area.y..area.y.saturating_add(area.height) {
            for x in area.x..area.x.saturating_add(area.width) {
                self.blend(x, y, color, 1.0);
            }
        }
    }

    /// Draws the one-pixel border just inside a box.
    pub fn border(&mut self, area: Area, color: Srgb) {
        let Area { x, y, width, height } = area;
        self.fill(Area { x, y, width, height: 1 }, color);
        self.fill(Area { x, y: y + height - 1, width, height: 1 }, color);
        self.fill(Area { x, y, width: 1, height }, color);
        self.fill(Area { x: x + width - 1, y, width: 1, height }, color);
    }

    /// Draws a straight stroke `width` pixels wide with round ends and smooth edges, cut to `clip`.
    pub fn stroke(&mut self, from: [f32; 2], to: [f32; 2], width: f32, color: Srgb, opacity: f32, clip: Area) {
        if !(from[0] + from[1] + to[0] + to[1]).is_finite() {
            return;
        }
        let reach = 0.5 * width + 1.0;
        let along = [to[0] - from[0], to[1] - from[1]];
        let square = along[0] * along[0] + along[1] * along[1];
        for y in clip.rows(from[1].min(to[1]) - reach, from[1].max(to[1]) + reach) {
            for x in clip.columns(from[0].min(to[0]) - reach, from[0].max(to[0]) + reach) {
                let (dx, dy) = (x as f32 + 0.5 - from[0], y as f32 + 0.5 - from[1]);
                let t = if square > 0.0 { ((dx * along[0] + dy * along[1]) / square).clamp(0.0, 1.0) } else { 0.0 };
                let distance = (dx - t * along[0]).hypot(dy - t * along[1]);
                self.blend(x, y, color, opacity * (0.5 * width + 0.5 - distance).clamp(0.0, 1.0));
            }
        }
    }

    /// Draws a disc with a smooth edge, cut to `clip`.
    pub fn disc(&mut self, center: [f32; 2], radius: f32, color: Srgb, clip: Area) {
        self.stroke(center, center, 2.0 * radius, color, 1.0, clip);
    }

    /// Draws a dashed polyline: `dash` pixels drawn, as many left out, the pattern running on through the corners.
    pub fn dashes(&mut self, points: &[[f32; 2]], dash: f32, width: f32, color: Srgb, opacity: f32, clip: Area) {
        let mut travelled = 0.0f32;
        for pair in points.windows(2) {
            let (a, b) = (pair[0], pair[1]);
            let length = (b[0] - a[0]).hypot(b[1] - a[1]);
            // A segment far longer than the canvas would be millions of dashes, none of them to be seen.
            if !length.is_finite() || length > 1e5 || length == 0.0 {
                continue;
            }
            let at = |s: f32| [a[0] + (b[0] - a[0]) * s / length, a[1] + (b[1] - a[1]) * s / length];
            let mut s = 0.0;
            while s < length {
                let phase = (travelled + s) % (2.0 * dash);
                let rest = if phase < dash { dash - phase } else { 2.0 * dash - phase };
                // The floor on the step ends the loop when rounding leaves no rest.
                let end = (s + rest.max(0.01)).min(length);
                if phase < dash {
                    self.stroke(at(s), at(end), width, color, opacity, clip);
                }
                s = end;
            }
            travelled = (travelled + length) % (2.0 * dash);
        }
    }
}

/// A box of pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Area {
    /// Left edge.
    pub x: i32,
    /// Top edge.
    pub y: i32,
    /// Width, pixels.
    pub width: i32,
    /// Height, pixels.
    pub height: i32,
}

impl Area {
    fn columns(&self, low: f32, high: f32) -> std::ops::Range<i32> {
        // Casts saturate, so coordinates far outside are safe.
        (low.floor() as i32).max(self.x)..(high.ceil() as i32).min(self.x + self.width)
    }

    fn rows(&self, low: f32, high: f32) -> std::ops::Range<i32> {
        (low.floor() as i32).max(self.y)..(high.ceil() as i32).min(self.y + self.height)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const WHITE: Srgb = [255; 3];
    const BLACK: Srgb = [0; 3];
    const ALL: Area = Area { x: 0, y: 0, width: 20, height: 20 };

    fn colors(canvas: Canvas) -> impl Fn(u32, u32) -> Srgb {
        let image = canvas.into_image();
        move |x, y| image.get_pixel(x, y).0
    }

    #[test]
    fn nothing_is_drawn_outside_the_clip_or_the_canvas() {
        let mut canvas = Canvas::new(20, 20, WHITE);
        let clip = Area { x: 5, y: 5, width: 5, height: 5 };
        canvas.stroke([-1e9, 7.0], [1e9, 7.0], 3.0, BLACK, 1.0, clip);
        canvas.disc([f32::NAN, 1.0], 4.0, BLACK, ALL);
        canvas.fill(Area { x: 18, y: -3, width: 100, height: 4 }, BLACK);
        let color = colors(canvas);
        for y in 0..20 {
            for x in 0..20 {
                let inside = (5..10).contains(&x) && (5..10).contains(&y);
                let corner = x >= 18 && y == 0;
                assert!(inside || corner || color(x, y) == WHITE, "{x} {y}");
            }
        }
        assert_eq!(color(19, 0), BLACK);
    }

    #[test]
    fn dashes_leave_gaps_and_end() {
        let mut canvas = Canvas::new(20, 20, WHITE);
        canvas.dashes(&[[0.0, 5.5], [20.0, 5.5], [20.0, 5.5], [f32::INFINITY, 0.0]], 4.0, 1.0, BLACK, 1.0, ALL);
        let color = colors(canvas);
        assert_eq!(color(2, 5), BLACK);
        assert_eq!(color(6, 5), WHITE);
        assert_eq!(color(10, 5), BLACK);
    }
}
