//! Messages on their way.

use super::view::View;
use crate::radio::Radio;
use crate::sensing::eye::Use;
use base::noise::share;
use brain::{Heard, Message};
use std::collections::VecDeque;

/// Messages on their way, by the step in which they are heard.
#[derive(Debug, Clone, Default)]
pub(crate) struct Air {
    /// The next step first.
    due: VecDeque<Vec<Sent>>,
    /// Emptied lists, to be used again.
    spare: Vec<Vec<Sent>>,
    /// Who hears a message; kept so that nothing is allocated.
    hearers: Vec<u32>,
}

/// A message on its way to one robot.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Sent {
    pub(crate) to: u32,
    pub(crate) at: u64,
    pub(crate) heard: Heard,
}

/// A message that a robot sends, and its place among those that it sends in this step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Outgoing {
    pub(crate) from: u32,
    pub(crate) number: u32,
    pub(crate) message: Message,
}

impl Air {
    /// What is heard in this step, in the order in which it was sent.
    pub(crate) fn arrive(&mut self) -> Vec<Sent> {
        self.due.pop_front().unwrap_or_default()
    }

    /// Takes back a list that `arrive` gave.
    pub(crate) fn reuse(&mut self, mut list: Vec<Sent>) {
        list.clear();
        if list.capacity() > 0 {
            self.spare.push(list);
        }
    }

    /// Keeps what `is_kept`, which may change it.
    pub(crate) fn retain(&mut self, mut is_kept: impl FnMut(&mut Heard) -> bool) {
        for list in &mut self.due {
            list.retain_mut(|sent| is_kept(&mut sent.heard));
        }
    }

    /// Sends a message to every robot that can hear it, of those that `view` shows.
    pub(crate) fn send(&mut self, view: &View, outgoing: Outgoing, radio: &Radio) {
        let from = outgoing.from as usize;
        let place = view.discs[from].centre;
        let steps = usize::try_from(radio.delay_steps - 1).unwrap_or(usize::MAX);
        while self.due.len() <= steps {
            self.due.push_back(self.spare.pop().unwrap_or_default());
        }
        let is_reached = |to: &u32| {
            let to = *to as usize;
            to != from && view.reaches(from, to, radio) && !view.is_lost(&outgoing, to, radio)
        };
        let about = view.neighbours.about(place, radio.range_m);
        self.hearers.clear();
        self.hearers.extend(about.filter(is_reached));
        self.hearers.sort_unstable();
        let heard = Heard {
            from: view.ids[from],
            age_s: 0.0,
            message: outgoing.message,
        };
        self.due[steps].extend(self.hearers.iter().map(|to| Sent {
            to: *to,
            at: view.tick,
            heard,
        }));
    }
}

impl View<'_> {
    /// Whether another robot hears what a robot sends with its radio, unless that is lost by chance.
    pub(super) fn reaches(&self, from: usize, to: usize, radio: &Radio) -> bool {
        let here = self.discs[from].centre;
        let there = self.scenario.image(here, self.discs[to].centre);
        if !self.is_listening(to) || here.to(there).length_squared() > radio.range_m * radio.range_m
        {
            return false;
        }
        let layers = [from, to].map(|robot| self.kind(robot).layer);
        !radio.needs_line_of_sight || self.scenario.hiding(layers).is_open(here, there)
    }

    fn is_lost(&self, outgoing: &Outgoing, to: usize, radio: &Radio) -> bool {
        if radio.loss_probability <= 0.0 {
            return false;
        }
        let sender = self.scenario.entity(self.ids[outgoing.from as usize]);
        let used = Use::Radio as u32 | outgoing.number << 16;
        // Steps are at most 1e8: the sender's kind is in the half of their number that is free.
        let time = u64::from(sender.kind) << 32 | self.tick;
        let words = self.noises[to].words(used, time, sender.index);
        share(words[0]) < radio.loss_probability
    }
}
