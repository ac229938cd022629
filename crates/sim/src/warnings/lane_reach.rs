//! The lowest risk of a mined lane that the robots that are sent can reach, and a warning where it is too high for any
//! declaration.

use crate::scenario::Checked;
use base::document::Place;
use base::warning::Warning;
use economy::Clearance;

/// Less of a lane than this is within the error of the examined places.
const MIN_SHARE: f64 = 0.001;

/// What the robots that are sent can find in a lane at most.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct LaneReach {
    /// Share of its free ground that none of them can see.
    pub(crate) unseen: f64,
    /// The probability that there is a mine that none of them can detect, however often all of them look, as believed.
    pub(crate) floor: f64,
}

/// Of the lane that controllers are to clear, if there is one and any robots are sent.
pub(crate) fn lane_reach(checked: &Checked) -> Option<LaneReach> {
    reach_of(checked.scenario.clearance()?, checked)
}

/// The same, with other knowledge of the lane.
pub(crate) fn reach_of(clearance: &Clearance, checked: &Checked) -> Option<LaneReach> {
    let sent = checked.spec.robots.values().map(|robot| robot.count > 0);
    let sent: Vec<bool> = sent.collect();
    let is_sent = |kind: usize| sent.get(kind) == Some(&true);
    sent.contains(&true).then(|| LaneReach {
        unseen: clearance.unseen_by(is_sent),
        floor: clearance.floor_of(is_sent),
    })
}

pub(super) fn warnings(checked: &Checked, at: &Place) -> Vec<Warning> {
    let kinds = checked.spec.controllers.iter();
    let kinds = kinds.filter(|(_, kind)| kind.count > 0);
    let found = kinds.filter_map(|(name, kind)| {
        let declare_below = kind.clearance.as_ref()?.declare_below;
        let reach = lane_reach(checked).filter(|reach| reach.floor >= declare_below)?;
        let at = at.key("controllers").key(name).key("clearance");
        Some(at.key("declare_below").warning(reach.effect(declare_below)))
    });
    found.collect()
}

impl LaneReach {
    /// Why the lane is never declared clear, and what to do.
    fn effect(&self, declare_below: f64) -> String {
        let is_out = self.unseen >= MIN_SHARE;
        let cause = if is_out {
            let unseen = percent(self.unseen);
            format!("{unseen} of the lane is out of reach of every robot")
        } else {
            "the sensors that reach each part of the lane are blind to some mines".to_owned()
        };
        let advice = if is_out {
            "make a way for a robot, or limit lane_m"
        } else {
            "send robots with another sensor model, or make a way for all"
        };
        let floor = percent(self.floor);
        format!(
            "{cause}: the risk never falls below {floor}, above {declare_below}: this lane is never declared clear; {advice}"
        )
    }
}

/// A probability; only what is certain is 0% or 100%.
pub(crate) fn percent(share: f64) -> String {
    match 100.0 * share {
        percent if percent > 0.0 && percent < 0.1 => "less than 0.1%".to_owned(),
        percent if percent > 99.9 && share < 1.0 => "more than 99.9%".to_owned(),
        percent => format!("{percent:.1}%"),
    }
}
