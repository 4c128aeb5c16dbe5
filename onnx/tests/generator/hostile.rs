//! Files that are not what they should be: each is an error of one line that names what is wrong,
//! never a panic, and never one that had to be caught.

use prost::Message;
use taut_onnx::{Error, Generator, MAX_FILE_BYTES, Request};

use crate::messages::*;
use crate::miniature::*;

/// The text of an error, after checks that hold for all of them.
fn text(error: &Error) -> String {
    let text = error.to_string();
    assert!(!text.is_empty() && text.len() < 1000, "{text}");
    assert!(!text.chars().any(char::is_control), "{text:?}");
    assert!(!text.contains("panicked"), "a check is missing: {text}");
    text
}

/// Loads and runs; what comes of it is finite or an error.
fn try_all(bytes: &[u8]) -> Result<(), Error> {
    let generator = Generator::from_bytes(bytes)?;
    let correction = generator.correct(&Request { pins: &[(0, 0)], ..Request::new("heavy blue denim") })?;
    assert!(correction.field.iter().all(|k| k.is_finite() && *k > 0.0));
    Ok(())
}

fn refused(model: &Model) -> Error {
    let error = try_all(&model.encode_to_vec()).expect_err("it must be refused");
    text(&error);
    error
}

/// The miniature with a change.
fn changed(change: impl FnOnce(&mut Model)) -> Model {
    let mut model = model();
    change(&mut model);
    model
}

fn graph(change: impl FnOnce(&mut Graph)) -> Error {
    refused(&changed(|m| change(m.graph.as_mut().unwrap())))
}

fn node(output: &str, change: impl FnOnce(&mut Node)) -> Error {
    graph(|g| change(g.node.iter_mut().find(|n| n.output[0] == output).unwrap()))
}

fn tensor(name: &str, change: impl FnOnce(&mut Tensor)) -> Error {
    graph(|g| change(g.initializer.iter_mut().find(|t| t.name == name).unwrap()))
}

fn metadata(key: &str, value: &str) -> Error {
    refused(&changed(|m| m.metadata_props.iter_mut().find(|e| e.key == key).unwrap().value = value.into()))
}

#[test]
fn cut_files() {
    let bytes = bytes();
    for i in 0..50 {
        let error = try_all(&bytes[..bytes.len() * i / 50]).expect_err("a cut file");
        text(&error);
        // within the graph, which is most of the file, the cut itself is named
        if (10..48).contains(&i) {
            assert!(matches!(error, Error::Truncated { .. }), "{i}: {error}");
        }
    }
    // the last bytes, one by one
    for cut in bytes.len() - 600..bytes.len() {
        text(&try_all(&bytes[..cut]).expect_err("a cut file"));
    }
}

/// Flips `count` single bits at places that `place` chooses.
fn flip(count: u32, seed: u64, place: impl Fn(u64, usize) -> usize) -> (u32, u32) {
    let good = bytes();
    let (mut refused, mut taken) = (0, 0);
    for i in 0..count {
        let mut bytes = good.clone();
        let random = taut::noise::bits(seed, i);
        let at = place(random, bytes.len());
        bytes[at] ^= 1 << (random >> 60 & 7);
        match try_all(&bytes) {
            Ok(()) => taken += 1,
            Err(error) => {
                text(&error);
                refused += 1;
            }
        }
    }
    (refused, taken)
}

#[test]
fn flipped_bits_anywhere() {
    let (_, taken) = flip(300, 1, |random, length| (random % length as u64) as usize);
    assert!(taken > 100, "most of the file is weights, where a flip only changes a number");
}

#[test]
fn flipped_bits_outside_the_first_layer() {
    // The nodes stand first, the weights of the first layer after them: 2000 bytes at either end
    // hold all that has structure.
    let (refused, _) = flip(1500, 2, |random, length| {
        let at = (random % 4000) as usize;
        if at < 2000 { at } else { length - 4000 + at }
    });
    assert!(refused > 700, "{refused}");
}

#[test]
fn overwritten_stretches() {
    let good = bytes();
    for i in 0..200 {
        let mut bytes = good.clone();
        let random = taut::noise::bits(3, i);
        let at = (random % 3000) as usize;
        for (k, byte) in bytes[at..at + 1 + i as usize % 24].iter_mut().enumerate() {
            *byte = taut::noise::bits(random, k as u32) as u8;
        }
        if let Err(error) = try_all(&bytes) {
            text(&error);
        }
    }
}

#[test]
fn other_files() {
    for bytes in [&b""[..], b"\0", b"\x89PNG\r\n\x1a\n", b"hello world, this is no model", &[0xff; 100]] {
        let error = try_all(bytes).unwrap_err();
        text(&error);
    }
    let huge = vec![0; MAX_FILE_BYTES + 1];
    assert_eq!(try_all(&huge), Err(Error::TooLarge { limit: MAX_FILE_BYTES }));
    // an ONNX file of someone else
    let error = refused(&changed(|m| m.metadata_props.clear()));
    assert_eq!(error, Error::MetadataMissing { key: "taut.format" });
}

#[test]
fn metadata_against_tensors() {
    assert!(matches!(metadata("taut.grid", "64"), Error::TensorShape { tensor, .. } if tensor == "pin_distance"));
    assert!(matches!(metadata("taut.noise", "64"), Error::TensorShape { tensor, .. } if tensor == "noise"));
    assert!(matches!(metadata("taut.tokens", "8"), Error::TensorShape { tensor, .. } if tensor == "tokens"));
    let error = metadata("taut.vocabulary", "<pad>\ndenim\nsilk");
    assert!(matches!(&error, Error::TensorShape { tensor, .. } if tensor == "words"), "{error}");
    for (key, value) in [("taut.grid", "999999999"), ("taut.vocabulary", "<pad>\ndenim\ndenim"), ("taut.format", "2")] {
        assert!(matches!(metadata(key, value), Error::Metadata { key: named, .. } if named == key));
    }
    for (key, _) in METADATA {
        let error = refused(&changed(|m| m.metadata_props.retain(|e| e.key != key)));
        assert_eq!(error, Error::MetadataMissing { key });
    }
}

#[test]
fn operations_that_do_not_belong() {
    for op in ["Loop", "If", "Scan", "RandomNormal", "Foo", "NonZero", "ConstantOfShape", "", "Einsum"] {
        let error = node("z", |n| n.op_type = op.into());
        assert!(matches!(&error, Error::Op { op: named, .. } if named == op), "{error}");
    }
    let error = node("y4", |n| n.domain = "com.example".into());
    assert!(text(&error).contains("com.example.Relu"), "{error}");
    assert!(matches!(node("fabric", |n| n.op_type = "Relu".into()), Error::Graph { .. }));
}

#[test]
fn shapes_that_do_not_fit() {
    let named = |error: Error, expected: &str| match &error {
        Error::TensorShape { tensor, .. } => assert_eq!(tensor, expected),
        _ => panic!("{error}"),
    };
    named(tensor("first.f16", |t| t.dims[0] -= 1), "first.f16");
    named(tensor("first.f16", |t| t.dims = vec![CHANNELS as i64, 136, 5, 5]), "first");
    named(tensor("first.f16", |t| t.dims = vec![136, CHANNELS as i64, 25]), "first");
    named(
        tensor("last.bias.f16", |t| {
            t.dims = vec![2];
            t.raw_data.truncate(4);
        }),
        "last.bias",
    );
    named(
        tensor("normal.var.f16", |t| {
            t.dims = vec![3];
            t.raw_data.truncate(6);
        }),
        "normal.var",
    );
    named(tensor("head.f16", |t| t.dims = vec![10, 4]), "head");
    named(
        tensor("head.f16", |t| {
            t.dims = vec![8, 4];
            t.raw_data.truncate(64);
        }),
        "fabric",
    );
    named(tensor("words.f16", |t| t.dims = vec![8, 10]), "words");
    named(tensor("words.f16", |t| t.raw_data.clear()), "words.f16");
    named(node("x4", |n| n.attribute[2] = ints("pads", &[0; 4])), "pin_distance");
    // sizes that no machine has
    for dims in [vec![i64::MAX], vec![1 << 40, 1 << 40], vec![-1], vec![0], vec![1; 100], vec![i64::MIN, 2]] {
        let error = tensor("words.f16", |t| t.dims = dims);
        assert!(text(&error).contains("words.f16"), "{error}");
    }
    let error = tensor("scales", |t| t.raw_data = [1f32, 1.0, 1e9, 1e9].iter().flat_map(|x| x.to_le_bytes()).collect());
    assert!(text(&error).contains("y32"), "{error}");
    let bomb = |b: &mut Builder| {
        b.integers("wide", &[1 << 20, 1 << 20, 128]);
        b.op("Expand", &["noise", "wide"], "bomb", vec![]);
    };
    let error = graph(|g| {
        let mut b = Builder { graph: std::mem::take(g) };
        bomb(&mut b);
        *g = b.graph;
    });
    assert!(text(&error).contains("bomb"), "{error}");
}

#[test]
fn attributes_that_do_not_fit() {
    let bad = [
        ints("strides", &[0, 0]),
        ints("strides", &[-1, 2]),
        ints("strides", &[2]),
        ints("strides", &[i64::MAX, i64::MAX]),
        ints("pads", &[9, 9, 9, 9]),
        ints("pads", &[1, 1]),
        ints("output_padding", &[5, 5]),
        ints("dilations", &[1000, 1000]),
        ints("kernel_shape", &[3, 3]),
        int("group", 0),
        int("group", 7),
        ints("output_shape", &[1 << 30, 1 << 30]),
        crate::miniature::text("auto_pad", "SAME_UPPER"),
        int("strides", 2),
        int("loop", 1),
    ];
    for attribute in bad {
        let error = node("x4", |n| {
            n.attribute.retain(|a| a.name != attribute.name);
            n.attribute.push(attribute.clone());
        });
        assert!(text(&error).contains("x4"), "{attribute:?}: {error}");
    }
    for (output, attribute) in [
        ("words", int("to", 7)),
        ("words", int("to", 0)),
        ("vectors", int("axis", 1)),
        ("vectors", int("axis", -3)),
        ("v_text", int("keepdims", 5)),
        ("z", int("axis", 9)),
        ("z", int("axis", i64::MIN)),
        ("n4", float("epsilon", f32::NAN)),
        ("n4", int("training_mode", 1)),
        ("y32", crate::miniature::text("mode", "cubic")),
        ("told", float("alpha", f32::INFINITY)),
        ("told", int("transA", 2)),
    ] {
        let error = node(output, |n| {
            n.attribute.retain(|a| a.name != attribute.name);
            n.attribute.push(attribute.clone());
        });
        assert!(text(&error).contains(output), "{attribute:?}: {error}");
    }
    node("z", |n| n.attribute.clear());
    node("x4", |n| {
        let again = n.attribute[0].clone();
        n.attribute.push(again);
    });
}

#[test]
fn graphs_that_are_put_together_wrongly() {
    let reason = |error: Error, part: &str| assert!(text(&error).contains(part), "{part}: {error}");
    reason(node("y4", |n| n.input[0] = "nothing".into()), "nothing");
    reason(node("y4", |n| n.input[0] = "y4".into()), "y4");
    reason(node("y4", |n| n.input.clear()), "0 inputs");
    reason(node("y4", |n| n.input[0].clear()), "input 0");
    reason(node("y4", |n| n.output.push("more".into())), "2 outputs");
    reason(node("y4", |n| n.output[0] = "n4".into()), "twice");
    reason(node("y4", |n| n.output[0] = "a\nb".into()), "plain");
    reason(node("y4", |n| n.output.clear()), "0 outputs");
    reason(node("vectors", |n| n.input[1] = "weights".into()), "int64");
    reason(node("told", |n| n.input[0] = "noise".into()), "head");
    reason(graph(|g| g.node.clear()), "no node writes");
    reason(graph(|g| g.node.reverse()), "not there before it");
    reason(
        graph(|g| {
            g.initializer.pop();
        }),
        "last.bias.f16",
    );
    reason(
        graph(|g| {
            let t = g.initializer[0].clone();
            g.initializer.push(t);
        }),
        "twice",
    );
    reason(
        graph(|g| {
            g.input.pop();
        }),
        "pin_distance",
    );
    reason(
        graph(|g| {
            g.output.pop();
        }),
        "fabric",
    );
    reason(
        graph(|g| {
            let i = g.input[0].clone();
            g.input.push(i);
        }),
        "other inputs",
    );
    reason(graph(|g| g.input[0].name = "words".into()), "tokens");
    reason(graph(|g| g.input[0].of = None), "type");
    reason(graph(|g| g.input[0].of.as_mut().unwrap().tensor.as_mut().unwrap().elem_type = FLOAT), "I64");
    reason(graph(|g| g.output[0].of.as_mut().unwrap().tensor.as_mut().unwrap().shape = None), "field");
    reason(graph(|g| g.initializer[0].name = "tokens".into()), "twice");
    reason(refused(&changed(|m| m.graph = None)), "missing");
    reason(refused(&changed(|m| m.ir_version = 3)), "IR version");
    reason(refused(&changed(|m| m.opset_import[0].version = 9)), "operator set 17");
    reason(refused(&changed(|m| m.opset_import.clear())), "operator set 17");
    reason(refused(&changed(|m| m.opset_import[0].domain = "ai.onnx.ml".into())), "operator set 17");
    // the fabric must not change with the seed
    reason(
        node("told", |n| {
            n.op_type = "Add".into();
            n.input = vec!["head_bias".into(), "noise".into()];
        }),
        "head_bias",
    );
    let error = graph(|g| {
        let mut b = Builder { graph: std::mem::take(g) };
        b.graph.node.retain(|n| n.output[0] != "fabric");
        b.integers("five", &[1, -1]);
        b.weight("mix", &[NOISE, 5], &vec![0.1; NOISE * 5]);
        b.op("MatMul", &["noise", "mix"], "mixed", vec![]);
        b.op("Add", &["mixed", "told"], "both", vec![]);
        b.op("Tanh", &["both"], "fabric", vec![]);
        *g = b.graph;
    });
    reason(error, "more than the words");
    reason(
        graph(|g| {
            g.node = (0..2000).map(|i| Node { output: vec![format!("n{i}")], ..Node::default() }).collect();
        }),
        "1000",
    );
}

#[test]
fn tensors_that_are_not_in_the_file() {
    let external = Entry { key: "location".into(), value: "/etc/passwd".into() };
    let error = tensor("first.f16", |t| {
        t.raw_data.clear();
        t.external_data = vec![external];
        t.data_location = 1;
    });
    assert!(text(&error).contains("first.f16"), "{error}");
    let error = tensor("axis_1", |t| {
        t.raw_data.clear();
        t.int64_data = vec![1];
    });
    assert!(text(&error).contains("axis_1"), "{error}");
    for data_type in [0, 2, 8, 11, 16, 20, -1, 9999] {
        let error = tensor("first.f16", |t| t.data_type = data_type);
        assert!(text(&error).contains("first.f16"), "{error}");
    }
}

#[test]
fn weights_that_are_not_finite() {
    for (name, bits) in [("words.f16", half(f32::NAN)), ("first.f16", half(f32::INFINITY)), ("last.bias.f16", 0xfc00)] {
        let error = tensor(name, |t| t.raw_data[2..4].copy_from_slice(&bits.to_le_bytes()));
        assert_eq!(error, Error::Weights { tensor: name.into() });
    }
    // finite, and yet its root is not
    let error = tensor("normal.var.f16", |t| t.raw_data[..2].copy_from_slice(&half(-1.0).to_le_bytes()));
    assert!(text(&error).contains("variance"), "{error}");
}
