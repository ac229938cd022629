//! Hashes of sets of goals.

use crate::io::goal_id::GoalId;
use base::hash::Hash;
use base::hashed::Hashed;

/// The number and hash of a set of goals, in any order.
pub(super) fn set_hash(goals: impl Iterator<Item = GoalId>) -> (u16, [u32; 2]) {
    let (mut count, mut sum) = (0_u16, 0_u64);
    for goal in goals {
        let mut hash = Hash::default();
        goal.add_to(&mut hash);
        (count, sum) = (count.saturating_add(1), sum.wrapping_add(hash.value()));
    }
    #[expect(clippy::cast_possible_truncation, reason = "both halves are kept")]
    let halves = [(sum >> 32) as u32, sum as u32];
    (count, halves)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sets_have_the_same_hash_in_any_order_and_different_sets_do_not() {
        let goal = |number| GoalId {
            number,
            ..GoalId::default()
        };
        let hash = |numbers: &[u32]| set_hash(numbers.iter().map(|number| goal(*number)));
        assert_eq!(hash(&[1, 2, 3]), hash(&[3, 1, 2]));
        assert_ne!(hash(&[1, 2, 3]), hash(&[1, 2, 4]));
        assert_ne!(hash(&[1, 2]), hash(&[1, 2, 3]));
    }
}
