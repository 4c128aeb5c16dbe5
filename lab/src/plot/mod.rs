//! Plots: lines and points over one or two logarithmic axes, and maps of coloured cells, as PNG and as SVG.

mod canvas;
mod cell_map;
mod chart;
mod error;

pub use canvas::Figure;
pub use cell_map::{CellMap, CellMaps, Places};
pub use chart::{Axis, Chart, Mark, Series};
pub use error::PlotError;
