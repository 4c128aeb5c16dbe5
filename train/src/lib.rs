//! Training: the GAN of Wang and Wang (2021) with a differentiable cloth, and the ONNX export.

pub mod cloth;
pub mod data;
pub mod evaluate;
pub mod export;
mod files;
pub mod gan;
pub mod image;
pub mod nets;
pub mod own;
pub mod reference;
mod shard;
mod sparse;
mod stop;
pub mod words;

pub use shard::Shard;
