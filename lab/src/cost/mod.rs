//! What a step costs: in every vector width, at every size, with every feature, beside the bound of the core it ran on.
//!
//! All times are thread CPU time. Other programs on a machine only make a run longer, so the quartiles of many short runs
//! are told, and settings that are compared run in turn within one call.

mod features;
mod load;
mod step;

pub use features::{FeatureRow, features};
pub use load::Load;
pub use step::{Law, StepRow, law, step, step_cells};
