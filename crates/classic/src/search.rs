//! A run of the plain form until all items are found, or proven never to be.

use crate::contact::{Contact, Found, Pose};
use crate::heading::Heading;
use crate::robot::{Colour, Start};
use crate::simulation::{Simulation, State};
use crate::world::Cell;
use std::collections::HashSet;

/// What is asked of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Task {
    /// What counts as finding an item.
    pub contact: Contact,
    /// Finds and collisions are counted to this paint, if the run is not complete before.
    pub cap_paints: u64,
}

/// What a run gave.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Outcome {
    /// The paint at which the last item was found, capped or not; `None` = proven never.
    pub paints: Option<u64>,
    /// Items found until completion or the cap.
    pub found: u8,
    /// Robot-decisions spent on a cell with something else on it, until completion or the cap.
    pub collisions: u64,
}

/// Runs the plain form from `starts`. The reference for [`crate::fast`]: slow and obvious.
#[must_use]
pub fn search(starts: &[Start], task: Task) -> Outcome {
    let mut run = Search::new(starts, task);
    loop {
        if run.found == Found::ALL {
            return run.outcome(Some(run.simulation.paint));
        }
        if run.has_recurred && run.simulation.paint >= task.cap_paints {
            return run.outcome(None);
        }
        run.step();
    }
}

struct Search {
    simulation: Simulation,
    task: Task,
    /// Pixels of each robot at the last decision, and paints since.
    decided_px: Vec<(f32, f32)>,
    paints_since: u8,
    /// Headings with which the robots looked at the last decision.
    looked: Vec<Heading>,
    found: Found,
    found_by_cap: Found,
    collisions: u64,
    seen: HashSet<State>,
    has_recurred: bool,
}

impl Search {
    fn new(starts: &[Start], task: Task) -> Self {
        let simulation = Simulation::new(starts);
        let mut search = Self {
            decided_px: pixels(&simulation),
            looked: headings(&simulation),
            simulation,
            task,
            paints_since: 0,
            found: Found::default(),
            found_by_cap: Found::default(),
            collisions: 0,
            seen: HashSet::new(),
            has_recurred: false,
        };
        search.judge();
        search
    }

    fn step(&mut self) {
        let looked = headings(&self.simulation);
        self.paints_since += 1;
        if self.simulation.step() {
            self.decided_px = pixels(&self.simulation);
            self.looked = looked;
            self.paints_since = 0;
            self.has_recurred |= !self.seen.insert(self.simulation.state());
            self.count_collisions();
        }
        self.judge();
    }

    fn judge(&mut self) {
        for index in 0..self.simulation.robots.len() {
            self.found |= Found::of(|item| self.is_contact(index, item));
        }
        if self.simulation.paint <= self.task.cap_paints {
            self.found_by_cap = self.found;
        }
    }

    fn is_contact(&self, index: usize, item: Cell) -> bool {
        let robot = &self.simulation.robots[index];
        let contact = self.task.contact;
        if contact.is_by_paint() {
            let (x_px, y_px) = self.decided_px[index];
            let px = (f64::from(x_px), f64::from(y_px));
            let speed = robot.speed.number();
            Pose::new(px, robot.heading, speed, self.paints_since).touches(item)
        } else {
            self.paints_since == 0 && contact.holds(robot.cell(), self.looked[index], item)
        }
    }

    fn count_collisions(&mut self) {
        if self.simulation.paint <= self.task.cap_paints {
            let robots = self.simulation.robots.iter();
            let red = robots.filter(|robot| robot.colour == Colour::Red);
            self.collisions += red.count() as u64;
        }
    }

    fn outcome(&self, paints: Option<u64>) -> Outcome {
        Outcome {
            paints,
            found: self.found_by_cap.count(),
            collisions: self.collisions,
        }
    }
}

fn headings(simulation: &Simulation) -> Vec<Heading> {
    simulation
        .robots
        .iter()
        .map(|robot| robot.heading)
        .collect()
}

fn pixels(simulation: &Simulation) -> Vec<(f32, f32)> {
    simulation
        .robots
        .iter()
        .map(|robot| (robot.x_px, robot.y_px))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::start::team_on;

    #[test]
    fn an_item_beside_the_start_is_found_at_paint_zero() {
        let starts = team_on(&[Cell { x: 4, y: 16 }]);
        let task = Task {
            contact: Contact::Neighbour,
            cap_paints: 0,
        };
        assert_eq!(search(&starts, task).found, 1);
    }
}
