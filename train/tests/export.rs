//! The generator file: rounding, contents, size, and what it refuses.

use burn::module::Module;
use half::f16;
use prost::Message;
use taut_train::export::proto::{ModelProto, data_type};
use taut_train::export::{
    ExportError, ExportMeta, MAX_FILE_BYTES, MAX_VOCABULARY, WordTable, export, fixture, import, round_to_f16,
    run_rounded,
};
use taut_train::nets::Generator;

fn small() -> (Generator, WordTable) {
    (fixture::seasoned_generator(2, 1, 2).expect("width"), fixture::word_table(10, 2))
}

fn kernel(g: &Generator) -> Vec<f32> {
    g.first.weight.val().into_data().try_into_vec().expect("f32")
}

fn mean(g: &Generator) -> Vec<f32> {
    g.valid().third.norm.running_mean.value().into_data().try_into_vec().expect("f32")
}

#[test]
fn rounding_gives_f16_numbers_and_leaves_the_original_alone() {
    let (g, _) = small();
    let (weights, means) = (kernel(&g), mean(&g));
    let rounded = round_to_f16(&g);
    assert_eq!((kernel(&g), mean(&g)), (weights.clone(), means.clone()), "the original keeps its numbers");
    assert_ne!(weights, kernel(&rounded));
    for (o, r) in weights.iter().zip(&kernel(&rounded)) {
        assert_eq!(f16::from_f32(*o).to_f32(), *r);
    }
    assert_eq!(means, mean(&rounded), "the normalisation stays as it is");
    let twice = round_to_f16(&rounded);
    assert_eq!((kernel(&twice), mean(&twice)), (kernel(&rounded), mean(&rounded)));
}

#[test]
fn what_is_read_back_is_what_was_written() {
    let (g, words) = small();
    let meta = ExportMeta { model_name: "small".into(), ..Default::default() };
    let bytes = export(&g, &words, &meta).expect("export");
    let (again, its_words, its_meta) = import(&bytes).expect("its own file");
    assert_eq!((its_words.tokens, &its_meta), (words.tokens.clone(), &meta));
    let words = WordTable { vectors: its_words.vectors, ..words };
    assert_eq!(export(&again, &words, &meta).expect("export"), bytes);

    let refused = |bytes: &[u8]| import(bytes).expect_err("refused").to_string();
    assert!(refused(b"no file").contains("not a generator file"));
    let mut model = ModelProto::decode(bytes.as_slice()).expect("decodes");
    model.graph.as_mut().expect("graph").initializer.retain(|t| t.name != "third.norm.mean");
    assert!(refused(&model.encode_to_vec()).contains("third.norm.mean"));
    model.metadata_props.clear();
    assert!(refused(&model.encode_to_vec()).contains("taut.model_name"));
}

#[test]
fn the_file_decodes_to_what_was_put_in() {
    let (g, words) = small();
    let meta = ExportMeta { model_name: "small".into(), training_digest: "00ff".into(), ..Default::default() };
    let bytes = export(&g, &words, &meta).expect("export");
    assert_eq!(bytes, export(&g, &words, &meta).expect("export"), "the same parts, the same bytes");
    let model = ModelProto::decode(bytes.as_slice()).expect("decodes");
    assert_eq!((model.ir_version, model.opset_import[0].version), (8, 17));
    let property = |key: &str| {
        let found: Vec<_> = model.metadata_props.iter().filter(|p| p.key == key).collect();
        assert_eq!(found.len(), 1, "{key}");
        found[0].value.clone()
    };
    assert_eq!(property("taut.format"), "1");
    assert_eq!(property("taut.vocabulary"), "<pad>\nw1\nw2\nw3\nw4\nw5\nw6\nw7\nw8\nw9");
    assert_eq!(property("taut.channels"), "warp,weft,shear,bend");
    assert_eq!(property("taut.channel_ranges_n_per_m"), "5:20000,5:20000,1:8000,0.02:400");
    assert_eq!(property("taut.fabric"), "density_kg_m2,hinge_rigidity_n_m,limit_warp,limit_weft,limit_diagonal");
    assert_eq!(
        (property("taut.grid"), property("taut.noise"), property("taut.tokens")),
        ("32".into(), "128".into(), "16".into())
    );
    assert_eq!((property("taut.training_digest"), property("taut.model_name")), ("00ff".into(), "small".into()));

    let graph = model.graph.expect("graph");
    let names = |v: &[taut_train::export::proto::ValueInfoProto]| v.iter().map(|i| i.name.clone()).collect::<Vec<_>>();
    assert_eq!(names(&graph.input), ["tokens", "weights", "noise", "pin_distance"]);
    assert_eq!(names(&graph.output), ["field", "fabric"]);
    // Every value is made before it is read, and made once.
    let mut known: Vec<String> = names(&graph.input);
    known.extend(graph.initializer.iter().map(|t| t.name.clone()));
    for node in &graph.node {
        for input in node.input.iter().filter(|i| !i.is_empty()) {
            assert!(known.contains(input), "{} reads {input} too early", node.name);
        }
        for output in &node.output {
            assert!(!known.contains(output), "{output} is made twice");
            known.push(output.clone());
        }
    }
    // All weights are f16; the only others are axes, scales and the vectors of the normalisation.
    for t in &graph.initializer {
        let count: i64 = t.dims.iter().product();
        let width = match t.data_type {
            data_type::FLOAT16 => 2,
            data_type::INT64 => 8,
            data_type::FLOAT => 4,
            other => panic!("{} has element type {other}", t.name),
        };
        assert_eq!(t.raw_data.len() as i64, count * width, "{}", t.name);
        assert!(t.data_type == data_type::FLOAT16 || count <= 4 || t.name.contains(".norm."), "{} is not f16", t.name);
    }
    let find = |name: &str| graph.initializer.iter().find(|t| t.name == name).expect("constant");
    let halves = |name: &str| -> Vec<f32> {
        let (pairs, _) = find(name).raw_data.as_chunks::<2>();
        pairs.iter().map(|b| f16::from_le_bytes(*b).to_f32()).collect()
    };
    assert_eq!(find("words").dims, [10, 1024]);
    assert_eq!(
        halves("words")[1024..2048],
        words.vectors[1024..2048].iter().map(|x| f16::from_f32(*x).to_f32()).collect::<Vec<_>>()
    );
    assert_eq!(halves("first.weight.f16"), kernel(&round_to_f16(&g)));
    let (raw, _) = find("third.norm.mean").raw_data.as_chunks::<4>();
    assert_eq!(
        raw.iter().map(|b| f32::from_le_bytes(*b)).collect::<Vec<_>>(),
        mean(&g),
        "the last step of training is in the statistics"
    );
}

#[test]
fn the_whole_file_stays_under_its_limit() {
    let g = fixture::seasoned_generator(16, 1, 0).expect("width");
    for n in [3000, MAX_VOCABULARY] {
        let bytes = export(&g, &fixture::word_table(n, 1), &ExportMeta::default()).expect("export");
        println!("{n} words, width 16, {} parameters: {} bytes", g.num_params(), bytes.len());
        assert!(bytes.len() < MAX_FILE_BYTES);
    }
    let wide = fixture::seasoned_generator(32, 1, 0).expect("width");
    let e = export(&wide, &fixture::word_table(3000, 1), &ExportMeta::default()).expect_err("too large");
    assert!(matches!(e, ExportError::TooLarge(n) if n >= MAX_FILE_BYTES), "{e}");
}

#[test]
fn bad_parts_are_named_and_nothing_is_written() {
    let (g, words) = small();
    let meta = ExportMeta::default();
    let refused = |change: &dyn Fn(&mut WordTable)| {
        let mut w = words.clone();
        change(&mut w);
        export(&g, &w, &meta).expect_err("refused").to_string()
    };
    assert!(refused(&|w| w.tokens[3] = "w2".into()).contains("twice"));
    assert!(refused(&|w| w.tokens[3] = "two words".into()).contains("two words"));
    assert!(refused(&|w| w.tokens[3] = "-x".into()).contains("-x"));
    assert!(refused(&|w| w.tokens[0] = "pad".into()).contains("pad"));
    assert!(refused(&|w| w.vectors[5] = 1.0).contains("padding"));
    assert!(refused(&|w| w.vectors[5000] = f32::NAN).contains("words"));
    assert!(refused(&|w| w.vectors[5000] = 7e4).contains("f16"));
    assert!(refused(&|w| w.vectors.truncate(100)).contains("100"));
    assert!(refused(&|w| w.tokens.truncate(1)).contains('1'));

    let e = export(&g, &words, &ExportMeta { training_digest: "no".into(), ..meta.clone() }).expect_err("digest");
    assert!(matches!(e, ExportError::Meta(_)));

    let mut broken = g.valid();
    broken.skip.weight = broken.skip.weight.map(|w| w.mul_scalar(f32::INFINITY));
    let e = export(&broken, &words, &meta).expect_err("infinite weight");
    assert_eq!(e, ExportError::NotHalf { tensor: "skip.weight".into() });
}

#[test]
fn statistics_that_are_not_finite_are_named() {
    let (g, words) = small();
    let mut g = g.valid();
    g.fourth.norm.gamma = g.fourth.norm.gamma.map(|x| x.div_scalar(0.0));
    assert_eq!(
        export(&g, &words, &ExportMeta::default()),
        Err(ExportError::NotFinite { tensor: "fourth.norm.scale".into() })
    );
}

#[test]
fn a_parity_run_names_bad_inputs() {
    let (g, words) = small();
    let good = fixture::input(2, 10, 3);
    let out = run_rounded(&g, &words, &good).expect("runs");
    assert_eq!((out.field.len(), out.fabric.len()), (2 * 4 * 32 * 32, 10));
    let mut bad = good.clone();
    bad.tokens[0] = 10;
    assert!(run_rounded(&g, &words, &bad).expect_err("token").to_string().contains("10"));
    bad.tokens[0] = -1;
    assert!(run_rounded(&g, &words, &bad).is_err());
    let mut bad = good.clone();
    bad.noise.pop();
    assert!(matches!(run_rounded(&g, &words, &bad), Err(ExportError::Input(_))));
    let json = serde_json::to_string(&out).expect("json");
    assert_eq!(serde_json::from_str::<taut_train::export::ParitySample>(&json).expect("reads back"), out);
    for key in ["tokens", "weights", "noise", "pin_distance", "field", "fabric"] {
        assert!(json.contains(&format!("\"{key}\":[")), "{key}");
    }
}
