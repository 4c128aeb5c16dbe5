//! What each operation of a generator does to shapes, for one description (batch 1).
//!
//! The inference engine infers shapes too, but it folds constants and reserves memory as it goes: a
//! file of 200 bytes can ask it for a terabyte. So every node is measured here first, by the rules
//! of opset 17 and only for the operations and attributes that a generator needs. What passes is
//! small, and every tensor is what its operation expects.

use crate::Error;
use crate::call::{Call, Kind, MAX_RANK, Value, elements};

/// The output of a node. Its dependence is the union of the inputs'. Errors: [`Error::Op`],
/// [`Error::Graph`], [`Error::TensorShape`].
pub(crate) fn infer(call: &Call<'_>) -> Result<Value, Error> {
    let mut out = match call.node.op_type.as_str() {
        "Cast" => cast(call),
        "Gather" => gather(call),
        "Unsqueeze" => unsqueeze(call),
        "Squeeze" => squeeze(call),
        "Add" | "Sub" | "Mul" | "Div" => broadcast(call),
        "ReduceSum" => reduce_sum(call),
        "Concat" => concat(call),
        "ConvTranspose" => convolution(call, true),
        "Conv" => convolution(call, false),
        "BatchNormalization" => batch_normalization(call),
        "Relu" | "Tanh" | "Sqrt" | "Identity" => element_wise(call, &[]),
        "LeakyRelu" => element_wise(call, &["alpha"]),
        "Gemm" => gemm(call),
        "MatMul" => mat_mul(call),
        "Reshape" => reshape(call),
        "Expand" => expand(call),
        "Transpose" => transpose(call),
        "Resize" => resize(call),
        op => Err(Error::Op { op: op.into(), node: call.output().into() }),
    }?;
    elements(&out.dims).ok_or_else(|| call.bad("its output is too large"))?;
    out.sources = call.inputs.iter().flatten().fold(0, |bits, v| bits | v.sources);
    Ok(out)
}

fn cast(call: &Call<'_>) -> Result<Value, Error> {
    call.takes(1..=1, &["to"])?;
    let x = call.input(0)?;
    if x.kind == Kind::I64 || call.int("to", 0)? != i64::from(Kind::F32.code()) {
        return Err(call.bad("only float16 or float32 to float32 is read"));
    }
    Ok(Value::computed(Kind::F32, x.dims.clone()))
}

fn gather(call: &Call<'_>) -> Result<Value, Error> {
    call.takes(2..=2, &["axis"])?;
    let (table, rows) = (call.input(0)?, call.input(1)?);
    if table.kind == Kind::I64 || !table.stored || rows.kind != Kind::I64 || call.int("axis", 0)? != 0 {
        return Err(call.bad("only rows (int64) of a stored table are read"));
    }
    if table.dims.len() != 2 {
        return Err(call.shape(0, "rows x width"));
    }
    let mut dims = rows.dims.clone();
    dims.push(table.dims[1]);
    Ok(Value::computed(table.kind, dims))
}

fn unsqueeze(call: &Call<'_>) -> Result<Value, Error> {
    call.takes(2..=2, &[])?;
    let x = call.input(0)?;
    let rank = x.dims.len() + call.input(1)?.list.len();
    let mut dims = x.dims.clone();
    for axis in call.axes(rank)? {
        dims.insert(axis, 1);
    }
    Ok(Value::computed(x.kind, dims))
}

fn squeeze(call: &Call<'_>) -> Result<Value, Error> {
    call.takes(2..=2, &[])?;
    let x = call.input(0)?;
    let mut dims = x.dims.clone();
    for axis in call.axes(dims.len())?.into_iter().rev() {
        if dims.remove(axis) != 1 {
            return Err(call.shape(0, "1 along the squeezed axes"));
        }
    }
    Ok(Value::computed(x.kind, dims))
}

fn broadcast(call: &Call<'_>) -> Result<Value, Error> {
    call.takes(2..=2, &[])?;
    let (a, b) = (call.float(0)?, call.float(1)?);
    let dims = join(&a.dims, &b.dims).ok_or_else(|| call.shape(1, &format!("one that fits {:?}", a.dims)))?;
    Ok(Value::computed(Kind::F32, dims))
}

/// The shape that both shapes stretch to along axes of 1, aligned at the last axis.
fn join(a: &[usize], b: &[usize]) -> Option<Vec<usize>> {
    let rank = a.len().max(b.len());
    let at = |d: &[usize], i: usize| (i + d.len()).checked_sub(rank).map_or(1, |i| d[i]);
    (0..rank)
        .map(|i| match (at(a, i), at(b, i)) {
            (x, y) if x == y || y == 1 => Some(x),
            (1, y) => Some(y),
            _ => None,
        })
        .collect()
}

fn reduce_sum(call: &Call<'_>) -> Result<Value, Error> {
    call.takes(2..=2, &["keepdims", "noop_with_empty_axes"])?;
    let x = call.float(0)?;
    let keep = call.int("keepdims", 1)?;
    let noop = call.int("noop_with_empty_axes", 0)?;
    if !(0..=1).contains(&keep) || !(0..=1).contains(&noop) {
        return Err(call.bad("its flags are not 0 or 1"));
    }
    let mut dims = x.dims.clone();
    for axis in call.axes(dims.len())?.into_iter().rev() {
        if keep == 1 {
            dims[axis] = 1;
        } else {
            dims.remove(axis);
        }
    }
    Ok(Value::computed(Kind::F32, dims))
}

fn concat(call: &Call<'_>) -> Result<Value, Error> {
    call.takes(1..=16, &["axis"])?;
    if call.attribute("axis", 2)?.is_none() {
        return Err(call.bad("its attribute axis is missing"));
    }
    let mut dims = call.float(0)?.dims.clone();
    let axis = call.axis(call.int("axis", 0)?, dims.len())?;
    for i in 1..call.inputs.len() {
        let next = &call.float(i)?.dims;
        let fits = next.len() == dims.len() && (0..dims.len()).all(|k| k == axis || next[k] == dims[k]);
        if !fits {
            return Err(call.shape(i, &format!("{dims:?} but for axis {axis}")));
        }
        // no overflow: both are within MAX_ELEMENTS
        dims[axis] += next[axis];
    }
    Ok(Value::computed(Kind::F32, dims))
}

/// Conv and ConvTranspose in two dimensions, one group, no dilation.
fn convolution(call: &Call<'_>, transposed: bool) -> Result<Value, Error> {
    let common = ["kernel_shape", "strides", "pads", "dilations", "group", "output_padding"];
    call.takes(2..=3, if transposed { &common } else { &common[..5] })?;
    let (x, w) = (call.float(0)?, call.weight(1)?);
    let &[batch, channels, height, width] = x.dims.as_slice() else {
        return Err(call.shape(0, "batch x channels x rows x columns"));
    };
    let &[w0, w1, kernel_rows, kernel_columns] = w.dims.as_slice() else {
        return Err(call.shape(1, "four axes"));
    };
    let (inputs, outputs) = if transposed { (w0, w1) } else { (w1, w0) };
    if inputs != channels {
        return Err(call.shape(1, &format!("{channels} input channels")));
    }
    let kernel = [kernel_rows, kernel_columns];
    if kernel.iter().any(|&k| k > 15) {
        return Err(call.shape(1, "a kernel of at most 15 x 15"));
    }
    if call.ints("kernel_shape", kernel, 1..=15)? != kernel {
        return Err(call.shape(1, "the kernel_shape of its node"));
    }
    if call.inputs.len() == 3 {
        call.expect(2, &call.weight(2)?.dims, &[outputs])?;
    }
    call.ints("dilations", [1, 1], 1..=1)?;
    if call.int("group", 1)? != 1 {
        return Err(call.bad("only one group is read"));
    }
    let strides = call.ints("strides", [1, 1], 1..=8)?;
    let pads: [usize; 4] = call.ints("pads", [0; 4], 0..=15)?;
    let extra = call.ints("output_padding", [0, 0], 0..=7)?;
    let mut sides = [0; 2];
    for (a, (side, size)) in sides.iter_mut().zip([height, width]).enumerate() {
        if pads[a] >= kernel[a] || pads[a + 2] >= kernel[a] || (extra[a] > 0 && extra[a] >= strides[a]) {
            return Err(call.bad("its padding is larger than its kernel or stride"));
        }
        let pad = pads[a] + pads[a + 2];
        let out = if transposed {
            ((size - 1) * strides[a] + kernel[a] + extra[a]).checked_sub(pad)
        } else {
            (size + pad).checked_sub(kernel[a]).map(|free| free / strides[a] + 1)
        };
        *side = out.filter(|&n| n > 0).ok_or_else(|| call.bad("its output is empty"))?;
    }
    let [rows, columns] = if transposed { [height, width] } else { sides };
    call.work(&[batch, channels, outputs, kernel_rows, kernel_columns, rows, columns])?;
    Ok(Value::computed(Kind::F32, vec![batch, outputs, sides[0], sides[1]]))
}

fn batch_normalization(call: &Call<'_>) -> Result<Value, Error> {
    call.takes(5..=5, &["epsilon", "momentum", "training_mode"])?;
    if call.number("epsilon", 1e-5)? <= 0.0 || call.int("training_mode", 0)? != 0 {
        return Err(call.bad("its epsilon is not above 0 or it is in training mode"));
    }
    call.number("momentum", 0.9)?;
    let x = call.float(0)?;
    if x.dims.len() != 4 {
        return Err(call.shape(0, "batch x channels x rows x columns"));
    }
    for i in 1..5 {
        call.expect(i, &call.weight(i)?.dims, &[x.dims[1]])?;
    }
    Ok(Value::computed(Kind::F32, x.dims.clone()))
}

fn element_wise(call: &Call<'_>, attributes: &[&str]) -> Result<Value, Error> {
    call.takes(1..=1, attributes)?;
    call.number("alpha", 0.01)?;
    Ok(Value::computed(Kind::F32, call.float(0)?.dims.clone()))
}

fn gemm(call: &Call<'_>) -> Result<Value, Error> {
    call.takes(2..=3, &["alpha", "beta", "transA", "transB"])?;
    call.number("alpha", 1.0)?;
    call.number("beta", 1.0)?;
    let side = |i: usize, name: &str| -> Result<[usize; 2], Error> {
        let &[rows, columns] = call.float(i)?.dims.as_slice() else {
            return Err(call.shape(i, "rows x columns"));
        };
        match call.int(name, 0)? {
            0 => Ok([rows, columns]),
            1 => Ok([columns, rows]),
            _ => Err(call.bad("its flags are not 0 or 1")),
        }
    };
    let ([rows, inner], [inner_b, columns]) = (side(0, "transA")?, side(1, "transB")?);
    if inner != inner_b {
        return Err(call.shape(1, &format!("{inner} along the inner axis")));
    }
    if call.inputs.len() == 3 {
        let c = &call.float(2)?.dims;
        if join(c, &[rows, columns]).is_none_or(|d| d != [rows, columns]) {
            return Err(call.shape(2, &format!("one that fits [{rows}, {columns}]")));
        }
    }
    call.work(&[rows, inner, columns])?;
    Ok(Value::computed(Kind::F32, vec![rows, columns]))
}

fn mat_mul(call: &Call<'_>) -> Result<Value, Error> {
    call.takes(2..=2, &[])?;
    let (&[rows, inner], &[inner_b, columns]) = (call.float(0)?.dims.as_slice(), call.float(1)?.dims.as_slice()) else {
        return Err(call.bad("only two axes are read"));
    };
    if inner != inner_b {
        return Err(call.shape(1, &format!("{inner} rows")));
    }
    call.work(&[rows, inner, columns])?;
    Ok(Value::computed(Kind::F32, vec![rows, columns]))
}

fn reshape(call: &Call<'_>) -> Result<Value, Error> {
    call.takes(2..=2, &["allowzero"])?;
    let x = call.float(0)?;
    let wanted = call.integers(1)?;
    if call.int("allowzero", 0)? != 0 || wanted.len() > MAX_RANK {
        return Err(call.bad("allowzero or too many axes"));
    }
    let total = elements(&x.dims).ok_or_else(|| call.bad("its input is too large"))?;
    let mut dims = Vec::new();
    let mut free = None;
    for (i, &want) in wanted.iter().enumerate() {
        dims.push(match want {
            // 0 copies the axis, -1 is what is left
            0 => *x.dims.get(i).ok_or_else(|| call.bad("it copies an axis that is not there"))?,
            -1 if free.is_none() => {
                free = Some(i);
                1
            }
            n => usize::try_from(n).map_err(|_| call.bad("a size is negative"))?,
        });
    }
    let known = elements(&dims).ok_or_else(|| call.bad("its output is too large"))?;
    if let Some(i) = free {
        dims[i] = total / known;
    }
    if elements(&dims) != Some(total) {
        return Err(call.shape(0, &format!("{wanted:?} has other elements")));
    }
    Ok(Value::computed(Kind::F32, dims))
}

fn expand(call: &Call<'_>) -> Result<Value, Error> {
    call.takes(2..=2, &[])?;
    let x = call.float(0)?;
    let wanted: Option<Vec<usize>> = call.integers(1)?.iter().map(|&n| usize::try_from(n).ok()).collect();
    let dims = wanted.and_then(|w| join(&x.dims, &w));
    Ok(Value::computed(Kind::F32, dims.ok_or_else(|| call.shape(0, "one that stretches to the wanted"))?))
}

fn transpose(call: &Call<'_>) -> Result<Value, Error> {
    call.takes(1..=1, &["perm"])?;
    let x = call.float(0)?;
    let perm = call.attribute("perm", 7)?.map(|a| a.ints.clone());
    let perm = perm.unwrap_or_else(|| (0..x.dims.len() as i64).rev().collect());
    let mut sorted = perm.clone();
    sorted.sort_unstable();
    if !sorted.iter().copied().eq(0..x.dims.len() as i64) {
        return Err(call.bad("its perm is no permutation"));
    }
    // each is within 0 and the rank
    Ok(Value::computed(Kind::F32, perm.iter().map(|&i| x.dims[i as usize]).collect()))
}

/// Nearest neighbour, to a whole multiple of both sides, given by scales or by sizes.
fn resize(call: &Call<'_>) -> Result<Value, Error> {
    call.takes(3..=4, &["mode", "coordinate_transformation_mode", "nearest_mode"])?;
    call.text("mode", "nearest", &["nearest"])?;
    call.text("coordinate_transformation_mode", "half_pixel", &["half_pixel", "asymmetric"])?;
    call.text("nearest_mode", "round_prefer_floor", &["floor", "round_prefer_floor"])?;
    let x = call.float(0)?;
    if x.dims.len() != 4 {
        return Err(call.shape(0, "batch x channels x rows x columns"));
    }
    let wanted: Vec<f64> = match (call.inputs[1], call.inputs[2], call.inputs.get(3).copied().flatten()) {
        (None, Some(_), None) => {
            let scales = call.weight(2)?;
            scales.list.iter().zip(&x.dims).map(|(s, &d)| s * d as f64).collect()
        }
        (None, None, Some(_)) => call.integers(3)?.iter().map(|&n| n as f64).collect(),
        _ => return Err(call.bad("either scales or sizes are read")),
    };
    let whole = |(&want, &have): (&f64, &usize)| {
        let times = want / have as f64;
        times.fract() == 0.0 && (1.0..=64.0).contains(&times)
    };
    if wanted.len() != 4
        || !wanted.iter().zip(&x.dims).all(whole)
        || wanted[0] != x.dims[0] as f64
        || wanted[1] != x.dims[1] as f64
    {
        return Err(call.bad("only whole multiples of both sides are read"));
    }
    Ok(Value::computed(Kind::F32, wanted.iter().map(|&n| n as usize).collect()))
}
