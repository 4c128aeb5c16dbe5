//! The soft shadow that a cloth casts on the wall behind it: it lifts the cloth off the background.

use super::raster::Raster;

/// How far the shadow lies to the right of and below the cloth, pixels.
const SHIFT: (usize, usize) = (9, 12);
/// Half the width of one blurring pass, pixels; two passes are made along each axis.
const BLUR: usize = 6;

/// Darkness of the shadow at every pixel of a view, in [0, 1], row by row.
pub fn cast(raster: &Raster) -> Vec<f32> {
    let (width, height) = (raster.width(), raster.height());
    let mut shade = vec![0.0; width * height];
    for y in SHIFT.1..height {
        for x in SHIFT.0..width {
            shade[y * width + x] = raster.pixel(x - SHIFT.0, y - SHIFT.1).1;
        }
    }
    for _ in 0..2 {
        blur_lines(&mut shade, height, width, width, 1);
        blur_lines(&mut shade, width, height, 1, width);
    }
    shade
}

/// Replaces every value by the mean of its neighbours along its line; nothing lies beyond the ends.
///
/// Line `l` has its entries at `l * line_step + i * step`, `i` in `0..length`.
fn blur_lines(values: &mut [f32], lines: usize, length: usize, line_step: usize, step: usize) {
    let mut sums = vec![0.0f32; length + 1];
    let share = 1.0 / (2 * BLUR + 1) as f32;
    for line in 0..lines {
        let at = |i: usize| line * line_step + i * step;
        for i in 0..length {
            sums[i + 1] = sums[i] + values[at(i)];
        }
        for i in 0..length {
            let window = sums[(i + BLUR + 1).min(length)] - sums[i.saturating_sub(BLUR)];
            values[at(i)] = (window * share).clamp(0.0, 1.0);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::raster::Vertex;
    use super::*;

    #[test]
    fn the_shadow_is_shifted_soft_and_as_dark_as_the_cloth_is_wide() {
        let mut raster = Raster::new(80, 80);
        let corner = |x: f32, y: f32| Vertex { screen: [x, y, 0.0], values: [] };
        let (a, b, c, d) = (corner(0.0, 0.0), corner(40.0, 0.0), corner(40.0, 40.0), corner(0.0, 40.0));
        raster.triangle([&a, &b, &c], |_| [1.0; 3]);
        raster.triangle([&a, &c, &d], |_| [1.0; 3]);
        let shade = cast(&raster);
        assert!((shade[32 * 80 + 29] - 1.0).abs() < 1e-4, "dark in the middle");
        assert_eq!(shade[79 * 80 + 79], 0.0);
        let edge = shade[32 * 80 + 49];
        assert!(edge > 0.3 && edge < 0.7, "soft at the edge: {edge}");
    }
}
