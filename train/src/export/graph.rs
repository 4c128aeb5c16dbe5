//! A graph under construction: constants and operations are appended in order, names come back.

use burn::Tensor;
use burn::nn::conv::{Conv2d, ConvTranspose2d};
use burn::nn::{BatchNorm, Linear};
use half::f16;

use super::ExportError;
use super::proto::{
    AttributeProto, Dimension, DimensionValue, GraphProto, NodeProto, TensorProto, TensorShapeProto, TensorTypeProto,
    TypeProto, ValueInfoProto, attribute_type, data_type,
};

/// The graph so far. Values are known by name: that of the constant, or of the node that makes them.
#[derive(Debug, Default)]
pub(super) struct GraphBuilder {
    graph: GraphProto,
}

impl GraphBuilder {
    pub(super) fn new(name: &str) -> Self {
        Self { graph: GraphProto { name: name.into(), ..Default::default() } }
    }

    pub(super) fn finish(self) -> GraphProto {
        self.graph
    }

    /// An input of the graph; a side of `None` is the symbolic `batch`.
    pub(super) fn input(&mut self, name: &str, elem_type: i32, shape: &[Option<usize>]) {
        self.graph.input.push(value_info(name, elem_type, shape));
    }

    /// Declares the value `name`, made by a node, an f32 output of the graph.
    pub(super) fn output(&mut self, name: &str, shape: &[Option<usize>]) {
        self.graph.output.push(value_info(name, data_type::FLOAT, shape));
    }

    /// An operation; its value has its name.
    pub(super) fn node(&mut self, name: &str, op: &str, input: &[&str], attribute: Vec<AttributeProto>) -> String {
        self.graph.node.push(NodeProto {
            input: input.iter().map(|s| s.to_string()).collect(),
            output: vec![name.into()],
            name: name.into(),
            op_type: op.into(),
            attribute,
        });
        name.into()
    }

    fn constant(&mut self, name: &str, dims: &[usize], data_type: i32, raw_data: Vec<u8>) -> String {
        let dims = dims.iter().map(|d| *d as i64).collect();
        self.graph.initializer.push(TensorProto { dims, data_type, name: name.into(), raw_data });
        name.into()
    }

    /// A vector of integers (axes and the like).
    pub(super) fn integers(&mut self, name: &str, values: &[i64]) -> String {
        let raw = values.iter().flat_map(|v| v.to_le_bytes()).collect();
        self.constant(name, &[values.len()], data_type::INT64, raw)
    }

    /// A vector of a normalisation, as f32 and without a Cast: see the writer for why.
    fn exact(&mut self, name: &str, tensor: Tensor<1>) -> Result<String, ExportError> {
        let values =
            tensor.into_data().try_into_vec::<f32>().map_err(|_| ExportError::Tensor { tensor: name.into() })?;
        if values.iter().any(|x| !x.is_finite()) {
            return Err(ExportError::NotFinite { tensor: name.into() });
        }
        Ok(self.floats(name, &values))
    }

    /// A vector of exact f32 numbers.
    pub(super) fn floats(&mut self, name: &str, values: &[f32]) -> String {
        let raw = values.iter().flat_map(|v| v.to_le_bytes()).collect();
        self.constant(name, &[values.len()], data_type::FLOAT, raw)
    }

    /// A constant of f16 numbers, as it is.
    pub(super) fn halves(&mut self, name: &str, dims: &[usize], values: &[f32]) -> Result<String, ExportError> {
        if dims.iter().product::<usize>() != values.len() {
            return Err(ExportError::Tensor { tensor: name.into() });
        }
        let mut raw = Vec::with_capacity(2 * values.len());
        for value in values {
            let half = f16::from_f32(*value);
            if !half.is_finite() {
                return Err(ExportError::NotHalf { tensor: name.into() });
            }
            raw.extend_from_slice(&half.to_le_bytes());
        }
        Ok(self.constant(name, dims, data_type::FLOAT16, raw))
    }

    /// The f32 view of a value.
    pub(super) fn cast(&mut self, name: &str, x: &str) -> String {
        self.node(name, "Cast", &[x], vec![int("to", data_type::FLOAT.into())])
    }

    /// A weight: an f16 constant `name.f16` and its Cast to f32, `name`.
    fn weight<const D: usize>(&mut self, name: &str, tensor: Tensor<D>) -> Result<String, ExportError> {
        let dims = tensor.dims();
        let values =
            tensor.into_data().try_into_vec::<f32>().map_err(|_| ExportError::Tensor { tensor: name.into() })?;
        let half = self.halves(&format!("{name}.f16"), &dims, &values).map_err(|e| match e {
            ExportError::NotHalf { .. } => ExportError::NotHalf { tensor: name.into() },
            _ => ExportError::Tensor { tensor: name.into() },
        })?;
        Ok(self.cast(name, &half))
    }

    fn bias(&mut self, name: &str, bias: Option<Tensor<1>>) -> Result<String, ExportError> {
        let name = format!("{name}.bias");
        match bias {
            Some(tensor) => self.weight(&name, tensor),
            None => Err(ExportError::Tensor { tensor: name }),
        }
    }

    pub(super) fn deconvolution(&mut self, name: &str, x: &str, l: &ConvTranspose2d) -> Result<String, ExportError> {
        let w = self.weight(&format!("{name}.weight"), l.weight.val())?;
        let b = self.bias(name, l.bias.as_ref().map(|b| b.val()))?;
        let [ph, pw] = l.padding;
        let attributes = vec![
            ints("kernel_shape", &l.kernel_size),
            ints("strides", &l.stride),
            ints("pads", &[ph, pw, ph, pw]),
            ints("output_padding", &l.padding_out),
            ints("dilations", &l.dilation),
            int("group", l.groups as i64),
        ];
        Ok(self.node(name, "ConvTranspose", &[x, &w, &b], attributes))
    }

    /// A 1 x 1 convolution (no padding, stride 1).
    pub(super) fn pointwise(&mut self, name: &str, x: &str, l: &Conv2d) -> Result<String, ExportError> {
        if l.kernel_size != [1, 1] || l.stride != [1, 1] || l.groups != 1 {
            return Err(ExportError::Tensor { tensor: format!("{name}.weight") });
        }
        let w = self.weight(&format!("{name}.weight"), l.weight.val())?;
        let b = self.bias(name, l.bias.as_ref().map(|b| b.val()))?;
        Ok(self.node(name, "Conv", &[x, &w, &b], vec![ints("kernel_shape", &l.kernel_size)]))
    }

    pub(super) fn batch_norm(&mut self, name: &str, x: &str, l: &BatchNorm) -> Result<String, ExportError> {
        let parts = [
            ("scale", l.gamma.val()),
            ("shift", l.beta.val()),
            ("mean", l.running_mean.value()),
            ("variance", l.running_var.value()),
        ];
        let mut inputs = vec![x.to_string()];
        for (part, tensor) in parts {
            inputs.push(self.exact(&format!("{name}.{part}"), tensor)?);
        }
        let inputs: Vec<&str> = inputs.iter().map(String::as_str).collect();
        Ok(self.node(name, "BatchNormalization", &inputs, vec![float("epsilon", l.epsilon as f32)]))
    }

    pub(super) fn linear(&mut self, name: &str, x: &str, l: &Linear) -> Result<String, ExportError> {
        let w = self.weight(&format!("{name}.weight"), l.weight.val())?;
        let b = self.bias(name, l.bias.as_ref().map(|b| b.val()))?;
        let product = self.node(&format!("{name}.product"), "MatMul", &[x, &w], vec![]);
        Ok(self.node(name, "Add", &[&product, &b], vec![]))
    }

    /// The sum over the axes that the constant `axes` names; they vanish, or stay with length 1 if `keep` is set.
    pub(super) fn sum_over(&mut self, name: &str, x: &str, axes: &str, keep: bool) -> String {
        self.node(name, "ReduceSum", &[x, axes], vec![int("keepdims", keep.into())])
    }

    pub(super) fn concat(&mut self, name: &str, inputs: &[&str]) -> String {
        self.node(name, "Concat", inputs, vec![int("axis", 1)])
    }

    /// Each pixel of an image becomes a block of `times` x `times` equal ones.
    pub(super) fn repeat(&mut self, name: &str, x: &str, times: usize) -> String {
        let scales = self.floats(&format!("{name}.scales"), &[1.0, 1.0, times as f32, times as f32]);
        let attributes = vec![
            text("mode", "nearest"),
            text("coordinate_transformation_mode", "asymmetric"),
            text("nearest_mode", "floor"),
        ];
        self.node(name, "Resize", &[x, "", &scales], attributes)
    }
}

fn value_info(name: &str, elem_type: i32, shape: &[Option<usize>]) -> ValueInfoProto {
    let dim = shape
        .iter()
        .map(|side| {
            let value = side.map_or(DimensionValue::Param("batch".into()), |n| DimensionValue::Value(n as i64));
            Dimension { value: Some(value) }
        })
        .collect();
    let tensor_type = Some(TensorTypeProto { elem_type, shape: Some(TensorShapeProto { dim }) });
    ValueInfoProto { name: name.into(), r#type: Some(TypeProto { tensor_type }) }
}

fn int(name: &str, i: i64) -> AttributeProto {
    AttributeProto { name: name.into(), i, r#type: attribute_type::INT, ..Default::default() }
}

fn ints(name: &str, values: &[usize]) -> AttributeProto {
    let ints = values.iter().map(|v| *v as i64).collect();
    AttributeProto { name: name.into(), ints, r#type: attribute_type::INTS, ..Default::default() }
}

fn float(name: &str, f: f32) -> AttributeProto {
    AttributeProto { name: name.into(), f, r#type: attribute_type::FLOAT, ..Default::default() }
}

fn text(name: &str, s: &str) -> AttributeProto {
    AttributeProto { name: name.into(), s: s.into(), r#type: attribute_type::STRING, ..Default::default() }
}
