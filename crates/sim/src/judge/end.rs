//! When a run is over.

use super::act_outcome::ActOutcome;
use super::clearance_tally::ClearanceTally;
use super::moment::Moment;
use crate::bodies::body_state::Status;
use crate::end::Count;
use crate::passage::convoy::Convoy;
use crate::scenario::Scenario;

/// A reason for which a run is over.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum EndRule {
    /// The condition of the scenario has held.
    Complete,
    /// The time limit is reached.
    TimeLimit,
    /// No robot can move.
    NoRobotActive,
    /// The controllers have given up the lane that they were to clear.
    GivenUp,
    /// No controller works any more that could declare the lane clear, with which the run would be complete.
    ControllersLost,
}

/// Why a run in which controllers were to clear a lane is over.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LaneEnd {
    /// It was declared clear.
    Declared,
    /// The controllers gave it up: nothing that they could do lowered the risk.
    Hopeless,
    /// The controllers gave it up, as a person ended the mission.
    CalledOff,
    /// No controller worked any more.
    ControllersLost,
    /// No robot could move any more.
    RobotsLost,
    /// The time limit was reached.
    TimeLimit,
}

impl EndRule {
    const ALL: [Self; 5] = [
        Self::Complete,
        Self::TimeLimit,
        Self::NoRobotActive,
        Self::GivenUp,
        Self::ControllersLost,
    ];

    fn holds(self, moment: &Moment) -> bool {
        let mut bodies = moment.body_states.iter();
        match self {
            Self::Complete => moment.tally.complete_at.is_some(),
            Self::TimeLimit => moment.tick >= moment.scenario.steps,
            Self::GivenUp => {
                let clearance = moment.tally.clearance.as_deref();
                clearance.is_some_and(ClearanceTally::has_given_up)
            }
            Self::ControllersLost => moment.has_lost_controllers(),
            Self::NoRobotActive => !bodies.any(|body| body.status == Status::Active),
        }
    }
}

impl Moment<'_> {
    /// Whether the run is over: one of the rules holds. While vehicles pass a lane, only the time limit ends it.
    pub(crate) fn is_over(&self) -> bool {
        let is_passing = self.convoy.is_some_and(Convoy::is_driving);
        let mut rules = EndRule::ALL.iter();
        rules.any(|rule| rule.holds(self) && (!is_passing || *rule == EndRule::TimeLimit))
    }

    fn has_lost_controllers(&self) -> bool {
        let clearance = self.tally.clearance.as_deref();
        let is_lost = clearance.is_some_and(|clearance| clearance.has_lost_controllers);
        let end = self.scenario.end.as_ref();
        is_lost && end.is_some_and(|end| end.count == Count::Declared)
    }

    /// Why a run in which controllers were to clear a lane is over, if it is and is not complete otherwise.
    pub(super) fn lane_end(&self, clearance: &ClearanceTally) -> Option<LaneEnd> {
        if clearance.has_declared() {
            return Some(LaneEnd::Declared);
        }
        if EndRule::Complete.holds(self) {
            return None;
        }
        let rules = [
            EndRule::GivenUp,
            EndRule::ControllersLost,
            EndRule::NoRobotActive,
            EndRule::TimeLimit,
        ];
        let rule = rules.into_iter().find(|rule| rule.holds(self))?;
        Some(match rule {
            EndRule::GivenUp if clearance.is_called_off() => LaneEnd::CalledOff,
            EndRule::GivenUp => LaneEnd::Hopeless,
            EndRule::ControllersLost => LaneEnd::ControllersLost,
            EndRule::NoRobotActive => LaneEnd::RobotsLost,
            EndRule::TimeLimit | EndRule::Complete => LaneEnd::TimeLimit,
        })
    }

    /// Whether the condition with which a run is complete holds now.
    pub(crate) fn meets_end(&self) -> bool {
        let end = self.scenario.end.as_ref();
        end.is_some_and(|end| end.comparison.holds_for(self.count(end.count)))
    }

    /// The step in which a run was complete, after its scenario changed; `before` is that of the run before.
    pub(crate) fn completed_at(&self, before: Option<u64>) -> Option<u64> {
        let end = self.scenario.end.as_ref().filter(|_| self.meets_end())?;
        if end.is_default() && matches!(end.count, Count::Missed | Count::Open) {
            // Without any of them, the run was complete when it began.
            return self.last_find().max(self.last_service()).or(Some(0));
        }
        before.or(Some(self.tick))
    }

    /// The step in which the last of the targets was found that were found.
    fn last_find(&self) -> Option<u64> {
        let found = self.items.kinds().zip(self.tally.records());
        let kinds = &self.scenario.items;
        let targets = found.filter(|(kind, _)| kinds[usize::from(*kind)].is_target);
        targets.filter_map(|(_, record)| record.found_at()).max()
    }

    /// The step in which the last of the goals was served that were served.
    fn last_service(&self) -> Option<u64> {
        let goals = self.tally.goals.iter();
        goals
            .flat_map(|goals| goals.services())
            .map(|(_, service)| service.at)
            .max()
    }

    fn count(&self, count: Count) -> f64 {
        let Self {
            scenario, tally, ..
        } = self;
        let missed = |kind: usize| tally.missed(kind);
        match count {
            Count::Found => scenario.sum_of_targets(|kind| tally.found[kind]).into(),
            Count::Missed => scenario.sum_of_targets(missed).into(),
            Count::FalseAlarms => events(tally.false_alarms),
            Count::Collisions => events(tally.collisions),
            Count::RobotsStopped => tally.removed.and(self.body_states.iter()).stopped.into(),
            Count::Served => self.served().into(),
            Count::Open => {
                let unserved = scenario.number_of_goals() - self.served();
                (scenario.sum_of_targets(missed) + unserved).into()
            }
            Count::Left => self.left().into(),
            Count::LeftOrOpen => {
                let unserved = scenario.number_of_goals() - self.served();
                (self.left() + unserved).into()
            }
            Count::Marked => self.acts().marked.into(),
            Count::Confirmed => self.acts().confirmed.into(),
            Count::Neutralised => self.acts().neutralised.into(),
            Count::RobotsLost => self.acts().robots_lost.into(),
            Count::Declared => {
                let clearance = tally.clearance.as_deref();
                f64::from(u8::from(
                    clearance.is_some_and(ClearanceTally::has_declared),
                ))
            }
            Count::FoundOf(kind) => tally.found[kind].into(),
            Count::MissedOf(kind) => missed(kind).into(),
        }
    }

    fn acts(&self) -> ActOutcome {
        let acts = self.tally.acts.as_deref();
        acts.map_or_else(ActOutcome::default, |acts| ActOutcome::of(self, acts))
    }

    fn served(&self) -> u32 {
        let goals = self.tally.goals.as_ref();
        goals.map_or(0, |goals| goals.served())
    }
}

impl Scenario {
    /// Whether a run can be complete with a step in which the judge counted something, or nothing: only robots stop
    /// without it.
    pub(crate) fn can_complete(&self, is_counted: bool) -> bool {
        let mut end = self.end.iter();
        end.any(|end| is_counted || end.count == Count::RobotsStopped)
    }
}

#[expect(clippy::cast_precision_loss, reason = "counts below 2^53")]
fn events(count: u64) -> f64 {
    count as f64
}
