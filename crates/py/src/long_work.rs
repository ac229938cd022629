//! Long computations: on threads, without holding the interpreter, interrupted by Ctrl-C.

use pyo3::exceptions::{PyOSError, PyRuntimeError};
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// Time between two checks for Ctrl-C.
const POLL_INTERVAL: Duration = Duration::from_millis(50);

/// Runs `work` on a pool of threads and checks for Ctrl-C in this one.
///
/// Other Python threads run meanwhile. After Ctrl-C, the flag passed to `work` is set; it should return
/// soon, and its result is discarded.
pub(crate) fn interruptible<T: Send>(
    py: Python<'_>,
    threads: Option<usize>,
    work: impl FnOnce(&AtomicBool) -> T + Send,
) -> PyResult<T> {
    let pool = pool(threads)?;
    let stop = AtomicBool::new(false);
    let (sender, receiver) = sync_channel(1);
    let stop = &stop;
    py.detach(move || {
        pool.in_place_scope(|scope| {
            scope.spawn(move |_| {
                // After Ctrl-C, the receiver is gone.
                let _ = sender.send(work(stop));
            });
            result_or_stop(&receiver, stop)
        })
    })
}

fn result_or_stop<T>(results: &Receiver<T>, stop: &AtomicBool) -> PyResult<T> {
    loop {
        match results.recv_timeout(POLL_INTERVAL) {
            Ok(result) => return Ok(result),
            // The work panicked; the scope propagates that.
            Err(RecvTimeoutError::Disconnected) => {
                return Err(PyRuntimeError::new_err("the computation returned nothing"));
            }
            Err(RecvTimeoutError::Timeout) => {
                Python::attach(look_for_signals)
                    .inspect_err(|_| stop.store(true, Ordering::Relaxed))?;
            }
        }
    }
}

fn look_for_signals(py: Python<'_>) -> PyResult<()> {
    py.check_signals()
}

/// A thread pool, with its process and its number of threads.
struct Kept {
    process: u32,
    threads: Option<usize>,
    pool: Arc<ThreadPool>,
}

static KEPT: Mutex<Option<Kept>> = Mutex::new(None);

/// A pool of this number of threads, reused between calls: starting one takes longer than a small block.
///
/// A forked process inherits the pool without its threads, so it creates its own.
fn pool(threads: Option<usize>) -> PyResult<Arc<ThreadPool>> {
    let mut kept = KEPT.lock().unwrap_or_else(PoisonError::into_inner);
    let process = std::process::id();
    if let Some(kept) = &*kept
        && (kept.process, kept.threads) == (process, threads)
    {
        return Ok(Arc::clone(&kept.pool));
    }
    let pool = ThreadPoolBuilder::new()
        .num_threads(threads.unwrap_or(0))
        .build()
        .map(Arc::new)
        .map_err(|error| PyOSError::new_err(error.to_string()))?;
    let new = Kept {
        process,
        threads,
        pool: Arc::clone(&pool),
    };
    let old = kept.replace(new);
    // The threads of the parent process cannot be joined here.
    if let Some(old) = old.filter(|old| old.process != process) {
        std::mem::forget(old);
    }
    Ok(pool)
}
