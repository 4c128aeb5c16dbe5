//! Any bytes as a generator file: what reads its metadata before anything else looks at it, from its own sources, without the
//! runtime of the network. Refused with an error, or parsed.
#![no_main]
#![allow(dead_code, unused_imports, reason = "the modules are those of another crate")]

// the name that those modules know it by
extern crate taut_core as taut;

#[path = "../../onnx/src/error.rs"]
mod error;
#[path = "../../onnx/src/metadata.rs"]
mod metadata;
#[path = "../../onnx/src/vocabulary.rs"]
mod vocabulary;
#[path = "../../onnx/src/wire.rs"]
mod wire;

use error::Error;
use libfuzzer_sys::fuzz_target;

/// The metadata of a good file.
const GOOD: [(&str, &str); 11] = [
    ("taut.format", "1"),
    ("taut.vocabulary", "<pad>\ncotton\ndenim"),
    ("taut.channels", "warp,weft,shear,bend"),
    ("taut.channel_ranges_n_per_m", "5:20000,5:20000,1:8000,0.02:400"),
    ("taut.fabric", "density_kg_m2,hinge_rigidity_n_m,limit_warp,limit_weft,limit_diagonal"),
    ("taut.fabric_ranges", "0.03:0.8,1e-7:1e-3,0.0005:0.3,0.0005:0.3,0.0005:0.3"),
    ("taut.grid", "32"),
    ("taut.noise", "128"),
    ("taut.tokens", "16"),
    ("taut.training_digest", "0123456789abcdef"),
    ("taut.model_name", "generator"),
];

fuzz_target!(|data: &[u8]| {
    if let Ok(entries) = wire::metadata(data) {
        let _ = metadata::parse(&entries);
    }
    // a good file with other values: pieces between zero bytes, the first byte of each tells which
    let mut entries = GOOD.map(|(key, value)| wire::Entry { key, value });
    for piece in data.split(|b| *b == 0) {
        if let Ok(text) = std::str::from_utf8(piece)
            && let Some(first) = text.chars().next()
        {
            entries[first as usize % GOOD.len()].value = &text[first.len_utf8()..];
        }
    }
    if let Ok((info, _)) = metadata::parse(&entries) {
        assert!(info.channel_ranges.iter().all(|r| 0.0 < r.low && r.low < r.high && r.high.is_finite()), "{info:?}");
        assert!(info.fabric_ranges.iter().all(|r| 0.0 < r.low && r.low < r.high && r.high.is_finite()), "{info:?}");
        assert!((2..=256).contains(&info.grid) && info.tokens >= 1 && info.noise >= 1);
    }
});
