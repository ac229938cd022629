//! Values that a hash of simulation states covers.

use crate::hash::Hash;
pub use derive::Hashed;
use std::collections::VecDeque;
use std::sync::Arc;

/// A value whose content a hash can cover: different contents add different words, numbers with all
/// their bits.
///
/// The derive macro covers each field, except those with `#[hashed(skip)]`, such as one that follows from others.
pub trait Hashed {
    /// Adds the content to a hash.
    fn add_to(&self, hash: &mut Hash);

    /// Adds the contents of several values, without their number. Small numbers share a word.
    fn add_all(values: &[Self], hash: &mut Hash)
    where
        Self: Sized,
    {
        for value in values {
            value.add_to(hash);
        }
    }
}

/// Numbers that widen to a word.
macro_rules! numbers {
    ($($kind:ty),+) => {
        $(impl Hashed for $kind {
            #[inline]
            fn add_to(&self, hash: &mut Hash) {
                hash.add(u64::from(*self));
            }
        })+
    };
}

numbers!(bool, u8, u16, u32, u64);

impl Hashed for usize {
    #[inline]
    fn add_to(&self, hash: &mut Hash) {
        hash.add(*self as u64);
    }
}

impl Hashed for i8 {
    #[inline]
    fn add_to(&self, hash: &mut Hash) {
        hash.add(u64::from(self.cast_unsigned()));
    }

    fn add_all(values: &[Self], hash: &mut Hash) {
        let word = |bytes: [Self; 8]| u64::from_le_bytes(bytes.map(Self::cast_unsigned));
        let (words, rest) = values.as_chunks();
        add_words(words, word, hash);
        for value in rest {
            value.add_to(hash);
        }
    }
}

impl Hashed for i32 {
    #[inline]
    fn add_to(&self, hash: &mut Hash) {
        hash.add(u64::from(self.cast_unsigned()));
    }
}

impl Hashed for f64 {
    #[inline]
    fn add_to(&self, hash: &mut Hash) {
        hash.add(self.to_bits());
    }
}

impl Hashed for f32 {
    #[inline]
    fn add_to(&self, hash: &mut Hash) {
        hash.add(u64::from(self.to_bits()));
    }

    fn add_all(values: &[Self], hash: &mut Hash) {
        let word =
            |[low, high]: [Self; 2]| u64::from(high.to_bits()) << 32 | u64::from(low.to_bits());
        let (words, rest) = values.as_chunks();
        add_words(words, word, hash);
        for value in rest {
            value.add_to(hash);
        }
    }
}

/// Adds many words in four hashes of their own, which a processor computes at the same time: maps
/// have thousands of cells.
fn add_words<T: Copy>(values: &[T], word: impl Fn(T) -> u64, hash: &mut Hash) {
    let mut lanes: [Hash; 4] = Default::default();
    let (fours, rest) = values.as_chunks::<4>();
    for four in fours {
        for (lane, value) in lanes.iter_mut().zip(four) {
            lane.add(word(*value));
        }
    }
    for lane in lanes {
        hash.add(lane.value());
    }
    for value in rest {
        hash.add(word(*value));
    }
}

impl<T: Hashed> Hashed for Option<T> {
    #[inline]
    fn add_to(&self, hash: &mut Hash) {
        hash.add(u64::from(self.is_some()));
        if let Some(value) = self {
            value.add_to(hash);
        }
    }
}

impl<T: Hashed> Hashed for [T] {
    #[inline]
    fn add_to(&self, hash: &mut Hash) {
        hash.add(self.len() as u64);
        T::add_all(self, hash);
    }
}

impl<T: Hashed, const N: usize> Hashed for [T; N] {
    #[inline]
    fn add_to(&self, hash: &mut Hash) {
        T::add_all(self, hash);
    }
}

impl<T: Hashed> Hashed for Vec<T> {
    #[inline]
    fn add_to(&self, hash: &mut Hash) {
        self.as_slice().add_to(hash);
    }
}

impl<T: Hashed + ?Sized> Hashed for Box<T> {
    #[inline]
    fn add_to(&self, hash: &mut Hash) {
        (**self).add_to(hash);
    }
}

impl<T: Hashed + ?Sized> Hashed for Arc<T> {
    #[inline]
    fn add_to(&self, hash: &mut Hash) {
        (**self).add_to(hash);
    }
}

impl<T: Hashed> Hashed for VecDeque<T> {
    fn add_to(&self, hash: &mut Hash) {
        hash.add(self.len() as u64);
        for value in self {
            value.add_to(hash);
        }
    }
}

impl<A: Hashed, B: Hashed> Hashed for (A, B) {
    #[inline]
    fn add_to(&self, hash: &mut Hash) {
        self.0.add_to(hash);
        self.1.add_to(hash);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Hashed)]
    struct Pair {
        left: u8,
        right: Option<f64>,
        #[hashed(skip)]
        scratch: u32,
    }

    const PAIR: Pair = Pair {
        left: 1,
        right: Some(0.0),
        scratch: 0,
    };

    fn hash_of(value: &(impl Hashed + ?Sized)) -> u64 {
        let mut hash = Hash::new();
        value.add_to(&mut hash);
        hash.value()
    }

    #[test]
    fn each_field_of_a_struct_changes_its_hash_but_for_those_left_out() {
        let others = [
            Pair { left: 2, ..PAIR },
            Pair {
                right: Some(-0.0),
                ..PAIR
            },
            Pair {
                right: None,
                ..PAIR
            },
        ];
        for other in &others {
            assert_ne!(hash_of(other), hash_of(&PAIR));
        }
        let same = Pair { scratch: 7, ..PAIR };
        assert_ne!(same.scratch, PAIR.scratch);
        assert_eq!(hash_of(&same), hash_of(&PAIR));
    }

    #[derive(Hashed)]
    #[expect(dead_code, reason = "skipped")]
    enum Shape<T> {
        None,
        Tuple(T, #[hashed(skip)] u8),
        Named { left: T, right: T },
    }

    #[test]
    fn the_variant_and_the_fields_of_an_enum_change_its_hash() {
        let named = |left, right| hash_of(&Shape::Named { left, right });
        let all = [
            hash_of(&Shape::<u8>::None),
            hash_of(&Shape::Tuple(0_u8, 7)),
            hash_of(&Shape::Tuple(1_u8, 7)),
            named(0_u8, 1),
            named(1, 0),
        ];
        for (number, hash) in all.iter().enumerate() {
            assert!(!all[..number].contains(hash), "{number}");
        }
        assert_eq!(hash_of(&Shape::Tuple(1_u8, 8)), all[2]);
    }

    #[test]
    fn each_of_several_numbers_that_share_a_word_changes_the_hash() {
        let bytes: Vec<i8> = (-50..50).collect();
        let singles: Vec<f32> = bytes.iter().map(|byte| f32::from(*byte)).collect();
        for place in 0..bytes.len() {
            let mut other = bytes.clone();
            other[place] = -51;
            assert_ne!(hash_of(&bytes), hash_of(&other));
            let mut other = singles.clone();
            other[place] = 0.5;
            assert_ne!(hash_of(&singles), hash_of(&other));
        }
    }

    #[test]
    fn the_lengths_of_lists_change_the_hash() {
        let lists = |first: &[u8], second: &[u8]| hash_of(&(first.to_vec(), second.to_vec()));
        assert_ne!(lists(&[0, 0], &[0]), lists(&[0], &[0, 0]));
        assert_ne!(hash_of(&vec![0_i8; 8]), hash_of(&vec![0_i8; 7]));
    }
}
