//! Scenes, fabrics, metrics and pictures, shared by the program, the tests, the benches and training.

pub mod against;
pub mod atlas;
pub mod block;
pub mod bound;
pub mod compare;
pub mod cost;
pub mod cusick;
pub mod distill;
pub mod fabric;
pub mod fall;
pub mod front;
pub mod holdout;
pub mod invariance;
pub mod ledger;
pub mod metrics;
pub mod npz;
pub mod peers;
pub mod picture;
pub mod plot;
pub mod scene;
pub mod twin;
