//! Team mates: where they are, what they have looked at, and where they are going.
//!
//! Each of these has its own age, which begins at the age of the message that told of it.

use crate::io::body::RobotId;
use crate::io::message::CommitmentStatus;
use crate::io::percept::Reading;
use alloc::vec::Vec;
use base::geometry::Point;

/// So many are remembered; who was heard of longest ago is forgotten first.
pub(crate) const MOST: usize = 32;

/// So many places where others have been are remembered, the newest.
const MOST_VISITS: usize = 64;

/// What was so long ago holds no more, in seconds.
const FORGOTTEN_S: f64 = 10.0;

/// Ages are of one moment if they differ by no more, but for rounding; in seconds.
const SAME_S: f64 = 1e-6;

/// A team mate, as its messages tell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Peer {
    pub(crate) id: RobotId,
    /// Where it said that it was, and how often it had looked for items by then: believed or not.
    looked: Option<Reading<(Point, u32)>>,
    /// Where it was, by what is believed.
    at: Option<Reading<Point>>,
    /// Where it is going, or that it goes nowhere.
    aim: Option<Reading<Option<Point>>>,
}

/// All of whom something was heard.
#[derive(Debug, Clone, Default)]
pub(crate) struct Peers {
    pub(crate) mates: Vec<Peer>,
    visits: Vec<Point>,
    /// How many there have been.
    visited: u32,
}

impl Peers {
    pub(crate) fn pass(&mut self, period_s: f64) {
        for peer in &mut self.mates {
            pass(&mut peer.looked, period_s);
            pass(&mut peer.at, period_s);
            pass(&mut peer.aim, period_s);
        }
    }

    /// Notes that one looked as often on its way to a place; returns where it was before, how often it says
    /// that it has looked since, and in what time, in seconds.
    pub(crate) fn looked(
        &mut self,
        id: RobotId,
        Reading { value, age_s }: Reading<(Point, u32)>,
    ) -> (Point, u32, f64) {
        let (at, observations) = value;
        let peer = self.peer(id);
        let Some(before) = peer.looked else {
            peer.looked = Some(Reading { value, age_s });
            return (at, observations.min(1), f64::INFINITY);
        };
        if is_outdated(peer.looked, age_s) {
            return (at, 0, 0.0);
        }
        peer.looked = Some(Reading { value, age_s });
        let (from, had) = before.value;
        // Who has been switched off and on begins anew.
        let since = observations.saturating_sub(had);
        (from, since, (before.age_s - age_s).max(0.0))
    }

    /// Notes where one was, an age ago in seconds.
    pub(crate) fn stands(&mut self, id: RobotId, at: Point, age_s: f64) {
        if age_s > FORGOTTEN_S {
            return;
        }
        let peer = self.peer(id);
        if !is_outdated(peer.at, age_s) {
            peer.at = Some(Reading { value: at, age_s });
        }
    }

    /// Notes where one was going, or no longer, an age ago in seconds. Where it has been it has been for ever.
    pub(crate) fn goes(&mut self, id: RobotId, at: Point, status: CommitmentStatus, age_s: f64) {
        if status == CommitmentStatus::Done {
            self.visit(at);
        }
        if age_s > FORGOTTEN_S {
            return;
        }
        let peer = self.peer(id);
        let value = (status == CommitmentStatus::Active).then_some(at);
        if !is_outdated(peer.aim, age_s) && (value.is_some() || peer.is_going_to(at)) {
            peer.aim = Some(Reading { value, age_s });
        }
    }

    fn visit(&mut self, at: Point) {
        if self.visits.len() == MOST_VISITS {
            self.visits.remove(0);
        }
        self.visits.push(at);
        self.visited = self.visited.wrapping_add(1);
    }

    /// Where others have been since so many visits, as far as they are remembered; `since` is then how many
    /// there have been by now.
    pub(crate) fn visits_since(&self, since: &mut u32) -> &[Point] {
        let new = self.visited.wrapping_sub(*since) as usize;
        *since = self.visited;
        &self.visits[self.visits.len().saturating_sub(new)..]
    }

    /// Whether somebody is going to a place for whom `counts` holds.
    pub(crate) fn anybody_goes(&self, to: Point, counts: impl Fn(RobotId) -> bool) -> bool {
        let mut mates = self.mates.iter();
        mates.any(|peer| peer.is_going_to(to) && counts(peer.id))
    }

    fn peer(&mut self, id: RobotId) -> &mut Peer {
        let known = self.mates.iter().position(|peer| peer.id == id);
        let place = known.unwrap_or_else(|| {
            if self.mates.len() == MOST {
                let numbered = self.mates.iter().enumerate();
                let ages = numbered.map(|(number, peer)| (peer.age_s(), number));
                let oldest = ages.max_by(|one, other| one.0.total_cmp(&other.0));
                self.mates.remove(oldest.map_or(0, |(_, number)| number));
            }
            self.mates.push(Peer {
                id,
                looked: None,
                at: None,
                aim: None,
            });
            self.mates.len() - 1
        });
        &mut self.mates[place]
    }
}

impl Peer {
    /// Where it was of late.
    pub(crate) fn at(&self) -> Option<Point> {
        fresh(self.at)
    }

    /// Where it is going, as it said of late.
    pub(crate) fn aim(&self) -> Option<Point> {
        fresh(self.aim).flatten()
    }

    fn is_going_to(&self, to: Point) -> bool {
        self.aim() == Some(to)
    }

    /// Time since it sent the newest of what is remembered of it, in seconds.
    fn age_s(&self) -> f64 {
        let ages = [age_s(self.looked), age_s(self.at), age_s(self.aim)];
        ages.into_iter().fold(f64::INFINITY, f64::min)
    }
}

fn pass<T>(reading: &mut Option<Reading<T>>, period_s: f64) {
    if let Some(reading) = reading {
        reading.age_s += period_s;
    }
}

fn age_s<T>(reading: Option<Reading<T>>) -> f64 {
    reading.map_or(f64::INFINITY, |reading| reading.age_s)
}

fn fresh<T>(reading: Option<Reading<T>>) -> Option<T> {
    let reading = reading.filter(|reading| reading.age_s <= FORGOTTEN_S);
    reading.map(|reading| reading.value)
}

/// Whether something newer is known than what is so old: messages may overtake each other.
fn is_outdated<T>(known: Option<Reading<T>>, of_s: f64) -> bool {
    age_s(known) + SAME_S < of_s
}

#[cfg(test)]
mod tests;
