//! taut: mass-spring cloth for games that does not stretch like rubber.
//!
//! A grid of particles joined by structural (warp, weft), shear and bend springs (Provot 1995; Wang and Wang 2021,
//! eq. 1 to 4), stepped by symplectic Euler at a fixed step (eq. 17). This crate has no std, allocates nothing, holds
//! no globals and gives the same bits on every target.
//!
//! Data flows one way: a stiffness field in N/m at the particles ([`Cloth::set_stiffness_field`]) is projected to what
//! the step can carry ([`Budget`]), and the cloth steps with the result ([`Cloth::step`]).
//!
//! ```
//! use taut::{Cloth, ClothDef, Grid, GridDef};
//! let grid = Grid::new(&GridDef { rows: 16, columns: 16, ..GridDef::default() })?;
//! let def = ClothDef::default();
//! let mut block = vec![0.0; Cloth::memory(&grid, &def)?];
//! let mut cloth = Cloth::create(&grid, &def, &mut block)?;
//! cloth.set_stiffness_uniform([2000.0, 400.0, 100.0, 8.0])?;
//! cloth.pin(0)?;
//! cloth.pin(15)?;
//! for _ in 0..60 {
//!     cloth.step()?;
//! }
//! assert!(cloth.strain().largest < 0.2);
//! # Ok::<(), taut::Error>(())
//! ```
#![no_std]
#![deny(unsafe_code)]

mod aim;
mod air;
mod ambient;
mod around;
pub mod baked;
mod bands;
mod bounds;
mod budget;
mod cloth;
mod colliders;
mod contact;
mod def;
mod environment;
mod error;
mod fault;
pub mod field;
mod force;
mod frame;
mod grid;
mod hash;
mod hinge;
mod implicit;
mod inertia;
mod layout;
mod levels;
mod limit;
mod mask;
mod masses;
mod math;
mod mesh;
mod node_mask;
pub mod noise;
mod normals;
mod passes;
mod pin_force;
mod pins;
pub mod plan;
mod pose;
mod prolong;
mod shapes;
mod simd;
mod sleep;
mod snapshot;
mod statics;
mod step;
mod strain;
mod strain_limit;
mod stretch;
mod targets;
mod tethers;
mod width;
mod within;

pub use air::Air;
pub use bands::{Bands, LEAST_BAND_ROWS};
pub use bounds::Bounds;
pub use budget::{BEND_SHARE, BudgetReport, CERTIFIED_SHARE, HINGE_SHARE, TUNED_SHARE};
pub use cloth::{Cloth, PositionView};
pub use colliders::{ColliderDef, ColliderId, MAX_COLLIDERS};
pub use def::{Budget, ClothDef, Features, Solver};
pub use environment::in_default_environment;
pub use error::Error;
pub use grid::{Families, Grid, GridDef};
pub use hash::Hash64;
pub use math::sqrt;
pub use nalgebra::Vector3;
pub use pose::Pose;
pub use shapes::Shape;
pub use step::StepFlags;
pub use strain::Strain;
pub use stretch::{BudgetFlags, LIMIT_SPEED_M_S, STRETCH_RANGE};
pub use targets::{Target, TargetLimit};
pub use width::Width;
