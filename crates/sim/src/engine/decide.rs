//! Sense, tell and decide, robot by robot: each from the same view, so that order never matters.

use super::air::Outgoing;
use super::mind::Mind;
use super::outside::Outside;
use super::sense::{Senses, sense};
use super::state::Status;
use super::view::View;
use crate::body::kind::Kind;
use crate::sensing::eye::Use;
use crate::world::items::RECOGNISED_WITHIN_M;
use base::geometry::Point;
use base::trig::sin_cos;
use brain::{Command, Motion, Percept, Reading, Scan};

/// What a thread needs to let robots decide, and what comes of it. It is used again in each step, so
/// that nothing is allocated.
#[derive(Debug, Clone, Default)]
pub(crate) struct Desk {
    pub(crate) percept: Percept,
    /// Scans that the last robot's percept had no use for.
    scans: Vec<Scan>,
    pub(crate) command: Command,
    pub(crate) senses: Senses,
    /// Messages that robots send, in their order.
    pub(crate) outbox: Vec<Outgoing>,
    /// What the brains of bodies outside want of them.
    pub(crate) answers: Vec<(usize, Command)>,
}

impl Desk {
    pub(crate) fn clear(&mut self) {
        self.senses.clear();
        self.outbox.clear();
        self.answers.clear();
    }

    /// Lets one robot sense, and decide if its brain steps now.
    #[inline]
    pub(crate) fn serve(&mut self, view: &View, robot: usize, mind: &mut Mind) {
        let hull = &view.hulls[robot];
        if hull.status != Status::Active {
            mind.wanted = Motion::default();
        } else if let Some(outside) = view.outside {
            self.serve_from_outside(view, robot, mind, outside);
        } else if !hull.is_external {
            self.serve_simulated(view, robot, mind);
        }
    }

    #[inline]
    fn serve_simulated(&mut self, view: &View, robot: usize, mind: &mut Mind) {
        if let Some(motion) = view.flocked(robot, mind) {
            mind.wanted = motion;
        } else if self.perceive(view, robot, mind) {
            mind.brain.step_into(&self.percept, &mut self.command);
            self.obey(view, robot, mind);
        }
    }

    /// The same in a step into which something comes from outside.
    fn serve_from_outside(
        &mut self,
        view: &View,
        robot: usize,
        mind: &mut Mind,
        outside: &Outside,
    ) {
        if let Some(command) = outside.asking.decided(robot) {
            self.take(command);
        } else if let Some(percept) = outside.percepts.get(&robot) {
            self.percept.clone_from(percept);
            mind.tell_messages(view.tick, view.scenario.step_s, &mut self.percept);
            self.recognise(view, robot);
            mind.brain.step_into(&self.percept, &mut self.command);
            self.answers.push((robot, self.command.clone()));
        } else if view.hulls[robot].is_external {
            return;
        } else {
            let Some(command) = outside.commands.get(&robot) else {
                self.serve_simulated(view, robot, mind);
                return;
            };
            self.perceive(view, robot, mind);
            self.take(command);
        }
        self.obey(view, robot, mind);
    }

    /// Takes over what was decided elsewhere.
    fn take(&mut self, command: &Command) {
        self.command.motion = command.motion;
        self.command.requests.clone_from(&command.requests);
        self.command.outbox.clone_from(&command.outbox);
    }

    /// Notes the items that contacts from outside are of: the nearest of the kind, if it is near.
    fn recognise(&mut self, view: &View, robot: usize) {
        let eye = view.eye(robot, 0, 0);
        for contact in &self.percept.contacts {
            let (y, x) = sin_cos(contact.bearing_rad);
            let place = eye.world_of(Point { x, y }.times(contact.range_m));
            let place = view.scenario.home(place);
            let near = view.items.near(place, RECOGNISED_WITHIN_M);
            let same = near.filter(|(_, item)| view.items.kind(*item) == contact.kind);
            let distances = same.map(|(at, item)| (place.to(*at).length(), *item));
            let nearest = distances.min_by(|one, other| one.0.total_cmp(&other.0));
            let nearest = nearest.filter(|(distance_m, _)| *distance_m <= RECOGNISED_WITHIN_M);
            self.senses.note(nearest.map(|(_, item)| item));
        }
    }

    /// Fills the percept; whether the brain steps now.
    pub(crate) fn perceive(&mut self, view: &View, robot: usize, mind: &mut Mind) -> bool {
        let kind = view.kind(robot);
        let beat = kind.rhythm.beat(view.tick);
        self.clear_percept(kind);
        let percept = beat.map(|_| &mut self.percept);
        sense(view, robot, mind, &mut self.senses, percept);
        if let Some(beat) = beat {
            self.tell(view, robot, beat);
        }
        beat.is_some()
    }

    /// Empties the percept but for the room that its lists have.
    #[inline]
    fn clear_percept(&mut self, kind: &Kind) {
        let percept = &mut self.percept;
        percept.position = None;
        percept.heading_rad = None;
        percept.looks.clear();
        percept.contacts.clear();
        percept.neighbours.clear();
        percept.inbox.clear();
        let rings = kind.brain.body().rings.len();
        // Kinds have more or fewer rings.
        while percept.scans.len() > rings {
            self.scans.extend(percept.scans.pop());
        }
        while percept.scans.len() < rings {
            percept.scans.push(self.scans.pop().unwrap_or_default());
        }
        for scan in &mut percept.scans {
            scan.age_s = None;
            scan.ranges_m.clear();
        }
    }

    /// Adds to the percept what the robot knows of itself.
    fn tell(&mut self, view: &View, robot: usize, beat: u64) {
        let (hull, kind) = (&view.hulls[robot], view.kind(robot));
        let percept = &mut self.percept;
        percept.time_s = view.time_s();
        percept.id = view.ids[robot];
        percept.of_kind = view.kind(robot).count;
        percept.dice = view.noises[robot].words(Use::Dice as u32, beat, 0);
        percept.touch = now(hull.is_pressed);
        percept.motion = now(Motion {
            speed_m_s: hull.speed_m_s,
            turn_rate_rad_s: hull.turn_rate_rad_s,
        });
        percept.battery = hull.charge(kind).and_then(now);
    }

    /// Takes from the command what the body is to do.
    #[inline]
    fn obey(&mut self, view: &View, robot: usize, mind: &mut Mind) {
        mind.wanted = self.command.motion;
        for request in &self.command.requests {
            mind.switch(*request);
        }
        let most = view
            .kind(robot)
            .radio
            .map_or(0, |radio| radio.messages_per_step);
        let messages = self.command.outbox.iter().take(most);
        #[expect(
            clippy::cast_possible_truncation,
            reason = "robots have 32-bit numbers"
        )]
        let outgoing = messages.zip(0..).map(|(message, number)| Outgoing {
            from: robot as u32,
            number,
            message: *message,
        });
        self.outbox.extend(outgoing);
    }
}

#[expect(
    clippy::unnecessary_wraps,
    reason = "a reading that is always there, among those that may not be"
)]
fn now<T>(value: T) -> Option<Reading<T>> {
    Some(Reading { value, age_s: 0.0 })
}
