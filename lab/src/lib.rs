//! Scenes, fabrics, metrics and pictures, shared by the program, the tests, the benches and training.

pub mod against;
pub mod bound;
pub mod compare;
pub mod cusick;
pub mod fabric;
pub mod ledger;
pub mod metrics;
pub mod npz;
pub mod picture;
pub mod plot;
pub mod scene;
