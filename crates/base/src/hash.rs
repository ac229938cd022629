//! A hash of simulation states.

/// An incremental hash of 64-bit words: FNV-1a (Fowler, Noll, Vo), one word at a time.
#[derive(Debug)]
pub struct Hash(u64);

impl Hash {
    /// The hash of no words.
    #[must_use]
    #[inline]
    pub fn new() -> Self {
        Self(0xCBF2_9CE4_8422_2325)
    }

    /// Adds a word.
    #[inline]
    pub fn add(&mut self, word: u64) {
        // The shift moves high bits to low ones, which a product alone does not.
        let mixed = (self.0 ^ word).wrapping_mul(0x0000_0100_0000_01B3);
        self.0 = mixed ^ (mixed >> 29);
    }

    /// The hash of all words added.
    #[must_use]
    #[inline]
    pub fn value(&self) -> u64 {
        self.0
    }
}

impl Default for Hash {
    fn default() -> Self {
        Self::new()
    }
}
