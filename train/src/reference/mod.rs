//! A continuum cloth that anyone can run: the stand-in for ARCSim, the engine that the paper took its images from.
//!
//! A triangle mesh with an orthotropic membrane (Green strain, measured tables), hinges, air, contact with a ball or a
//! pedestal and friction, stepped by linearly implicit Euler with a sparse Cholesky factorisation, in f64. See
//! docs/reference.md.

mod cloth;
pub mod command;
mod error;
mod fabrics;
mod hinge;
mod material;
mod membrane;
mod pictures;
mod run;
pub mod scenes;
mod sheet;
mod solid;
#[cfg(test)]
mod tests;
mod vector;

pub use cloth::{Cloth, Surroundings};
pub use error::ReferenceError;
pub use fabrics::{MEASURED, Material, Measured};
pub use material::{Bending, BendingTable, Membrane, StretchingTable};
pub use sheet::Sheet;
pub use solid::Solid;
pub use vector::V3;
