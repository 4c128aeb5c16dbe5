//! What is known of a tensor, and a node with what is known of its inputs: the questions that the
//! rules in `shapes` ask of both.

use std::ops::RangeInclusive;

use tract_onnx::pb::{AttributeProto, NodeProto};

use crate::Error;

/// Most numbers of one tensor: twice the first layer of a generator of width 64.
pub(crate) const MAX_ELEMENTS: usize = 1 << 25;
/// Most multiply-adds of one node, some seconds of one core.
const MAX_WORK: usize = 1 << 32;
/// Most axes of a tensor.
pub(crate) const MAX_RANK: usize = 6;

/// Type of the numbers of a tensor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    F32,
    F16,
    I64,
}

impl Kind {
    /// Its number in onnx.proto3.
    pub fn code(self) -> i32 {
        match self {
            Kind::F32 => 1,
            Kind::F16 => 10,
            Kind::I64 => 7,
        }
    }

    pub fn of_code(code: i32) -> Option<Kind> {
        [Kind::F32, Kind::F16, Kind::I64].into_iter().find(|k| k.code() == code)
    }

    pub fn bytes(self) -> usize {
        match self {
            Kind::F32 => 4,
            Kind::F16 => 2,
            Kind::I64 => 8,
        }
    }
}

/// What is known of a tensor.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Value {
    pub kind: Kind,
    pub dims: Vec<usize>,
    /// The graph inputs that it depends on, a bit each.
    pub sources: u8,
    /// Whether it stands in the file.
    pub stored: bool,
    /// The numbers of a short stored list: axes, sizes, scales.
    pub list: Vec<f64>,
}

impl Value {
    /// A tensor that is computed.
    pub fn computed(kind: Kind, dims: Vec<usize>) -> Value {
        Value { kind, dims, sources: 0, stored: false, list: Vec::new() }
    }
}

/// A node with what is known of its inputs; an input that is left out is None.
pub(crate) struct Call<'a> {
    pub node: &'a NodeProto,
    pub inputs: Vec<Option<&'a Value>>,
}

/// Numbers of a tensor, at most [`MAX_ELEMENTS`], of at most 6 axes that are not empty.
pub(crate) fn elements(dims: &[usize]) -> Option<usize> {
    if dims.len() > MAX_RANK || dims.contains(&0) {
        return None;
    }
    let product = dims.iter().try_fold(1usize, |n, &d| n.checked_mul(d));
    product.filter(|&n| n <= MAX_ELEMENTS)
}

impl Call<'_> {
    pub fn output(&self) -> &str {
        self.node.output.first().map_or("", String::as_str)
    }

    pub fn bad(&self, reason: &str) -> Error {
        Error::Graph { reason: format!("{} {}: {reason}", self.node.op_type, self.output()) }
    }

    /// Checks the number of inputs and the names of the attributes.
    pub fn takes(&self, inputs: RangeInclusive<usize>, attributes: &[&str]) -> Result<(), Error> {
        if !inputs.contains(&self.inputs.len()) {
            return Err(self.bad(&format!("{} inputs", self.inputs.len())));
        }
        let given = &self.node.attribute;
        for (i, a) in given.iter().enumerate() {
            if !attributes.contains(&a.name.as_str()) || given[..i].iter().any(|b| b.name == a.name) {
                return Err(self.bad(&format!("its attribute {} does not belong here", a.name)));
            }
        }
        Ok(())
    }

    pub fn input(&self, i: usize) -> Result<&Value, Error> {
        let value = self.inputs.get(i).copied().flatten();
        value.ok_or_else(|| self.bad(&format!("its input {i} is missing")))
    }

    pub fn float(&self, i: usize) -> Result<&Value, Error> {
        let value = self.input(i)?;
        if value.kind == Kind::F32 { Ok(value) } else { Err(self.bad(&format!("its input {i} is not float32"))) }
    }

    /// A float32 tensor of the file.
    pub fn weight(&self, i: usize) -> Result<&Value, Error> {
        let value = self.float(i)?;
        if value.stored { Ok(value) } else { Err(self.bad(&format!("its input {i} is not a weight of the file"))) }
    }

    /// A short list of whole numbers of the file.
    pub fn integers(&self, i: usize) -> Result<Vec<i64>, Error> {
        let value = self.input(i)?;
        if value.kind != Kind::I64 || !value.stored || value.dims.len() != 1 || value.list.len() != value.dims[0] {
            return Err(self.bad(&format!("its input {i} is not a short stored list of int64")));
        }
        Ok(value.list.iter().map(|&x| x as i64).collect())
    }

    pub fn expect(&self, i: usize, found: &[usize], expected: &[usize]) -> Result<(), Error> {
        if found == expected { Ok(()) } else { Err(self.shape(i, &format!("{expected:?}"))) }
    }

    pub fn shape(&self, i: usize, expected: &str) -> Error {
        Error::TensorShape {
            tensor: self.node.input.get(i).cloned().unwrap_or_default(),
            expected: format!("{expected} ({} {})", self.node.op_type, self.output()),
            found: self.inputs.get(i).copied().flatten().map(|v| v.dims.clone()).unwrap_or_default(),
        }
    }

    pub fn attribute(&self, name: &str, code: i32) -> Result<Option<&AttributeProto>, Error> {
        match self.node.attribute.iter().find(|a| a.name == name) {
            Some(a) if a.r#type != code => Err(self.bad(&format!("its attribute {name} has a wrong type"))),
            found => Ok(found),
        }
    }

    pub fn int(&self, name: &str, default: i64) -> Result<i64, Error> {
        Ok(self.attribute(name, 2)?.map_or(default, |a| a.i))
    }

    pub fn number(&self, name: &str, default: f32) -> Result<f32, Error> {
        let value = self.attribute(name, 1)?.map_or(default, |a| a.f);
        if value.is_finite() { Ok(value) } else { Err(self.bad(&format!("its attribute {name} is not finite"))) }
    }

    pub fn text(&self, name: &str, default: &str, allowed: &[&str]) -> Result<(), Error> {
        let value = self.attribute(name, 3)?.map_or(default.as_bytes(), |a| a.s.as_slice());
        if allowed.iter().any(|a| a.as_bytes() == value) {
            return Ok(());
        }
        Err(self.bad(&format!("its attribute {name} is not one of {allowed:?}")))
    }

    /// A list attribute of `N` whole numbers within `bounds`.
    pub fn ints<const N: usize>(
        &self,
        name: &str,
        default: [usize; N],
        bounds: RangeInclusive<usize>,
    ) -> Result<[usize; N], Error> {
        let Some(a) = self.attribute(name, 7)? else {
            return Ok(default);
        };
        let list: Option<Vec<usize>> = a.ints.iter().map(|&i| usize::try_from(i).ok()).collect();
        list.and_then(|l| <[usize; N]>::try_from(l).ok()).filter(|l| l.iter().all(|i| bounds.contains(i))).ok_or_else(
            || {
                self.bad(&format!(
                    "its attribute {name} is not {N} numbers within {} to {}",
                    bounds.start(),
                    bounds.end()
                ))
            },
        )
    }

    /// An axis of a tensor of `rank` axes; negative ones count from the end.
    pub fn axis(&self, axis: i64, rank: usize) -> Result<usize, Error> {
        let from_end = if axis < 0 { axis.checked_add(rank as i64) } else { Some(axis) };
        let axis = from_end.and_then(|a| usize::try_from(a).ok()).filter(|&a| a < rank);
        axis.ok_or_else(|| self.bad("an axis is out of range"))
    }

    /// The axes of input 1, distinct and sorted.
    pub fn axes(&self, rank: usize) -> Result<Vec<usize>, Error> {
        let mut axes = self.integers(1)?.into_iter().map(|a| self.axis(a, rank)).collect::<Result<Vec<_>, _>>()?;
        let given = axes.len();
        axes.sort_unstable();
        axes.dedup();
        if axes.len() != given || given == 0 {
            return Err(self.bad("its axes repeat or are none"));
        }
        Ok(axes)
    }

    pub fn work(&self, factors: &[usize]) -> Result<(), Error> {
        let work = factors.iter().try_fold(1usize, |n, &f| n.checked_mul(f));
        if work.is_some_and(|w| w <= MAX_WORK) { Ok(()) } else { Err(self.bad("it asks for too much work")) }
    }
}
