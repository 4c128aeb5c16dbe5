//! Other engines on the falling sheet of [`crate::fall`]: what they cost per iteration, and until the sheet stretches no more
//! than so much.
//!
//! Bullet and rapier3d run in a program of their own, `lab/peers`, which is no part of the workspace. NvCloth and Jolt were
//! measured by another run on another machine; their rows only stand beside the others.

mod recorded;
mod row;
mod run;

pub use recorded::recorded;
pub use row::{Reached, Row, row};
pub use run::{ENGINES, Engine, Fell, parse, settings};

/// How the program of the peers is made.
pub const HOW_TO_BUILD: &str = "apt-get install libbullet-dev pkg-config g++\n\
     cargo build --release --manifest-path lab/peers/Cargo.toml\n\
     (without rapier3d, which compiles for minutes: --no-default-features --features bullet)";
