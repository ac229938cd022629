//! Sense, tell and decide, robot by robot: each from the same view, so that order never matters.

use super::air::Outgoing;
use super::mind::Mind;
use super::sense::{Senses, sense};
use super::state::Status;
use super::view::View;
use crate::body::kind::Kind;
use crate::sensing::eye::Use;
use brain::{Command, Motion, Percept, Reading};

/// What a thread needs to let robots decide, and what comes of it. It is used again in each step, so
/// that nothing is allocated.
#[derive(Debug, Clone, Default)]
pub(crate) struct Desk {
    pub(crate) percept: Percept,
    pub(crate) command: Command,
    pub(crate) senses: Senses,
    /// Messages that robots send, in their order.
    pub(crate) outbox: Vec<Outgoing>,
}

impl Desk {
    pub(crate) fn clear(&mut self) {
        self.senses.clear();
        self.outbox.clear();
    }

    /// Lets one robot sense, and decide if its brain steps now.
    #[inline]
    pub(crate) fn serve(&mut self, view: &View, robot: usize, mind: &mut Mind) {
        let hull = &view.hulls[robot];
        if hull.status != Status::Active || hull.is_external {
            mind.wanted = Motion::default();
            return;
        }
        let kind = view.kind(robot);
        let beat = kind.rhythm.beat(view.tick);
        clear(&mut self.percept, kind);
        let percept = beat.map(|_| &mut self.percept);
        sense(view, robot, mind, &mut self.senses, percept);
        if let Some(beat) = beat {
            self.tell(view, robot, beat);
            mind.brain.step_into(&self.percept, &mut self.command);
            self.obey(robot, mind, kind);
        }
    }

    /// Adds to the percept what the robot knows of itself.
    fn tell(&mut self, view: &View, robot: usize, beat: u64) {
        let (hull, kind) = (&view.hulls[robot], view.kind(robot));
        let percept = &mut self.percept;
        percept.time_s = view.time_s();
        percept.dice = view.noises[robot].words(Use::Dice as u32, beat, 0);
        percept.touch = now(hull.is_pressed);
        percept.motion = now(Motion {
            speed_m_s: hull.speed_m_s,
            turn_rate_rad_s: hull.turn_rate_rad_s,
        });
        let battery = kind
            .battery
            .filter(|battery| battery.capacity_j.is_finite());
        percept.battery = battery.and_then(|battery| now(1.0 - hull.energy_j / battery.capacity_j));
    }

    /// Takes from the command what the body is to do.
    #[inline]
    fn obey(&mut self, robot: usize, mind: &mut Mind, kind: &Kind) {
        mind.wanted = self.command.motion;
        for request in &self.command.requests {
            mind.switch(request);
        }
        let most = kind.radio.map_or(0, |radio| radio.messages_per_step);
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

/// Empties a percept but for the room that its lists have.
#[inline]
fn clear(percept: &mut Percept, kind: &Kind) {
    percept.position = None;
    percept.heading_rad = None;
    percept.contacts.clear();
    percept.neighbours.clear();
    percept.inbox.clear();
    percept
        .scans
        .resize_with(kind.body.rings.len(), Default::default);
    for scan in &mut percept.scans {
        scan.age_s = None;
        scan.ranges_m.clear();
    }
}
