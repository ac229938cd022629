//! Sets of tracks.

use base::hash::Hash;
use base::hashed::Hashed;

/// The highest number of tracks of a robot.
pub(crate) const MAX_TRACKS: usize = 1024;

const WORD: usize = 64;
const WORDS: usize = MAX_TRACKS / WORD;

/// A set of tracks, by index: one bit for each.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct TrackSet {
    words: [u64; WORDS],
}

impl Hashed for TrackSet {
    /// Without the words of tracks that robots have only with a higher limit than the default.
    fn add_to(&self, hash: &mut Hash) {
        let last = self.words.iter().rposition(|word| *word != 0);
        for word in &self.words[..=last.unwrap_or(0)] {
            word.add_to(hash);
        }
    }
}

impl TrackSet {
    /// The first tracks, up to a number.
    pub(crate) fn first(count: usize) -> Self {
        let mut set = Self::default();
        (0..count).for_each(|track| set.insert(track));
        set
    }

    /// A single track.
    pub(crate) fn of(track: usize) -> Self {
        let mut set = Self::default();
        set.insert(track);
        set
    }

    /// Adds a track; one beyond [`MAX_TRACKS`] does not exist.
    pub(crate) fn insert(&mut self, track: usize) {
        if let Some(word) = self.words.get_mut(track / WORD) {
            *word |= 1 << (track % WORD);
        }
    }

    pub(crate) fn remove(&mut self, track: usize) {
        if let Some(word) = self.words.get_mut(track / WORD) {
            *word &= !(1 << (track % WORD));
        }
    }

    /// Adds all tracks of another set.
    pub(crate) fn extend(&mut self, other: &Self) {
        for (word, more) in self.words.iter_mut().zip(&other.words) {
            *word |= more;
        }
    }

    /// The tracks, in increasing order.
    pub(crate) fn iter(self) -> impl Iterator<Item = usize> {
        let words = self.words.into_iter().enumerate();
        let words = words.filter(|(_, word)| *word != 0);
        words.flat_map(|(number, word)| {
            let set = (0..WORD).filter(move |bit| word >> bit & 1 == 1);
            set.map(move |bit| WORD * number + bit)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use alloc::vec::Vec;

    #[test]
    fn a_set_lists_its_tracks_in_increasing_order() {
        let mut set = TrackSet::default();
        for track in [1023, 64, 0, 63, 64, 5] {
            set.insert(track);
        }
        set.remove(5);
        set.insert(MAX_TRACKS);
        assert_eq!(set.iter().collect::<Vec<_>>(), [0, 63, 64, 1023]);
        let mut all = TrackSet::first(3);
        all.extend(&set);
        assert_eq!(all.iter().collect::<Vec<_>>(), [0, 1, 2, 63, 64, 1023]);
    }

    #[test]
    fn the_hash_of_the_first_tracks_is_that_of_their_word() {
        let of = |value: &dyn Fn(&mut Hash)| {
            let mut hash = Hash::default();
            value(&mut hash);
            hash
        };
        let set = TrackSet::first(64);
        let [set, word] = [
            of(&|hash| set.add_to(hash)),
            of(&|hash| u64::MAX.add_to(hash)),
        ];
        assert_eq!(set.value(), word.value());
    }
}
