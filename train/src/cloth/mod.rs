//! The differentiable cloth: a stiffness field in, the shape in which the cloth hangs at rest out, and the gradient of
//! any loss of that shape with respect to the field.
//!
//! The cloth is the grid of springs of core in f64: the field goes through a twin of core's `tuned` budget, the shape at
//! rest is found by Newton's method, and the gradient comes by implicit differentiation there: one sparse solve. Gradients
//! through explicit steps explode; this one is exact.
//!
//! - [`Springs`]: the spring network of a rows x columns grid.
//! - [`Budget`], [`Projection`]: field to spring stiffness, with its vector-Jacobian product.
//! - [`Scene`]: pins, masses, time step, and the state in which the next solve starts.
//! - [`equilibrium`]: the burn operation over a batch of fields and scenes.
//!
//! Units are SI. Particle (row, column) has the index `row * columns + column`; row 0 is the top row.

mod adjoint;
mod equilibrium;
mod error;
mod hessian;
mod law;
mod op;
mod projection;
mod relax;
mod scene;
mod springs;
#[cfg(test)]
mod tests;

pub use error::ClothError;
pub use op::equilibrium;
pub use projection::{BEND_SHARE, Budget, Projection, TUNED_FRACTION, inertia};
pub use scene::{Pin, Scene, SceneDef, Settled, Solution};
pub use springs::{BEND, CHANNELS, SHEAR, Spring, Springs, WARP, WEFT};
