//! Which panels can be drawn, and the frame that they share.

use super::camera::{Frame, View};
use super::sheet::Panel;

/// A cloth that reaches further from the others than this many rest diagonals is not drawn: it has blown up.
const OFF_SCALE: f32 = 20.0;

/// What a panel's window shows.
pub enum Content {
    /// The cloth.
    Cloth,
    /// A message: a coordinate is not a finite number.
    NotFinite,
    /// A message: the cloth reaches too far to be drawn with the others.
    OffScale,
}

/// The frame of the smallest finite cloth, to which the others are compared.
fn smallest_frame(panels: &[Panel], view: &View) -> Option<(Frame, f32)> {
    panels
        .iter()
        .filter(|panel| panel.grid.is_finite())
        .filter_map(|panel| Some((Frame::around(view, &panel.grid.present())?, panel.grid.diagonal_m())))
        // Finite positions may lie so far out that their projections are not.
        .filter(|(frame, _)| frame.size().iter().all(|side| side.is_finite()))
        .min_by(|(a, _), (b, _)| {
            let extent = |frame: &Frame| frame.size()[0].max(frame.size()[1]);
            extent(a).total_cmp(&extent(b))
        })
}

/// What to show of every panel.
pub fn contents(panels: &[Panel], view: &View) -> Vec<Content> {
    let smallest = smallest_frame(panels, view);
    panels
        .iter()
        .map(|panel| {
            if !panel.grid.is_finite() {
                return Content::NotFinite;
            }
            let near = smallest.zip(Frame::around(view, &panel.grid.present())).is_some_and(|((base, _), frame)| {
                let limit = base.grown(OFF_SCALE * panel.grid.diagonal_m());
                base.size()[0].max(base.size()[1]) <= OFF_SCALE * panel.grid.diagonal_m()
                    && frame.size().iter().all(|side| side.is_finite())
                    && frame.clamped(&limit) == frame
            });
            if near { Content::Cloth } else { Content::OffScale }
        })
        .collect()
}

/// The frame that all panels share; a unit square when no panel can be drawn.
pub fn shared_frame(panels: &[Panel], contents: &[Content], view: &View) -> Frame {
    let unit = Frame { min: [0.0; 2], max: [1.0; 2] };
    let Some((base, diagonal)) = smallest_frame(panels, view) else {
        return unit;
    };
    let limit = base.grown(diagonal);
    panels
        .iter()
        .zip(contents)
        .filter(|(_, content)| matches!(content, Content::Cloth))
        .filter_map(|(panel, _)| Frame::around(view, &panel.grid.present()))
        .map(|frame| frame.clamped(&limit))
        .reduce(|a, b| a.union(&b))
        .unwrap_or(unit)
}
