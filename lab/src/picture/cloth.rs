//! Draws a grid as shaded fabric, its over-stretched edges in colour.

use super::camera::Camera;
use super::color::{Linear, Ramp, STRAIN_CEILING, Srgb, mix, to_linear};
use super::grid::Grid;
use super::raster::{Raster, Vertex};
use super::vector::{Vec3, dot, normalized, scale};

/// How cloth is coloured.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Style {
    /// The fabric's own colour; middling dark blues and greys set off both ramps best.
    pub fabric: Srgb,
    /// Which colours show stretch.
    pub ramp: Ramp,
}

impl Default for Style {
    fn default() -> Self {
        Self { fabric: [84, 112, 160], ramp: Ramp::Heat }
    }
}

/// Directions to the lamps in the picture's frame (right, up, toward the viewer), their colour and strength.
const LAMPS: [(Vec3, Linear); 2] =
    [([-0.78, 0.42, 0.46], [1.25, 1.20, 1.12]), ([0.80, 0.10, 0.60], [0.22, 0.26, 0.34])];
/// Light from above and from below, mixed by the normal's height.
const SKY: Linear = [0.30, 0.33, 0.38];
const GROUND: Linear = [0.14, 0.13, 0.12];
/// The far side is drawn darker by this factor, so that a fold that turns over is told from one that does not.
const BACK: f32 = 0.72;
/// Brightness that stretch colours keep in the deepest shade: they must match the legend.
const GLOW: f32 = 0.62;

/// Thread lines closer than this many pixels are thinned out.
const THREAD_SPACING_PX: f32 = 9.0;
/// Half the width of a thread line and of an over-stretched edge, pixels.
const THREAD_HALF_PX: f32 = 0.55;
const EDGE_HALF_PX: f32 = 1.5;
/// How dark a thread line is beside the fabric, and how far stretch tints the fabric between the edges.
const THREAD_SHADE: f32 = 0.70;
const TINT: f32 = 0.72;
/// An edge is drawn only where its strain is at least this share of its surroundings': a weft edge at 3 % would be no
/// more than a speck of yellow where the warp stretches by 20 %.
const EDGE_SHOWS: f32 = 0.7;

/// Draws the grid, which must be finite, into the raster through the camera.
///
/// A cell is four triangles about its middle, so that no diagonal is preferred. Lines are drawn in the cell's own
/// coordinates, thus part of the surface: they stretch and hide with it.
pub fn draw(raster: &mut Raster, camera: &Camera, grid: &Grid, style: &Style) {
    let normals = grid.normals();
    let lights = Lights::new(camera);
    let fabric = to_linear(style.fabric);
    let weave = Weave::new(grid, camera.pixels_per_metre(), style.ramp);
    let strains = grid.particle_strains();
    for row in 0..grid.rows() - 1 {
        for column in 0..grid.columns() - 1 {
            let cell = Cell::new(grid, row, column);
            let corners = [(0, 0), (0, 1), (1, 1), (1, 0)].map(|(dr, dc)| {
                let particle = (row + dr) * grid.columns() + column + dc;
                let ([x, y, z], [u, v]) = (normals[particle], strains[particle]);
                let screen = camera.project(grid.positions()[particle]);
                Vertex { screen, values: [x, y, z, dc as f32, dr as f32, u, v] }
            });
            let there = [(0, 0), (0, 1), (1, 1), (1, 0)].map(|(dr, dc)| grid.has(row + dr, column + dc));
            match there.iter().filter(|there| **there).count() {
                4 => {}
                // a cell with three corners is a triangle
                3 => {
                    let shade = |&[x, y, z, s, t, u, v]: &[f32; 7]| {
                        let at = Spot { s: s.clamp(0.0, 1.0), t: t.clamp(0.0, 1.0), strain: u.max(v) };
                        weave.shade(&cell, &at, fabric, lights.at([x, y, z]))
                    };
                    let missing = there.iter().position(|there| !there).unwrap_or(0);
                    raster.triangle([1, 2, 3].map(|i| &corners[(missing + i) % 4]), shade);
                    continue;
                }
                _ => continue,
            }
            let middle = Vertex {
                screen: camera.project(grid.cell_center(row, column)),
                values: std::array::from_fn(|i| corners.iter().map(|corner| corner.values[i]).sum::<f32>() * 0.25),
            };
            for i in 0..4 {
                raster.triangle([&corners[i], &corners[(i + 1) % 4], &middle], |&[x, y, z, s, t, u, v]| {
                    let at = Spot { s: s.clamp(0.0, 1.0), t: t.clamp(0.0, 1.0), strain: u.max(v) };
                    weave.shade(&cell, &at, fabric, lights.at([x, y, z]))
                });
            }
        }
    }
}

/// A place within a cell: coordinates in [0, 1] along u and v, and the larger of the strains there.
struct Spot {
    s: f32,
    t: f32,
    strain: f32,
}

/// The lamps, turned with the camera: every panel is lit alike.
pub(super) struct Lights {
    toward: Vec3,
    up: Vec3,
    lamps: [(Vec3, Linear); 2],
}

impl Lights {
    pub fn new(camera: &Camera) -> Self {
        let lamps =
            LAMPS.map(|(local, color)| (normalized(camera.direction(local)).unwrap_or(camera.view().toward), color));
        Self { toward: camera.view().toward, up: camera.view().up, lamps }
    }

    /// Light that reaches the viewer from a white surface with this normal (need not be of unit length).
    pub fn at(&self, normal: Vec3) -> Linear {
        let normal = normalized(normal).unwrap_or(self.toward);
        let facing = dot(normal, self.toward);
        let normal = if facing < 0.0 { scale(normal, -1.0) } else { normal };
        let height = 0.5 + 0.5 * dot(normal, self.up);
        let mut light = mix(GROUND, SKY, height);
        for (direction, color) in self.lamps {
            // Cloth scatters light round the edge of its shade a little.
            let lambert = ((dot(normal, direction) + 0.15) / 1.15).max(0.0);
            light = std::array::from_fn(|i| light[i] + color[i] * lambert);
        }
        // Fibres that stand off catch light where the surface turns away.
        let rim = 1.0 - facing.abs().min(1.0);
        light = light.map(|v| v + 0.12 * rim * rim * rim);
        if facing < 0.0 { scale(light, BACK) } else { light }
    }
}

/// The strains of a cell's four edges and whether thread lines run along them.
struct Cell {
    top: f32,
    bottom: f32,
    left: f32,
    right: f32,
    row: usize,
    column: usize,
}

impl Cell {
    fn new(grid: &Grid, row: usize, column: usize) -> Self {
        Self {
            top: grid.strain_u(row, column),
            bottom: grid.strain_u(row + 1, column),
            left: grid.strain_v(row, column),
            right: grid.strain_v(row, column + 1),
            row,
            column,
        }
    }
}

/// Entries of the table of stretch colours, and the strain between two of them.
const TABLE: usize = 512;
const TABLE_STEP: f32 = STRAIN_CEILING / (TABLE - 1) as f32;

/// The table's entry for a strain; strains beyond its ends have the last entry on their side.
fn table_index(strain: f32) -> usize {
    ((strain / TABLE_STEP + 0.5).max(0.0) as usize).min(TABLE - 1)
}

/// Line widths in cell coordinates and which lines are drawn, by the size of a cell in pixels.
struct Weave {
    /// Half widths across weft edges (in t) and across warp edges (in s).
    thread: [f32; 2],
    edge: [f32; 2],
    /// Every how many columns and rows a thread is drawn.
    every: [usize; 2],
    /// The ramp in linear light from strain 0 to its end.
    colors: Vec<Linear>,
}

impl Weave {
    fn new(grid: &Grid, pixels_per_metre: f32, ramp: Ramp) -> Self {
        let cell = grid.rest_m().map(|rest| (rest * pixels_per_metre).max(1e-3));
        let half = |pixels: f32, most: f32| [(pixels / cell[1]).min(most), (pixels / cell[0]).min(most)];
        Self {
            thread: half(THREAD_HALF_PX, 0.5),
            edge: half(EDGE_HALF_PX, 0.26),
            colors: (0..TABLE).map(|i| to_linear(ramp.color(i as f32 * TABLE_STEP))).collect(),
            every: cell.map(|pixels| (THREAD_SPACING_PX / pixels).ceil().max(1.0) as usize),
        }
    }

    /// Colour at (s, t) of a cell: fabric and threads, tinted by the strain there, over-stretched edges on top.
    fn shade(&self, cell: &Cell, at: &Spot, fabric: Linear, light: Linear) -> Linear {
        let &Spot { s, t, strain: between } = at;
        let threads = [
            t < self.thread[0] && cell.row.is_multiple_of(self.every[1]),
            1.0 - t < self.thread[0] && (cell.row + 1).is_multiple_of(self.every[1]),
            s < self.thread[1] && cell.column.is_multiple_of(self.every[0]),
            1.0 - s < self.thread[1] && (cell.column + 1).is_multiple_of(self.every[0]),
        ];
        let cloth = if threads.contains(&true) { scale(fabric, THREAD_SHADE) } else { fabric };
        let edges = [
            (t < self.edge[0], cell.top),
            (1.0 - t < self.edge[0], cell.bottom),
            (s < self.edge[1], cell.left),
            (1.0 - s < self.edge[1], cell.right),
        ];
        // The more stretched of the edges that meet here lies on top.
        let edge = edges.iter().filter(|edge| edge.0).map(|edge| edge.1).fold(0.0, f32::max);
        let (strain, weight) = if edge > EDGE_SHOWS * between {
            (edge, Ramp::weight(edge))
        } else {
            (between, TINT * Ramp::weight(between))
        };
        let lit: Linear = std::array::from_fn(|i| cloth[i] * light[i]);
        if weight == 0.0 {
            return lit;
        }
        let brightness = GLOW + (1.0 - GLOW) * ((light[0] + light[1] + light[2]) / 3.0).min(1.0);
        mix(lit, scale(self.colors[table_index(strain)], brightness), weight)
    }
}

#[cfg(test)]
mod tests {
    use super::super::camera::{Frame, View};
    use super::super::color::to_srgb;
    use super::*;

    /// A flat 9 x 9 sheet, stretched along u, drawn from the front; colour of the pixel in the middle of the view.
    fn middle(strain: f32, style: &Style) -> Srgb {
        let positions: Vec<Vec3> =
            (0..81).map(|i| [((i % 9) as f32 / 8.0 - 0.5) * (1.0 + strain), 0.5 - (i / 9) as f32 / 8.0, 0.0]).collect();
        let grid = Grid::new(&positions, 9, 9, 1.0, 1.0).expect("a grid");
        let view = View::new(0.0, 0.0);
        let frame = Frame { min: [-0.5, -0.5], max: [0.5, 0.5] };
        let camera = Camera::fit(view, &frame, 160, 160, 0);
        let mut raster = Raster::new(160, 160);
        draw(&mut raster, &camera, &grid, style);
        // Particle (4, 4) is in the middle: a weft edge runs through it.
        let (color, coverage) = raster.pixel(84, 80);
        assert_eq!(coverage, 1.0);
        to_srgb(color)
    }

    fn close(a: Srgb, b: Srgb, within: i32) -> bool {
        a.iter().zip(b).all(|(a, b)| (i32::from(*a) - i32::from(b)).abs() <= within)
    }

    #[test]
    fn stretched_edges_have_the_ramp_colour_of_their_strain() {
        for ramp in [Ramp::Heat, Ramp::ColorBlindSafe] {
            let style = Style { ramp, ..Style::default() };
            let unstretched = middle(0.0, &style);
            assert_eq!(middle(0.019, &style), unstretched, "below 2 % the fabric keeps its colour");
            for strain in [0.04, 0.07, 0.13, 0.20, 0.50] {
                let (seen, meant) = (middle(strain, &style), ramp.color(strain));
                assert!(close(seen, meant, 12), "{ramp:?} {strain}: {seen:?} for {meant:?}");
            }
        }
    }

    #[test]
    fn compressed_cloth_keeps_its_colour() {
        let style = Style::default();
        let [r, g, b] = middle(-0.3, &style);
        assert!(b > g && g > r, "blue fabric");
    }

    #[test]
    fn both_sides_are_drawn_and_the_far_side_is_darker() {
        let style = Style::default();
        let sheet = |flip: f32| {
            let positions: Vec<Vec3> =
                [[-0.5, 0.5], [0.5, 0.5], [-0.5, -0.5], [0.5, -0.5]].map(|[x, y]| [x * flip, y, 0.0]).to_vec();
            let grid = Grid::new(&positions, 2, 2, 1.0, 1.0).expect("a grid");
            let frame = Frame { min: [-0.5, -0.5], max: [0.5, 0.5] };
            let camera = Camera::fit(View::new(0.0, 0.0), &frame, 60, 60, 0);
            let mut raster = Raster::new(60, 60);
            draw(&mut raster, &camera, &grid, &style);
            raster.pixel(20, 30)
        };
        let (front, back) = (sheet(1.0), sheet(-1.0));
        assert_eq!((front.1, back.1), (1.0, 1.0));
        assert!(back.0[2] < 0.8 * front.0[2]);
    }
}
