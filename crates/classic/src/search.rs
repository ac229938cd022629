//! A run of the plain form, paint by paint, and its outcome: items found, collisions, the end.

use crate::contact::{Contact, Pose};
use crate::heading::Heading;
use crate::robot::{Colour, Robot, Start, cell_of};
use crate::simulation::{Simulation, State};
use crate::world::{Cell, ITEMS};
use base::hash::Hash;

/// What counts as a find, and the time limit of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Task {
    /// What counts as finding an item.
    pub contact: Contact,
    /// Finds and collisions are counted up to this paint, unless the run is complete earlier.
    pub time_limit_paints: u64,
}

/// The outcome of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Outcome {
    /// The paint at which the last item was found, within the time limit or not; `None` if it is proven
    /// that some item is never found.
    pub paints: Option<u64>,
    /// Items found until completion or the time limit.
    pub found: u8,
    /// Robot-decisions spent on a cell with something else on it, until completion or the time limit.
    pub collisions: u64,
}

/// Runs the plain form from `starts`. It is slow, and the reference for [`crate::fast`].
#[must_use]
pub fn search(starts: &[Start], task: Task) -> Outcome {
    Search::new(starts, task).concluded()
}

/// A run of the plain form, with its finds and collisions so far.
#[derive(Debug, Clone)]
pub struct Search {
    simulation: Simulation,
    task: Task,
    /// One per robot.
    marks: Vec<Mark>,
    /// The paint at which each item was found.
    found_at: [Option<u64>; ITEMS.len()],
    collisions: u64,
    recurrence: Recurrence,
}

/// A robot at its last decision; before the first decision, as it started.
#[derive(Debug, Clone, Copy)]
struct Mark {
    px: (f32, f32),
    /// The heading in which it looked.
    looked: Heading,
    paints_since: u8,
}

/// Detects a recurring state by Brent's method: the states of decisions 1, 2, 4, 8, ... are kept, and
/// every later state is compared with the last one kept.
#[derive(Debug, Clone, Default)]
struct Recurrence {
    decisions: u64,
    kept: Option<State>,
    is_proven: bool,
}

impl Search {
    /// A run before its first paint.
    #[must_use]
    pub fn new(starts: &[Start], task: Task) -> Self {
        let simulation = Simulation::new(starts);
        let mut search = Self {
            marks: simulation.robots.iter().map(Mark::new).collect(),
            simulation,
            task,
            found_at: [None; ITEMS.len()],
            collisions: 0,
            recurrence: Recurrence::default(),
        };
        search.judge();
        search
    }

    /// The underlying run of the original program.
    #[must_use]
    pub fn simulation(&self) -> &Simulation {
        &self.simulation
    }

    /// The paint at which each item was found; `None` if it has not been found.
    #[must_use]
    pub fn found_at(&self) -> [Option<u64>; ITEMS.len()] {
        self.found_at
    }

    /// Items found, and collisions.
    #[must_use]
    pub fn counts(&self) -> (u64, u64) {
        let found = self.found_at.iter().flatten().count();
        (found as u64, self.collisions)
    }

    /// Whether the run is over: all items are found, the time limit is reached, or a state has recurred,
    /// so that the other items will never be found.
    #[must_use]
    pub fn is_over(&self) -> bool {
        let is_out_of_time = self.simulation.paint >= self.task.time_limit_paints;
        self.is_complete() || self.recurrence.is_proven || is_out_of_time
    }

    /// Advances by one paint, also after the run is over.
    pub fn step(&mut self) {
        let is_counted = !self.is_complete() && self.simulation.paint < self.task.time_limit_paints;
        let looked = self.simulation.robots.iter().map(|robot| robot.heading);
        let looked: Vec<Heading> = looked.collect();
        self.marks
            .iter_mut()
            .for_each(|mark| mark.paints_since += 1);
        if self.simulation.step() {
            let robots = self.simulation.robots.iter().zip(looked);
            let mark = |(robot, looked)| Mark {
                looked,
                ..Mark::new(robot)
            };
            self.marks = robots.map(mark).collect();
            self.recurrence.note(self.simulation.state());
            self.collisions += if is_counted { self.collided() } else { 0 };
        }
        self.judge();
    }

    /// Continues with another task and with one robot per start: robots at the end of the list leave, or
    /// new ones enter at their starts.
    pub fn change(&mut self, task: Task, starts: &[Start]) {
        let robots = &mut self.simulation.robots;
        // A proof holds for one team and one contact definition only.
        if robots.len() != starts.len() || task.contact != self.task.contact {
            self.recurrence = Recurrence::default();
        }
        self.task = task;
        robots.truncate(starts.len());
        robots.extend(starts.iter().skip(robots.len()).map(Robot::new));
        self.marks.truncate(robots.len());
        self.marks
            .extend(robots.iter().skip(self.marks.len()).map(Mark::new));
        // The grid of the last decision, with the present robots.
        self.simulation
            .grid
            .refresh(self.marks.iter().map(Mark::cell));
        self.judge();
    }

    /// The outcome so far; `paints` is `None` until all items are found.
    #[must_use]
    pub fn outcome(&self) -> Outcome {
        let time_limit_paints = self.task.time_limit_paints;
        let finds = self.found_at.iter().flatten();
        let in_time = finds.clone().filter(|at| **at <= time_limit_paints);
        Outcome {
            paints: finds.max().copied().filter(|_| self.is_complete()),
            found: in_time.map(|_| 1).sum(),
            collisions: self.collisions,
        }
    }

    /// The final outcome, if the run continues unchanged.
    #[must_use]
    pub fn concluded(&self) -> Outcome {
        let mut rest = self.clone();
        while !rest.is_concluded() {
            rest.step();
        }
        rest.outcome()
    }

    /// A hash of everything that is visible or affects the future of the run.
    #[must_use]
    pub fn hash(&self) -> u64 {
        let mut hash = Hash::new();
        hash.add(self.simulation.paint);
        hash.add(u64::from(self.simulation.carry.cast_unsigned()));
        for (robot, mark) in self.simulation.robots.iter().zip(&self.marks) {
            robot.words().into_iter().for_each(|word| hash.add(word));
            mark.words().into_iter().for_each(|word| hash.add(word));
        }
        for found_at in self.found_at {
            hash.add(found_at.map_or(0, |paint| paint + 1));
        }
        hash.add(self.collisions);
        hash.add(self.recurrence.is_proven.into());
        hash.value()
    }

    fn is_complete(&self) -> bool {
        self.found_at.iter().all(Option::is_some)
    }

    fn is_concluded(&self) -> bool {
        let is_out_of_time = self.simulation.paint >= self.task.time_limit_paints;
        self.is_complete() || (self.recurrence.is_proven && is_out_of_time)
    }

    fn judge(&mut self) {
        for (number, item) in ITEMS.into_iter().enumerate() {
            if self.found_at[number].is_none() && self.is_found(item) {
                self.found_at[number] = Some(self.simulation.paint);
            }
        }
    }

    fn is_found(&self, item: Cell) -> bool {
        let mut robots = self.simulation.robots.iter().zip(&self.marks);
        robots.any(|(robot, mark)| self.is_contact(robot, mark, item))
    }

    fn is_contact(&self, robot: &Robot, mark: &Mark, item: Cell) -> bool {
        let contact = self.task.contact;
        if contact.is_by_paint() {
            let px = (f64::from(mark.px.0), f64::from(mark.px.1));
            let speed = robot.speed.number();
            Pose::new(px, robot.heading, speed, mark.paints_since).touches(item)
        } else {
            mark.paints_since == 0 && contact.holds(robot.cell(), mark.looked, item)
        }
    }

    /// Number of robots that share their cell with something else.
    fn collided(&self) -> u64 {
        let robots = self.simulation.robots.iter();
        robots.filter(|robot| robot.colour == Colour::Red).count() as u64
    }
}

impl Mark {
    /// The mark of a robot that has just decided, or is at its start.
    fn new(robot: &Robot) -> Self {
        Self {
            px: (robot.x_px, robot.y_px),
            looked: robot.heading,
            paints_since: 0,
        }
    }

    fn cell(&self) -> Cell {
        cell_of(self.px.0, self.px.1)
    }

    fn words(&self) -> [u64; 2] {
        let [x, y] = [self.px.0, self.px.1].map(|px| u64::from(px.to_bits()));
        let since = u64::from(self.paints_since);
        [x << 32 | y, u64::from(self.looked.degrees()) << 8 | since]
    }
}

impl Recurrence {
    fn note(&mut self, state: State) {
        self.decisions += 1;
        self.is_proven |= self.kept.as_ref() == Some(&state);
        if self.decisions.is_power_of_two() {
            self.kept = Some(state);
        }
    }
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
            time_limit_paints: 0,
        };
        assert_eq!(search(&starts, task).found, 1);
    }
}
