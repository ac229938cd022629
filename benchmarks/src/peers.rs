//! The field of the sensing team as JSON, for other simulators.

use crate::field::Field;
use crate::team;
use serde_json::json;
use sim::simulation::Simulation;
use std::sync::Arc;

/// Prints the starts of a hundred robots and their obstacles; lengths are in metres.
pub(crate) fn report() {
    let field = Field::new(100);
    let simulation = Simulation::new(Arc::new(field.scenario()), 1, 0);
    let starts = team::starts(&simulation.expect("there is room"));
    let robots = starts.iter().map(|(at, rad)| [at.x, at.y, *rad]);
    let pillars = field.pillars.iter();
    let pillars = pillars.map(|disc| [disc.centre.x, disc.centre.y, disc.radius_m]);
    let boxes = field.boxes.iter();
    let boxes = boxes.map(|[low, high]| [low.x, low.y, high.x, high.y]);
    let whole = json!({
        "side_m": field.side_m,
        "pillars": pillars.collect::<Vec<_>>(),
        "boxes": boxes.collect::<Vec<_>>(),
        "robots": robots.collect::<Vec<_>>(),
    });
    println!("{whole}");
}
