//! The charges of a robot at a goal, and what they are aimed at.

use crate::io::goal_id::GoalId;
use crate::io::work::Task;
use crate::perception::beliefs::Beliefs;
use crate::perception::beliefs::items::track::{Track, probability};
use base::geometry::Point;
use base::hash::Hash;
use base::hashed::Hashed;

/// An item is acted on from this probability on.
const ACT_ABOVE: f64 = 0.5;

/// What a robot has detected, and is to neutralise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Aim {
    /// Its position in the world.
    pub(crate) at: Point,
    /// The robot's mark there.
    pub(super) mark: GoalId,
}

/// The charges of a robot at a goal.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Charges {
    /// Number of charges that have gone off, and whether one has destroyed something.
    pub(crate) fired: u8,
    pub(super) is_success: bool,
    /// Whether it has looked for the time of the service, and has detected nothing.
    pub(crate) has_looked: bool,
    /// Whether one has been commanded and its result is not known.
    pub(crate) is_firing: bool,
    pub(crate) fence: Fence,
}

/// Whether a robot fences off an item that it cannot neutralise.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hashed)]
pub(crate) enum Fence {
    /// It has no reason to.
    #[default]
    None,
    /// It is to do so, or is doing it.
    Wanted,
    /// It has.
    Done,
    /// It has tried, but it was out of the tool's range.
    Failed,
}

/// Goals without charges have the hash that they had before there were charges.
impl Hashed for Charges {
    fn add_to(&self, hash: &mut Hash) {
        if *self != Self::default() {
            self.fired.add_to(hash);
            [self.is_success, self.has_looked, self.is_firing].add_to(hash);
            if self.fence != Fence::None {
                self.fence.add_to(hash);
            }
        }
    }
}

/// The goal at which a robot has commanded a charge whose result it does not know, and its mark there.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Firing(pub(super) Option<(GoalId, Option<GoalId>)>);

/// Nothing is added for robots without charges.
impl Hashed for Firing {
    fn add_to(&self, hash: &mut Hash) {
        if self.0.is_some() {
            self.0.add_to(hash);
        }
    }
}

impl Aim {
    /// The own track with the highest probability that may be the marked item, of the kinds that are to be
    /// cleared.
    pub(super) fn new(
        task: &Task,
        beliefs: &Beliefs,
        (within_m, is_hazard): (f64, impl Fn(u16) -> bool),
    ) -> Option<Self> {
        let tracks = beliefs.items.tracks.iter();
        let near = tracks.filter(|track| {
            let is_likely = probability(track.log_odds()) >= ACT_ABOVE && is_hazard(track.kind);
            is_likely && track.at.to(task.at()).length() <= within_m
        });
        let own = near.filter_map(|track| Some((track, own_mark(track, beliefs)?)));
        let best = own.max_by(|(one, _), (other, _)| one.log_odds().total_cmp(&other.log_odds()));
        best.map(|(track, mark)| Self { at: track.at, mark })
    }
}

/// The id of the robot's mark of a track that it has detected itself.
fn own_mark(track: &Track, beliefs: &Beliefs) -> Option<GoalId> {
    let own = track.own_contact(beliefs.id)?;
    Some(GoalId {
        issuer: beliefs.id.into(),
        number: own.provenance.track_id,
    })
}
