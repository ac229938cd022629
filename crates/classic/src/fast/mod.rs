//! The fast form: the same run as [`crate::search`], for studies.
//!
//! A team that starts on cells with speed 1 (see [`crate::start`]) moves by exactly one cell a
//! period, so pixels need not be stored. What a robot does then depends on the three cells it looks
//! at, on whether it has been circling, and on the carry only through one comparison: its
//! left-slow score against the best of its other scores. Sixty-four [`tables::Rule`]s hold that,
//! and a robot is one [`word`] to which the chosen rule adds.
//!
//! Cost of a robot-decision: five small loads, one rule, one addition, one update of the grid, and no
//! data-dependent branch. The carry is the only dependency between robots (a bitwise AND and an
//! addition), so the processor can overlap the robots of a team.
//!
//! As in the plain form, a recurring state proves that the run never ends. Brent's method finds it: the
//! state is kept at decisions 1, 2, 4, 8, ... and compared with every later one.

mod tables;
mod word;

use crate::clock::{self, DECISION_PERIOD, FIRST_DECISION};
use crate::contact::{Contact, Found};
use crate::search::{Outcome, Task};
use crate::start::MAX_ROBOTS;
use crate::world::{Cell, ITEMS};
use tables::{ContactTables, Grid, TABLES, Tables};
use word::Word;

/// A runner of the fast form, which reuses its memory between runs.
pub struct FastSearch {
    tables: &'static Tables,
    contacts: &'static ContactTables,
    task: Task,
    grid: Grid,
    /// The robots at the last decision, after the present one, and in the state that is compared with.
    robots: Vec<Word>,
    next: Vec<Word>,
    kept: Vec<Word>,
    carry: i32,
    kept_carry: i32,
}

/// The progress of a run.
#[derive(Clone, Copy)]
struct Tally {
    decision: u64,
    found: Found,
    /// `found` without the finds at this decision and in the period after it.
    found_before: Found,
    collisions: u64,
}

impl FastSearch {
    /// A runner for this task.
    #[must_use]
    pub fn new(task: Task) -> Self {
        Self {
            tables: &TABLES,
            contacts: tables::contact_tables(task.contact),
            task,
            grid: TABLES.grid,
            robots: Vec::new(),
            next: Vec::new(),
            kept: Vec::new(),
            carry: 0,
            kept_carry: 0,
        }
    }

    /// Simulates a team of 1 to [`MAX_ROBOTS`] that starts on `cells` (each of the grid, none on its
    /// frame), as [`crate::start::team_on`] places it.
    pub fn run(&mut self, cells: impl Iterator<Item = Cell>) -> Outcome {
        self.place(cells);
        let outcome = if self.task.contact == Contact::Touch {
            self.search::<true>()
        } else {
            self.search::<false>()
        };
        self.clear();
        outcome
    }

    fn place(&mut self, cells: impl Iterator<Item = Cell>) {
        self.robots.clear();
        let words = cells.zip(0..).map(|(cell, index)| word::start(cell, index));
        self.robots.extend(words);
        debug_assert!((1..=MAX_ROBOTS as usize).contains(&self.robots.len()));
        for robot in &self.robots {
            self.grid[word::position(*robot)] += 1;
        }
        self.next.clone_from(&self.robots);
        self.carry = 0;
        self.keep();
    }

    fn clear(&mut self) {
        for robot in &self.robots {
            self.grid[word::position(*robot)] -= 1;
        }
    }

    fn search<const AFTER_TURN: bool>(&mut self) -> Outcome {
        let mut tally = self.tally_of_start();
        let mut at_time_limit: Option<(Found, u64)> = None;
        let mut is_never = false;
        let mut keep_at = 1;
        loop {
            if at_time_limit.is_none()
                && clock::paint_of(tally.decision + 1) > self.task.time_limit_paints
            {
                at_time_limit = Some((self.found_in_time(&tally), tally.collisions));
            }
            let is_complete = tally.found == Found::ALL;
            if is_complete || (is_never && at_time_limit.is_some()) {
                let (found, collisions) = at_time_limit.unwrap_or((tally.found, tally.collisions));
                return Outcome {
                    paints: is_complete.then(|| self.completion_paint(&tally)),
                    found: found.count(),
                    collisions,
                };
            }
            self.decide::<AFTER_TURN>(&mut tally);
            is_never = is_never || self.has_recurred();
            if tally.decision == keep_at {
                self.keep();
                keep_at *= 2;
            }
        }
    }

    fn tally_of_start(&self) -> Tally {
        let finds =
            |robot: &Word| self.contacts.start[word::motion(*robot)][word::position(*robot)];
        Tally {
            decision: 0,
            found: Found(
                self.robots
                    .iter()
                    .fold(0, |found, robot| found | finds(robot)),
            ),
            found_before: Found::default(),
            collisions: 0,
        }
    }

    /// One period: every robot moves, looks at the previous positions, chooses and turns.
    ///
    /// `AFTER_TURN`: contact is judged with the new heading, as [`Contact::Touch`] needs, which is judged
    /// while the robot moves on. [`Contact::Ahead`] needs the old heading; the other definitions do not
    /// depend on it.
    fn decide<const AFTER_TURN: bool>(&mut self, tally: &mut Tally) {
        let Tables {
            motions,
            is_inner,
            rules,
            ..
        } = self.tables;
        let grid = &mut self.grid;
        tally.decision += 1;
        tally.found_before = tally.found;
        for (robot, next) in self.robots.iter().zip(&mut self.next) {
            let motion = motions[word::motion(*robot)];
            let position = word::position_after(*robot, motion.step);
            let filled = motion
                .looks
                .map(|look| usize::from(grid[word::offset(position, look)] != 0));
            let bonus = usize::from(is_inner[word::offset(position, 0)]) & word::speed(*robot);
            let seen = filled[0] | filled[1] << 1 | filled[2] << 2;
            let rule = &rules[seen | word::circling(*robot) << 3 | bonus << 5];
            self.carry = (self.carry & rule.keep) + rule.add;
            let moved = word::moved_to(*robot, position);
            let change = rule.change[usize::from(self.carry >= rule.threshold)];
            *next = word::stopped(moved).wrapping_add(change);
            let judged = if AFTER_TURN { *next } else { moved };
            tally.found.0 |= self.contacts.decision[word::motion(judged)][word::position(judged)];
        }
        for (robot, next) in self.robots.iter().zip(&self.next) {
            grid[word::position(*robot)] -= 1;
            grid[word::position(*next)] += 1;
        }
        let is_shared = |robot: &Word| u64::from(grid[word::position(*robot)] > 1);
        tally.collisions += self.next.iter().map(is_shared).sum::<u64>();
        std::mem::swap(&mut self.robots, &mut self.next);
    }

    fn has_recurred(&self) -> bool {
        // Nearly every comparison is decided by the first robot.
        self.robots.first() == self.kept.first()
            && self.carry == self.kept_carry
            && self.robots == self.kept
    }

    fn keep(&mut self) {
        self.kept.clone_from(&self.robots);
        self.kept_carry = self.carry;
    }

    /// The finds up to the time limit, which is in the period after the tally's decision.
    fn found_in_time(&self, tally: &Tally) -> Found {
        if !self.task.contact.is_by_paint() {
            return tally.found;
        }
        let paints = self.task.time_limit_paints - clock::paint_of(tally.decision) + 1;
        let mut found = tally.found_before;
        found |= Found::of(|item| self.first_find(item, paints).is_some());
        found
    }

    /// The paint of the last find, in the period after the tally's decision.
    fn completion_paint(&self, tally: &Tally) -> u64 {
        let decision = clock::paint_of(tally.decision);
        if !self.task.contact.is_by_paint() {
            return decision;
        }
        let period = if tally.decision == 0 {
            FIRST_DECISION
        } else {
            DECISION_PERIOD
        };
        let was_missing = ITEMS
            .into_iter()
            .enumerate()
            .filter(|(bit, _)| !tally.found_before.has(*bit));
        let finds = was_missing.filter_map(|(_, item)| self.first_find(item, period));
        decision + finds.max().unwrap_or(0)
    }

    /// Paints since the last decision until any robot touches an item, if within `paints`.
    fn first_find(&self, item: Cell, paints: u64) -> Option<u64> {
        let find = |robot: &Word| {
            tables::first_touch(word::cell(*robot), word::motion(*robot), item, paints)
        };
        self.robots.iter().filter_map(find).min()
    }
}

#[cfg(test)]
mod tests;
