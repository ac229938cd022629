//! Trade over radios: goals of the wrong half of a field are served by the other one.

use crate::common::{scenario, start, with};
use sim::simulation::Simulation;

/// Two halves, whose robots reach only the controller of their own; goals are dealt to the controllers in turn.
const HALVES: &str = r#"
clock = { time_limit_s = 250, step_s = 0.2 }
world.size_m = [300, 60]
goals.west = { count = 8, requires = "west", placement = { kind = "uniform", within_m = [[5, 5], [55, 55]] } }
goals.east = { count = 8, requires = "east", placement = { kind = "uniform", within_m = [[245, 5], [295, 55]] } }
controllers.base = { start.at_m = [[30, 30], [270, 30]], radio = { range_m = 400, messages_per_step = 20 } }
[robots.west]
capabilities = ["west"]
start.at_m = [[20, 20], [40, 40]]
drive = { max_speed_m_s = 2, max_turn_rate_deg_s = 120 }
radio = { range_m = 100, messages_per_step = 20 }
sensors = { gps.kind = "position", compass.kind = "heading" }
brain.behaviours = [{ kind = "serve" }]
[robots.east]
capabilities = ["east"]
start.at_m = [[260, 20], [280, 40]]
drive = { max_speed_m_s = 2, max_turn_rate_deg_s = 120 }
radio = { range_m = 100, messages_per_step = 20 }
sensors = { gps.kind = "position", compass.kind = "heading" }
brain.behaviours = [{ kind = "serve" }]
"#;

fn finished(text: &str) -> Simulation {
    let mut simulation = start(text);
    while !simulation.state().is_over(simulation.scenario()) {
        simulation.step();
    }
    simulation
}

#[test]
fn goals_that_are_dealt_wrongly_are_served_with_trade_and_never_without() {
    for backup in ["majority", "none"] {
        let without = with(HALVES, &format!("controllers.base.backup = \"{backup}\""));
        let served = |text: &str| finished(text).outcome().goals.unwrap().served;
        assert_eq!(served(&without), 8, "{backup}");
        let traded = with(&without, "controllers.base.trade = {}");
        assert_eq!(served(&traded), 16, "{backup}");
        let transfers = finished(&traded);
        let transfers = transfers.state().each_controller().map(|it| it.transfers);
        assert_eq!(transfers.collect::<Vec<u32>>(), [4, 4], "{backup}");
    }
}

#[test]
fn trade_continues_when_it_begins_in_mid_run() {
    let mut simulation = start(HALVES);
    (0..200).for_each(|_| simulation.step());
    let traded = scenario(&with(HALVES, "controllers.base.trade = {}"));
    simulation.change(traded).unwrap();
    while !simulation.state().is_over(simulation.scenario()) {
        simulation.step();
    }
    assert_eq!(simulation.outcome().goals.unwrap().served, 16);
}
