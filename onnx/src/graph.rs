//! Checks that a file holds the graph of a generator, and brings it into the form that is run: one
//! description at a time, weights in float32.

use std::collections::{HashMap, HashSet};

use tract_onnx::pb::tensor_shape_proto::{Dimension, dimension};
use tract_onnx::pb::{
    GraphProto, ModelProto, NodeProto, TensorProto, TensorShapeProto, TypeProto, ValueInfoProto, type_proto,
};
use tract_onnx::prelude::{Framework, tract_data::half::f16};

use crate::call::{Call, Kind, Value, elements};
use crate::guard::guarded;
use crate::shapes::infer;
use crate::{Error, Info};

/// Names of the graph inputs, in the order in which they are fed.
pub(crate) const INPUTS: [&str; 4] = ["tokens", "weights", "noise", "pin_distance"];
/// Names of the graph outputs, in the order in which they are read.
pub(crate) const OUTPUTS: [&str; 2] = ["field", "fabric"];

const IR_VERSION: i64 = 8;
const OPSET: i64 = 17;
const MAX_NODES: usize = 1000;
/// Most numbers that all nodes together may write: some hundred MB.
const MAX_WRITTEN: usize = 1 << 26;
/// Lists up to here are kept by value, for axes, sizes and scales.
const MAX_LIST: usize = 16;

/// A graph that has passed.
pub(crate) struct Checked {
    pub model: ModelProto,
    /// Numbers of all its weights and word vectors.
    pub parameters: usize,
}

/// Shapes of the inputs for one description, in the order of [`INPUTS`].
pub(crate) fn input_shapes(info: &Info) -> [(Kind, Vec<usize>); 4] {
    [
        (Kind::I64, vec![1, info.tokens]),
        (Kind::F32, vec![1, info.tokens]),
        (Kind::F32, vec![1, info.noise]),
        (Kind::F32, vec![1, 1, info.grid, info.grid]),
    ]
}

/// Shapes of the outputs for one description, in the order of [`OUTPUTS`].
pub(crate) fn output_shapes(info: &Info) -> [Vec<usize>; 2] {
    [vec![1, info.channel_ranges.len(), info.grid, info.grid], vec![1, info.fabric_ranges.len()]]
}

/// Decodes and checks the graph of a file whose metadata is `info`.
pub(crate) fn check(bytes: &[u8], info: &Info) -> Result<Checked, Error> {
    let mut reader = bytes;
    let decoded = guarded("decode", || tract_onnx::onnx().proto_model_for_read(&mut reader));
    let mut model = decoded.map_err(|e| match e {
        Error::Inference { reason, .. } => Error::NotOnnx { reason },
        other => other,
    })?;
    let opsets: Vec<_> = model.opset_import.iter().map(|o| (o.domain.as_str(), o.version)).collect();
    if model.ir_version != IR_VERSION || !matches!(opsets[..], [("" | "ai.onnx", OPSET)]) {
        return Err(bad(format!("not of IR version {IR_VERSION} and operator set {OPSET}")));
    }
    let Some(graph) = model.graph.take() else {
        return Err(bad("it is missing"));
    };
    let (graph, parameters) = rebuild(graph, info)?;
    // only what is needed goes on to the engine
    let model = ModelProto {
        ir_version: IR_VERSION,
        opset_import: model.opset_import,
        graph: Some(graph),
        ..ModelProto::default()
    };
    Ok(Checked { model, parameters })
}

fn bad(reason: impl Into<String>) -> Error {
    Error::Graph { reason: reason.into() }
}

fn rebuild(graph: GraphProto, info: &Info) -> Result<(GraphProto, usize), Error> {
    if !graph.sparse_initializer.is_empty() || !graph.quantization_annotation.is_empty() {
        return Err(bad("sparse or quantised weights are not read"));
    }
    if graph.node.len() > MAX_NODES || graph.initializer.len() > MAX_NODES {
        return Err(bad(format!("more than {MAX_NODES} nodes or weights")));
    }
    let inputs = input_shapes(info);
    for (name, (kind, dims)) in INPUTS.iter().zip(&inputs) {
        check_declared(&graph.input, name, *kind, dims)?;
    }
    let outputs = output_shapes(info);
    for (name, dims) in OUTPUTS.iter().zip(&outputs) {
        check_declared(&graph.output, name, Kind::F32, dims)?;
    }
    if graph.input.len() != INPUTS.len() || graph.output.len() != OUTPUTS.len() {
        return Err(bad("it has other inputs or outputs than a generator"));
    }

    let mut values: HashMap<String, Value> = HashMap::new();
    for (bit, (name, (kind, dims))) in INPUTS.iter().zip(inputs.clone()).enumerate() {
        let value = Value { kind, dims, sources: 1 << bit, stored: false, list: Vec::new() };
        define(&mut values, name, value)?;
    }
    let mut weights: HashMap<String, TensorProto> = HashMap::new();
    let mut parameters = 0;
    for tensor in graph.initializer {
        let (value, tensor) = read_weight(tensor)?;
        parameters += if value.kind == Kind::I64 { 0 } else { value.dims.iter().product::<usize>() };
        define(&mut values, &tensor.name, value)?;
        weights.insert(tensor.name.clone(), tensor);
    }

    let mut nodes: Vec<NodeProto> = Vec::new();
    let mut written = 0;
    for mut node in graph.node {
        let value = measure(&node, &values, info)?;
        written += value.dims.iter().product::<usize>();
        if written > MAX_WRITTEN {
            return Err(bad("its nodes write too many numbers"));
        }
        if node.op_type == "BatchNormalization" {
            check_variance(&node, &weights)?;
        }
        let output = node.output[0].clone();
        define(&mut values, &output, value)?;
        match weights.get(&node.input[0]) {
            // A stored f16 weight is widened here, once: the engine asks for stored parameters in
            // batch normalisation, and does not fold a Cast of more than 16 numbers in time.
            Some(weight) if node.op_type == "Cast" => {
                let widened = TensorProto { name: output.clone(), ..weight.clone() };
                weights.insert(output, widened);
            }
            _ => {
                // `#` cannot be in the name of a tensor, so no two names of the engine collide
                node.name = format!("#{}", nodes.len());
                node.doc_string.clear();
                nodes.push(node);
            }
        }
    }
    check_outputs(&nodes, &values, &outputs)?;

    let used: HashSet<&str> = nodes.iter().flat_map(|n| &n.input).map(String::as_str).collect();
    weights.retain(|name, _| used.contains(name.as_str()));
    let mut initializer: Vec<_> = weights.into_values().collect();
    initializer.sort_by(|a, b| a.name.cmp(&b.name));
    let declare = |name: &&str, kind, dims: &[usize]| ValueInfoProto {
        name: (*name).into(),
        r#type: Some(declared_type(kind, dims)),
        ..ValueInfoProto::default()
    };
    let graph = GraphProto {
        node: nodes,
        name: "generator".into(),
        initializer,
        input: INPUTS.iter().zip(&inputs).map(|(n, (k, d))| declare(n, *k, d)).collect(),
        output: OUTPUTS.iter().zip(&outputs).map(|(n, d)| declare(n, Kind::F32, d)).collect(),
        ..GraphProto::default()
    };
    Ok((graph, parameters))
}

/// What a node writes. Its one output is not known yet, and all its inputs are.
fn measure(node: &NodeProto, values: &HashMap<String, Value>, info: &Info) -> Result<Value, Error> {
    let output = node.output.first().map_or("", String::as_str);
    if !matches!(node.domain.as_str(), "" | "ai.onnx") {
        return Err(Error::Op { op: format!("{}.{}", node.domain, node.op_type), node: output.into() });
    }
    let mut inputs = Vec::new();
    for name in &node.input {
        let value = values.get(name);
        if value.is_none() && !name.is_empty() {
            return Err(bad(format!("{output} reads {name}, which is not there before it")));
        }
        inputs.push(value);
    }
    let value = infer(&Call { node, inputs })?;
    if node.output.len() != 1 {
        return Err(bad(format!("{} has {} outputs", node.op_type, node.output.len())));
    }
    let folded = node.op_type == "Cast" && values.get(&node.input[0]).is_some_and(|v| v.stored);
    if node.op_type == "Gather" {
        let table = &values[&node.input[0]];
        if node.input[1] != INPUTS[0] {
            return Err(bad(format!("{output} gathers by {}, not by tokens", node.input[1])));
        }
        if table.dims[0] != info.words + 1 {
            return Err(Error::TensorShape {
                tensor: node.input[0].clone(),
                expected: format!("{} rows, one a line of taut.vocabulary", info.words + 1),
                found: table.dims.clone(),
            });
        }
    }
    let list = if folded { values[&node.input[0]].list.clone() } else { Vec::new() };
    Ok(Value { stored: folded, list, ..value })
}

/// A variance below 0 has no root. The engine would take what comes of it for 0, and run on.
fn check_variance(node: &NodeProto, weights: &HashMap<String, TensorProto>) -> Result<(), Error> {
    let name = &node.input[4];
    let raw = weights.get(name).map_or(&[][..], |w| &w.raw_data);
    let mut numbers = raw.as_chunks::<4>().0.iter().map(|&b| f32::from_le_bytes(b));
    if numbers.any(|x| x < 0.0) {
        return Err(bad(format!("the variance {name} is negative")));
    }
    Ok(())
}

/// Adds a tensor under a name that is plain and new.
fn define(values: &mut HashMap<String, Value>, name: &str, value: Value) -> Result<(), Error> {
    let plain = |b: u8| b.is_ascii_alphanumeric() || b"_./:-".contains(&b);
    if !(1..=128).contains(&name.len()) || !name.bytes().all(plain) {
        return Err(bad(format!(
            "the tensor name \"{}\" is not 1 to 128 plain characters",
            name.chars().take(40).collect::<String>()
        )));
    }
    if values.insert(name.to_owned(), value).is_some() {
        return Err(bad(format!("the tensor {name} is there twice")));
    }
    Ok(())
}

/// Outputs have the shapes that the metadata gives, come from tanh, and the fabric depends on the
/// words alone: another seed must not be another fabric.
fn check_outputs(nodes: &[NodeProto], values: &HashMap<String, Value>, shapes: &[Vec<usize>; 2]) -> Result<(), Error> {
    for (name, dims) in OUTPUTS.iter().zip(shapes) {
        let Some(node) = nodes.iter().find(|n| n.output[0] == *name) else {
            return Err(bad(format!("no node writes the output {name}")));
        };
        if node.op_type != "Tanh" {
            return Err(bad(format!("the output {name} comes from {}, not from Tanh", node.op_type)));
        }
        if values[*name].dims != *dims {
            return Err(Error::TensorShape {
                tensor: (*name).into(),
                expected: format!("{dims:?} by the metadata"),
                found: values[*name].dims.clone(),
            });
        }
    }
    let words_only = 0b0011;
    if values["fabric"].sources & !words_only != 0 {
        return Err(bad("the output fabric depends on more than the words"));
    }
    if values["field"].sources & 1 == 0 {
        return Err(bad("the output field does not depend on the words"));
    }
    Ok(())
}

/// Checks the declared type of an input or output; its batch may be 1 or left open.
fn check_declared(declared: &[ValueInfoProto], name: &str, kind: Kind, dims: &[usize]) -> Result<(), Error> {
    let Some(info) = declared.iter().find(|i| i.name == name) else {
        return Err(bad(format!("the input or output {name} is missing")));
    };
    let Some(TypeProto { value: Some(type_proto::Value::TensorType(tensor)), .. }) = &info.r#type else {
        return Err(bad(format!("{name} is declared without a type")));
    };
    if tensor.elem_type != kind.code() {
        return Err(bad(format!("{name} is not declared as {kind:?}")));
    }
    let sizes: &[Dimension] = tensor.shape.as_ref().map_or(&[], |s| &s.dim);
    let fixed = |d: &Dimension| match d.value {
        Some(dimension::Value::DimValue(n)) => usize::try_from(n).ok(),
        _ => None,
    };
    let found: Vec<usize> = sizes.iter().map(|d| fixed(d).unwrap_or(0)).collect();
    // 0 stands for an open size, which only the batch may be
    let batch = found.first().is_some_and(|&b| b <= 1);
    if !batch || found.len() != dims.len() || found[1..] != dims[1..] {
        return Err(Error::TensorShape {
            tensor: name.into(),
            expected: format!("batch x {:?} by the metadata", &dims[1..]),
            found,
        });
    }
    Ok(())
}

fn declared_type(kind: Kind, dims: &[usize]) -> TypeProto {
    let dim = |&n: &usize| Dimension {
        // at most 4096 by the metadata
        value: Some(dimension::Value::DimValue(n as i64)),
        ..Dimension::default()
    };
    let shape = TensorShapeProto { dim: dims.iter().map(dim).collect() };
    let tensor = type_proto::Tensor { elem_type: kind.code(), shape: Some(shape) };
    TypeProto { value: Some(type_proto::Value::TensorType(tensor)), ..TypeProto::default() }
}

/// Checks a stored tensor and widens it: float numbers become f32. Its numbers must be finite.
fn read_weight(tensor: TensorProto) -> Result<(Value, TensorProto), Error> {
    let name = tensor.name.clone();
    let Some(kind) = Kind::of_code(tensor.data_type) else {
        return Err(bad(format!("the tensor {name} is not float32, float16 or int64")));
    };
    let dims: Option<Vec<usize>> = tensor.dims.iter().map(|&d| usize::try_from(d).ok()).collect();
    let sized = dims.and_then(|d| elements(&d).map(|n| (d, n)));
    let Some((dims, count)) = sized else {
        return Err(bad(format!("the tensor {name} has the impossible shape {:?}", tensor.dims)));
    };
    let typed = !tensor.float_data.is_empty()
        || !tensor.int32_data.is_empty()
        || !tensor.int64_data.is_empty()
        || !tensor.double_data.is_empty()
        || !tensor.uint64_data.is_empty()
        || !tensor.string_data.is_empty();
    if typed || tensor.segment.is_some() || !tensor.external_data.is_empty() || tensor.data_location.unwrap_or(0) != 0 {
        return Err(bad(format!("the tensor {name} is not stored as raw data in the file")));
    }
    let raw = tensor.raw_data;
    if raw.len() != count * kind.bytes() {
        return Err(Error::TensorShape {
            tensor: name,
            expected: format!("one of {} bytes, as many as are stored", raw.len()),
            found: dims,
        });
    }
    let mut list = Vec::new();
    let short = count <= MAX_LIST && dims.len() == 1;
    let raw = match kind {
        Kind::I64 => {
            let numbers = raw.as_chunks::<8>().0.iter().map(|&b| i64::from_le_bytes(b));
            if short {
                // sizes beyond 2^53 are refused by every rule that reads them
                list = numbers.map(|n| n as f64).collect();
            }
            raw
        }
        Kind::F16 | Kind::F32 => {
            let raw = if kind == Kind::F16 { widen(&raw) } else { raw };
            let mut numbers = raw.as_chunks::<4>().0.iter().map(|&b| f32::from_le_bytes(b));
            if numbers.clone().any(|x| !x.is_finite()) {
                return Err(Error::Weights { tensor: name });
            }
            if short {
                list = numbers.by_ref().map(f64::from).collect();
            }
            raw
        }
    };
    let stored = TensorProto {
        name,
        dims: tensor.dims,
        // f16 is widened at once; the graph still sees it as f16 until its Cast
        data_type: if kind == Kind::I64 { kind.code() } else { Kind::F32.code() },
        raw_data: raw,
        ..TensorProto::default()
    };
    Ok((Value { kind, dims, sources: 0, stored: true, list }, stored))
}

/// f16 numbers as f32 numbers, both little-endian.
fn widen(raw: &[u8]) -> Vec<u8> {
    let wide = |&b: &[u8; 2]| f16::from_le_bytes(b).to_f32().to_le_bytes();
    raw.as_chunks::<2>().0.iter().flat_map(wide).collect()
}
