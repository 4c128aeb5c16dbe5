//! How the program ends when it cannot do what it was asked for.

use std::fmt;
use std::io::{ErrorKind, Write};
use std::process::ExitCode;

/// Longest error text in characters: a hostile file or argument must not fill the terminal.
const LONGEST: usize = 600;

/// Why the program stops.
#[derive(Debug, PartialEq)]
pub enum Failure {
    /// Something that the user can put right, in one line.
    User(String),
    /// Whoever read stdout has stopped reading, as `head` does: there is nobody left to tell.
    ClosedPipe,
}

impl Failure {
    /// A failure with its text; line breaks and control characters in it are made visible.
    pub fn new(text: impl fmt::Display) -> Failure {
        Failure::User(one_line(&text.to_string()))
    }

    /// Writes the line to stderr. The exit code is 2, or 0 for a closed pipe.
    pub fn report(&self) -> ExitCode {
        match self {
            Failure::User(text) => {
                complain(text);
                ExitCode::from(2)
            }
            Failure::ClosedPipe => ExitCode::SUCCESS,
        }
    }
}

impl From<taut_onnx::Error> for Failure {
    fn from(e: taut_onnx::Error) -> Failure {
        Failure::new(e)
    }
}

/// Writes `taut: text` and nothing else to stderr. A closed stderr is no reason to stop.
pub fn complain(text: &str) {
    let _ = writeln!(std::io::stderr(), "taut: {}", one_line(text));
}

/// Writes text to stdout as it is.
pub fn print(text: &str) -> Result<(), Failure> {
    let mut out = std::io::stdout().lock();
    out.write_all(text.as_bytes()).and_then(|()| out.flush()).map_err(|e| match e.kind() {
        ErrorKind::BrokenPipe => Failure::ClosedPipe,
        _ => Failure::new(format_args!("cannot write to stdout: {e}")),
    })
}

/// Writes text to stderr as it is; what cannot be written there is lost.
pub fn print_aside(text: &str) {
    let _ = std::io::stderr().write_all(text.as_bytes());
}

/// The answer of a command: its text, or with `--json` its JSON alone on stdout and the text on stderr.
pub fn answer(as_json: bool, text: &str, json: &str) -> Result<(), Failure> {
    if as_json {
        print_aside(text);
        return print(json);
    }
    print(text)
}

/// A bug must look like one, in one line, not like a page of the program's inside.
pub fn quiet_panics() {
    std::panic::set_hook(Box::new(|panic| {
        let at = panic.location().map_or(String::new(), |l| format!(" at {}:{}", l.file(), l.line()));
        complain(&format!(
            "internal error{at}, please report it: {}",
            panic.payload_as_str().unwrap_or("unknown reason")
        ));
    }));
}

/// Text as one line: control characters are escaped, what is too long is cut.
pub fn one_line(text: &str) -> String {
    let mut line = String::new();
    for (i, c) in text.chars().enumerate() {
        if i == LONGEST {
            line.push_str("...");
            break;
        }
        if c.is_control() || matches!(c, '\u{2028}' | '\u{2029}') {
            line.extend(c.escape_default());
        } else {
            line.push(c);
        }
    }
    line
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_are_one_line() {
        let Failure::User(text) = Failure::new("a\nb\u{1b}[31m\r".repeat(1000)) else {
            panic!("a user failure");
        };
        assert!(text.starts_with("a\\nb\\u{1b}[31m\\ra"), "{text}");
        assert!(!text.chars().any(char::is_control) && text.len() < 8 * LONGEST);
        assert_eq!(one_line("jupe d'été"), "jupe d'été");
    }
}
