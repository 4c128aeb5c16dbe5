//! The legend of a sheet: the stretch ramp with its ticks, and what pins, dashes and the scale bar mean.

use super::canvas::{Area, Canvas};
use super::cloth::Style;
use super::color::{Ramp, Srgb, mix, to_linear, to_srgb};
use super::text::{Align, Face, write};

/// Text and strokes.
pub const INK: Srgb = [32, 36, 44];
/// Less important text.
pub const SOFT_INK: Srgb = [88, 95, 107];
/// Dashes of the reference panel's outline.
pub const OUTLINE: Srgb = [46, 51, 61];
/// Pins, and the ring that sets them off the cloth.
pub const PIN: Srgb = [24, 28, 36];
/// Ring round a pin.
pub const PIN_RING: Srgb = [255, 255, 255];

/// Strain at the right end of the bar; beyond 20 % it is the last colour.
const BAR_END: f32 = 0.24;
/// Labelled strains.
const TICKS: [(f32, &str); 6] = [(0.0, "0"), (0.02, "2"), (0.05, "5"), (0.10, "10"), (0.15, "15"), (0.20, "20 %")];

const BAR_HEIGHT: i32 = 20;
const CAPTION_GAP: i32 = 28;
const KEY_HEIGHT: i32 = 26;
/// Room that the bar with its caption and labels takes.
const SCALE_HEIGHT: i32 = CAPTION_GAP + BAR_HEIGHT + 26;
const BAR_WIDTH: i32 = 420;
/// From this width on the keys stand beside the bar.
const SIDE_BY_SIDE: i32 = 820;

/// What there is to explain besides the ramp.
#[derive(Debug, Clone)]
pub struct Keys {
    /// Heading of the panel whose outline is dashed into the others.
    pub outline_of: Option<String>,
    /// True when a panel has pins.
    pub pins: bool,
    /// Scale of all panels; none when no panel could be drawn.
    pub pixels_per_metre: Option<f32>,
}

impl Keys {
    fn count(&self) -> i32 {
        i32::from(self.outline_of.is_some()) + i32::from(self.pins) + i32::from(self.pixels_per_metre.is_some())
    }

    /// Height that the legend needs at a width, pixels.
    pub fn height(&self, width: i32) -> i32 {
        let keys = self.count() * KEY_HEIGHT;
        if width >= SIDE_BY_SIDE { SCALE_HEIGHT.max(keys) } else { SCALE_HEIGHT + 10 + keys }
    }
}

/// Draws the legend into the top of `area`.
pub fn draw(canvas: &mut Canvas, area: Area, style: &Style, keys: &Keys) {
    let bar = Area { width: BAR_WIDTH.min(area.width), height: SCALE_HEIGHT, ..area };
    draw_bar(canvas, bar, style);
    let beside = area.width >= SIDE_BY_SIDE;
    let (x, mut y) = if beside { (area.x + bar.width + 60, area.y) } else { (area.x, area.y + SCALE_HEIGHT + 10) };
    let sample = 46;
    let mut line = |canvas: &mut Canvas, text: &str, symbol: &dyn Fn(&mut Canvas, i32)| {
        symbol(canvas, y + KEY_HEIGHT / 2);
        let text_area = Area {
            x: x + sample + 14,
            y: y + (KEY_HEIGHT - Face::Small.height()) / 2,
            width: area.x + area.width - (x + sample + 14),
            height: Face::Small.height(),
        };
        write(canvas, text_area, text, Face::Small, Align::Left, SOFT_INK);
        y += KEY_HEIGHT;
    };
    if keys.pins {
        line(canvas, "pinned particle", &|canvas, y| pin(canvas, [(x + sample / 2) as f32, y as f32], 4.0, area));
    }
    if let Some(heading) = &keys.outline_of {
        line(canvas, &format!("outline of \"{heading}\""), &|canvas, y| {
            let y = y as f32;
            outline(canvas, &[[x as f32, y], [(x + sample) as f32, y]], area);
        });
    }
    if let Some(pixels_per_metre) = keys.pixels_per_metre {
        let (metres, label) = scale_length(pixels_per_metre, sample as f32);
        line(canvas, &format!("{label} in every panel"), &|canvas, y| {
            let length = metres * pixels_per_metre;
            let left = x as f32 + 0.5 * (sample as f32 - length);
            let y = y as f32;
            for (from, to) in [
                ([left, y], [left + length, y]),
                ([left, y - 4.0], [left, y + 4.0]),
                ([left + length, y - 4.0], [left + length, y + 4.0]),
            ] {
                canvas.stroke(from, to, 1.6, INK, 1.0, area);
            }
        });
    }
}

/// Draws a pin.
pub fn pin(canvas: &mut Canvas, center: [f32; 2], radius: f32, clip: Area) {
    canvas.disc(center, radius + 1.4, PIN_RING, clip);
    canvas.disc(center, radius, PIN, clip);
}

/// Draws one line of the dashed outline of the reference panel.
pub fn outline(canvas: &mut Canvas, points: &[[f32; 2]], clip: Area) {
    canvas.dashes(points, 5.0, 1.2, OUTLINE, 1.0, clip);
}

fn draw_bar(canvas: &mut Canvas, area: Area, style: &Style) {
    let caption = Area { height: Face::Body.height(), ..area };
    write(canvas, caption, "stretch of an edge", Face::Body, Align::Left, SOFT_INK);
    let bar = Area { y: area.y + CAPTION_GAP, height: BAR_HEIGHT, ..area };
    for x in 0..bar.width {
        let strain = (x as f32 + 0.5) / bar.width as f32 * BAR_END;
        let color = mix(to_linear(style.fabric), to_linear(style.ramp.color(strain)), Ramp::weight(strain));
        canvas.fill(Area { x: bar.x + x, width: 1, ..bar }, to_srgb(color));
    }
    canvas.border(bar, SOFT_INK);
    let advance = Face::Small.advance();
    for (strain, label) in TICKS {
        let x = bar.x + ((bar.width - 1) as f32 * strain / BAR_END + 0.5) as i32;
        canvas.fill(Area { x, y: bar.y + bar.height, width: 1, height: 5 }, SOFT_INK);
        // Digits are centred on the tick; a unit after them hangs over to the right.
        let digits = label.chars().filter(char::is_ascii_digit).count() as i32;
        let text = Area {
            x: (x - digits * advance / 2).max(bar.x),
            y: bar.y + bar.height + 6,
            width: Face::Small.width(label),
            height: Face::Small.height(),
        };
        write(canvas, text, label, Face::Small, Align::Left, SOFT_INK);
    }
}

/// The longest of 1, 2, 5 times a power of ten metres that is at most `pixels` wide, and its name.
fn scale_length(pixels_per_metre: f32, pixels: f32) -> (f32, String) {
    let most = f64::from(pixels / pixels_per_metre);
    let power = 10f64.powf(most.log10().floor());
    let metres = [5.0, 2.0, 1.0].map(|step| step * power).into_iter().find(|&m| m <= most).unwrap_or(power);
    let label = if metres >= 1.0 {
        format!("{metres:.0} m")
    } else if metres >= 0.01 {
        format!("{:.0} cm", metres * 100.0)
    } else {
        format!("{:.1} mm", metres * 1000.0)
    };
    (metres as f32, label)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scale_bars_have_round_lengths() {
        assert_eq!(scale_length(300.0, 46.0).1, "10 cm");
        assert_eq!(scale_length(20.0, 46.0).1, "2 m");
        assert_eq!(scale_length(4000.0, 46.0).1, "1 cm");
        assert_eq!(scale_length(9000.0, 46.0).1, "5.0 mm");
        for pixels_per_metre in [3.0, 77.0, 410.0, 2500.0] {
            let length = scale_length(pixels_per_metre, 46.0).0 * pixels_per_metre;
            assert!(length > 46.0 / 2.6 && length <= 46.1, "{length}");
        }
    }
}
