//! What a robot reports to the controllers of a lane: coverage, marks and statements, at a bounded rate.

use super::ability::Moment;
use super::lane_coverage::LaneCoverage;
use super::lane_marks::LaneMarks;
use crate::io::dispatch::{Dispatch, Task};
use crate::io::lane::{Lane, MarkVerdict, Statement};
use crate::perception::beliefs::Beliefs;
use crate::perception::beliefs::items::track::probability;
use alloc::boxed::Box;
use alloc::vec::Vec;
use base::hash::Hash;
use base::hashed::Hashed;

/// Time between two reports, in seconds, and the maximum number of messages of each kind in one.
const PERIOD_S: f64 = 1.0;
const MAX_COVERAGE: usize = 6;
const MAX_MARKS: usize = 6;

/// A mark is confirmed from this probability of an item that is to be cleared on.
const CONFIRM_ABOVE: f64 = 0.5;

/// Each statement is sent this many times.
const REPEATS: u32 = 3;

/// Without a message about the lane for this time, in seconds, nothing is reported: no controller is in
/// range.
const SILENCE_S: f64 = 30.0;

/// The reports of a robot about a lane, once a controller has named one.
#[derive(Debug, Clone, Default)]
pub(crate) struct LaneReports {
    work: Option<Box<Work>>,
    /// Statements, and how often each is still sent.
    statements: Vec<(Statement, u32)>,
    next_statement_s: f64,
}

/// Robots without a lane have the hash that they had before there were lanes.
impl Hashed for LaneReports {
    fn add_to(&self, hash: &mut Hash) {
        if let Some(work) = &self.work {
            work.add_to(hash);
        }
        for statement in &self.statements {
            (*statement, self.next_statement_s).add_to(hash);
        }
    }
}

#[derive(Debug, Clone)]
struct Work {
    coverage: LaneCoverage,
    marks: LaneMarks,
    named_s: f64,
    next_s: f64,
}

base::hashed!(Work {
    coverage,
    marks,
    named_s,
    next_s
});

impl LaneReports {
    /// A controller has named a lane. Looks count from the first message on; another lane replaces it.
    pub(crate) fn name(&mut self, lane: Lane, beliefs: &Beliefs, now_s: f64) {
        let (true, Some(map)) = (lane.is_valid(), &beliefs.map) else {
            return;
        };
        match &mut self.work {
            Some(work) if work.coverage.lane() == lane => work.named_s = now_s,
            _ => {
                self.work = Some(Box::new(Work {
                    coverage: LaneCoverage::new(lane, map),
                    marks: LaneMarks::default(),
                    named_s: now_s,
                    next_s: now_s,
                }));
            }
        }
    }

    /// States what the robot believes of a mark that it has interrogated.
    pub(crate) fn state(&mut self, task: &Task, beliefs: &Beliefs) {
        let lane = self.work.as_ref().map(|work| work.coverage.lane());
        let is_hazard = |kind: u16| lane.is_none_or(|lane| lane.is_hazard(kind.into()));
        let radius_m = f64::from(task.radius_m);
        let mut tracks = beliefs.items.tracks.iter();
        let is_there = tracks.any(|track| {
            let is_near = track.at.to(task.at()).length() <= radius_m;
            is_near && is_hazard(track.kind) && probability(track.log_odds()) >= CONFIRM_ABOVE
        });
        let verdict = if is_there {
            MarkVerdict::Confirmed
        } else {
            MarkVerdict::Rejected
        };
        let statement = Statement {
            mark: task.id,
            at_m: task.at_m,
            verdict,
        };
        self.statements.push((statement, REPEATS));
    }

    /// Takes the looks and tracks of a step; returns the messages that are due.
    pub(crate) fn step(&mut self, moment: &Moment, beliefs: &Beliefs, now_s: f64) -> Vec<Dispatch> {
        let mut due = self.statements_due(now_s);
        due.append(&mut self.lane_due(moment, beliefs, now_s));
        due
    }

    fn statements_due(&mut self, now_s: f64) -> Vec<Dispatch> {
        if now_s < self.next_statement_s || self.statements.is_empty() {
            return Vec::new();
        }
        self.next_statement_s = now_s + PERIOD_S;
        let send = |(statement, times): &mut (Statement, u32)| {
            *times -= 1;
            Dispatch::Statement(*statement)
        };
        let due = self.statements.iter_mut().map(send).collect();
        self.statements.retain(|(_, times)| *times > 0);
        due
    }

    fn lane_due(&mut self, moment: &Moment, beliefs: &Beliefs, now_s: f64) -> Vec<Dispatch> {
        let (Some(work), Some(map)) = (&mut self.work, &beliefs.map) else {
            return Vec::new();
        };
        let coverage = &work.coverage;
        work.marks
            .update(beliefs, |track| coverage.nats_at(map, track.at));
        work.coverage.update(moment, beliefs);
        if now_s < work.next_s || now_s >= work.named_s + SILENCE_S {
            return Vec::new();
        }
        work.next_s = now_s + PERIOD_S;
        let marks = work.marks.due(MAX_MARKS).into_iter();
        let coverage = work.coverage.due(map, work.marks.count(), MAX_COVERAGE);
        let coverage = coverage.into_iter().map(Dispatch::Coverage);
        marks.map(Dispatch::Mark).chain(coverage).collect()
    }
}
