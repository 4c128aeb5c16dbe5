//! A generator of a few thousand weights with the inputs, outputs and metadata of a real one:
//!
//! words -> mean word vector -> Gemm, tanh = fabric; (mean, noise) -> 5 x 5 transposed convolution
//! to 4 x 4 -> batch normalisation, ReLU -> nearest to 32 x 32 -> joined with the pin distance ->
//! 3 x 3 transposed convolution, tanh = field.

use prost::Message;

use crate::messages::*;

pub const FLOAT: i32 = 1;
pub const INT64: i32 = 7;
pub const FLOAT16: i32 = 10;

/// Width of a word vector.
pub const WIDTH: usize = 8;
/// Channels of the first layer.
pub const CHANNELS: usize = 6;
pub const NOISE: usize = 128;
pub const WORDS: [&str; 9] = ["heavy", "blue", "denim", "silk", "cotton", "jersey", "knit", "stretch", "non-woven"];

pub const METADATA: [(&str, &str); 10] = [
    ("taut.format", "1"),
    ("taut.channels", "warp,weft,shear,bend"),
    ("taut.channel_ranges_n_per_m", "5:20000,5:20000,1:8000,0.02:400"),
    ("taut.fabric", "density_kg_m2,hinge_rigidity_n_m,limit_warp,limit_weft,limit_diagonal"),
    ("taut.fabric_ranges", "0.03:0.8,1e-7:1e-3,0.0005:0.3,0.0005:0.3,0.0005:0.3"),
    ("taut.grid", "32"),
    ("taut.noise", "128"),
    ("taut.tokens", "16"),
    ("taut.training_digest", "00112233445566778899aabbccddeeff"),
    ("taut.model_name", "miniature"),
];

/// Puts a graph together, one call a node.
#[derive(Clone, Default)]
pub struct Builder {
    pub graph: Graph,
}

impl Builder {
    /// A weight as f16 with the Cast behind it; returns the name of the f32 tensor.
    pub fn weight(&mut self, name: &str, dims: &[usize], values: &[f32]) -> String {
        assert_eq!(dims.iter().product::<usize>(), values.len());
        let raw = values.iter().flat_map(|&x| half(x).to_le_bytes()).collect();
        self.store(&format!("{name}.f16"), FLOAT16, dims, raw);
        self.op("Cast", &[&format!("{name}.f16")], name, vec![int("to", i64::from(FLOAT))])
    }

    pub fn floats(&mut self, name: &str, values: &[f32]) -> String {
        let raw = values.iter().flat_map(|x| x.to_le_bytes()).collect();
        self.store(name, FLOAT, &[values.len()], raw)
    }

    pub fn integers(&mut self, name: &str, values: &[i64]) -> String {
        let raw = values.iter().flat_map(|x| x.to_le_bytes()).collect();
        self.store(name, INT64, &[values.len()], raw)
    }

    pub fn store(&mut self, name: &str, data_type: i32, dims: &[usize], raw_data: Vec<u8>) -> String {
        let dims = dims.iter().map(|&d| d as i64).collect();
        let tensor = Tensor { dims, data_type, name: name.into(), raw_data, ..Tensor::default() };
        self.graph.initializer.push(tensor);
        name.into()
    }

    pub fn op(&mut self, op: &str, input: &[&str], output: &str, attribute: Vec<Attribute>) -> String {
        self.graph.node.push(Node {
            input: input.iter().map(|&s| s.into()).collect(),
            output: vec![output.into()],
            name: output.into(),
            op_type: op.into(),
            attribute,
            domain: String::new(),
        });
        output.into()
    }

    /// The model, with the inputs and outputs of the contract declared.
    pub fn finish(mut self) -> Model {
        let declare = |name: &str, elem_type: i32, dims: &[i64]| {
            let batch = Dimension { size: Some(Size::Open("batch".into())) };
            let fixed = dims.iter().map(|&d| Dimension { size: Some(Size::Fixed(d)) });
            let shape = Shape { dim: std::iter::once(batch).chain(fixed).collect() };
            let tensor = TensorType { elem_type, shape: Some(shape) };
            Declared { name: name.into(), of: Some(Type { tensor: Some(tensor) }) }
        };
        self.graph.name = "miniature".into();
        self.graph.input = vec![
            declare("tokens", INT64, &[16]),
            declare("weights", FLOAT, &[16]),
            declare("noise", FLOAT, &[NOISE as i64]),
            declare("pin_distance", FLOAT, &[1, 32, 32]),
        ];
        self.graph.output = vec![declare("field", FLOAT, &[4, 32, 32]), declare("fabric", FLOAT, &[5])];
        let vocabulary = format!("<pad>\n{}", WORDS.join("\n"));
        let entry = |key: &str, value: &str| Entry { key: key.into(), value: value.into() };
        let mut metadata_props: Vec<_> = METADATA.iter().map(|(k, v)| entry(k, v)).collect();
        metadata_props.push(entry("taut.vocabulary", &vocabulary));
        Model {
            ir_version: 8,
            producer_name: "taut".into(),
            graph: Some(self.graph),
            opset_import: vec![Opset { domain: String::new(), version: 17 }],
            metadata_props,
        }
    }
}

pub fn int(name: &str, i: i64) -> Attribute {
    Attribute { name: name.into(), i, kind: 2, ..Attribute::default() }
}

pub fn float(name: &str, f: f32) -> Attribute {
    Attribute { name: name.into(), f, kind: 1, ..Attribute::default() }
}

pub fn text(name: &str, s: &str) -> Attribute {
    Attribute { name: name.into(), s: s.into(), kind: 3, ..Attribute::default() }
}

pub fn ints(name: &str, ints: &[i64]) -> Attribute {
    Attribute { name: name.into(), ints: ints.into(), kind: 7, ..Attribute::default() }
}

/// Numbers within -scale and scale, rounded to what f16 holds.
pub fn numbers(seed: u64, count: usize, scale: f32) -> Vec<f32> {
    let uniform = |i| taut::noise::uniform(seed, i as u32) * 2.0 - 1.0;
    (0..count).map(|i| unhalf(half(scale * uniform(i)))).collect()
}

/// The nearest f16 towards zero, as bits; for numbers below 65504 that are 0 or above 2^-14 in size.
pub fn half(x: f32) -> u16 {
    let bits = x.to_bits();
    let sign = (bits >> 16) as u16 & 0x8000;
    let exponent = (bits >> 23 & 0xff) as i32 - 112;
    match exponent {
        ..1 => sign,
        1..31 => sign | (exponent as u16) << 10 | (bits >> 13 & 0x3ff) as u16,
        _ if x.is_nan() => 0x7e00,
        _ => sign | 0x7c00,
    }
}

pub fn unhalf(h: u16) -> f32 {
    if h & 0x7fff == 0 {
        return 0.0;
    }
    f32::from_bits(u32::from(h & 0x8000) << 16 | (u32::from(h & 0x7fff) + (112 << 10)) << 13)
}

/// The weights of the miniature, for the reference too.
pub struct Weights {
    /// [words + 1][WIDTH], row 0 is zero.
    pub words: Vec<f32>,
    /// [WIDTH][5]
    pub head: Vec<f32>,
    /// [WIDTH + NOISE][CHANNELS][5][5]
    pub first: Vec<f32>,
    /// scale, bias, mean, variance, each [CHANNELS]
    pub normal: [Vec<f32>; 4],
    /// [CHANNELS + 1][4][3][3]
    pub last: Vec<f32>,
    /// [4]
    pub bias: Vec<f32>,
}

impl Weights {
    pub fn new() -> Weights {
        let mut words = numbers(1, (WORDS.len() + 1) * WIDTH, 1.0);
        words[..WIDTH].fill(0.0);
        let above_zero = |v: Vec<f32>| v.into_iter().map(|x| unhalf(half(x.abs() + 0.5))).collect();
        Weights {
            words,
            head: numbers(2, WIDTH * 5, 1.0),
            first: numbers(3, (WIDTH + NOISE) * CHANNELS * 25, 0.1),
            normal: [
                above_zero(numbers(4, CHANNELS, 0.5)),
                numbers(5, CHANNELS, 0.5),
                numbers(6, CHANNELS, 0.5),
                above_zero(numbers(7, CHANNELS, 0.5)),
            ],
            last: numbers(8, (CHANNELS + 1) * 4 * 9, 0.2),
            bias: numbers(9, 4, 0.2),
        }
    }
}

/// The nodes up to the mean word vector `v_text` and the fabric.
pub fn front(b: &mut Builder, w: &Weights) {
    b.weight("words", &[WORDS.len() + 1, WIDTH], &w.words);
    b.op("Gather", &["words", "tokens"], "vectors", vec![int("axis", 0)]);
    b.integers("axis_2", &[2]);
    b.op("Unsqueeze", &["weights", "axis_2"], "shares", vec![]);
    b.op("Mul", &["vectors", "shares"], "shared", vec![]);
    b.integers("axis_1", &[1]);
    b.op("ReduceSum", &["shared", "axis_1"], "v_text", vec![int("keepdims", 0)]);
    b.weight("head", &[WIDTH, 5], &w.head);
    b.op("Gemm", &["v_text", "head"], "told", vec![]);
    b.op("Tanh", &["told"], "fabric", vec![]);
}

/// The nodes from `v_text` and the noise to `x4` [1, CHANNELS, 4, 4].
pub fn first_layer(b: &mut Builder, w: &Weights) {
    b.op("Concat", &["v_text", "noise"], "z", vec![int("axis", 1)]);
    b.integers("axes_2_3", &[2, 3]);
    b.op("Unsqueeze", &["z", "axes_2_3"], "z4", vec![]);
    b.weight("first", &[WIDTH + NOISE, CHANNELS, 5, 5], &w.first);
    let attributes = vec![
        ints("kernel_shape", &[5, 5]),
        ints("strides", &[2, 2]),
        ints("pads", &[1, 1, 1, 1]),
        ints("output_padding", &[1, 1]),
        ints("dilations", &[1, 1]),
        int("group", 1),
    ];
    b.op("ConvTranspose", &["z4", "first"], "x4", attributes);
}

/// Batch normalisation and ReLU from `x4` to `y4`.
pub fn normalise(b: &mut Builder, w: &Weights) {
    for (name, values) in ["scale", "bias", "mean", "var"].iter().zip(&w.normal) {
        b.weight(&format!("normal.{name}"), &[CHANNELS], values);
    }
    let names = ["x4", "normal.scale", "normal.bias", "normal.mean", "normal.var"];
    b.op("BatchNormalization", &names, "n4", vec![float("epsilon", 1e-5)]);
    b.op("Relu", &["n4"], "y4", vec![]);
}

/// From `y32` [1, CHANNELS, 32, 32] to the field.
pub fn last_layer(b: &mut Builder, w: &Weights) {
    b.op("Concat", &["y32", "pin_distance"], "y32p", vec![int("axis", 1)]);
    b.weight("last", &[CHANNELS + 1, 4, 3, 3], &w.last);
    b.weight("last.bias", &[4], &w.bias);
    let attributes = vec![ints("kernel_shape", &[3, 3]), ints("pads", &[1, 1, 1, 1])];
    b.op("ConvTranspose", &["y32p", "last", "last.bias"], "t", attributes);
    b.op("Tanh", &["t"], "field", vec![]);
}

pub fn nearest() -> Vec<Attribute> {
    vec![text("mode", "nearest"), text("coordinate_transformation_mode", "asymmetric"), text("nearest_mode", "floor")]
}

/// The whole miniature.
pub fn model() -> Model {
    let (mut b, w) = (Builder::default(), Weights::new());
    front(&mut b, &w);
    first_layer(&mut b, &w);
    normalise(&mut b, &w);
    b.floats("scales", &[1.0, 1.0, 8.0, 8.0]);
    b.op("Resize", &["y4", "", "scales"], "y32", nearest());
    last_layer(&mut b, &w);
    b.finish()
}

pub fn bytes() -> Vec<u8> {
    model().encode_to_vec()
}
