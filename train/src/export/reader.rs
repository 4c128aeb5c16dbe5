//! Reads a generator file back into a network that burn runs: what [`super::export`] wrote, with its words and metadata.

use std::collections::HashMap;

use burn::Tensor;
use burn::module::{Param, RunningState};
use burn::nn::conv::ConvTranspose2d;
use burn::nn::{BatchNorm, Linear};
use burn::tensor::{Device, TensorData};
use half::f16;
use prost::Message;

use super::proto::{ModelProto, TensorProto, data_type};
use super::words::check_words;
use super::{ExportError, ExportMeta, WordTable};
use crate::nets::generator::Deconvolution;
use crate::nets::{DESCRIPTION, Generator, GeneratorConfig};

/// The network of a file for inference, with the file's rounded numbers, its words and what it says of itself.
///
/// # Errors
/// [`ExportError::File`] for what is no generator file of ours, [`ExportError::Tensor`] names a tensor that is missing or of
/// another shape.
pub fn import(bytes: &[u8]) -> Result<(Generator, WordTable, ExportMeta), ExportError> {
    let bad = |what: &str| ExportError::File(what.to_string());
    let model = ModelProto::decode(bytes).map_err(|e| ExportError::File(e.to_string()))?;
    let graph = model.graph.ok_or_else(|| bad("it has no graph"))?;
    let parts = Parts { tensors: graph.initializer.into_iter().map(|t| (t.name.clone(), t)).collect() };
    let property = |key: &str| {
        let found = model.metadata_props.iter().find(|p| p.key == key);
        found.map(|p| p.value.clone()).ok_or_else(|| ExportError::File(format!("it does not say `{key}`")))
    };
    let meta = ExportMeta {
        model_name: property("taut.model_name")?,
        training_digest: property("taut.training_digest")?,
        channel_ranges_n_per_m: ranges(&property("taut.channel_ranges_n_per_m")?)?,
        fabric_ranges: ranges(&property("taut.fabric_ranges")?)?,
    };
    let tokens: Vec<String> = property("taut.vocabulary")?.split('\n').map(str::to_string).collect();
    let vectors = parts.numbers("words", &[tokens.len(), DESCRIPTION])?;
    let words = WordTable { tokens, vectors };
    check_words(&words)?;

    let width = parts.tensors.get("sixth.weight.f16").and_then(|t| t.dims.first()).map_or(0, |d| d - 1);
    let levels = parts.tensors.contains_key("level.weight.f16");
    let config = GeneratorConfig { width: width.max(0) as usize, levels, ..GeneratorConfig::default() };
    let mut g = config.init(0, &Device::flex()).map_err(|e| ExportError::File(e.to_string()))?;
    parts.deconvolution("first", &mut g.first)?;
    parts.fill("skip.weight.f16", &mut g.skip.weight)?;
    parts.fill_bias("skip", &mut g.skip.bias)?;
    for (name, layer) in [
        ("second", &mut g.second),
        ("third", &mut g.third),
        ("fourth", &mut g.fourth),
        ("fifth", &mut g.fifth),
        ("sixth", &mut g.sixth),
    ] {
        let Deconvolution { norm, deconvolution } = layer;
        parts.norm(name, norm)?;
        parts.deconvolution(name, deconvolution)?;
    }
    parts.linear("fabric.head", &mut g.fabric)?;
    if let Some(level) = &mut g.level {
        parts.linear("level", level)?;
    }
    Ok((g, words, meta))
}

/// The constants of a file.
struct Parts {
    tensors: HashMap<String, TensorProto>,
}

impl Parts {
    /// The numbers of a constant of a shape.
    fn numbers(&self, name: &str, shape: &[usize]) -> Result<Vec<f32>, ExportError> {
        let bad = || ExportError::Tensor { tensor: name.into() };
        let tensor = self.tensors.get(name).ok_or_else(bad)?;
        if !tensor.dims.iter().map(|d| *d as usize).eq(shape.iter().copied()) {
            return Err(bad());
        }
        let values: Vec<f32> = match tensor.data_type {
            data_type::FLOAT16 => {
                tensor.raw_data.as_chunks::<2>().0.iter().map(|b| f16::from_le_bytes(*b).to_f32()).collect()
            }
            data_type::FLOAT => tensor.raw_data.as_chunks::<4>().0.iter().map(|b| f32::from_le_bytes(*b)).collect(),
            _ => return Err(bad()),
        };
        if values.len() == shape.iter().product::<usize>() { Ok(values) } else { Err(bad()) }
    }

    fn tensor<const D: usize>(&self, name: &str, like: &Tensor<D>) -> Result<Tensor<D>, ExportError> {
        let shape = like.dims();
        Ok(Tensor::from_data(TensorData::new(self.numbers(name, &shape)?, shape), &like.device()))
    }

    fn fill<const D: usize>(&self, name: &str, param: &mut Param<Tensor<D>>) -> Result<(), ExportError> {
        *param = Param::from_tensor(self.tensor(name, &param.val())?);
        Ok(())
    }

    fn fill_bias(&self, layer: &str, bias: &mut Option<Param<Tensor<1>>>) -> Result<(), ExportError> {
        bias.as_mut().map_or(Ok(()), |b| self.fill(&format!("{layer}.bias.f16"), b))
    }

    fn deconvolution(&self, name: &str, layer: &mut ConvTranspose2d) -> Result<(), ExportError> {
        self.fill(&format!("{name}.weight.f16"), &mut layer.weight)?;
        self.fill_bias(name, &mut layer.bias)
    }

    fn linear(&self, name: &str, layer: &mut Linear) -> Result<(), ExportError> {
        self.fill(&format!("{name}.weight.f16"), &mut layer.weight)?;
        self.fill_bias(name, &mut layer.bias)
    }

    fn norm(&self, name: &str, layer: &mut BatchNorm) -> Result<(), ExportError> {
        let part = |part: &str| format!("{name}.norm.{part}");
        self.fill(&part("scale"), &mut layer.gamma)?;
        self.fill(&part("shift"), &mut layer.beta)?;
        layer.running_mean = RunningState::new(self.tensor(&part("mean"), &layer.running_mean.value())?);
        layer.running_var = RunningState::new(self.tensor(&part("variance"), &layer.running_var.value())?);
        Ok(())
    }
}

/// `lo:hi,lo:hi,...` as [`ExportMeta::properties`] writes it.
fn ranges<const N: usize>(text: &str) -> Result<[(f64, f64); N], ExportError> {
    let pair = |part: &str| part.split_once(':').and_then(|(a, b)| Some((a.parse().ok()?, b.parse().ok()?)));
    let all: Option<Vec<(f64, f64)>> = text.split(',').map(pair).collect();
    all.and_then(|v| v.try_into().ok()).ok_or_else(|| ExportError::File(format!("`{text}` is not {N} ranges")))
}
