//! Keeps a panic of the inference engine inside.
//!
//! Every graph is checked before the engine sees it (`graph`, `shapes`), and the tests assert that
//! no hostile file gets as far as a panic. The engine is large, though, and it indexes, unwraps and
//! allocates by what a file says; a game that loads a file must not die of what those checks have
//! overlooked. In a build with `panic = "abort"` this net is not there, and the checks stand alone.

use std::cell::Cell;
use std::panic::{self, AssertUnwindSafe};
use std::sync::Once;

use crate::Error;

thread_local! {
    /// Whether a panic of this thread is about to be caught here, and so needs no message.
    static QUIET: Cell<bool> = const { Cell::new(false) };
}

/// The reason in [`Error::Inference`] where a panic was caught.
pub(crate) const PANICKED: &str = "it panicked";

/// Runs `work` on the engine. An error of the engine, or a panic, becomes [`Error::Inference`] with
/// the name of the `stage`.
pub(crate) fn guarded<T, E: std::fmt::Display>(
    stage: &'static str,
    work: impl FnOnce() -> Result<T, E>,
) -> Result<T, Error> {
    // The hook of the program stays in charge of every panic but those that are caught below.
    static HOOK: Once = Once::new();
    HOOK.call_once(|| {
        let programs_own = panic::take_hook();
        panic::set_hook(Box::new(move |panic| {
            if !QUIET.get() {
                programs_own(panic);
            }
        }));
    });
    let before = QUIET.replace(true);
    // Safe to unwind through: `work` owns or only reads what it touches, and its result is dropped.
    let result = panic::catch_unwind(AssertUnwindSafe(work));
    QUIET.set(before);
    match result {
        Ok(Ok(value)) => Ok(value),
        // the alternate form of the engine's errors has the whole chain of causes
        Ok(Err(e)) => Err(Error::Inference { stage, reason: format!("{e:#}") }),
        Err(_) => Err(Error::Inference { stage, reason: PANICKED.into() }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_becomes_an_error() {
        let got: Result<(), Error> = guarded("run", || -> Result<(), String> { panic!("inside") });
        assert_eq!(got, Err(Error::Inference { stage: "run", reason: PANICKED.into() }));
        assert_eq!(guarded("run", || Ok::<_, String>(3)), Ok(3));
        assert!(!QUIET.get());
    }
}
