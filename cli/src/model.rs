//! The generator: the one that is built in, or a file.

use std::path::Path;

use taut_lab::scene::Scene;
use taut_onnx::{Correction, Error, Generator, Request};

use crate::args;
use crate::failure::{Failure, complain, one_line};

/// The generator that every build carries.
static EMBEDDED: &[u8] = include_bytes!("../../onnx/generator.onnx");

/// What the built-in generator is called where a file would have its path.
pub const BUILT_IN: &str = "built in";

/// Reads a generator file, or the built-in one. The failure names the file.
pub fn load(path: Option<&Path>) -> Result<Generator, Failure> {
    let Some(path) = path else {
        return Ok(Generator::from_bytes(EMBEDDED)?);
    };
    Generator::load(path).map_err(|e| match e {
        Error::Io { .. } => Failure::from(e),
        _ => Failure::new(format_args!("{}: {e}", path.display())),
    })
}

/// The field of a fabric for a scene, and the generator that made it. Words that did not count are named on stderr.
pub fn correct(args: &args::Cloth) -> Result<(Generator, Correction), Failure> {
    let generator = load(args.model.as_deref())?;
    let correction = correct_with(&generator, args)?;
    Ok((generator, correction))
}

/// The same with a generator that is there.
pub fn correct_with(generator: &Generator, args: &args::Cloth) -> Result<Correction, Failure> {
    let columns = args.grid.columns as usize;
    let pins: Vec<(usize, usize)> =
        args.scene.pins(args.grid.rows as usize, columns).into_iter().map(|p| (p / columns, p % columns)).collect();
    let correction = generator.correct(&Request {
        description: &args.description,
        seed: args.seed,
        rows: args.grid.rows as usize,
        columns,
        width_m: args.size.width_m,
        height_m: args.size.height_m,
        pins: &pins,
    })?;
    warn(&correction, generator.info().tokens);
    Ok(correction)
}

fn warn(c: &Correction, limit: usize) {
    if !c.unknown_words.is_empty() {
        let words = quoted(&c.unknown_words);
        complain(&format!("warning: the generator does not know {words}: skipped"));
    }
    if !c.dropped_words.is_empty() {
        let words = quoted(&c.dropped_words);
        complain(&format!("warning: only the first {limit} known words count: {words} skipped"));
    }
}

/// Words for a message: the first eight, each cut at 40 letters.
fn quoted(words: &[String]) -> String {
    const SHOWN: usize = 8;
    let mut list: Vec<String> =
        words.iter().take(SHOWN).map(|w| format!("`{}`", w.chars().take(40).collect::<String>())).collect();
    if words.len() > SHOWN {
        list.push(format!("{} more", words.len() - SHOWN));
    }
    one_line(&list.join(", "))
}

/// A scene for people.
pub fn scene_text(scene: Scene) -> String {
    format!("{scene} ({})", scene.about())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_lists_are_cut() {
        let words: Vec<String> = (0..20).map(|i| format!("{i}{}", "x".repeat(100))).collect();
        let text = quoted(&words);
        assert!(text.len() < 400 && text.ends_with("12 more"), "{text}");
        assert_eq!(quoted(&["ab".into(), "c".into()]), "`ab`, `c`");
    }

    #[test]
    fn the_built_in_generator_is_one() {
        let g = load(None).expect("a generator");
        assert!(g.info().words > 0);
        assert_eq!(g.info().file_bytes, EMBEDDED.len());
    }
}
