//! Scenes, fabrics, metrics and pictures, shared by the program, the tests, the benches and training.

pub mod bound;
pub mod compare;
pub mod fabric;
pub mod metrics;
pub mod picture;
pub mod scene;
