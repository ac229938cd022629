//! The goals that follow from what a controller believes of a lane.
//!
//! ```text
//! search       each tile, again in each way, while that lowers the expected number of mines
//! interrogate  each mark without a verdict above a probability of a mine; rejected ones again
//! neutralise   each mark that has been confirmed, or fenced off, and those that remain above that
//!              probability when they have been interrogated: the sensors may be blind to the mine
//! ```
//!
//! Where mines may look like clutter however often sensors look, the marks below that probability can be what keeps
//! the risk too high. Once the rest of the lane is searched, they are interrogated and neutralised as well.
//!
//! The value of a goal is the expected number of mines that it finds or destroys. An auction divides
//! the time of a bid by it, so that robots serve first what lowers the risk most per second.

use super::picture::{BelievedMark, LanePicture};
use super::settings::{Clearance, Skill};
use alloc::vec::Vec;
use base::geometry::Point;
use brain::{Lane, MarkVerdict, Work};

/// Goals with a lower value, as a share of the expected number of mines that are left, are not served.
const MIN_SHARE: f64 = 1e-3;

/// Goals lower the risk if they find more than this share of the mines that are left.
const MIN_POSSIBLE_SHARE: f64 = 0.02;

/// Radius of a place, in deviations of its position.
const RADIUS_DEVIATIONS: f64 = 3.0;

/// A mark is interrogated at most this many times: more looks of a blind sensor change nothing.
pub(crate) const MAX_INTERROGATIONS: u32 = 2;

/// A mark at which this many charges have destroyed nothing is left as it is.
pub(crate) const MAX_FAILED_CHARGES: u32 = 3;

/// What a goal is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Subject {
    /// A search of a tile, by the index of the way.
    Tile { tile: u32, search: u8 },
    /// The interrogation of a marked place.
    Suspect { place: u32 },
    /// The neutralisation of a marked place.
    Mine { place: u32 },
}

/// A goal that is to be served.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Proposal {
    pub(crate) subject: Subject,
    /// The tile in which it lies.
    pub(crate) tile: u32,
    pub(crate) at: Point,
    pub(crate) radius_m: f64,
    /// Expected number of mines that it finds or destroys.
    pub(crate) value: f64,
    pub(crate) work: Work,
    pub(crate) skill: Skill,
}

/// All goals that lower the risk.
#[derive(Debug, Clone, Default)]
pub(crate) struct Plan {
    pub(crate) proposals: Vec<Proposal>,
    /// The expected number of mines that those of its own tiles find or destroy which robots in range can serve.
    pub(crate) gain: f64,
    /// Whether these, or the goals of other controllers, lower the risk.
    pub(crate) is_possible: bool,
    /// Whether a mark that may be a mine has no verdict.
    pub(crate) has_open_marks: bool,
    /// The probability that at least one mine is left.
    pub(crate) risk: f64,
}

/// The circumstances in which a controller plans.
pub(crate) struct Circumstances<'c> {
    /// The kinds of robots in range.
    pub(crate) kinds: &'c [u8],
    /// How often a place has been interrogated.
    pub(crate) interrogations: &'c dyn Fn(u32) -> u32,
    /// Whether no robot can do it at present.
    pub(crate) is_impossible: &'c dyn Fn(Subject) -> bool,
    /// Whether it has been served in vain, so that it is not to be served again.
    pub(crate) is_vain: &'c dyn Fn(&Proposal) -> bool,
    /// Whether the goals of a tile are those of this controller.
    pub(crate) is_own: &'c dyn Fn(u32) -> bool,
    /// The expected number of mines that the goals of the other controllers in range may find or destroy.
    pub(crate) others_gain: f64,
}

impl Plan {
    pub(crate) fn new(picture: &LanePicture, circumstances: &Circumstances) -> Self {
        let clearance = picture.clearance();
        let tiles = clearance.tiles();
        let mut proposals = Vec::new();
        for (search, skill) in (0..).zip(&clearance.searches) {
            proposals.extend(searches(picture, &tiles, search, *skill));
        }
        let marks = picture.marks();
        let marks = marks.filter(|mark| mark.may_be_in(&clearance.lane));
        let marks: Vec<BelievedMark> = marks.collect();
        let suspect_above = suspect_above(picture, &marks);
        for mark in &marks {
            let interrogations = (circumstances.interrogations)(mark.number);
            let is_suspect = mark.mine > suspect_above;
            let work = work_at(mark, clearance, is_suspect, interrogations);
            proposals.extend(work.and_then(|work| at_mark(mark, &tiles, work)));
        }
        proposals.retain(|one| !(circumstances.is_vain)(one));
        let risk = picture.risk_with(marks.iter().copied());
        let expected = risk.expected();
        let possible = proposals.iter();
        let possible = possible.filter(|one| circumstances.allow(clearance, one));
        let gain: f64 = possible.map(|one| one.value).sum();
        proposals.retain(|one| one.value > MIN_SHARE * expected);
        Self {
            proposals,
            gain,
            is_possible: gain + circumstances.others_gain > MIN_POSSIBLE_SHARE * expected,
            has_open_marks: marks.iter().any(|mark| mark.is_open(clearance)),
            risk: risk.probability,
        }
    }
}

impl Circumstances<'_> {
    /// Whether a goal is one of this controller that a robot in range can serve.
    fn allow(&self, clearance: &Clearance, one: &Proposal) -> bool {
        let is_impossible = (self.is_impossible)(one.subject);
        (self.is_own)(one.tile) && self.has(clearance, one.skill) && !is_impossible
    }

    /// Whether a robot in range has a skill.
    fn has(&self, clearance: &Clearance, skill: Skill) -> bool {
        let mut kinds = self.kinds.iter();
        kinds.any(|kind| {
            let robot = clearance.robots.get(usize::from(*kind));
            robot.is_some_and(|robot| robot.has(skill))
        })
    }
}

impl BelievedMark {
    /// Whether it may be a mine and has no verdict.
    fn is_open(&self, clearance: &Clearance) -> bool {
        self.mine > clearance.interrogate_above && self.verdict.is_none()
    }
}

/// One more search of each tile.
fn searches(picture: &LanePicture, tiles: &Lane, search: u8, skill: Skill) -> Vec<Proposal> {
    let gains = picture.gains(search, tiles.cells());
    let each = (0..).zip(gains).map(|(tile, value)| {
        let area = tiles.cell_area(tile as usize);
        Proposal {
            subject: Subject::Tile { tile, search },
            tile,
            at: tiles.centre(tile as usize),
            radius_m: area.size().length() / 2.0,
            value,
            work: Work::Search,
            skill,
        }
    });
    each.collect()
}

/// Marks are worth a visit while the probability of a mine there is above this.
///
/// It is 0 when marks of which looks do not settle the kind are all that keeps the lane from being declared clear.
fn suspect_above(picture: &LanePicture, marks: &[BelievedMark]) -> f64 {
    let clearance = picture.clearance();
    let above = clearance.interrogate_above;
    if !clearance.has_lookalikes() {
        return above;
    }
    let improbable = marks.iter().filter(|mark| mark.mine <= above);
    let with = picture.risk_with(improbable.copied()).probability;
    let without = picture.risk_with(core::iter::empty()).probability;
    if without < clearance.declare_below && with >= clearance.declare_below {
        0.0
    } else {
        above
    }
}

/// What is to be done at a mark, if anything, and what robots need for it.
fn work_at(
    mark: &BelievedMark,
    clearance: &Clearance,
    is_suspect: bool,
    interrogations: u32,
) -> Option<(Work, Skill)> {
    match mark.verdict {
        Some(MarkVerdict::Confirmed | MarkVerdict::Isolated) => {
            Some((Work::Neutralise, clearance.neutralise?.skill))
        }
        None | Some(MarkVerdict::Rejected | MarkVerdict::Missed)
            if is_suspect && interrogations < MAX_INTERROGATIONS =>
        {
            Some((Work::Interrogate, clearance.interrogate?))
        }
        None | Some(MarkVerdict::Rejected | MarkVerdict::Missed)
            if is_suspect && mark.failed_charges < MAX_FAILED_CHARGES =>
        {
            Some((Work::Neutralise, clearance.neutralise?.skill))
        }
        _ => None,
    }
}

fn at_mark(mark: &BelievedMark, tiles: &Lane, (work, skill): (Work, Skill)) -> Option<Proposal> {
    let place = mark.number;
    Some(Proposal {
        subject: match work {
            Work::Neutralise => Subject::Mine { place },
            _ => Subject::Suspect { place },
        },
        tile: u32::try_from(tiles.nearest_cell(mark.at)).ok()?,
        at: mark.at,
        radius_m: RADIUS_DEVIATIONS * mark.deviation_m,
        value: mark.mine,
        work,
        skill,
    })
}
