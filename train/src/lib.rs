//! Training: the GAN of Wang and Wang (2021) with a differentiable cloth, and the ONNX export.

pub mod cloth;
