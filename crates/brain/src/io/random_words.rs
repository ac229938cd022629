//! Uniform numbers from the random bits of a percept.

/// Uniform numbers from a percept's [`random_words`](crate::Percept::random_words), in a fixed
/// order.
///
/// The first four are its four words; further ones are derived by mixing these again.
#[derive(Debug, Clone)]
pub struct RandomWords {
    words: [u32; 4],
    drawn: usize,
}

impl RandomWords {
    /// At the first number.
    #[must_use]
    pub fn new(words: [u32; 4]) -> Self {
        Self { words, drawn: 0 }
    }

    /// From 0 up to, but not including, 1.
    pub fn unit(&mut self) -> f64 {
        f64::from(self.word()) / 4_294_967_296.0
    }

    /// From `low` up to, but not including, `high`.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// An integer below `end`; 0 if that is 0.
    pub fn below(&mut self, end: u32) -> u32 {
        let product = u64::from(self.word()) * u64::from(end);
        u32::try_from(product >> 32).unwrap_or_default()
    }

    fn word(&mut self) -> u32 {
        if self.drawn == self.words.len() {
            self.mix();
        }
        let word = self.words.get(self.drawn).copied();
        self.drawn += 1;
        word.unwrap_or_default()
    }

    /// Each word as murmur3 would finish it, with the one before it; their places make equal words
    /// differ.
    fn mix(&mut self) {
        let mut before = self.words[3];
        for (place, word) in (1..).zip(&mut self.words) {
            let mut bits = *word ^ before.wrapping_add(0x9e37_79b9_u32.wrapping_mul(place));
            bits = (bits ^ (bits >> 16)).wrapping_mul(0x85eb_ca6b);
            bits = (bits ^ (bits >> 13)).wrapping_mul(0xc2b2_ae35);
            *word = bits ^ (bits >> 16);
            before = *word;
        }
        self.drawn = 0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::random::{Entity, Purpose, stream};
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn numbers_lie_within_their_bounds(words: [u32; 4], end in 1_u32..1000) {
            let mut random_words = RandomWords::new(words);
            for _ in 0..20 {
                prop_assert!((0.0..1.0).contains(&random_words.unit()));
                prop_assert!((-3.0..2.0).contains(&random_words.between(-3.0, 2.0)));
                prop_assert!(random_words.below(end) < end);
            }
            prop_assert_eq!(random_words.below(0), 0);
        }

        #[test]
        fn the_first_four_numbers_are_the_words(words: [u32; 4]) {
            let mut random_words = RandomWords::new(words);
            for word in words {
                prop_assert_eq!(random_words.unit().to_bits(), (f64::from(word) / 4_294_967_296.0).to_bits());
            }
        }
    }

    #[test]
    fn each_of_the_first_twelve_numbers_is_uniform() {
        // Chi-square over 16 bins of 16,000 draws, seed fixed: above 46.5 with probability 4.4e-5
        // for one number, 5e-4 for any of the twelve.
        let mut random = stream(1, 0, Entity { kind: 0, index: 0 }, Purpose::Start);
        let mut bins = [[0_u32; 16]; 12];
        for _ in 0..16_000 {
            let mut random_words = RandomWords::new(std::array::from_fn(|_| random.next_u32()));
            for bins in &mut bins {
                bins[random_words.below(16) as usize] += 1;
            }
        }
        for (place, bins) in bins.iter().enumerate() {
            let excess = bins
                .iter()
                .map(|count| (f64::from(*count) - 1000.0).powi(2));
            let statistic = excess.sum::<f64>() / 1000.0;
            assert!(statistic < 46.5, "number {place}: {statistic}");
        }
    }

    #[test]
    fn dice_of_zeros_do_not_stay_zeros() {
        let mut random_words = RandomWords::new([0; 4]);
        let later: Vec<u32> = (0..8)
            .map(|_| random_words.below(1 << 30))
            .skip(4)
            .collect();
        assert!(later.iter().all(|number| *number > 0), "{later:?}");
    }
}
