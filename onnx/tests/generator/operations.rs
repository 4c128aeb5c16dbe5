//! Other ways to put the same network together: every operation that is let through must mean the
//! same to the shape rules and to the engine.

use prost::Message;
use taut_onnx::{Generator, Request};

use crate::messages::Model;
use crate::miniature::*;

/// The field of a model for one request.
fn field(model: &Model) -> Vec<f32> {
    let generator = Generator::from_bytes(&model.encode_to_vec()).unwrap_or_else(|e| panic!("{e}"));
    let request = Request { seed: 3, pins: &[(0, 0), (0, 31)], ..Request::new("blue silk") };
    generator.correct(&request).unwrap().field.iter().copied().collect()
}

/// The miniature with another way from `y4` [1, C, 4, 4] to `y32` [1, C, 32, 32].
fn upsampled_by(way: impl Fn(&mut Builder)) -> Vec<f32> {
    let (mut b, w) = (Builder::default(), Weights::new());
    front(&mut b, &w);
    first_layer(&mut b, &w);
    normalise(&mut b, &w);
    way(&mut b);
    last_layer(&mut b, &w);
    field(&b.finish())
}

fn assert_same(a: &[f32], b: &[f32]) {
    assert_eq!(a.len(), b.len());
    for (i, (x, y)) in a.iter().zip(b).enumerate() {
        assert!((x / y - 1.0).abs() < 1e-4, "at {i}: {x}, {y}");
    }
}

#[test]
fn nearest_neighbours_by_sizes_scales_and_halves() {
    let expected = field(&model());
    let by_sizes = upsampled_by(|b| {
        b.integers("sizes", &[1, CHANNELS as i64, 32, 32]);
        b.op("Resize", &["y4", "", "", "sizes"], "y32", nearest());
    });
    assert_same(&by_sizes, &expected);
    let half_pixel = upsampled_by(|b| {
        b.floats("scales", &[1.0, 1.0, 8.0, 8.0]);
        b.op("Resize", &["y4", "", "scales"], "y32", vec![text("mode", "nearest")]);
    });
    assert_same(&half_pixel, &expected);
    let in_steps = upsampled_by(|b| {
        b.floats("scales", &[1.0, 1.0, 2.0, 4.0]);
        b.op("Resize", &["y4", "", "scales"], "y8", nearest());
        b.floats("more", &[1.0, 1.0, 4.0, 2.0]);
        b.op("Resize", &["y8", "", "more"], "y32", nearest());
    });
    assert_same(&in_steps, &expected);
}

#[test]
fn reshape_expand_reshape() {
    let c = CHANNELS as i64;
    let by_expand = upsampled_by(|b| {
        b.integers("split", &[0, c, 4, 1, -1, 1]);
        b.op("Reshape", &["y4", "split"], "y411", vec![]);
        b.integers("wide", &[1, c, 4, 8, 4, 8]);
        b.op("Expand", &["y411", "wide"], "y88", vec![]);
        b.integers("joined", &[0, 0, 32, 32]);
        b.op("Reshape", &["y88", "joined"], "y32", vec![]);
    });
    assert_same(&by_expand, &field(&model()));
}

#[test]
fn convolutions_and_plain_arithmetic_that_change_nothing() {
    let c = CHANNELS;
    let changed = upsampled_by(|b| {
        // a 1 x 1 convolution with the identity and a bias, which is then taken away again
        let identity: Vec<f32> = (0..c * c).map(|i| f32::from(u8::from(i % (c + 1) == 0))).collect();
        b.weight("one", &[c, c, 1, 1], &identity);
        b.weight("half", &[c], &vec![0.5; c]);
        b.op("Conv", &["y4", "one", "half"], "a", vec![ints("kernel_shape", &[1, 1])]);
        b.weight("half4", &[1, c, 1, 1], &vec![0.5; c]);
        b.op("Sub", &["a", "half4"], "b", vec![]);
        b.op("Add", &["b", "b"], "d", vec![]);
        b.floats("two", &[2.0]);
        b.op("Div", &["d", "two"], "e", vec![]);
        // numbers above 0 pass a leaky ReLU
        b.op("LeakyRelu", &["e"], "f", vec![float("alpha", 0.2)]);
        b.op("Transpose", &["f"], "g", vec![ints("perm", &[0, 2, 3, 1])]);
        b.op("Transpose", &["g"], "h", vec![ints("perm", &[0, 3, 1, 2])]);
        b.integers("axis_0", &[0]);
        b.op("Squeeze", &["h", "axis_0"], "i", vec![]);
        b.op("Unsqueeze", &["i", "axis_0"], "j", vec![]);
        b.op("Identity", &["j"], "k", vec![]);
        b.floats("scales", &[1.0, 1.0, 8.0, 8.0]);
        b.op("Resize", &["k", "", "scales"], "y32", nearest());
    });
    assert_same(&changed, &field(&model()));
}

#[test]
fn a_matrix_product_for_the_head() {
    let (expected, w) = (Generator::from_bytes(&bytes()).unwrap(), Weights::new());
    let mut model = model();
    let graph = model.graph.as_mut().unwrap();
    let told = graph.node.iter_mut().find(|n| n.output[0] == "told").unwrap();
    told.op_type = "MatMul".into();
    let product = Generator::from_bytes(&model.encode_to_vec()).unwrap();

    let graph = model.graph.as_mut().unwrap();
    let told = graph.node.iter_mut().find(|n| n.output[0] == "told").unwrap();
    told.op_type = "Gemm".into();
    told.input = vec!["v_text".into(), "turned".into(), "none".into()];
    told.attribute = vec![int("transB", 1), float("beta", 0.5)];
    let turned: Vec<f32> = (0..5 * WIDTH).map(|i| w.head[i % WIDTH * 5 + i / WIDTH]).collect();
    let raw = turned.iter().flat_map(|x| x.to_le_bytes()).collect();
    let mut b = Builder { graph: graph.clone() };
    b.store("turned", FLOAT, &[5, WIDTH], raw);
    b.floats("none", &[0.0; 5]);
    *graph = b.graph;
    let transposed = Generator::from_bytes(&model.encode_to_vec()).unwrap();

    let density = |g: &Generator| g.correct(&Request::new("denim")).unwrap().density_kg_m2;
    let expected = density(&expected);
    assert!((density(&product) / expected - 1.0).abs() < 1e-5);
    assert!((density(&transposed) / expected - 1.0).abs() < 1e-5);
}

#[test]
fn words_may_be_widened_after_they_are_gathered() {
    let mut model = model();
    let graph = model.graph.as_mut().unwrap();
    let cast = graph.node.iter().position(|n| n.output[0] == "words").unwrap();
    let mut cast = graph.node.remove(cast);
    let gather = graph.node.iter().position(|n| n.op_type == "Gather").unwrap();
    graph.node[gather].input[0] = "words.f16".into();
    graph.node[gather].output[0] = "narrow".into();
    cast.input[0] = "narrow".into();
    cast.output[0] = "vectors".into();
    graph.node.insert(gather + 1, cast);
    assert_same(&field(&model), &field(&crate::miniature::model()));
}

#[test]
fn strides_and_uneven_padding() {
    // 4 x 4 -> 8 x 10 -> 5 x 5 -> 9 x 9 -> 4 x 4: what the rules expect is what the engine writes
    let c = CHANNELS as i64;
    upsampled_by(|b| {
        let weights = numbers(20, CHANNELS * CHANNELS * 12, 0.3);
        b.weight("wa", &[CHANNELS, CHANNELS, 3, 4], &weights);
        let attributes = vec![ints("strides", &[2, 3]), ints("pads", &[1, 2, 1, 1]), ints("output_padding", &[1, 0])];
        b.op("ConvTranspose", &["y4", "wa"], "a", attributes);
        b.weight("wb", &[CHANNELS, CHANNELS, 3, 4], &weights);
        let attributes = vec![ints("strides", &[2, 2]), ints("pads", &[2, 1, 1, 1])];
        b.op("Conv", &["a", "wb"], "b", attributes);
        b.weight("wc", &[CHANNELS, CHANNELS, 2, 3], &numbers(21, CHANNELS * CHANNELS * 6, 0.3));
        b.op("ConvTranspose", &["b", "wc"], "d", vec![ints("strides", &[2, 2]), ints("pads", &[1, 1, 0, 1])]);
        b.weight("wd", &[CHANNELS, CHANNELS, 3, 3], &numbers(22, CHANNELS * CHANNELS * 9, 0.3));
        b.op("Conv", &["d", "wd"], "e", vec![ints("strides", &[2, 2])]);
        b.integers("sizes", &[1, c, 32, 32]);
        b.op("Resize", &["e", "", "", "sizes"], "y32", nearest());
    });
}
