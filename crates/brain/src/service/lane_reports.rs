//! What a robot reports to the controllers of a lane: coverage, marks and statements, at a bounded rate.

use super::ability::Moment;
use super::lane_coverage::LaneCoverage;
use super::lane_marks::LaneMarks;
use crate::io::act::{Act, ActKind, MAX_ACTS};
use crate::io::body::Body;
use crate::io::work::Task;
use crate::io::work::lane::LaneMessage;
use crate::io::work::lane::{Lane, MarkVerdict, Statement};
use crate::perception::beliefs::Beliefs;
use crate::perception::beliefs::items::track::probability;
use alloc::boxed::Box;
use alloc::vec::Vec;
use base::geometry::Rectangle;
use base::hash::Hash;
use base::hashed::Hashed;

/// Time between two reports of a robot about a lane, in seconds.
pub const LANE_REPORT_PERIOD_S: f64 = 1.0;

/// Maximum number of messages of marks and coverage in a report.
pub const LANE_REPORT_MESSAGES: u32 = MAX_COVERAGE + MAX_MARKS;

const MAX_COVERAGE: u32 = 12;
const MAX_MARKS: u32 = 6;

/// A mark is confirmed from this probability of an item that is to be cleared on.
const CONFIRM_ABOVE: f64 = 0.5;

/// Each statement is sent this many times.
const REPEATS: u32 = 6;

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
    /// Acts by which it marks, confirms and rejects, not yet commanded.
    acts: Vec<Act>,
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
        if !self.acts.is_empty() {
            self.acts.add_to(hash);
        }
    }
}

/// The interrogation of a mark that has ended.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Interrogation {
    pub(crate) task: Task,
    /// How far the marked item may be from the mark.
    pub(crate) within_m: f64,
    /// Whether the robot has fenced the item off.
    pub(crate) is_isolated: bool,
}

#[derive(Debug, Clone, Hashed)]
struct Work {
    coverage: LaneCoverage,
    marks: LaneMarks,
    named_s: f64,
    next_s: f64,
}

impl LaneReports {
    /// A controller has named a lane. Looks count from the first message on; another lane replaces it. Each robot has
    /// its own phase within the period: together, all reports would be more than a radio receives in a step.
    pub(crate) fn name(&mut self, (lane, phase): (Lane, f64), beliefs: &Beliefs, now_s: f64) {
        if !lane.is_valid() || beliefs.map.is_none() {
            return;
        }
        match &mut self.work {
            Some(work) if work.coverage.lane() == lane => work.named_s = now_s,
            _ => {
                self.work = Some(Box::new(Work {
                    coverage: LaneCoverage::new(lane),
                    marks: LaneMarks::default(),
                    named_s: now_s,
                    next_s: now_s + phase * LANE_REPORT_PERIOD_S,
                }));
            }
        }
    }

    /// The area of the lane.
    pub(super) fn area(&self) -> Option<Rectangle> {
        let work = self.work.as_ref()?;
        Some(work.coverage.lane().area())
    }

    /// Whether items of a kind are to be cleared: all, unless a controller has named a lane.
    pub(super) fn is_hazard(&self, kind: u16) -> bool {
        let lane = self.work.as_ref().map(|work| work.coverage.lane());
        lane.is_none_or(|lane| lane.is_hazard(kind.into()))
    }

    /// States what the robot believes of a mark that it has interrogated: whether one of the items that are
    /// to be cleared is within a distance of it, or that it has fenced it off.
    pub(crate) fn state(&mut self, looked: &Interrogation, body: &Body, beliefs: &Beliefs) {
        let Interrogation {
            task,
            within_m,
            is_isolated,
        } = looked;
        let tracks = beliefs.items.tracks.iter();
        let near = tracks.filter(|track| {
            let is_near = track.at.to(task.at()).length() <= *within_m;
            let is_likely = probability(track.log_odds()) >= CONFIRM_ABOVE;
            is_near && is_likely && self.is_hazard(track.kind)
        });
        let item = near.max_by(|one, other| one.log_odds().total_cmp(&other.log_odds()));
        let (verdict, kind) = match item {
            Some(_) => (MarkVerdict::Confirmed, ActKind::Confirm),
            None => (MarkVerdict::Rejected, ActKind::Reject),
        };
        if body.tool(kind).is_some() {
            let at = item.map_or(task.at(), |track| track.at);
            self.acts.push(Act { kind, at });
        }
        self.add(Statement {
            mark: task.id,
            at_m: task.at_m,
            verdict: if *is_isolated {
                MarkVerdict::Isolated
            } else {
                verdict
            },
        });
    }

    /// Sends a statement from now on.
    pub(super) fn add(&mut self, statement: Statement) {
        self.statements.push((statement, REPEATS));
    }

    /// Commands the acts that are due, at most as many as a command can have.
    pub(super) fn act(&mut self, acts: &mut Vec<Act>) {
        let free = MAX_ACTS.saturating_sub(acts.len()).min(self.acts.len());
        acts.extend(self.acts.drain(..free));
    }

    /// Takes the looks and tracks of a step; returns the messages that are due.
    pub(crate) fn step(
        &mut self,
        moment: &Moment,
        beliefs: &Beliefs,
        now_s: f64,
    ) -> Vec<LaneMessage> {
        let mut due = self.statements_due(now_s);
        due.append(&mut self.lane_due(moment, beliefs, now_s));
        due
    }

    fn statements_due(&mut self, now_s: f64) -> Vec<LaneMessage> {
        if now_s < self.next_statement_s || self.statements.is_empty() {
            return Vec::new();
        }
        self.next_statement_s = now_s + LANE_REPORT_PERIOD_S;
        let send = |(statement, times): &mut (Statement, u32)| {
            *times -= 1;
            LaneMessage::Statement(*statement)
        };
        let due = self.statements.iter_mut().map(send).collect();
        self.statements.retain(|(_, times)| *times > 0);
        due
    }

    fn lane_due(&mut self, moment: &Moment, beliefs: &Beliefs, now_s: f64) -> Vec<LaneMessage> {
        let Some(work) = &mut self.work else {
            return Vec::new();
        };
        let coverage = &work.coverage;
        work.marks
            .update((beliefs, moment.body.position_noise_m), |at| {
                coverage.nats_at(at)
            });
        work.coverage.update(moment, beliefs);
        if now_s < work.next_s || now_s >= work.named_s + SILENCE_S {
            return Vec::new();
        }
        work.next_s = now_s + LANE_REPORT_PERIOD_S;
        let marks = work.marks.due(MAX_MARKS as usize);
        if moment.body.tool(ActKind::Mark).is_some() {
            let kind = ActKind::Mark;
            let new = marks.iter().filter(|(_, is_new)| *is_new);
            self.acts.extend(new.map(|(mark, _)| Act {
                kind,
                at: mark.at(),
            }));
        }
        let marks = marks.into_iter().map(|(mark, _)| mark);
        let coverage = work.coverage.due(work.marks.count(), MAX_COVERAGE as usize);
        let coverage = coverage.into_iter().map(LaneMessage::Coverage);
        marks.map(LaneMessage::Mark).chain(coverage).collect()
    }
}
