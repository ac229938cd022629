//! What a controller knows of the vehicles that are to pass a lane.

use super::grid::PassageGrid;
use alloc::vec::Vec;
use brain::{Lane, MARK_KINDS};

/// Vehicles that are to pass a lane, one after the other on one path.
#[derive(Debug, Clone, PartialEq)]
pub struct Passage {
    /// Width of the path, in metres: mines within it can destroy a vehicle.
    pub width_m: f64,
    /// Number of vehicles.
    pub vehicles: u32,
    /// The path keeps at least this distance from marks that have been isolated, in metres.
    pub keep_out_m: f64,
    /// What an item of each kind that makes the lane unsafe does to a vehicle.
    pub effects: [MineEffect; MARK_KINDS],
    /// The places where the centre of a vehicle can be.
    pub grid: PassageGrid,
    /// Whether an obstacle is in the way, for each place of the grid.
    pub blocked: Vec<bool>,
}

/// What a mine within the width of the path does to a vehicle.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct MineEffect {
    /// Probability that it destroys a vehicle, independently of others.
    pub destroy_probability: f64,
    /// Whether it is destroyed with the vehicle.
    pub detonates: bool,
}

impl Passage {
    /// A passage of a lane without obstacles.
    #[must_use]
    pub fn new(lane: &Lane, width_m: f64, vehicles: u32) -> Self {
        let grid = PassageGrid::new(lane.area(), width_m);
        Self {
            width_m,
            vehicles,
            keep_out_m: 0.0,
            effects: [MineEffect::default(); MARK_KINDS],
            blocked: alloc::vec![false; grid.cells()],
            grid,
        }
    }
}
