//! What a controller knows of a lane and of the sensors of robots before the mission.

use crate::clearance::risk::chance_of_any;
use alloc::vec::Vec;
use brain::Lane;

/// A lane that controllers are to clear, and what they assume of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Clearance {
    /// The lane, and the kinds of items that make it unsafe until they are neutralised.
    pub lane: Lane,
    /// Share of each cell that is free ground, not inside of obstacles; empty if all of the lane is. Items are on free
    /// ground only, so that there is nothing to search elsewhere.
    pub free_shares: Vec<f64>,
    /// Expected number of items of each kind in the lane, uniformly distributed over its free ground; the number is Poisson
    /// distributed. At most four kinds: marks distinguish no more.
    pub expected: Vec<f64>,
    /// Probability that an item of each kind destroys a robot that drives over it; 0 if missing.
    pub destroy_probability: Vec<f64>,
    /// The kinds of robots, as ids count them.
    pub robots: Vec<RobotModel>,
    /// The lane is declared clear when the risk is below this probability.
    pub declare_below: f64,
    /// Marks are interrogated while the probability of a mine there is above this.
    pub interrogate_above: f64,
    /// Side of the tiles that are searched as one goal, in metres.
    pub tile_m: f32,
    /// The ways to search a tile, such as a survey from the air and a search on the ground.
    pub searches: Vec<Skill>,
    /// How marks are interrogated; without it, no robot can.
    pub interrogate: Option<Skill>,
    /// How marks are neutralised; without it, no robot can.
    pub neutralise: Option<Charge>,
}

/// A charge that neutralises marked items.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Charge {
    /// What robots need to use it.
    pub skill: Skill,
    /// Probability that it destroys an item within its reach.
    pub success_probability: f64,
    /// Maximum distance of the item from the place where it goes off, in metres.
    pub reach_m: f64,
}

impl Charge {
    /// Probability that a charge at a mark misses the marked item, for the standard deviation of its position.
    pub(crate) fn missed(&self, deviation_m: f64) -> f64 {
        let squares = self.reach_m * self.reach_m / (deviation_m * deviation_m);
        1.0 + self.success_probability * libm::expm1(-squares / 2.0)
    }
}

/// What robots need for goals of a kind.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Skill {
    /// Number of the capability; 0 if all robots have it.
    pub capability: u8,
    /// Time that it takes at the place.
    pub service_s: f32,
}

/// What is known of the item detector of a kind of robots.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct RobotModel {
    /// Number of the sensor model: robots with the same model are blind to the same items.
    pub model: u32,
    /// Share of the items of each kind that sensors of the model never detect; 0 if missing.
    pub blind_share: Vec<f64>,
    /// Share of the items of each kind (row) that look like each kind (column) to sensors of the model; empty if all look
    /// like what they are. They are searched like items of their own kind: an approximation, if sensors detect the
    /// kinds unequally well.
    pub lookalike_share: Vec<Vec<f64>>,
    /// Numbers of the capabilities.
    pub capabilities: Vec<u8>,
    /// Probability that one search of a place misses an item that the sensor can detect, as its
    /// negative logarithm in nats.
    pub search_nats: f64,
    /// The cells that its sensors can see from where its robots can be; empty if all.
    pub seen: Vec<bool>,
}

impl Clearance {
    /// Lowest risk that any number of looks of all robots can reach: the probability that there is a
    /// mine to which all sensor models are blind. A mine that looks like another kind gets a mark, which robots can
    /// neutralise.
    #[must_use]
    pub fn floor(&self) -> f64 {
        chance_of_any(self.undetected(&self.models()))
    }

    /// The same for those robots that `is_sent` chooses, with the parts of the lane that they cannot see.
    #[must_use]
    pub fn floor_of(&self, is_sent: impl Fn(usize) -> bool) -> f64 {
        let free_m2 = self.free_area_m2();
        let left = (0..self.lane.cells()).map(|cell| {
            let robots = self.robots.iter().enumerate();
            let see = robots.filter(|(kind, robot)| is_sent(*kind) && robot.sees(cell));
            let robots: Vec<&RobotModel> = see.map(|(_, robot)| robot).collect();
            self.free_m2(cell) / free_m2 * self.undetected(&one_of_each_model(robots.into_iter()))
        });
        chance_of_any(left.sum())
    }

    /// The share of the free ground that none of those robots can see.
    #[must_use]
    pub fn unseen_by(&self, is_sent: impl Fn(usize) -> bool) -> f64 {
        let is_unseen = |cell: &usize| {
            let mut robots = self.robots.iter().enumerate();
            !robots.any(|(kind, robot)| is_sent(kind) && robot.sees(*cell))
        };
        let unseen = (0..self.lane.cells()).filter(is_unseen);
        let unseen_m2: f64 = unseen.map(|cell| self.free_m2(cell)).sum();
        unseen_m2 / self.free_area_m2()
    }

    /// The expected number of mines to which some models are blind.
    fn undetected(&self, models: &[&RobotModel]) -> f64 {
        let left = self.hazards().map(|(kind, expected)| {
            let blind = models.iter().map(|robot| robot.blind_share_of(kind));
            expected * blind.product::<f64>()
        });
        left.sum()
    }

    /// The free ground of a cell, in square metres.
    pub(crate) fn free_m2(&self, cell: usize) -> f64 {
        let share = self.free_shares.get(cell).copied().unwrap_or(1.0);
        share * self.lane.cell_area(cell).area_m2()
    }

    /// The free ground of the lane, in square metres.
    #[must_use]
    pub fn free_area_m2(&self) -> f64 {
        if self.free_shares.is_empty() {
            return self.lane.area().area_m2();
        }
        (0..self.lane.cells()).map(|cell| self.free_m2(cell)).sum()
    }

    /// Whether robots with a skill can see a cell.
    pub(crate) fn can_see(&self, skill: Skill, cell: usize) -> bool {
        let mut robots = self.robots.iter();
        robots.any(|robot| robot.has(skill) && robot.sees(cell))
    }

    /// The kinds that make the lane unsafe, and their expected numbers.
    pub fn hazards(&self) -> impl Iterator<Item = (usize, f64)> {
        let kinds = self.expected.iter().copied().enumerate();
        kinds.filter(|(kind, _)| self.lane.is_hazard(*kind))
    }

    /// Expected number of mines, of all kinds.
    pub(super) fn mines(&self) -> f64 {
        self.hazards().map(|(_, expected)| expected).sum()
    }

    /// Whether items look like another kind to some sensors, however often they look.
    pub(crate) fn has_lookalikes(&self) -> bool {
        let mut robots = self.robots.iter();
        robots.any(|robot| !robot.lookalike_share.is_empty())
    }

    /// One kind of robots of each sensor model.
    pub(crate) fn models(&self) -> Vec<&RobotModel> {
        one_of_each_model(self.robots.iter())
    }

    /// For each kind of robots, the index of its sensor model in [`models`](Self::models).
    pub(crate) fn model_of_kind(&self) -> Vec<usize> {
        let models = self.models();
        let index = |robot: &RobotModel| models.iter().position(|known| known.model == robot.model);
        self.robots.iter().filter_map(index).collect()
    }
}

fn one_of_each_model<'r>(robots: impl Iterator<Item = &'r RobotModel>) -> Vec<&'r RobotModel> {
    let mut models: Vec<&RobotModel> = Vec::new();
    for robot in robots {
        if !models.iter().any(|known| known.model == robot.model) {
            models.push(robot);
        }
    }
    models
}

impl RobotModel {
    /// Whether its sensors can see a cell.
    pub(crate) fn sees(&self, cell: usize) -> bool {
        self.seen.is_empty() || self.seen.get(cell) == Some(&true)
    }

    pub(crate) fn has(&self, skill: Skill) -> bool {
        skill.capability == 0 || self.capabilities.contains(&skill.capability)
    }

    pub(crate) fn blind_share_of(&self, kind: usize) -> f64 {
        self.blind_share.get(kind).copied().unwrap_or_default()
    }
}
