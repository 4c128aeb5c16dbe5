//! Writes the generator file: opset 17, IR version 8.
//!
//! | input | type | meaning |
//! | --- | --- | --- |
//! | tokens | int64 [batch, 16] | rows of the word table, 0 = padding |
//! | weights | f32 [batch, 16] | 1/n for each of the n known words, 0 for padding |
//! | noise | f32 [batch, 128] | Gaussian |
//! | pin_distance | f32 [batch, 1, 32, 32] | distance to the nearest pin over the larger side, in [0, 1], row 0 on top |
//!
//! Outputs: `field` f32 [batch, 4, 32, 32] and `fabric` f32 [batch, 5], both in [-1, 1]. The words are gathered as f16
//! and cast then, which gives the numbers of a cast table without ever holding one.
//!
//! Kernels, matrices, biases and words are f16 behind a Cast. The four vectors of each normalisation stay f32: a running
//! variance may be too small for f16, and an error of the mean is multiplied by its ratio to the deviation. They are
//! fewer than 1 in 1000 of the numbers.

use prost::Message;

use super::graph::GraphBuilder;
use super::proto::{ModelProto, OperatorSetIdProto, StringStringEntryProto, data_type};
use super::words::check_words;
use super::{ExportError, ExportMeta, MAX_FILE_BYTES, TOKENS, WordTable};
use crate::nets::generator::Deconvolution;
use crate::nets::{
    CHANNELS, DESCRIPTION, DESCRIPTION_EPSILON, FABRIC, GRID, Generator, HEAD_SCALE, NOISE, SHARES_EPSILON,
};

/// Version of the operators; both runtimes that matter know it.
const OPSET: i64 = 17;
/// Version of the file format.
const IR_VERSION: i64 = 8;

/// The bytes of the generator file: the network with its running statistics, the words, the metadata. The same parts
/// give the same bytes.
///
/// # Errors
/// [`ExportError`] names the word, the metadata or the tensor that the file cannot hold, or its size.
pub fn export(generator: &Generator, words: &WordTable, meta: &ExportMeta) -> Result<Vec<u8>, ExportError> {
    check_words(words)?;
    let metadata_props = meta
        .properties(words)?
        .into_iter()
        .map(|(key, value)| StringStringEntryProto { key: key.into(), value })
        .collect();
    // the copy for inference also brings the running statistics up to the last training step
    let graph = network(&generator.whole(), words)?;
    let model = ModelProto {
        ir_version: IR_VERSION,
        producer_name: "taut".into(),
        producer_version: env!("CARGO_PKG_VERSION").into(),
        opset_import: vec![OperatorSetIdProto { domain: String::new(), version: OPSET }],
        metadata_props,
        graph: Some(graph.finish()),
    };
    let bytes = model.encoded_len();
    if bytes >= MAX_FILE_BYTES {
        return Err(ExportError::TooLarge(bytes));
    }
    Ok(model.encode_to_vec())
}

fn network(m: &Generator, words: &WordTable) -> Result<GraphBuilder, ExportError> {
    let mut builder = GraphBuilder::new("taut_generator");
    let g = &mut builder;
    g.input("tokens", data_type::INT64, &[None, Some(TOKENS)]);
    g.input("weights", data_type::FLOAT, &[None, Some(TOKENS)]);
    g.input("noise", data_type::FLOAT, &[None, Some(NOISE)]);
    g.input("pin_distance", data_type::FLOAT, &[None, Some(1), Some(GRID), Some(GRID)]);

    let axis1 = g.integers("axis_1", &[1]);
    let axis2 = g.integers("axis_2", &[2]);
    let axes23 = g.integers("axes_2_3", &[2, 3]);

    // The description: the sum of the word vectors, which is n times their mean; 1/n is the sum of the squared shares.
    let table = g.halves("words", &[words.tokens.len(), DESCRIPTION], &words.vectors)?;
    let gathered = g.node("words.gathered", "Gather", &[&table, "tokens"], vec![]);
    let vectors = g.cast("words.vectors", &gathered);
    let shares = g.node("words.shares", "Unsqueeze", &["weights", &axis2], vec![]);
    let weighted = g.node("words.weighted", "Mul", &[&vectors, &shares], vec![]);
    let mean = g.sum_over("words.mean", &weighted, &axis1, false);
    let share_squares = g.node("words.share_squares", "Mul", &["weights", "weights"], vec![]);
    let share = g.sum_over("words.share", &share_squares, &axis1, true);
    let share_epsilon = g.floats("words.share_epsilon", &[SHARES_EPSILON]);
    let share = g.node("words.share_above_zero", "Add", &[&share, &share_epsilon], vec![]);
    let words = g.node("words.sum", "Div", &[&mean, &share], vec![]);

    // Scaled to a mean square of 1, as `nets::normalise` does it.
    let squares = g.node("words.squares", "Mul", &[&words, &words], vec![]);
    let sum = g.sum_over("words.sum_of_squares", &squares, &axis1, true);
    let count = g.floats("words.count", &[DESCRIPTION as f32]);
    let mean_square = g.node("words.mean_square", "Div", &[&sum, &count], vec![]);
    let epsilon = g.floats("words.epsilon", &[DESCRIPTION_EPSILON]);
    let above_zero = g.node("words.above_zero", "Add", &[&mean_square, &epsilon], vec![]);
    let root = g.node("words.root", "Sqrt", &[&above_zero], vec![]);
    let description = g.node("description", "Div", &[&words, &root], vec![]);
    let scale = g.floats("heads.scale", &[HEAD_SCALE]);
    let scaled = g.node("heads.scaled", "Mul", &[&description, &scale], vec![]);
    let heard = g.concat("heads.heard", &[&scaled, &words]);
    let head = g.linear("fabric.head", &heard, &m.fabric)?;
    g.node("fabric", "Tanh", &[&head], vec![]);

    let v = g.concat("v", &[&description, "noise"]);
    let v = g.node("v.pixel", "Unsqueeze", &[&v, &axes23], vec![]);
    let first = g.deconvolution("first", &v, &m.first)?;
    let a1 = g.node("first.active", "Relu", &[&first], vec![]);
    let skip = g.pointwise("skip", &a1, &m.skip)?;
    let a2 = active(g, "second", &a1, &m.second)?;
    let s2 = stitch(g, "second", &a2, &skip, 2);
    let a3 = active(g, "third", &s2, &m.third)?;
    let s3 = stitch(g, "third", &a3, &skip, 4);
    let a4 = active(g, "fourth", &s3, &m.fourth)?;
    let s4 = stitch(g, "fourth", &a4, &skip, 8);
    let fifth = with_pins(g, "fifth", &s4, &m.fifth)?;
    let residual = g.node("fifth.residual", "Add", &[&fifth, &a4], vec![]);
    let a5 = g.node("fifth.active", "Relu", &[&residual], vec![]);
    let mut sixth = with_pins(g, "sixth", &a5, &m.sixth)?;
    if let Some(level) = &m.level {
        let level = g.linear("level", &heard, level)?;
        let level = g.node("level.pixel", "Unsqueeze", &[&level, &axes23], vec![]);
        sixth = g.node("sixth.levelled", "Add", &[&sixth, &level], vec![]);
    }
    g.node("field", "Tanh", &[&sixth], vec![]);

    g.output("field", &[None, Some(CHANNELS), Some(GRID), Some(GRID)]);
    g.output("fabric", &[None, Some(FABRIC)]);
    Ok(builder)
}

/// Normalisation, deconvolution, ReLU.
fn active(g: &mut GraphBuilder, name: &str, x: &str, l: &Deconvolution) -> Result<String, ExportError> {
    let x = g.batch_norm(&format!("{name}.norm"), x, &l.norm)?;
    let x = g.deconvolution(name, &x, &l.deconvolution)?;
    Ok(g.node(&format!("{name}.active"), "Relu", &[&x], vec![]))
}

/// Normalisation, the pins beside it, deconvolution.
fn with_pins(g: &mut GraphBuilder, name: &str, x: &str, l: &Deconvolution) -> Result<String, ExportError> {
    let x = g.batch_norm(&format!("{name}.norm"), x, &l.norm)?;
    let x = g.concat(&format!("{name}.pinned"), &[&x, "pin_distance"]);
    g.deconvolution(name, &x, &l.deconvolution)
}

fn stitch(g: &mut GraphBuilder, name: &str, x: &str, skip: &str, times: usize) -> String {
    let repeated = g.repeat(&format!("{name}.skip"), skip, times);
    g.concat(&format!("{name}.stitched"), &[x, &repeated])
}
