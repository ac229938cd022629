//! Searches of tiles that have been served, and whether they found what they were to find.
//!
//! Some places no robot can see: within walls, or beside a mine that no robot neutralises. A search that changes hardly
//! anything several times in succession is planned no more, until there is more to find: otherwise it would be repeated until
//! the time limit.

use crate::clearance::plan::{Proposal, Subject};
use alloc::vec::Vec;
use base::hashed::Hashed;

/// A search changed something if its tile is worth less by at least this part of the value. If it is worth more by this part,
/// there is something new to find.
const MIN_CHANGE: f64 = 0.1;

/// A tile is searched in vain in the same way at most this many times in succession.
const MAX_IN_VAIN: u8 = 2;

/// The searches of tiles that have been served.
#[derive(Debug, Clone, Default, Hashed)]
pub(super) struct Tried(Vec<Search>);

#[derive(Debug, Clone, Copy, Hashed)]
struct Search {
    tile: u32,
    way: u8,
    /// What it was to find when it was planned last, until that is judged.
    value: Option<f64>,
    /// How often in succession it was in vain, and what it was to find then.
    in_vain: u8,
    vain_value: f64,
}

impl Tried {
    /// Notes that a search has been served, which was to find a number of mines.
    pub(super) fn served(&mut self, subject: Subject, value: f64) {
        let Subject::Tile { tile, search: way } = subject else {
            return;
        };
        match self.find(subject) {
            Some(index) => self.0[index].value = Some(value),
            None => self.0.push(Search {
                tile,
                way,
                value: Some(value),
                in_vain: 0,
                vain_value: 0.0,
            }),
        }
    }

    /// Judges the last search of a tile by what another one is to find; returns whether it is to be planned no more.
    pub(super) fn judge(&mut self, proposal: &Proposal) -> bool {
        let Some(index) = self.find(proposal.subject) else {
            return false;
        };
        let search = &mut self.0[index];
        if let Some(before) = search.value.take() {
            let is_in_vain = (proposal.value - before).abs() < MIN_CHANGE * before;
            search.in_vain = if is_in_vain {
                search.in_vain.saturating_add(1)
            } else {
                0
            };
            search.vain_value = proposal.value;
        }
        search.is_vain(proposal.value)
    }

    /// Whether a search has been in vain too often, and is to find no more than then.
    pub(super) fn is_vain(&self, proposal: &Proposal) -> bool {
        let index = self.find(proposal.subject);
        index.is_some_and(|index| self.0[index].is_vain(proposal.value))
    }

    fn find(&self, subject: Subject) -> Option<usize> {
        let Subject::Tile { tile, search } = subject else {
            return None;
        };
        let mut all = self.0.iter();
        all.position(|known| (known.tile, known.way) == (tile, search))
    }
}

impl Search {
    fn is_vain(&self, value: f64) -> bool {
        self.in_vain >= MAX_IN_VAIN && value < (1.0 + MIN_CHANGE) * self.vain_value
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::geometry::Point;
    use brain::Work;

    const SEARCH: Subject = Subject::Tile { tile: 3, search: 1 };

    fn proposal(value: f64) -> Proposal {
        Proposal {
            subject: SEARCH,
            tile: 3,
            at: Point::default(),
            radius_m: 1.0,
            value,
            work: Work::Search,
            skill: crate::clearance::Skill::default(),
        }
    }

    #[test]
    fn a_search_that_is_in_vain_twice_in_succession_is_planned_no_more() {
        let mut tried = Tried::default();
        tried.served(SEARCH, 1.0);
        assert!(!tried.judge(&proposal(0.95)) && !tried.is_vain(&proposal(0.95)));
        // It is judged once each time that it has been served.
        assert!(!tried.judge(&proposal(0.95)));
        tried.served(SEARCH, 0.95);
        assert!(tried.judge(&proposal(0.95)) && tried.is_vain(&proposal(0.95)));
        let other = Proposal {
            subject: Subject::Tile { tile: 3, search: 0 },
            ..proposal(0.95)
        };
        assert!(!tried.is_vain(&other));
    }

    #[test]
    fn one_that_finds_what_it_was_to_find_is_planned_again() {
        let mut tried = Tried::default();
        for value in [1.0, 0.95, 0.5, 0.49, 0.2] {
            tried.served(SEARCH, value);
            assert!(!tried.judge(&proposal(0.4 * value)));
        }
        assert!(!tried.is_vain(&proposal(0.1)));
    }

    #[test]
    fn a_search_in_vain_is_planned_again_when_there_is_more_to_find() {
        let mut tried = Tried::default();
        for _ in 0..2 {
            tried.served(SEARCH, 1.0);
            tried.judge(&proposal(1.0));
        }
        assert!(tried.is_vain(&proposal(1.0)) && !tried.is_vain(&proposal(1.5)));
        // What has become more during a search does not show that it was in vain.
        tried.served(SEARCH, 1.5);
        assert!(!tried.judge(&proposal(3.0)));
    }
}
