//! Items: where they are believed to be, how surely, and who says so.
//!
//! Every belief is made of sources: for each robot that looked at the item, what its observations together say,
//! and how many there were. A report carries the same, so that it may come any number of times, over
//! any number of others, and each look counts once: of one source the report with the most observations holds.
//!
//! ```text
//! log odds = log odds before its observations + sum over sources of their log likelihood ratios
//! a contact adds    ln(p N(d; S) / f)    p: probability of detection at that distance,
//! a miss adds       ln(1 - p)            N: normal density of its being d off, f: false contacts a m2
//! a report counts   as t x its confidence + (1 - t) x the confidence before
//!                   t: trust in who tells it, times that in who looked if it was another
//! ```
//!
//! Before an item's observations it is as likely as items are dense, and as observations that saw nothing there would
//! have missed it.

use super::Map;
use super::coverage_map::View;
use super::pose::Pose;
use crate::io::body::{Detector, RobotId};
use crate::io::message::Provenance;
use crate::io::percept::Contact;
use crate::perception::sector::direction;
use alloc::vec::Vec;
use base::geometry::Point;
use core::f64::consts::PI;

mod reports;

pub(crate) use reports::{Reception, Report};

/// So many items are kept in mind; the least believed is forgotten first.
const MOST: usize = 64;

/// So many robots' observations are kept apart for each item.
const SOURCES: usize = 6;

/// A contact is of an item it is not farther off than so many standard deviations.
const GATE: f64 = 3.0;

/// No position is better than this, in metres.
const LEAST_DEVIATION_M: f64 = 0.05;

/// One look says no more than this against an item, and nobody is surer than that: natural logarithms of
/// odds.
const MOST_A_LOOK: f64 = 8.0;
const MOST_AT_ALL: f64 = 15.0;

/// However often nobody saw anything somewhere, an item there is no less likely than by this factor: what is
/// said of detectors errs.
const LEAST_UNSEEN: f64 = 0.01;

/// An item, or what was taken for one.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Track {
    /// Place of its kind in the body's `item_kinds`.
    pub(crate) kind: u16,
    /// In the world.
    pub(crate) at: Point,
    /// Of its position, along each axis.
    pub(crate) variance_m2: f64,
    /// Log odds before any look.
    before: f64,
    sources: [Source; SOURCES],
    count: usize,
    /// Logarithm of the probability that all observations at the edge of what was seen missed it.
    edge: f64,
}

/// What the observations of one robot say.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
struct Source {
    provenance: Provenance,
    /// Who told of them; of own ones, the robot itself.
    from: RobotId,
    /// Log odds before its observations, beside what others say of the same item.
    before: f64,
    /// Log likelihood ratio of all its observations.
    odds: f64,
    /// What others were told last; 0 if nothing. Kept short: there are hundreds of these.
    told: f32,
    /// Whether own observations have confirmed or refuted it: each counts once, whoever told it later.
    is_judged: bool,
}

/// All items that a robot believes in.
#[derive(Debug, Clone, Default)]
pub(crate) struct Items {
    pub(crate) tracks: Vec<Track>,
    last_track_id: u32,
    /// Place of the item that others are told of again next.
    again: usize,
    /// A bit for each item of which others may not know yet, and for each whose reports may be judged.
    news: u64,
    unjudged: u64,
}

/// One look of an own detector.
#[derive(Debug, Clone, Copy)]
pub(crate) struct OwnLook<'l> {
    pub(crate) observer: RobotId,
    pub(crate) detector: &'l Detector,
    /// Where the robot was.
    pub(crate) pose: Pose,
    /// Items of each kind that there are in a square metre, before any look.
    pub(crate) per_m2: &'l [f64],
}

impl Items {
    /// Takes in a look: its contacts, and what it should have seen and did not.
    pub(crate) fn look<'c>(
        &mut self,
        look: &OwnLook,
        contacts: impl Iterator<Item = &'c Contact>,
        map: Option<&Map>,
    ) {
        // A bit for each item that it recognised.
        let mut recognised = 0_u64;
        for contact in contacts {
            recognised |= self.recognise(look, contact, recognised, map);
        }
        let view = View::new(look.detector, look.pose.heading_rad);
        let mut told = recognised;
        for (number, track) in self.tracks.iter_mut().enumerate() {
            if recognised & (1 << number) == 0 {
                let in_view = track.in_view(&view, look, map);
                if in_view > 0.0 {
                    let odds = track.miss(look, in_view);
                    track.add((look.observer, track.before), &mut self.last_track_id, odds);
                    told |= 1 << number;
                }
            }
        }
        self.note(told);
    }

    /// Notes that something was said of items.
    fn note(&mut self, told: u64) {
        self.news |= told;
        self.unjudged |= told;
    }

    /// Takes in a contact; returns the bit of its item.
    fn recognise(
        &mut self,
        look: &OwnLook,
        contact: &Contact,
        taken: u64,
        map: Option<&Map>,
    ) -> u64 {
        if !(0.0..=1e6).contains(&contact.range_m) || contact.bearing_rad.abs() > 10.0 {
            return 0;
        }
        let way = direction(contact.bearing_rad).times(contact.range_m);
        let at = look.pose.world_of(way);
        let variance_m2 = look.variance_m2(contact.range_m);
        let place = match self.nearest(contact.kind, at, variance_m2, taken) {
            Some(place) => place,
            None => self.begin(
                contact.kind,
                at,
                variance_m2,
                look.left_m2(contact.kind, at, variance_m2, map),
            ),
        };
        let track = &mut self.tracks[place];
        let odds = track.likelihood(look, at, variance_m2, contact.range_m);
        let before = track.before_another(at, variance_m2, of(look.per_m2, contact.kind));
        track.add((look.observer, before), &mut self.last_track_id, odds);
        track.correct(at, variance_m2);
        1 << place
    }

    /// The nearest item of a kind that can be at a place, but for those that are taken.
    fn nearest(&self, kind: u16, at: Point, variance_m2: f64, taken: u64) -> Option<usize> {
        let tracks = self.tracks.iter().enumerate();
        let same =
            tracks.filter(|(number, track)| track.kind == kind && taken & (1 << number) == 0);
        let near = same.filter_map(|(number, track)| {
            let square = track.at.to(at).length_squared();
            let all_m2 = variance_m2 + track.variance_m2;
            (square <= GATE * GATE * all_m2).then_some((square, number))
        });
        let nearest = near.min_by(|one, other| one.0.total_cmp(&other.0));
        nearest.map(|(_, number)| number)
    }

    /// A new item at a place; returns its number.
    fn begin(&mut self, kind: u16, at: Point, variance_m2: f64, per_m2: f64) -> usize {
        let track = Track {
            kind,
            at,
            variance_m2,
            before: log_before(variance_m2, per_m2),
            sources: [Source::default(); SOURCES],
            count: 0,
            edge: 0.0,
        };
        if self.tracks.len() < MOST {
            self.tracks.push(track);
            return self.tracks.len() - 1;
        }
        let numbered = self.tracks.iter().enumerate();
        let sums = numbered.map(|(number, track)| (track.sum(), number));
        let least = sums.min_by(|one, other| one.0.total_cmp(&other.0));
        let place = least.map_or(0, |(_, number)| number);
        self.tracks[place] = track;
        place
    }

    /// Keeps what those looked at that `keep` has a number for.
    pub(crate) fn renumber(&mut self, keep: impl Fn(&mut RobotId) -> bool) {
        for track in &mut self.tracks {
            let mut kept = 0;
            for place in 0..track.count {
                let mut source = track.sources[place];
                if keep(&mut source.provenance.observer) && keep(&mut source.from) {
                    track.sources[kept] = source;
                    kept += 1;
                }
            }
            track.count = kept;
        }
        self.tracks.retain(|track| track.count > 0);
        self.note(u64::MAX);
    }

    /// Lets others be told again of one item, each in its turn: messages are lost, and who was out of reach
    /// may no longer be.
    pub(crate) fn tell_again(&mut self) {
        self.again = (self.again + 1).checked_rem(self.tracks.len()).unwrap_or(0);
        if let Some(track) = self.tracks.get_mut(self.again) {
            for source in &mut track.sources {
                source.told = f32::NEG_INFINITY;
            }
            self.news |= 1 << self.again;
        }
    }
}

/// The places of the bits that are set, the least first.
fn bits(set: u64) -> impl Iterator<Item = usize> {
    (0..MOST).filter(move |bit| set >> bit & 1 == 1)
}

/// What there is of a kind.
fn of(per_m2: &[f64], kind: u16) -> f64 {
    per_m2.get(usize::from(kind)).copied().unwrap_or_default()
}

impl OwnLook<'_> {
    /// Items of a kind in a square metre at a place that nobody has seen yet.
    ///
    /// A cell at the edge of what a look sees is not noted as seen, though a contact may be in it; and one
    /// that errs by more than half a cell may be in any of those about it. Then the most seen of them holds.
    fn left_m2(&self, kind: u16, at: Point, variance_m2: f64, map: Option<&Map>) -> f64 {
        let unseen = map.map_or(1.0, |map| {
            let cell = map.field.nearest_cell(at);
            let view = View::new(self.detector, self.pose.heading_rad);
            let way = self.pose.at.to(map.field.centre(cell));
            let half_m = map.field.cell_m / 2.0;
            let is_clear = view.holds_cell(&map.field, way) && variance_m2 < half_m * half_m;
            let reach = i32::from(!is_clear);
            let about = map.field.around(cell, reach);
            about.map(|cell| map.unseen.of(cell)).fold(1.0, f64::min)
        });
        of(self.per_m2, kind) * unseen.max(LEAST_UNSEEN)
    }

    /// Of a contact at a distance, along each axis.
    fn variance_m2(&self, range_m: f64) -> f64 {
        let aside_m = range_m * self.pose.deviation_rad;
        let noise_m = self.detector.noise_m.max(LEAST_DEVIATION_M);
        noise_m * noise_m + aside_m * aside_m + self.pose.deviation_m * self.pose.deviation_m
    }
}

impl Track {
    /// Log odds with full trust in everybody.
    fn sum(&self) -> f64 {
        let sources = self.sources[..self.count].iter();
        self.before + sources.map(|source| source.odds).sum::<f64>()
    }

    /// The logarithm of how much likelier a contact is if the item is there.
    fn likelihood(&self, look: &OwnLook, at: Point, variance_m2: f64, range_m: f64) -> f64 {
        let kind = usize::from(self.kind);
        let seen = look.detector.probability(kind, range_m).max(1e-6);
        let all_m2 = variance_m2
            + if self.count == 0 {
                0.0
            } else {
                self.variance_m2
            };
        let off = self.at.to(at).length_squared() / (2.0 * all_m2);
        let false_per_m2 = look.detector.false_alarms_per_m2.get(kind);
        let false_per_m2 = false_per_m2.copied().unwrap_or_default().max(1e-12);
        let odds = libm::log(seen / (2.0 * PI * all_m2 * false_per_m2)) - off;
        odds.max(-MOST_A_LOOK).min(MOST_AT_ALL - self.before)
    }

    /// Log odds before the observations of one more robot that says that it is at a place.
    ///
    /// ```text
    /// odds = odds of the one x odds of the other x N(d; S) / density of items
    /// ```
    ///
    /// Two that saw an item each may have seen two: that they are d apart, with variances that sum to S,
    /// speaks for one.
    fn before_another(&self, at: Point, variance_m2: f64, per_m2: f64) -> f64 {
        if self.count == 0 {
            return self.before;
        }
        let all_m2 = self.variance_m2 + variance_m2;
        let off = self.at.to(at).length_squared() / (2.0 * all_m2);
        log_before(all_m2, per_m2) + off
    }

    /// Adds to what own observations say; `before` holds if these are the first.
    fn add(&mut self, (observer, before): (RobotId, f64), last_track_id: &mut u32, odds: f64) {
        let own = self.sources[..self.count]
            .iter()
            .position(|source| source.provenance.observer == observer);
        let place = own.unwrap_or_else(|| {
            *last_track_id = last_track_id.wrapping_add(1);
            let provenance = Provenance {
                observer,
                track_id: *last_track_id,
                observations: 0,
            };
            self.room(observer, f64::INFINITY).map_or(0, |place| {
                (self.sources[place].provenance, self.sources[place].from) = (provenance, observer);
                self.sources[place].before = before;
                place
            })
        });
        let source = &mut self.sources[place];
        source.odds = (source.odds + odds)
            .max(-MOST_AT_ALL)
            .min(MOST_AT_ALL - self.before);
        source.provenance.observations = source.provenance.observations.saturating_add(1);
    }

    /// The place of a new source that says so much, in place of the least telling one if there is no room;
    /// `None` if all others say more. Own observations are never forgotten.
    fn room(&mut self, own: RobotId, odds: f64) -> Option<usize> {
        let place = if self.count < SOURCES {
            self.count += 1;
            self.count - 1
        } else {
            let others = self.sources.iter().enumerate();
            let others = others.filter(|(_, source)| source.provenance.observer != own);
            let strengths = others.map(|(number, source)| (source.odds.abs(), number));
            let least = strengths.min_by(|one, other| one.0.total_cmp(&other.0));
            least.filter(|(least, _)| *least < odds.abs())?.1
        };
        self.sources[place] = Source::default();
        Some(place)
    }

    fn place_of(&self, provenance: Provenance) -> Option<usize> {
        let sources = self.sources[..self.count].iter();
        let is_same = |source: &Source| {
            source.provenance.observer == provenance.observer
                && source.provenance.track_id == provenance.track_id
        };
        sources.into_iter().position(is_same)
    }

    fn has_looked(&self, own: RobotId) -> bool {
        let mut sources = self.sources[..self.count].iter();
        sources.any(|source| source.provenance.observer == own)
    }

    /// Corrects where it is.
    fn correct(&mut self, at: Point, variance_m2: f64) {
        if self.count == 1 && self.sources[0].provenance.observations <= 1 {
            (self.at, self.variance_m2) = (at, variance_m2);
            return;
        }
        let gain = self.variance_m2 / (self.variance_m2 + variance_m2);
        self.at = self.at.plus(self.at.to(at).times(gain));
        let least_m2 = LEAST_DEVIATION_M * LEAST_DEVIATION_M;
        self.variance_m2 = (self.variance_m2 * (1.0 - gain)).max(least_m2);
    }

    /// The logarithm of how much likelier it is not to be recognised if the item is there and has been in
    /// view with a probability.
    ///
    /// Looks at the edge of what a robot sees pass an item by for one reason: it is not where it is believed
    /// to be. So together they say no more than that: k of them are as likely as `in_view (1 - p)^k + 1 - in_view`.
    fn miss(&mut self, look: &OwnLook, in_view: f64) -> f64 {
        let distance_m = look.pose.at.to(self.at).length();
        let seen = look.detector.probability(self.kind.into(), distance_m);
        let missed = libm::log1p(-seen.min(0.999));
        if in_view >= 1.0 {
            return missed;
        }
        let likely = |edge: f64| in_view * libm::exp(edge) + 1.0 - in_view;
        let before = likely(self.edge);
        self.edge = (self.edge + missed).max(-MOST_AT_ALL);
        libm::log(likely(self.edge) / before)
    }

    /// How likely a look had it in view: five places stand for the normal distribution of where it is, with
    /// the same mean and variance.
    fn in_view(&self, view: &View, look: &OwnLook, map: Option<&Map>) -> f64 {
        let way = look.pose.at.to(self.at);
        let length_m = way.length().max(1e-9);
        let error_m = 2.0 * libm::sqrt(self.variance_m2 + look.variance_m2(length_m));
        if length_m > look.detector.range_m + error_m {
            return 0.0;
        }
        let out = way.times(error_m / length_m);
        let aside = Point {
            x: -out.y,
            y: out.x,
        };
        let share = |place: Point, of: f64| if view.holds(place) { of } else { 0.0 };
        let about = [way.plus(out), out.to(way), way.plus(aside), aside.to(way)];
        let all = share(way, 0.5) + about.map(|place| share(place, 0.125)).iter().sum::<f64>();
        let is_hidden = || {
            look.detector.needs_line_of_sight
                && map.is_some_and(|map| !map.filled.sees(&map.field, look.pose.at, self.at, 0.0))
        };
        if all > 0.0 && is_hidden() { 0.0 } else { all }
    }
}

impl Source {
    /// Log odds by its observations alone.
    fn says(&self) -> f64 {
        self.before + self.odds
    }
}

/// Log odds that one of so many items in a square metre is at a place with a variance.
fn log_before(variance_m2: f64, per_m2: f64) -> f64 {
    log_odds((2.0 * PI * variance_m2 * per_m2).clamp(1e-9, 0.1))
}

fn log_odds(probability: f64) -> f64 {
    libm::log(probability / (1.0 - probability))
}

fn probability(log_odds: f64) -> f64 {
    1.0 / (1.0 + libm::exp(-log_odds))
}

#[cfg(test)]
mod tests;
