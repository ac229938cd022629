//! The work of a robot that neutralises a marked item: it looks, acts on what it has detected, and
//! looks again.

use super::ability::{Ability, Moment};
use super::assignee::Assignee;
use crate::io::act::{Act, ActKind};
use crate::io::dispatch::{Reason, Task, Work};
use crate::io::goal_id::GoalId;
use crate::io::lane::{MarkVerdict, Statement};
use crate::perception::beliefs::Beliefs;
use crate::perception::beliefs::items::track::{Track, probability};
use base::geometry::Point;
use base::hash::Hash;
use base::hashed::Hashed;

/// Charges at one goal; then another robot may try.
const MAX_CHARGES: u8 = 3;

/// An item is acted on from this probability on.
const ACT_ABOVE: f64 = 0.5;

/// What a robot has detected, and is to neutralise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Aim {
    /// Its position in the world.
    pub(crate) at: Point,
    /// The robot's mark there.
    mark: GoalId,
}

/// The charges of a robot at a goal.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Charges {
    /// Number of charges that have gone off, and whether one has destroyed something.
    pub(crate) fired: u8,
    is_success: bool,
    /// Whether it has looked for the time of the service, and has detected nothing.
    pub(crate) has_looked: bool,
    /// Whether one has been commanded and its result is not known.
    pub(crate) is_firing: bool,
}

/// Goals without charges have the hash that they had before there were charges.
impl Hashed for Charges {
    fn add_to(&self, hash: &mut Hash) {
        if *self != Self::default() {
            self.fired.add_to(hash);
            [self.is_success, self.has_looked, self.is_firing].add_to(hash);
        }
    }
}

/// The goal at which a robot has commanded a charge whose result it does not know, and its mark there.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Firing(Option<(GoalId, Option<GoalId>)>);

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
    fn new(
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
    let mut sources = track.sources[..track.count].iter();
    let own =
        sources.find(|source| source.provenance.observer == beliefs.id && source.is_contact)?;
    Some(GoalId {
        issuer: beliefs.id,
        number: own.provenance.track_id,
    })
}

impl Assignee {
    /// Updates what the robot is to neutralise, by its beliefs.
    pub(super) fn aim(&mut self, ability: &Ability, moment: &Moment) {
        let Some(beliefs) = moment.beliefs else {
            return;
        };
        let lane = &self.lane;
        for job in &mut self.jobs.list {
            if job.task.work == Work::Neutralise {
                let within_m = ability.uncertain_m(&job.task);
                let is_hazard = |kind| lane.is_hazard(kind);
                job.aim = Aim::new(&job.task, beliefs, (within_m, is_hazard));
            }
        }
    }

    /// Takes the results of charges: they are those of the goal that the robot serves.
    pub(super) fn take_results(&mut self, moment: &Moment) {
        for acted in &moment.percept.acted {
            let job = self.firing.0.and_then(|(goal, _)| self.jobs.get_mut(goal));
            let Some(job) = job.filter(|_| acted.kind == ActKind::Neutralise) else {
                continue;
            };
            job.charges.fired = job.charges.fired.saturating_add(1);
            job.charges.is_firing = false;
            if acted.is_success {
                // It looks again: there may be another item.
                job.charges.is_success = true;
                job.charges.has_looked = false;
                job.served_s = 0.0;
                let mark = self.firing.0.and_then(|(_, mark)| mark);
                let statement = Statement {
                    mark: mark.unwrap_or(job.task.id),
                    at_m: [acted.at.x, acted.at.y].map(short),
                    verdict: MarkVerdict::Neutralised,
                };
                self.lane.add(statement);
            }
            self.firing = Firing(None);
        }
    }

    /// Looks for the item of a goal at which the robot is, and acts on it.
    pub(super) fn neutralise(&mut self, goal: GoalId, moment: &Moment) {
        let Some(job) = self.jobs.get_mut(goal) else {
            return;
        };
        if let Some(at) = job.charge_at() {
            let is_spent = job.charges.fired >= MAX_CHARGES || moment.percept.charges == Some(0);
            if is_spent {
                let (task, charges) = (job.task, job.charges);
                if charges.fired > 0 && !charges.is_success {
                    self.lane.add(missed(&task));
                }
                self.report_failure(goal, Reason::Capability);
                self.release(goal);
                return;
            }
            job.charges.is_firing = true;
            self.firing = Firing(Some((goal, job.aim.map(|aim| aim.mark))));
            let kind = ActKind::Neutralise;
            self.acts.push(Act { kind, at });
        } else if job.left_s() > 0.0 {
            job.served_s += moment.body.period_s;
        } else if job.charges.fired == 0 {
            job.charges.has_looked = true;
        } else {
            let (task, is_success) = (job.task, job.charges.is_success);
            if !is_success {
                self.lane.add(missed(&task));
            }
            self.finish(goal);
        }
    }
}

/// The statement that a charge at the mark of a goal has destroyed nothing.
fn missed(task: &Task) -> Statement {
    Statement {
        mark: task.id,
        at_m: task.at_m,
        verdict: MarkVerdict::Missed,
    }
}

#[expect(clippy::cast_possible_truncation, reason = "messages are short")]
fn short(along_m: f64) -> f32 {
    along_m as f32
}
