//! Work on the pictures of a batch in parallel, with results that do not depend on the number of threads.

use std::num::NonZero;

/// Threads this process may use.
pub fn available_threads() -> NonZero<usize> {
    std::thread::available_parallelism().unwrap_or(NonZero::<usize>::MIN)
}

/// Calls `work(i, chunk)` for every chunk of `chunk_len` values of `out`, on at most `threads` threads.
///
/// Each chunk is written by one call that sees nothing of the others, hence no sum runs across threads and the result is
/// the same for every number of threads. `state` makes what one thread keeps between its chunks (scratch memory).
pub(super) fn for_each_chunk<T: Send, S>(
    out: &mut [T],
    chunk_len: usize,
    threads: NonZero<usize>,
    state: impl Fn() -> S + Sync,
    work: impl Fn(&mut S, usize, &mut [T]) + Sync,
) {
    if out.is_empty() || chunk_len == 0 {
        return;
    }
    let chunks = out.len().div_ceil(chunk_len);
    let per_thread = chunks.div_ceil(threads.get());
    let run = |first: usize, part: &mut [T]| {
        let mut scratch = state();
        for (i, chunk) in part.chunks_mut(chunk_len).enumerate() {
            work(&mut scratch, first + i, chunk);
        }
    };
    if per_thread >= chunks {
        return run(0, out);
    }
    std::thread::scope(|scope| {
        for (t, part) in out.chunks_mut(per_thread * chunk_len).enumerate() {
            let run = &run;
            scope.spawn(move || run(t * per_thread, part));
        }
    });
}
