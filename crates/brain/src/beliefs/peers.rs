//! Team mates: where they are, what they have looked at, and where they are going.

use crate::body::RobotId;
use crate::command::Stand;
use alloc::vec::Vec;
use base::geometry::Point;

/// So many are remembered; who was heard of longest ago is forgotten first.
pub(crate) const MOST: usize = 32;

/// So many places where others have been are remembered, the newest.
const MOST_VISITS: usize = 64;

/// What was heard so long ago holds no more, in seconds.
const FORGOTTEN_S: f64 = 10.0;

/// A team mate, as its messages tell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Peer {
    pub(crate) id: RobotId,
    /// Where it was, and how often it had looked for items by then.
    pub(crate) at: Option<(Point, u32)>,
    /// Where it is going.
    pub(crate) aim: Option<Point>,
    pub(crate) age_s: f64,
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
            peer.age_s += period_s;
        }
    }

    /// Those of whom something was heard of late.
    pub(crate) fn fresh(&self) -> impl Iterator<Item = &Peer> {
        self.mates.iter().filter(|peer| peer.age_s <= FORGOTTEN_S)
    }

    /// Notes where one is; returns where it was before, and how often it has looked since.
    pub(crate) fn stands(&mut self, id: RobotId, at: Point, looks: u32) -> (Point, u32) {
        let peer = self.peer(id);
        let before = peer.at.replace((at, looks));
        peer.age_s = 0.0;
        let (from, had) = before.unwrap_or((at, 0));
        // Who has been switched off and on begins anew.
        (
            from,
            if before.is_some() {
                looks.saturating_sub(had)
            } else {
                looks.min(1)
            },
        )
    }

    /// Notes where one is going, or no longer.
    pub(crate) fn goes(&mut self, id: RobotId, at: Point, stand: Stand) {
        let peer = self.peer(id);
        peer.age_s = 0.0;
        if stand == Stand::Going {
            peer.aim = Some(at);
        } else if peer.aim == Some(at) {
            peer.aim = None;
        }
        if stand == Stand::Done {
            if self.visits.len() == MOST_VISITS {
                self.visits.remove(0);
            }
            self.visits.push(at);
            self.visited = self.visited.wrapping_add(1);
        }
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
        self.fresh()
            .any(|peer| peer.aim == Some(to) && counts(peer.id))
    }

    fn peer(&mut self, id: RobotId) -> &mut Peer {
        let known = self.mates.iter().position(|peer| peer.id == id);
        let place = known.unwrap_or_else(|| {
            if self.mates.len() == MOST {
                let numbered = self.mates.iter().enumerate();
                let oldest = numbered.max_by(|one, other| one.1.age_s.total_cmp(&other.1.age_s));
                let oldest = oldest.map_or(0, |(number, _)| number);
                self.mates.remove(oldest);
            }
            self.mates.push(Peer {
                id,
                at: None,
                aim: None,
                age_s: 0.0,
            });
            self.mates.len() - 1
        });
        &mut self.mates[place]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MATE: RobotId = RobotId { kind: 0, index: 1 };

    #[test]
    fn looks_between_two_messages_are_those_that_came_between() {
        let mut peers = Peers::default();
        let (here, there) = (Point { x: 1.0, y: 1.0 }, Point { x: 3.0, y: 1.0 });
        assert_eq!(peers.stands(MATE, here, 7), (here, 1));
        assert_eq!(peers.stands(MATE, there, 12), (here, 5));
        assert_eq!(peers.stands(MATE, there, 12), (there, 0));
    }

    #[test]
    fn where_one_goes_is_known_until_it_is_there_or_not_heard_of() {
        let mut peers = Peers::default();
        let place = Point { x: 3.0, y: 1.0 };
        peers.goes(MATE, place, Stand::Going);
        assert!(peers.anybody_goes(place, |_| true) && !peers.anybody_goes(place, |id| id != MATE));
        for stand in [Stand::Done, Stand::Left] {
            peers.goes(MATE, place, Stand::Going);
            peers.goes(MATE, place, stand);
            assert!(!peers.anybody_goes(place, |_| true));
        }
        peers.pass(11.0);
        assert_eq!(peers.fresh().count(), 0);
    }

    #[test]
    fn where_others_have_been_is_told_once() {
        let (mut peers, mut since) = (Peers::default(), 0);
        for x in 0..100 {
            let at = Point {
                x: f64::from(x),
                y: 0.0,
            };
            peers.goes(MATE, at, Stand::Done);
            peers.goes(MATE, at, Stand::Left);
            if x < 50 {
                assert_eq!(peers.visits_since(&mut since), [at]);
                assert_eq!(peers.visits_since(&mut since), []);
            }
        }
        assert_eq!(peers.visits_since(&mut since).len(), 50);
        assert_eq!(peers.visits.len(), MOST_VISITS);
    }

    #[test]
    fn a_crowd_takes_bounded_memory() {
        let mut peers = Peers::default();
        for index in 0..1000 {
            peers.goes(RobotId { kind: 0, index }, Point::default(), Stand::Going);
        }
        assert_eq!(peers.mates.len(), MOST);
    }
}
