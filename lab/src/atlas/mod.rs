//! The atlas of extremes: what becomes of a sheet hung at two corners when a step, a stiffness, a mass, a start or a pin is
//! extreme. Every cell is one run ([`run`]) and ends in one [`Class`].

mod axes;
mod cell;
mod report;
mod run;
mod start;

pub use axes::{Axis, MAPS, Map, sample};
pub use cell::{Cell, Limits, Variant};
pub use report::{Atlas, Entry};
pub use run::{Class, Effort, Finding, run};
pub use start::Start;
