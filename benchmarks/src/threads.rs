//! The same work on one thread and on two.

use crate::clock::{median, took_by_both};
use rayon::ThreadPool;

/// Work per second of a number of threads: of processor time, and of wall-clock time.
pub(crate) struct Rate {
    pub(crate) threads: u32,
    pub(crate) a_second: f64,
    pub(crate) by_wall: f64,
}

/// Alternates between one thread and two, and checks that both give the same hash.
pub(crate) fn by_turns(
    pieces: u32,
    amount: f64,
    mut work: impl FnMut(u32) -> u64 + Send,
) -> ([Rate; 2], u64) {
    let pools = [1, 2].map(|threads| (threads, pool(threads)));
    let mut rates = [const { Vec::new() }; 4];
    let mut hash = 0;
    for piece in 0..pieces {
        let mut hashes = [0; 2];
        for (number, (threads, pool)) in pools.iter().enumerate() {
            let work = || hashes[number] = pool.install(|| work(piece));
            let [processors_s, wall_s] = took_by_both(work);
            rates[number].push(f64::from(*threads) * amount / processors_s);
            rates[2 + number].push(amount / wall_s);
        }
        assert_eq!(hashes[0], hashes[1], "whatever the number of threads");
        hash = hashes[0];
    }
    let [one, two, one_by_wall, two_by_wall] = rates.map(median);
    let rows = [(1, one, one_by_wall), (2, two, two_by_wall)];
    let rates = rows.map(|(threads, rate, by_wall)| Rate {
        threads,
        a_second: rate,
        by_wall,
    });
    (rates, hash)
}

/// A pool of this number of threads.
pub(crate) fn pool(threads: u32) -> ThreadPool {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads as usize);
    pool.build().expect("threads can be made")
}
