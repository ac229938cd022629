//! Items that are too close to each other to be tracked apart: drawn from the model, kind 1 is to be cleared.

use super::uncertain::{CONFUSION, DETECTION, beliefs, look, seen_as};
use super::*;
use alloc::vec::Vec;
use base::noise::normal_pair;

/// Kind 1, mines.
const TO_CLEAR: u8 = 0b10;

const LOOKS: u32 = 30;

/// The tracks of a robot after looks at items of some kinds, 5 cm from each other.
fn seen(kinds: &[usize], run: u32) -> Items {
    let (mut items, detector) = beliefs();
    items.hazards = Some(TO_CLEAR);
    let entity = Entity {
        kind: 9,
        index: run,
    };
    let mut random = stream(1, 0, entity, Purpose::Item);
    for _ in 0..LOOKS {
        let mut contacts = Vec::new();
        for (number, kind) in (0..).zip(kinds) {
            let [right_m, up_m] = normal_pair([random.next_u32(), random.next_u32()]);
            let is_clutter = unit(&mut random) < CONFUSION[*kind][0];
            let at = Point {
                x: POSITION.x + 0.05 * f64::from(number) + 0.1 * right_m,
                y: POSITION.y + 0.1 * up_m,
            };
            if unit(&mut random) < DETECTION[*kind] {
                contacts.push(seen_as(u16::from(!is_clutter), at));
            }
        }
        look(&mut items, &detector, Point::default(), &contacts, None);
    }
    items
}

/// For the first track: the ratio of the likelihoods of an item that is to be cleared and of clutter, in nats, and the
/// expected number of such items that are left when one is destroyed.
fn shown(kinds: &[usize], run: u32) -> [f64; 2] {
    let items = seen(kinds, run);
    let model = items.kinds.as_deref().unwrap();
    let track = &items.tracks[0];
    let mut ratios = track.visible_log_ratios(model);
    let group = track.group.as_ref().unwrap();
    group.with_several(model.shares(), &mut ratios);
    [ratios[1] - ratios[0], group.further()]
}

/// In how many of 40 runs something holds.
fn count(kinds: &[usize], is_so: impl Fn([f64; 2]) -> bool) -> usize {
    (0..40).filter(|run| is_so(shown(kinds, *run))).count()
}

/// Three of ten contacts of clutter are as of a mine. The limits are two to four standard errors from the shares that these
/// runs have: a change that distinguishes as well fails one of them in at most 5% of the cases.
#[test]
fn a_mine_shows_among_pieces_of_scrap_that_cannot_be_tracked_apart() {
    assert!(count(&[1, 0], |[mine, _]| mine > 2.0) >= 32);
    assert!(count(&[1, 0, 0], |[mine, _]| mine > 0.0) >= 30);
}

#[test]
fn scrap_alone_is_not_taken_for_a_mine() {
    assert!(count(&[0], |[mine, _]| mine > 0.0) <= 1);
    assert!(count(&[0, 0], |[mine, _]| mine > 2.0) <= 4);
}

#[test]
fn two_mines_show_that_one_is_left_when_the_other_is_destroyed() {
    assert!(count(&[1, 1], |[_, further]| further > 0.5) >= 24);
    assert!(count(&[1], |[_, further]| further > 0.2) <= 2);
    assert!(count(&[0, 0], |[_, further]| further > 0.5) <= 4);
}
