//! Team mates: their positions, observations and destinations, as received by radio.
//!
//! Each of these has its own age, which starts at the age of its message.

use crate::io::agent_id::AgentId;
use crate::io::goal_id::{GoalId, GoalPlace};
use crate::io::message::CommitmentStatus;
use crate::io::percept::Reading;
use alloc::vec::Vec;
use base::geometry::Point;
use base::hashed::Hashed;

/// Maximum number of team mates; the one with the oldest message is dropped first.
pub(crate) const MAX_PEERS: usize = 64;

/// Maximum number of visited destinations that are remembered; the oldest is dropped first.
const MAX_VISITS: usize = 64;

/// Positions and destinations expire after this time.
const MAX_AGE_S: f64 = 10.0;

/// Rounding tolerance of ages.
const AGE_TOLERANCE_S: f64 = 1e-6;

/// A team mate, as known from its messages.
#[derive(Debug, Clone, Copy, PartialEq, Hashed)]
pub(crate) struct Peer {
    pub(crate) id: AgentId,
    /// Its last reported position and number of observations, whether trusted or not.
    reported: Option<Reading<(Point, u32)>>,
    /// Its last trusted position.
    at: Option<Reading<Point>>,
    /// Its last trusted destination, or that it has none.
    destination: Option<Reading<Option<GoalPlace>>>,
}

/// All robots from which a message was received.
#[derive(Debug, Clone, Default, Hashed)]
pub(crate) struct Peers {
    pub(crate) mates: Vec<Peer>,
    visits: Vec<GoalId>,
    /// Total number of visits.
    visited: u32,
}

impl Peers {
    pub(crate) fn advance(&mut self, elapsed_s: f64) {
        for peer in &mut self.mates {
            advance(&mut peer.reported, elapsed_s);
            advance(&mut peer.at, elapsed_s);
            advance(&mut peer.destination, elapsed_s);
        }
    }

    /// Updates the reported position and number of observations of a robot. Returns its previous
    /// position, the number of observations since then, and the time between the two reports in
    /// seconds.
    pub(crate) fn update_observations(
        &mut self,
        id: AgentId,
        Reading { value, age_s }: Reading<(Point, u32)>,
    ) -> (Point, u32, f64) {
        let (at, observations) = value;
        let peer = self.peer(id);
        let Some(before) = peer.reported else {
            peer.reported = Some(Reading { value, age_s });
            return (at, observations.min(1), f64::INFINITY);
        };
        if is_outdated(peer.reported, age_s) {
            return (at, 0, 0.0);
        }
        peer.reported = Some(Reading { value, age_s });
        let (from, observations_before) = before.value;
        // The count restarts when the robot is restarted.
        let since = observations.saturating_sub(observations_before);
        (from, since, (before.age_s - age_s).max(0.0))
    }

    /// Updates the position of a robot with a report of a given age.
    pub(crate) fn update_position(&mut self, id: AgentId, at: Point, age_s: f64) {
        if age_s > MAX_AGE_S {
            return;
        }
        let peer = self.peer(id);
        if !is_outdated(peer.at, age_s) {
            peer.at = Some(Reading { value: at, age_s });
        }
    }

    /// Updates the destination of a robot with a report of a given age. Visits never expire.
    pub(crate) fn update_destination(
        &mut self,
        id: AgentId,
        goal: GoalPlace,
        status: CommitmentStatus,
        age_s: f64,
    ) {
        if status == CommitmentStatus::Done {
            self.add_visit(goal.id);
        }
        if age_s > MAX_AGE_S {
            return;
        }
        let peer = self.peer(id);
        let value = (status == CommitmentStatus::Active).then_some(goal);
        if !is_outdated(peer.destination, age_s) && (value.is_some() || peer.is_going_to(goal.id)) {
            peer.destination = Some(Reading { value, age_s });
        }
    }

    fn add_visit(&mut self, goal: GoalId) {
        if self.visits.len() == MAX_VISITS {
            self.visits.remove(0);
        }
        self.visits.push(goal);
        self.visited = self.visited.wrapping_add(1);
    }

    /// Returns the remembered visits after the first `since`, and sets `since` to the total number.
    pub(crate) fn visits_since(&self, since: &mut u32) -> &[GoalId] {
        let new = self.visited.wrapping_sub(*since) as usize;
        *since = self.visited;
        &self.visits[self.visits.len().saturating_sub(new)..]
    }

    /// Returns whether a robot that fulfils a condition has committed to a goal.
    pub(crate) fn is_any_going_to(
        &self,
        goal: GoalId,
        condition: impl Fn(AgentId) -> bool,
    ) -> bool {
        let mut mates = self.mates.iter();
        mates.any(|peer| peer.is_going_to(goal) && condition(peer.id))
    }

    fn peer(&mut self, id: AgentId) -> &mut Peer {
        let known = self.mates.iter().position(|peer| peer.id == id);
        let index = known.unwrap_or_else(|| {
            if self.mates.len() == MAX_PEERS {
                let numbered = self.mates.iter().enumerate();
                let ages = numbered.map(|(number, peer)| (peer.age_s(), number));
                let oldest = ages.max_by(|one, other| one.0.total_cmp(&other.0));
                self.mates.remove(oldest.map_or(0, |(_, number)| number));
            }
            self.mates.push(Peer {
                id,
                reported: None,
                at: None,
                destination: None,
            });
            self.mates.len() - 1
        });
        &mut self.mates[index]
    }
}

impl Peer {
    /// Its position, unless it is too old.
    pub(crate) fn at(&self) -> Option<Point> {
        fresh(self.at)
    }

    /// Its destination, unless it is too old.
    pub(crate) fn destination(&self) -> Option<GoalPlace> {
        fresh(self.destination).flatten()
    }

    fn is_going_to(&self, goal: GoalId) -> bool {
        self.destination().is_some_and(|to| to.id == goal)
    }

    /// Age of its newest message, in seconds.
    fn age_s(&self) -> f64 {
        let ages = [
            age_s(self.reported),
            age_s(self.at),
            age_s(self.destination),
        ];
        ages.into_iter().fold(f64::INFINITY, f64::min)
    }
}

fn advance<T>(reading: &mut Option<Reading<T>>, elapsed_s: f64) {
    if let Some(reading) = reading {
        reading.age_s += elapsed_s;
    }
}

fn age_s<T>(reading: Option<Reading<T>>) -> f64 {
    reading.map_or(f64::INFINITY, |reading| reading.age_s)
}

fn fresh<T>(reading: Option<Reading<T>>) -> Option<T> {
    let reading = reading.filter(|reading| reading.age_s <= MAX_AGE_S);
    reading.map(|reading| reading.value)
}

/// Whether a newer reading is known: messages may arrive out of order.
fn is_outdated<T>(known: Option<Reading<T>>, new_age_s: f64) -> bool {
    age_s(known) + AGE_TOLERANCE_S < new_age_s
}

#[cfg(test)]
mod tests;
