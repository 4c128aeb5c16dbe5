//! One panel of a sheet: its box, its text and what its window shows.

use super::camera::Camera;
use super::canvas::{Area, Canvas};
use super::color::{Srgb, to_srgb};
use super::framing::Content;
use super::grid::Grid;
use super::layout::{Layout, MAX_LINES, PADDING};
use super::legend::{self, INK, SOFT_INK};
use super::raster::Raster;
use super::shadow;
use super::sheet::Panel;
use super::text::{Align, Face, write};

/// A card, its border, and the wall behind the cloth from top to bottom.
const CARD: Srgb = [255, 255, 255];
const RULE: Srgb = [214, 213, 208];
const WALL_TOP: Srgb = [240, 242, 245];
const WALL_BOTTOM: Srgb = [214, 219, 226];
/// Text of a panel that could not be drawn.
pub const ALARM: Srgb = [176, 24, 40];
const SHADOW: Srgb = [70, 80, 98];
/// Opacity of the shadow where it is darkest.
const SHADOW_DEPTH: f32 = 0.34;

/// Draws a panel's box, its text and the wall behind its cloth.
pub fn draw_card(canvas: &mut Canvas, layout: &Layout, index: usize, panel: &Panel, content: &Content) {
    let card = layout.card(index);
    canvas.fill(card, CARD);
    let window = layout.window(index);
    for row in 0..window.height {
        let t = row as f32 / window.height as f32;
        let color = std::array::from_fn(|i| {
            let (a, b) = (f32::from(WALL_TOP[i]), f32::from(WALL_BOTTOM[i]));
            (a + (b - a) * t + 0.5) as u8
        });
        canvas.fill(Area { y: window.y + row, height: 1, ..window }, color);
    }
    canvas.border(card, RULE);
    let (x, width) = (card.x + PADDING, card.width - 2 * PADDING);
    let mut y = card.y + PADDING - 2;
    let color = if matches!(content, Content::Cloth) { INK } else { ALARM };
    let area = Area { x, y, width, height: Face::Heading.height() };
    write(canvas, area, &panel.heading, Face::Heading, Align::Left, color);
    y += Face::Heading.height() + 3;
    for line in panel.lines.iter().take(MAX_LINES) {
        let area = Area { x, y, width, height: Face::Body.height() };
        write(canvas, area, line, Face::Body, Align::Left, SOFT_INK);
        y += Face::Body.height() + 3;
    }
}

/// Lays drawn cloth and its shadow over the wall of a window.
pub fn lay_cloth(canvas: &mut Canvas, window: Area, raster: &Raster) {
    let shade = shadow::cast(raster);
    for y in 0..raster.height() {
        for x in 0..raster.width() {
            let (left, top) = (window.x + x as i32, window.y + y as i32);
            canvas.blend(left, top, SHADOW, SHADOW_DEPTH * shade[y * raster.width() + x]);
            let (color, coverage) = raster.pixel(x, y);
            if coverage > 0.0 {
                canvas.blend(left, top, to_srgb(color), coverage);
            }
        }
    }
}

/// Points of a window as points of the canvas.
fn shifted(points: &[[f32; 2]], window: Area) -> Vec<[f32; 2]> {
    points.iter().map(|[x, y]| [window.x as f32 + x, window.y as f32 + y]).collect()
}

/// Pins lie on top of everything: which particles are held must be seen even where cloth hangs over them.
pub fn draw_pins(canvas: &mut Canvas, window: Area, camera: &Camera, grid: &Grid) {
    let spacing = grid.rest_m()[0].min(grid.rest_m()[1]) * camera.pixels_per_metre();
    let radius = if grid.pins().len() > 4 { (0.25 * spacing).clamp(1.2, 4.0) } else { 4.0 };
    let points: Vec<[f32; 2]> = grid
        .pins()
        .iter()
        .map(|&pin| {
            let [x, y, _] = camera.project(grid.positions()[pin]);
            [x, y]
        })
        .collect();
    for point in shifted(&points, window) {
        legend::pin(canvas, point, radius, window);
    }
}

/// Says in a window why there is no cloth.
pub fn draw_alarm(canvas: &mut Canvas, window: Area, headline: &str, reason: &str) {
    let y = window.y + window.height / 2 - Face::Heading.height();
    let line = |y, height| Area { x: window.x, y, width: window.width, height };
    write(canvas, line(y, Face::Heading.height()), headline, Face::Heading, Align::Center, ALARM);
    let y = y + Face::Heading.height() + 4;
    write(canvas, line(y, Face::Small.height()), reason, Face::Small, Align::Center, SOFT_INK);
}

/// Dashes the outlines of the reference panel into a window.
pub fn draw_outlines(canvas: &mut Canvas, window: Area, outlines: &[Vec<[f32; 2]>]) {
    for line in outlines {
        legend::outline(canvas, &shifted(line, window), window);
    }
}
