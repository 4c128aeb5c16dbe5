//! The picture of a comparison: one panel a setting.

use taut_lab::compare::Outcome;
use taut_lab::picture::{Grid, Panel, PictureError, Sheet, encode_png};
use taut_lab::scene::Scene;

use crate::colour;
use crate::failure::{Failure, one_line};
use crate::notes::{self, number};
use crate::report::{Report, Setting};

/// Height of the viewer over what lies on something, in degrees.
pub const FROM_ABOVE: f32 = 35.0;

impl From<PictureError> for Failure {
    fn from(e: PictureError) -> Failure {
        Failure::new(e)
    }
}

/// The picture as the bytes of a PNG file.
pub fn png(report: &Report, scene: Scene, outcomes: &[Outcome]) -> Result<Vec<u8>, Failure> {
    let [rows, columns] = report.grid.map(|n| n as usize);
    let [width_m, height_m] = report.size_m;
    let mut sheet = Sheet::new(one_line(&report.description))
        .subtitle(notes::setup(report))
        .style(colour::style(&report.description))
        .footer(notes::notes(report).join(" "));
    if scene.solid(width_m, height_m).is_some() {
        // what lies on something is seen from above
        sheet = sheet.seen_from(FROM_ABOVE);
    }
    for (i, (outcome, setting)) in outcomes.iter().zip(&report.settings).enumerate() {
        let grid = grid(scene, &outcome.positions, [rows, columns], report.size_m)?;
        let mut panel = Panel::new(notes::heading(setting.name), grid);
        for line in lines(setting, report.grid) {
            panel = panel.line(line);
        }
        sheet = sheet.panel(panel);
        if setting.name == "reference" {
            sheet = sheet.outline_of(i);
        }
    }
    Ok(encode_png(&sheet.render()?)?)
}

/// The cloth of a scene as it is drawn: its pins, what is absent, what it lies on.
pub fn grid(scene: Scene, positions: &[[f32; 3]], shape: [usize; 2], size_m: [f32; 2]) -> Result<Grid, PictureError> {
    let ([rows, columns], [width_m, height_m]) = (shape, size_m);
    let pins = scene.pins(rows, columns);
    // where a whole part is held, a mark at each of its particles would hide it
    let pins = if pins.len() > 2 * (rows + columns) { &[][..] } else { &pins };
    let present: Vec<bool> = (0..rows * columns).map(|i| scene.has(i, rows, columns)).collect();
    Ok(Grid::new(positions, rows, columns, width_m, height_m)?
        .with_pins(pins)?
        .with_mask(&present)?
        .with_solid(scene.solid(width_m, height_m)))
}

/// What stands above a cloth.
fn lines(s: &Setting, grid: [u32; 2]) -> [String; 4] {
    let stretch = s.stretch_pct;
    let cut = if notes::fills_the_budget(s.name) { "K at limit".into() } else { format!("K cut {} %", notes::cut(s)) };
    [
        format!("max {} %  p99 {} %", number(stretch.max), number(stretch.p99)),
        format!("away from pins {} %", number(stretch.ex_pin_max)),
        format!("{cut}  {:.1} ns/particle-step", s.ns_per_particle_step),
        format!("{} substeps  {:.0} us/frame", s.substeps, notes::us_per_frame(s, grid)),
    ]
}
