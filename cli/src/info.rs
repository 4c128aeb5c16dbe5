//! `taut info`: what a generator file tells of itself.

use serde_json::{Map, Value, json};
use taut::field::CHANNELS;
use taut_onnx::{FABRIC, Info, Range};

use crate::failure::{self, Failure, one_line};
use crate::{args, model};

/// Runs the command.
pub fn run(args: &args::Info) -> Result<(), Failure> {
    let generator = model::load(args.file.as_deref())?;
    let source = args.file.as_ref().map_or(model::BUILT_IN.into(), |f| f.display().to_string());
    let text = if args.json {
        let json = serde_json::to_string_pretty(&as_json(&source, generator.info()));
        json.map_err(Failure::new)? + "\n"
    } else {
        as_text(&source, generator.info())
    };
    failure::print(&text)
}

fn ranges(names: &[&str], ranges: &[Range]) -> Value {
    let pairs = names.iter().zip(ranges);
    let map: Map<String, Value> = pairs.map(|(n, r)| (n.to_string(), json!([r.low, r.high]))).collect();
    Value::Object(map)
}

/// A number as short as it can be read back.
fn number(x: f32) -> String {
    if (1e-4..1e6).contains(&x) { x.to_string() } else { format!("{x:e}") }
}

fn as_json(source: &str, info: &Info) -> Value {
    json!({
        "file": source,
        "file_bytes": info.file_bytes,
        "model_name": info.model_name,
        "training_digest": info.training_digest,
        "parameters": info.parameters,
        "words": info.words,
        "tokens": info.tokens,
        "noise": info.noise,
        "grid": [info.grid, info.grid],
        "channel_ranges_n_per_m": ranges(&CHANNELS, &info.channel_ranges),
        "fabric_ranges": ranges(&FABRIC, &info.fabric_ranges),
    })
}

fn as_text(source: &str, info: &Info) -> String {
    let mut text = format!(
        "File              {} ({} bytes)\n\
         Model             {}, {} parameters\n\
         Training digest   {}\n\
         Vocabulary        {} words, at most {} of a description count\n\
         Field             {} x {}, from {} Gaussian numbers\n",
        one_line(source),
        info.file_bytes,
        info.model_name,
        info.parameters,
        info.training_digest,
        info.words,
        info.tokens,
        info.grid,
        info.grid,
        info.noise,
    );
    let ranges = |text: &mut String, title: &str, names: &[&str], ranges: &[Range]| {
        for (i, (name, r)) in names.iter().zip(ranges).enumerate() {
            let title = if i == 0 { title } else { "" };
            let (low, high) = (number(r.low), number(r.high));
            text.push_str(&format!("{title:<16}  {name:<18}  {low} to {high}\n"));
        }
    };
    ranges(&mut text, "Stiffness, N/m", &CHANNELS, &info.channel_ranges);
    ranges(&mut text, "Fabric, SI", &FABRIC, &info.fabric_ranges);
    text
}
