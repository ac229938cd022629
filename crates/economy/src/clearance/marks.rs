//! The marks of all robots, as places.

use super::place::Place;
use alloc::vec::Vec;
use base::geometry::Point;
use base::hashed::Hashed;
use brain::{AgentId, Mark, Statement};

/// Maximum number of places; marks of further ones are refused, and remain missing.
const MAX_PLACES: usize = 10_000;

/// Marks of one robot are at most this many places that may be one item.
const MAX_OF_ROBOT: usize = 3;

/// All places that robots have marked.
#[derive(Debug, Clone, Default, Hashed)]
pub(super) struct Marks {
    pub(super) places: Vec<Place>,
    next_number: u32,
    /// For each robot, the number of its marks that have been received, and of those that it reports.
    counts: Vec<MarkCount>,
}

#[derive(Debug, Clone, Copy, Hashed)]
struct MarkCount {
    robot: AgentId,
    received: u32,
    reported: u32,
}

impl Marks {
    /// Takes a mark: it updates the one with the same id, or belongs to the nearest place within reach,
    /// or is a new place.
    pub(super) fn take(&mut self, mark: Mark) {
        let is_full = self.places.len() >= MAX_PLACES;
        let known = self.places.iter_mut().find(|place| place.holds(&mark));
        match known {
            Some(place) => match place.without(&mark) {
                // It has moved away from the other marks.
                Some(others) if others.distance_to(&mark).is_none() => *place = others,
                _ => {
                    place.put(mark);
                    return;
                }
            },
            None if is_full => return,
            None => self.count(mark.robot()).received += 1,
        }
        self.add(mark);
    }

    fn add(&mut self, mark: Mark) {
        // What is detected where something has been destroyed is another item.
        let places = self.places.iter_mut();
        let places = places.filter(|place| place.is_other > 0.5 && !place.is_neutralised());
        let near = places.filter_map(|place| Some((place.distance_to(&mark)?, place)));
        let near: Vec<(f64, &mut Place)> = near.collect();
        let robot = mark.robot();
        // Two marks of one robot are two places, unless it has too many there to be distinguished.
        let has_many = near.iter().filter(|(_, place)| place.is_of(robot)).count() >= MAX_OF_ROBOT;
        let near = near.into_iter();
        let near = near.filter(|(_, place)| has_many || !place.is_of(robot));
        let nearest = near.min_by(|one, other| one.0.total_cmp(&other.0));
        if let Some((_, place)) = nearest {
            place.put(mark);
        } else {
            self.places.push(Place::new(self.next_number, mark));
            self.next_number += 1;
        }
    }

    /// Takes a statement about the place of a mark; if the mark is not known, about the nearest place. A charge destroys one
    /// item, of which the marks can be several places. Returns the place where something has been
    /// destroyed.
    pub(super) fn state(&mut self, statement: &Statement, items_per_m2: f64) -> Option<Place> {
        let index = self.stated(statement)?;
        let place = &mut self.places[index];
        let was_neutralised = place.is_neutralised();
        place.state(statement.verdict, statement.mark);
        if was_neutralised || !place.is_neutralised() {
            return None;
        }
        let destroyed = place.clone();
        let others = self.places.iter_mut();
        let others = others.filter(|place| !place.is_neutralised());
        others.for_each(|place| place.note_destroyed(&destroyed, items_per_m2));
        Some(destroyed)
    }

    /// The place that a statement is about.
    fn stated(&self, statement: &Statement) -> Option<usize> {
        let at = Point::from(statement.at_m.map(f64::from));
        let is_named = |place: &Place| place.marks.iter().any(|mark| mark.id == statement.mark);
        let named = self.places.iter().position(is_named);
        named.or_else(|| {
            let places = self.places.iter().enumerate();
            let away = places.map(|(index, place)| (place.at.to(at).length(), index, place));
            let near = away.filter(|(away_m, _, place)| *away_m <= place.reach_m());
            let nearest = near.min_by(|one, other| one.0.total_cmp(&other.0));
            nearest.map(|(_, index, _)| index)
        })
    }

    /// The robots that have marked something within a distance of a position.
    pub(super) fn robots_near(&self, at: Point, within_m: f64) -> Vec<AgentId> {
        let all = self.places.iter().flat_map(|place| &place.marks);
        let near = all.filter(|mark| mark.at().to(at).length() <= within_m);
        let mut robots: Vec<AgentId> = near.map(Mark::robot).collect();
        robots.sort_unstable();
        robots.dedup();
        robots
    }

    /// Notes how many marks a robot has; returns whether all of them have been received.
    pub(super) fn note_reported(&mut self, robot: AgentId, reported: u32) -> bool {
        let count = self.count(robot);
        count.reported = count.reported.max(reported);
        count.received >= reported
    }

    /// Number of marks that robots report and that have not been received.
    pub(super) fn missing(&self) -> u32 {
        let missing = self.counts.iter();
        let missing = missing.map(|count| count.reported.saturating_sub(count.received));
        missing.sum()
    }

    fn count(&mut self, robot: AgentId) -> &mut MarkCount {
        let known = self.counts.iter().position(|count| count.robot == robot);
        let index = known.unwrap_or_else(|| {
            self.counts.push(MarkCount {
                robot,
                received: 0,
                reported: 0,
            });
            self.counts.len() - 1
        });
        &mut self.counts[index]
    }
}
