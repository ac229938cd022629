//! The work of a robot that neutralises a marked item: it looks, acts on what it has detected, and
//! looks again.

use super::ability::{Ability, Moment};
use super::assignee::Assignee;
use super::charge_state::{Aim, Fence, Firing};
use super::jobs::Job;
use crate::io::act::{Act, ActKind};
use crate::io::goal_id::GoalId;
use crate::io::reason::Reason;
use crate::io::work::lane::{MarkVerdict, Statement};
use crate::io::work::{Effect, Task};

/// Charges at one goal; then another robot may try.
const MAX_CHARGES: u8 = 3;

impl Assignee {
    /// Updates what the robot is to neutralise, by its beliefs.
    pub(super) fn aim(&mut self, ability: &Ability, moment: &Moment) {
        let Some(beliefs) = moment.beliefs else {
            return;
        };
        let lane = &self.lane;
        for job in &mut self.jobs.list {
            let is_aimed = match job.task.work.manner().effect {
                Some(Effect::Neutralise) => true,
                Some(Effect::Isolate) => ability.isolates(moment.percept.charges),
                None => false,
            };
            if is_aimed {
                let within_m = ability.uncertain_m(&job.task);
                let is_hazard = |kind| lane.is_hazard(kind);
                job.aim = Aim::new(&job.task, beliefs, (within_m, is_hazard));
            }
        }
    }

    /// Takes the results of charges: they are those of the goal that the robot serves.
    pub(super) fn take_results(&mut self, moment: &Moment) {
        for acted in &moment.percept.acted {
            if acted.kind == ActKind::Isolate {
                self.take_fence(acted.is_success);
                continue;
            }
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
    pub(super) fn neutralise(&mut self, goal: GoalId, ability: &Ability, moment: &Moment) {
        let Some(job) = self.jobs.get_mut(goal) else {
            return;
        };
        if let Some(at) = job.charge_at() {
            let is_spent = job.charges.fired >= MAX_CHARGES || moment.percept.charges == Some(0);
            let is_open =
                job.aim.is_some() && matches!(job.charges.fence, Fence::None | Fence::Wanted);
            if is_spent && is_open && ability.isolates(moment.percept.charges) {
                job.charges.fence = Fence::Wanted;
                self.isolate(goal);
                return;
            }
            if is_spent {
                let (task, charges) = (job.task, job.charges);
                if charges.fired > 0 && !charges.is_success {
                    self.lane.add(missed(&task));
                }
                self.report_failure(goal, Reason::Capability);
                self.release(goal, Reason::Capability);
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

impl Assignee {
    /// Whether an interrogation ends with a fence: the robot has confirmed an item that it cannot neutralise.
    pub(super) fn is_to_isolate(
        &mut self,
        goal: GoalId,
        ability: &Ability,
        moment: &Moment,
    ) -> bool {
        let Some(job) = self.jobs.get_mut(goal) else {
            return false;
        };
        let is_fenced = job.task.work.manner().effect == Some(Effect::Isolate);
        let is_confirmed = is_fenced && job.aim.is_some();
        if is_confirmed
            && job.charges.fence == Fence::None
            && ability.isolates(moment.percept.charges)
        {
            job.charges.fence = Fence::Wanted;
        }
        job.fence_at().is_some()
    }

    /// Fences the item of a goal off: a tool that takes time is used until its result is known.
    pub(super) fn isolate(&mut self, goal: GoalId) {
        let job = self.jobs.get(goal);
        if let Some(at) = job.and_then(Job::fence_at) {
            let kind = ActKind::Isolate;
            self.acts.push(Act { kind, at });
        }
    }

    /// Takes the result of a fence: it is that of the goal that the robot serves.
    fn take_fence(&mut self, is_success: bool) {
        let mut jobs = self.jobs.list.iter_mut();
        let Some(job) = jobs.find(|job| job.charges.fence == Fence::Wanted) else {
            return;
        };
        job.charges.fence = if is_success {
            Fence::Done
        } else {
            Fence::Failed
        };
        let aim = job.aim.filter(|_| is_success && job.neutralises());
        let statement = aim.map(|aim| Statement {
            mark: aim.mark,
            at_m: [aim.at.x, aim.at.y].map(short),
            verdict: MarkVerdict::Isolated,
        });
        if let Some(statement) = statement {
            self.lane.add(statement);
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
