//! Pictures: a small deterministic software renderer for cloth, and the sheets that compare settings side by side.
//!
//! [`Sheet`] is the way in: panels of one shared scale, shaded fabric, over-stretched edges in colour, a legend; [`encode_gif`]
//! makes a film of sheets.

mod camera;
mod canvas;
mod card;
mod cloth;
mod color;
mod contour;
mod error;
mod film;
mod framing;
mod grid;
mod layout;
mod legend;
mod raster;
mod save;
mod shadow;
mod sheet;
mod solid;
mod text;
mod vector;

pub use cloth::Style;
pub use color::{Ramp, STRAIN_CEILING, STRAIN_FLOOR, Srgb};
pub use error::PictureError;
pub use film::encode_gif;
pub use grid::Grid;
pub(crate) use raster::{Raster, Vertex};
pub use save::{encode_png, save_png};
pub use sheet::{MAX_PANELS, Panel, Sheet};
