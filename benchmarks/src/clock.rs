//! Time that threads had a processor, from Linux: on a shared machine a wall clock says little.

use std::time::Instant;

/// Nanoseconds for which each thread of this process has run, by the thread's number.
fn threads() -> Vec<(String, u64)> {
    let Ok(tasks) = std::fs::read_dir("/proc/self/task") else {
        return Vec::new();
    };
    let mut threads: Vec<(String, u64)> = tasks
        .flatten()
        .filter_map(|task| {
            let text = std::fs::read_to_string(task.path().join("schedstat")).ok()?;
            let run_ns = text.split(' ').next()?.parse().ok()?;
            Some((task.file_name().to_string_lossy().into_owned(), run_ns))
        })
        .collect();
    threads.sort();
    threads
}

/// What some work took.
#[derive(Debug, Clone, Copy)]
#[allow(
    dead_code,
    clippy::struct_field_names,
    reason = "for worlds shared by threads"
)]
pub(crate) struct Took {
    /// Of all threads together.
    pub(crate) cpu_s: f64,
    /// Of the thread that ran longest: the time it would take on processors of its own, unless
    /// threads wait for each other.
    pub(crate) longest_s: f64,
    pub(crate) wall_s: f64,
}

/// Does some work, and says what it took.
#[expect(clippy::cast_precision_loss, reason = "nanoseconds of minutes")]
pub(crate) fn took(work: impl FnOnce()) -> Took {
    let before = threads();
    let start = Instant::now();
    work();
    let wall_s = start.elapsed().as_secs_f64();
    let run_ns = threads().into_iter().map(|(thread, run_ns)| {
        let then = before.iter().find(|(before, _)| *before == thread);
        (run_ns - then.map_or(0, |(_, run_ns)| *run_ns)) as f64
    });
    let run_ns: Vec<f64> = run_ns.collect();
    Took {
        cpu_s: run_ns.iter().sum::<f64>() / 1e9,
        longest_s: run_ns.iter().copied().fold(0.0, f64::max) / 1e9,
        wall_s,
    }
}

/// The middle of some numbers.
pub(crate) fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}
