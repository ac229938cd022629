//! The outcome of a run.

use super::act_outcome::ActOutcome;
use super::clearance_outcome::ClearanceOutcome;
use super::conclusion_tally::StatedClearance;
use super::goal_outcome::GoalOutcome;
use super::moment::Moment;
use super::passage_outcome::PassageOutcome;
use crate::clock::seconds;

/// The outcome of a run, named like the columns of results.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// Time until the run was complete; the time limit if it was not.
    pub time_s: f64,
    /// Whether the run was not complete. Without targets and without a condition of its own, a run cannot fail.
    pub has_failed: bool,
    /// Items found, by kind.
    pub found: Vec<u32>,
    /// Items not found, by kind.
    pub missed: Vec<u32>,
    /// The time of each find, by kind, in ascending order.
    pub found_s: Vec<Vec<f64>>,
    /// Contacts that are no item.
    pub false_alarms: u64,
    /// New contacts of two robots, or of a robot with static geometry; per step at most as many as
    /// there are robots.
    pub collisions: u64,
    /// Of all robots, including those that were removed during the run.
    pub energy_j: f64,
    /// Of all robots, including those that were removed during the run.
    pub distance_m: f64,
    /// Robots that are empty or broken, including those that were removed in that state.
    pub robots_stopped: u32,
    /// The outcome of the goals, in a scenario with kinds of goals.
    pub goals: Option<GoalOutcome>,
    /// What robots did to items, in a scenario where they can do more than detect them, or items destroy them.
    pub acts: Option<ActOutcome>,
    /// What controllers stated of a lane that they were to clear, and whether that was true.
    pub clearance: Option<ClearanceOutcome>,
    /// The share of the mines of each kind that were cleared when controllers made a statement about a lane, as stated and in
    /// truth; none before.
    pub cleared: Vec<StatedClearance>,
    /// What was stated of vehicles that are to pass the lane, and what became of them; `None` if none are.
    pub passage: Option<PassageOutcome>,
    /// Whether every robot has a finite pose.
    is_placed: bool,
}

impl Outcome {
    /// The outcome so far.
    pub(crate) fn of(moment: &Moment) -> Self {
        let Moment {
            scenario, tally, ..
        } = *moment;
        let missed = (0..scenario.items.len()).map(|kind| tally.missed(kind));
        let complete_s = tally.complete_at.map(|tick| seconds(tick, scenario.step_s));
        let cost = tally.removed.and(moment.body_states.iter());
        Self {
            // The step may exceed the time limit by a rounding error.
            time_s: complete_s.map_or(scenario.time_limit_s, |time_s| {
                time_s.min(scenario.time_limit_s)
            }),
            has_failed: complete_s.is_none() && scenario.end.is_some(),
            found: tally.found.clone(),
            missed: missed.collect(),
            found_s: find_times(moment),
            false_alarms: tally.false_alarms,
            collisions: tally.collisions,
            energy_j: cost.energy_j,
            distance_m: cost.distance_m,
            robots_stopped: cost.stopped,
            goals: tally
                .goals
                .as_ref()
                .map(|goals| GoalOutcome::of(moment, goals)),
            acts: tally.acts.as_ref().map(|acts| ActOutcome::of(moment, acts)),
            clearance: tally
                .clearance
                .as_ref()
                .map(|clearance| ClearanceOutcome::of(moment, clearance)),
            cleared: tally
                .conclusion
                .as_ref()
                .map_or_else(Vec::new, |conclusion| conclusion.cleared.clone()),
            passage: scenario.passage.map(|_| PassageOutcome::of(moment)),
            is_placed: is_placed(moment),
        }
    }

    /// Whether all its numbers are finite, and the poses of the robots from which they come.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        let numbers = [self.time_s, self.energy_j, self.distance_m];
        self.is_placed && numbers.iter().all(|value| value.is_finite())
    }
}

/// The time of each find, by kind, in ascending order.
fn find_times(moment: &Moment) -> Vec<Vec<f64>> {
    let mut found_s = vec![Vec::new(); moment.scenario.items.len()];
    for (kind, record) in moment.items.kinds().zip(moment.tally.records()) {
        if let Some(tick) = record.found_at() {
            found_s[usize::from(kind)].push(seconds(tick, moment.scenario.step_s));
        }
    }
    for times in &mut found_s {
        times.sort_unstable_by(f64::total_cmp);
    }
    found_s
}

fn is_placed(moment: &Moment) -> bool {
    let places = moment.discs.iter().map(|disc| disc.centre);
    let places = places.map(|at| at.x + at.y);
    let headings = moment.orientations.iter().map(|course| course.heading_rad);
    places.chain(headings).all(f64::is_finite)
}

#[cfg(test)]
mod tests {
    use crate::run::State;
    use crate::scenario::ScenarioSpec;
    use base::document::Document;

    const ROVERS: &str = "
clock = { time_limit_s = 60 }
world = { size_m = [20, 10] }
[robots.rover]
count = 2
radius_m = 0.4
drive = { max_speed_m_s = 1, max_turn_rate_deg_s = 90 }
";

    #[test]
    fn a_run_with_a_robot_that_is_nowhere_is_not_finite() {
        let document = Document::parse("t.toml", ROVERS).unwrap();
        let scenario = ScenarioSpec::read(&document).unwrap().scenario;
        let state = State::new(&scenario, 1, 0).unwrap();
        let is_finite = |state: &State| state.outcome(&scenario).is_finite();
        assert!(is_finite(&state));
        for nowhere in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let mut lost = state.clone();
            lost.discs[1].centre.y = nowhere;
            assert!(!is_finite(&lost));
            let mut lost = state.clone();
            lost.orientations[0].heading_rad = nowhere;
            assert!(!is_finite(&lost));
        }
    }
}
