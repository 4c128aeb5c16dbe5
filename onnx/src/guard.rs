//! Runs the inference engine apart: in a thread of its own, so that two things stay inside.
//!
//! A panic: every graph is checked before the engine sees it (`graph`, `shapes`), and the tests assert that no hostile file
//! gets as far as one. The engine is large, though, and it indexes, unwraps and allocates by what a file says; a game that
//! loads a file must not die of what those checks have overlooked. In a build with `panic = "abort"` this net is not there,
//! the checks stand alone, and the panic's own message is printed.
//!
//! The state of the vector registers: the engine's kernels leave their upper halves in use, and a cloth that was stepped on
//! the same thread afterwards took three times as long.

use std::cell::Cell;
use std::panic;
use std::sync::Once;
use std::thread;

use crate::Error;

thread_local! {
    /// Whether a panic of this thread is about to be caught here, and so needs no message.
    static QUIET: Cell<bool> = const { Cell::new(false) };
}

/// The reason in [`Error::Inference`] where a panic was caught.
pub(crate) const PANICKED: &str = "it panicked";

/// Runs `work` on the engine and waits for it. An error of the engine, a panic, or a thread that cannot be started becomes
/// [`Error::Inference`] with the name of the `stage`.
pub(crate) fn guarded<T: Send, E: std::fmt::Display>(
    stage: &'static str,
    work: impl FnOnce() -> Result<T, E> + Send,
) -> Result<T, Error> {
    // The hook of the program stays in charge of every panic but those that are caught below.
    static HOOK: Once = Once::new();
    HOOK.call_once(|| {
        let programs_own = panic::take_hook();
        panic::set_hook(Box::new(move |panic| {
            if !QUIET.get() || cfg!(panic = "abort") {
                programs_own(panic);
            }
        }));
    });
    let failed = |reason: String| Error::Inference { stage, reason };
    let apart = || {
        QUIET.set(true);
        // the alternate form of the engine's errors has the whole chain of causes
        work().map_err(|e| format!("{e:#}"))
    };
    thread::scope(|scope| {
        let thread = thread::Builder::new().spawn_scoped(scope, apart).map_err(|e| failed(e.to_string()))?;
        // a panic ends the thread and arrives here
        thread.join().unwrap_or_else(|_| Err(PANICKED.into())).map_err(failed)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_becomes_an_error() {
        let got: Result<(), Error> = guarded("run", || -> Result<(), String> { panic!("inside") });
        assert_eq!(got, Err(Error::Inference { stage: "run", reason: PANICKED.into() }));
        assert_eq!(guarded("run", || Ok::<_, String>(3)), Ok(3));
        assert!(!QUIET.get(), "a panic of the caller's own is not silenced");
    }
}
