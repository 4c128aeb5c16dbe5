//! tract, which ships, answers what burn, which trains, answers on the numbers of the file.

use std::io::Cursor;
use std::time::Instant;

use taut_train::export::{ExportMeta, ParityInput, ParitySample, WordTable, export, fixture, run_rounded};
use taut_train::nets::Generator;
use tract_onnx::prelude::*;

/// Largest difference of any output, in tanh units.
const TOLERANCE: f32 = 1e-5;
/// Rows of the word table, as many as a real file has.
const WORDS: usize = 3000;

fn parts() -> (Generator, WordTable) {
    (fixture::seasoned_generator(16, 1, 6).expect("width"), fixture::word_table(WORDS, 2))
}

fn feed(input: &ParityInput) -> TVec<TValue> {
    let batch = input.batch().expect("fits");
    let tensor = |shape: &[usize], v: &[f32]| Tensor::from_shape(shape, v).expect("shape").into_tvalue();
    tvec!(
        Tensor::from_shape(&[batch, 16], &input.tokens).expect("shape").into_tvalue(),
        tensor(&[batch, 16], &input.weights),
        tensor(&[batch, 128], &input.noise),
        tensor(&[batch, 1, 32, 32], &input.pin_distance),
    )
}

fn worst(a: &TValue, b: &[f32]) -> f32 {
    let a = a.to_plain_array_view::<f32>().expect("f32");
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).fold(0.0, |w: f32, (a, b)| {
        let d = (a - b).abs();
        if d.is_nan() { f32::INFINITY } else { w.max(d) }
    })
}

#[test]
fn tract_agrees_with_burn_on_the_rounded_weights() -> TractResult<()> {
    let (generator, words) = parts();
    let bytes = export(&generator, &words, &ExportMeta::default()).expect("export");
    let start = Instant::now();
    let model = tract_onnx::onnx().model_for_read(&mut Cursor::new(&bytes))?.into_optimized()?.into_runnable()?;
    let load = start.elapsed();
    for (batch, seed) in [(1, 1), (1, 2), (5, 3)] {
        let input = fixture::input(batch, WORDS, seed);
        let burn = run_rounded(&generator, &words, &input).expect("runs");
        let tract = model.run(feed(&input))?;
        assert_eq!(tract[0].shape(), [batch, 4, 32, 32]);
        assert_eq!(tract[1].shape(), [batch, 5]);
        let (field, fabric) = (worst(&tract[0], &burn.field), worst(&tract[1], &burn.fabric));
        println!("batch {batch}: largest difference of field {field:.1e}, fabric {fabric:.1e}");
        assert!(field <= TOLERANCE && fabric <= TOLERANCE, "field {field}, fabric {fabric}");
        let spread = burn.field.iter().fold(0.0f32, |m, v| m.max(v.abs()));
        assert!(spread > 0.2, "the field says something: {spread}");
    }
    let input = fixture::input(1, WORDS, 9);
    let best = (0..20)
        .map(|_| {
            let (values, start) = (feed(&input), Instant::now());
            model.run(values).map(|_| start.elapsed())
        })
        .collect::<TractResult<Vec<_>>>()?;
    println!("{} bytes, load {load:.1?}, run of batch 1 {:.2?} at best", bytes.len(), best.iter().min().expect("20"));
    Ok(())
}

#[test]
fn the_file_that_ships_answers_what_burn_answered() -> TractResult<()> {
    let sample: ParitySample = serde_json::from_str(include_str!("../../onnx/parity.json")).expect("a sample");
    let bytes = include_bytes!("../../onnx/generator.onnx");
    assert!(bytes.len() < 16_000_000);
    let model = tract_onnx::onnx().model_for_read(&mut Cursor::new(bytes))?.into_optimized()?.into_runnable()?;
    let tract = model.run(feed(&sample.input))?;
    let (field, fabric) = (worst(&tract[0], &sample.field), worst(&tract[1], &sample.fabric));
    println!("largest difference of field {field:.1e}, fabric {fabric:.1e}");
    assert!(field <= TOLERANCE && fabric <= TOLERANCE, "field {field}, fabric {fabric}");
    Ok(())
}

#[test]
fn the_same_inputs_give_the_same_bytes() -> TractResult<()> {
    let (generator, words) = parts();
    let bytes = export(&generator, &words, &ExportMeta::default()).expect("export");
    let input = fixture::input(1, WORDS, 4);
    let mut answers = Vec::new();
    for _ in 0..2 {
        let model = tract_onnx::onnx().model_for_read(&mut Cursor::new(&bytes))?.into_optimized()?.into_runnable()?;
        let out = model.run(feed(&input))?;
        answers.push(
            out.iter()
                .map(|o| o.to_plain_array_view::<f32>().map(|a| a.iter().map(|x| x.to_bits()).collect::<Vec<_>>()))
                .collect::<TractResult<Vec<_>>>()?,
        );
    }
    assert_eq!(answers[0], answers[1]);
    Ok(())
}

#[test]
fn tract_reads_the_metadata() -> TractResult<()> {
    let (generator, words) = parts();
    let bytes = export(&generator, &words, &ExportMeta::default()).expect("export");
    let model = tract_onnx::onnx().model_for_read(&mut Cursor::new(&bytes))?;
    let text = |key: &str| -> TractResult<String> {
        let value = &model.properties[&format!("onnx.metadata_props.{key}")];
        Ok(value.try_as_plain_ram()?.to_scalar::<String>()?.clone())
    };
    assert_eq!(text("taut.format")?, "1");
    let vocabulary = text("taut.vocabulary")?;
    assert_eq!(vocabulary.lines().count(), WORDS);
    assert!(vocabulary.starts_with("<pad>\nw1\n"));
    Ok(())
}
