//! Numbers of requests.

use crate::io::percept::Percept;
use base::hash::Hash;
use base::hashed::Hashed;

/// Numbers of the requests of an agent, each different from all others.
///
/// The first number is a hash of the agent's first percept: an agent that restarts, and remembers
/// nothing, does not take the answer to an earlier request for that to a new one.
#[derive(Debug, Clone, Copy, Default, Hashed)]
pub struct Numbers {
    last: Option<u32>,
}

impl Numbers {
    /// Takes the percept of a step; the first one decides about the first number.
    pub fn step(&mut self, percept: &Percept) {
        self.last.get_or_insert_with(|| before_first(percept));
    }

    /// The next number.
    pub fn draw(&mut self) -> u32 {
        let next = self.last.unwrap_or_default().wrapping_add(1);
        self.last = Some(next);
        next
    }
}

#[expect(clippy::cast_possible_truncation, reason = "a hash")]
fn before_first(percept: &Percept) -> u32 {
    let mut hash = Hash::default();
    percept.time_s.add_to(&mut hash);
    percept.random_words.add_to(&mut hash);
    percept.id.add_to(&mut hash);
    let value = hash.value();
    (value >> 32) as u32 ^ value as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(time_s: f64) -> Percept {
        Percept {
            time_s: Some(time_s),
            ..Percept::default()
        }
    }

    #[test]
    fn numbers_differ_also_after_a_restart() {
        let mut numbers = Numbers::default();
        numbers.step(&at(1.0));
        let before: Vec<u32> = (0..100).map(|_| numbers.draw()).collect();
        let mut restarted = Numbers::default();
        restarted.step(&at(2.0));
        assert!((0..100).all(|_| !before.contains(&restarted.draw())));
    }

    #[test]
    fn agents_with_the_same_clock_and_other_random_words_have_other_numbers() {
        let first = |words: u32| {
            let percept = Percept {
                random_words: [words; 4],
                ..at(1.0)
            };
            let mut numbers = Numbers::default();
            numbers.step(&percept);
            numbers.draw()
        };
        assert_ne!(first(1), first(2));
    }
}
