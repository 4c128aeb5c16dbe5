//! The outline of what a view shows: the border of its covered pixels as smooth closed lines.

use super::raster::Raster;

/// Loops of fewer steps are specks, not cloth.
const SHORTEST: usize = 24;
/// Smoothing passes: enough to turn the pixel staircase into a line, few enough to keep corners.
const PASSES: usize = 8;
/// Of the smoothed points every so many are kept.
const STRIDE: usize = 4;

/// Steps right, down, left, up: each direction is the former one turned clockwise (y runs down).
const STEPS: [(isize, isize); 4] = [(1, 0), (0, 1), (-1, 0), (0, -1)];

/// Closed lines (first point = last point) in pixels around the covered parts of a view and round its holes.
pub fn outlines(raster: &Raster) -> Vec<Vec<[f32; 2]>> {
    let (width, height) = (raster.width(), raster.height());
    let mask: Vec<bool> = (0..width * height).map(|i| raster.pixel(i % width, i / width).1 >= 0.5).collect();
    let covered = |x: isize, y: isize| {
        x >= 0 && y >= 0 && x < width as isize && y < height as isize && mask[y as usize * width + x as usize]
    };
    // At every pixel corner, one bit for each border edge that leaves it with the covered pixel on its right.
    let stride = width + 1;
    let mut leaving = vec![0u8; stride * (height + 1)];
    for y in 0..=height as isize {
        for x in 0..=width as isize {
            let (upper_left, upper_right) = (covered(x - 1, y - 1), covered(x, y - 1));
            let (lower_left, lower_right) = (covered(x - 1, y), covered(x, y));
            let edges = [
                lower_right && !upper_right,
                lower_left && !lower_right,
                upper_left && !lower_left,
                upper_right && !upper_left,
            ];
            for (direction, edge) in edges.into_iter().enumerate() {
                leaving[y as usize * stride + x as usize] |= u8::from(edge) << direction;
            }
        }
    }
    let mut loops = Vec::new();
    for start in 0..leaving.len() {
        while leaving[start] != 0 {
            let line = follow(&mut leaving, stride, start);
            if line.len() > SHORTEST {
                loops.push(smoothed(line));
            }
        }
    }
    loops
}

/// Walks along border edges from a corner, using each up, until no edge leaves where the walk stands.
fn follow(leaving: &mut [u8], stride: usize, start: usize) -> Vec<[f32; 2]> {
    let mut points = Vec::new();
    let (mut at, mut heading) = (start, 0);
    loop {
        points.push([(at % stride) as f32, (at / stride) as f32]);
        // Right first: where two covered pixels touch by a corner only, the loop stays with its own.
        let Some(turn) = [1, 0, 3].into_iter().find(|turn| leaving[at] & (1 << ((heading + turn) % 4)) != 0) else {
            break;
        };
        heading = (heading + turn) % 4;
        leaving[at] &= !(1 << heading);
        let (dx, dy) = STEPS[heading];
        at = at.wrapping_add_signed(dy * stride as isize + dx);
    }
    points
}

/// Repeated means of neighbours around a closed line.
fn smoothed(mut line: Vec<[f32; 2]>) -> Vec<[f32; 2]> {
    line.pop();
    let count = line.len();
    for _ in 0..PASSES {
        line = (0..count)
            .map(|i| {
                let (before, here, after) = (line[(i + count - 1) % count], line[i], line[(i + 1) % count]);
                std::array::from_fn(|axis| 0.25 * before[axis] + 0.5 * here[axis] + 0.25 * after[axis])
            })
            .collect();
    }
    // Fewer, longer pieces: strokes are drawn one by one, and their round ends overlap.
    let mut line: Vec<_> = line.into_iter().step_by(STRIDE).collect();
    line.extend(line.first().copied());
    line
}

#[cfg(test)]
mod tests {
    use super::super::raster::Vertex;
    use super::*;

    fn square(raster: &mut Raster, low: f32, high: f32) {
        let corner = |x, y| Vertex { screen: [x, y, 0.0], values: [] };
        let (a, b, c, d) = (corner(low, low), corner(high, low), corner(high, high), corner(low, high));
        raster.triangle([&a, &b, &c], |_| [1.0; 3]);
        raster.triangle([&a, &c, &d], |_| [1.0; 3]);
    }

    #[test]
    fn two_squares_give_two_closed_loops() {
        let mut raster = Raster::new(60, 60);
        square(&mut raster, 5.0, 25.0);
        square(&mut raster, 25.0, 45.0);
        square(&mut raster, 50.0, 52.0);
        let lines = outlines(&raster);
        assert_eq!(lines.len(), 2, "they touch at a corner; the speck is left out");
        for (line, low) in lines.iter().zip([5.0, 25.0]) {
            assert_eq!(line.first(), line.last());
            assert_eq!(line.len(), 80 / STRIDE + 1);
            for &[x, y] in line {
                let edge = [x, y, low + 20.0 - x + low, low + 20.0 - y + low].into_iter().fold(f32::MAX, f32::min);
                assert!((edge - low).abs() < 2.0, "{x} {y}");
            }
        }
    }

    #[test]
    fn cloth_that_fills_the_view_and_empty_views() {
        assert!(outlines(&Raster::new(30, 30)).is_empty());
        let mut raster = Raster::new(30, 30);
        square(&mut raster, -10.0, 40.0);
        assert_eq!(outlines(&raster).len(), 1);
    }
}
