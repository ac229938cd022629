//! Controllers that clear a mined lane from what robots report.

use crate::common::{id, robots, scenario, step_with, with};
use base::engine::{BlockOptions, Runner};
use brain::{About, AgentId, Command, Message, Provenance};
use rayon::ThreadPoolBuilder;
use sim::judge::{ClearanceOutcome, Outcome};
use sim::runner::Runs;
use sim::simulation::Simulation;
use std::sync::Arc;

/// A lane of 40 m x 12 m with an air vehicle, two ground vehicles and a controller.
pub(super) const LANE: &str = r#"
clock = { step_s = 0.2, time_limit_s = 300 }
world.size_m = [52, 20]
[items.clutter]
count = 2
number = "poisson"
target = false
placement = { kind = "uniform", within_m = [[8, 4], [48, 16]] }
[items.mine]
count = 2
number = "poisson"
completed_by = "neutralised"
placement = { kind = "uniform", within_m = [[8, 4], [48, 16]] }
[robots.oav]
layer = "air"
radius_m = 0.1
capabilities = ["survey"]
start = { kind = "uniform", within_m = [[1, 4], [5, 16]] }
drive = { max_speed_m_s = 5, max_acceleration_m_s2 = 4, max_turn_rate_deg_s = 120 }
radio = { range_m = 100, messages_per_step = 50 }
sensors.gps = { kind = "position", noise_m = 0.5 }
sensors.compass = { kind = "heading", noise_deg = 2 }
brain.arbitration.kind = "goals"
brain.behaviours = [{ kind = "serve" }]
brain.beliefs = { cell_m = 1, prior_count = { mine = 2, clutter = 2 } }
sensors.camera = { kind = "items", range_m = 5, noise_m = 0.3,
    detection_probability = { mine = 0.3, clutter = 0.3 }, blind_share = { mine = 0.06, clutter = 0.06 },
    confusion = { mine = { mine = 0.74, clutter = 0.26 }, clutter = { mine = 0.26, clutter = 0.74 } } }
[robots.ugv]
count = 2
radius_m = 0.4
payload_kg = 10
capabilities = ["search"]
start = { kind = "uniform", within_m = [[1, 4], [5, 16]] }
drive = { max_speed_m_s = 1.5, max_acceleration_m_s2 = 1, max_turn_rate_deg_s = 90 }
radio = { range_m = 100, messages_per_step = 50 }
tools.neutralise = { range_m = 3, reach_m = 0.75, duration_s = 5, charges = 8 }
sensors.gps = { kind = "position", noise_m = 0.2 }
sensors.compass = { kind = "heading", noise_deg = 2 }
sensors.near = { kind = "robots", range_m = 6 }
brain.arbitration.kind = "goals"
brain.behaviours = [{ kind = "serve" }, { kind = "avoid" }]
brain.beliefs = { cell_m = 1, prior_count = { mine = 2, clutter = 2 } }
sensors.detector = { kind = "items", range_m = 4, fov_deg = 180, noise_m = 0.1,
    detection_probability = { mine = 0.3, clutter = 0.3 }, blind_share = { mine = 0.05, clutter = 0.05 },
    confusion = { mine = { mine = 0.95, clutter = 0.05 }, clutter = { mine = 0.08, clutter = 0.92 } } }
[controllers.station]
start = { kind = "uniform", within_m = [[1, 4], [5, 16]] }
radio = { range_m = 100, messages_per_step = 50 }
service_lease_s = 60
[controllers.station.clearance]
lane_m = [[8, 4], [48, 16]]
declare_below = 0.1
interrogate_above = 0.004
searches = [{ requires = "survey" }, { requires = "search" }]
interrogate = { requires = "search", service_s = 4 }
neutralise = { requires = "search", service_s = 3 }
"#;

/// The lane with mines at these positions.
pub(super) fn with_mines(places: &str, count: u32) -> String {
    let fixed = format!("count = {count}, number = \"fixed\", placement.at_m = {places}");
    with(LANE, &format!("items.mine = {{ {fixed} }}"))
}

pub(super) fn begin(text: &str, run: u64) -> Simulation {
    Simulation::new(scenario(text), 1, run).unwrap()
}

pub(super) fn finish(text: &str, run: u64) -> (Outcome, Simulation) {
    let mut simulation = begin(text, run);
    (simulation.finish(), simulation)
}

pub(super) fn lane(outcome: &Outcome) -> &ClearanceOutcome {
    outcome.clearance.as_ref().unwrap()
}

fn mines_left(simulation: &Simulation) -> u32 {
    simulation.state().mines_left(simulation.scenario())
}

pub(super) fn is_over(simulation: &Simulation) -> bool {
    simulation.state().is_over(simulation.scenario())
}

#[test]
fn a_run_ends_with_the_statement_of_a_controller_and_not_with_the_last_mine() {
    let mut steps_without_a_mine = 0;
    for run in 0..10 {
        let mut simulation = begin(LANE, run);
        while !is_over(&simulation) {
            let statements = simulation.state().each_lane();
            assert!(statements.into_iter().all(|lane| lane.statement.is_none()));
            steps_without_a_mine += u32::from(mines_left(&simulation) == 0);
            simulation.step();
        }
        let outcome = simulation.outcome();
        let believed = simulation.state().each_lane().next().unwrap();
        let statement = believed.statement.unwrap();
        assert!(statement.is_clear && statement.risk < 0.1);
        assert!(!outcome.has_failed && lane(&outcome).is_declared);
        assert_eq!(lane(&outcome).stated_risk, statement.risk);
        assert_eq!(lane(&outcome).declared_s, outcome.time_s);
        assert!(outcome.time_s < 300.0, "{}", outcome.time_s);
    }
    assert!(steps_without_a_mine > 100, "{steps_without_a_mine}");
}

#[test]
fn a_controller_with_no_robot_in_range_never_declares_a_lane() {
    // It gives a lane up after a minute without robots in range.
    let deaf = "clock.time_limit_s = 50\ncontrollers.station.radio = { range_m = 0.01, messages_per_step = 4 }";
    let deaf = with(LANE, deaf);
    for run in 0..3 {
        let (outcome, simulation) = finish(&deaf, run);
        assert_eq!((outcome.time_s, outcome.has_failed), (50.0, true));
        assert_eq!(simulation.state().tick(), 250);
        let lane = lane(&outcome);
        assert_eq!(
            (lane.is_declared, lane.stated_risk, lane.declared_s),
            (false, 1.0, 50.0)
        );
    }
}

#[test]
fn a_team_that_cannot_neutralise_gives_up_and_fails() {
    let unable = with(
        &with_mines("[[12, 8], [20, 10], [30, 12], [40, 6]]", 4),
        "controllers.station.clearance.neutralise.requires = \"blast\"\n\
         [robots.sapper]\ncount = 0\npayload_kg = 1\ncapabilities = [\"blast\"]\nradio.range_m = 9\n\
         radius_m = 0.3\nsensors = { gps.kind = \"position\", compass.kind = \"heading\" }\n\
         brain.behaviours = [{ kind = \"serve\" }]",
    );
    for run in 0..3 {
        let (outcome, simulation) = finish(&unable, run);
        let lane = lane(&outcome);
        assert!(outcome.has_failed && !lane.is_declared && !lane.is_clear);
        let statement = simulation
            .state()
            .each_lane()
            .find_map(|each| each.statement);
        let statement = statement.unwrap();
        assert!(!statement.is_clear && statement.risk > 0.9);
        assert_eq!(lane.stated_risk, statement.risk);
        assert!(is_over(&simulation) && simulation.state().tick() < 1500);
        assert_eq!((outcome.time_s, mines_left(&simulation)), (300.0, 4));
    }
}

#[test]
fn a_mission_that_a_person_ends_is_given_up_with_the_risk_of_that_time() {
    let ended = with(LANE, "controllers.station.clearance.called_off = true");
    for run in 0..3 {
        let mut simulation = begin(LANE, run);
        (0..100).for_each(|_| simulation.step());
        let risk_of = |simulation: &Simulation| {
            let believed = simulation.state().each_lane().next().unwrap();
            (believed.risk.probability, believed.statement)
        };
        let (before, none) = risk_of(&simulation);
        assert_eq!(none, None);
        simulation.change(scenario(&ended)).unwrap();
        let outcome = simulation.finish();
        let (lane, (_, statement)) = (lane(&outcome), risk_of(&simulation));
        assert!(lane.is_given_up && !lane.is_declared && outcome.has_failed);
        // Within the period of the plans, after a second.
        assert!(simulation.state().tick() <= 106);
        // What had been searched by then is remembered.
        assert!((statement.unwrap().risk - before).abs() < 0.2 && before < 0.999_999);
        assert_eq!(lane.stated_risk, statement.unwrap().risk);
    }
    let (outcome, _) = finish(LANE, 0);
    assert!(lane(&outcome).is_declared && !lane(&outcome).is_given_up);
}

#[test]
fn statement_truth_and_columns_agree() {
    let sloppy = LANE.replace("declare_below = 0.1", "declare_below = 0.85");
    let runs = Runs(scenario(&sloppy));
    let names = runs.columns();
    let place = |name: &str| names.iter().position(|column| column.name == name).unwrap();
    let [declared, clear, not_clear, risk] = [
        "declared",
        "declared_clear",
        "declared_not_clear",
        "stated_risk",
    ]
    .map(place);
    let mut wrong = 0;
    let columns = runs.run_block(1, 0..20, BlockOptions::ALONE);
    for run in 0..20 {
        let (outcome, simulation) = finish(&sloppy, run);
        let lane = lane(&outcome);
        assert_eq!(
            lane.is_clear,
            lane.is_declared && mines_left(&simulation) == 0
        );
        let flags = [
            lane.is_declared,
            lane.is_clear,
            lane.is_declared && !lane.is_clear,
        ];
        assert_eq!(
            [declared, clear, not_clear].map(|column| columns[column][run as usize] == 1.0),
            flags
        );
        assert_eq!(columns[risk][run as usize], lane.stated_risk);
        wrong += u32::from(flags[2]);
    }
    assert!(0 < wrong && wrong < 20, "{wrong}");
}

#[test]
fn mines_outside_of_the_lane_do_not_count() {
    let outside = with_mines("[[3, 1.5], [50, 18], [28, 1]]", 3);
    for run in 0..5 {
        let (outcome, simulation) = finish(&outside, run);
        assert_eq!(mines_left(&simulation), 0);
        assert!(lane(&outcome).is_clear && !outcome.has_failed);
        assert!(outcome.acts.as_ref().unwrap().left > 0);
    }
}

#[test]
fn the_first_declaration_of_two_controllers_ends_the_run() {
    let two = with(LANE, "controllers.station.count = 2");
    // Each controller receives other messages.
    let two = two.replace(
        "messages_per_step = 50 }",
        "messages_per_step = 50, loss_probability = 0.4 }",
    );
    let mut alone = 0;
    for run in 0..10 {
        let (outcome, simulation) = finish(&two, run);
        let statements = simulation
            .state()
            .each_lane()
            .filter_map(|lane| lane.statement);
        let risks: Vec<f64> = statements.map(|statement| statement.risk).collect();
        // Some runs end at the time limit, as messages are lost.
        let Some(first) = risks.first() else {
            continue;
        };
        assert_eq!(lane(&outcome).stated_risk, *first);
        alone += u32::from(risks.len() == 1);
    }
    assert!(alone > 0);
}

/// Steps until the run is over; the robot `jammer` sends to the controller as much as it can in each.
fn jammed(mut simulation: Simulation, jammer: AgentId) -> Simulation {
    let station = simulation.state().each_controller().next().unwrap().id;
    let noise = Message {
        to: station.into(),
        about: About::Item {
            kind: 0,
            at: [1.0, 1.0].into(),
            provenance: Provenance::default(),
            kind_share: None,
        },
        confidence: 0.5,
    };
    while !is_over(&simulation) {
        let outbox = vec![noise; 50];
        let command = Command {
            outbox,
            ..Command::default()
        };
        step_with(&mut simulation, [(jammer, command)]);
    }
    simulation
}

#[test]
fn robots_that_flood_the_channel_do_not_make_lanes_declared_early() {
    let jammer = "controllers.station.radio.messages_per_step = 6\n\
                  [robots.jammer]\nlayer = \"air\"\nradius_m = 0.1\nstart.at_m = [[50, 1]]\n\
                  radio = { range_m = 100, messages_per_step = 50 }";
    let text = with(LANE, jammer);
    let (mut later, mut earlier, mut not_clear) = (0, 0, 0);
    for run in 0..12 {
        let (free, _) = finish(&text, run);
        let simulation = jammed(begin(&text, run), id(0, 0));
        let outcome = simulation.outcome();
        let (free, flooded) = (lane(&free), lane(&outcome));
        assert!(
            flooded.messages_dropped > 1000,
            "{}",
            flooded.messages_dropped
        );
        later += u32::from(flooded.declared_s > free.declared_s);
        earlier += u32::from(flooded.declared_s < free.declared_s);
        not_clear += u32::from(flooded.is_declared && !flooded.is_clear);
    }
    // Without an effect of the flood, at least 10 of 12 are later in 2% of the cases.
    assert!(later >= 10, "{later} later, {earlier} earlier");
    assert!(not_clear <= 4, "{not_clear}");
}

#[test]
fn a_run_is_the_same_on_any_number_of_threads() {
    let scenario = scenario(LANE);
    let on = |threads| {
        let pool = ThreadPoolBuilder::new().num_threads(threads);
        let mut simulation = Simulation::new(Arc::clone(&scenario), 3, 1).unwrap();
        let outcome = pool.build().unwrap().install(|| simulation.finish());
        (outcome, simulation.state().hash())
    };
    let alone = on(1);
    assert!(lane(&alone.0).is_declared);
    for threads in [2, 5] {
        assert_eq!(on(threads), alone, "{threads} threads");
    }
}

#[test]
fn a_run_that_is_restored_or_changed_continues_with_the_same_bytes() {
    let more = with(LANE, "robots.ugv.count = 3");
    let mut simulation = begin(LANE, 4);
    (0..150).for_each(|_| simulation.step());
    let saved = simulation.state().clone();
    let mut continue_with = |text: Option<&String>| {
        simulation.restore(saved.clone());
        if let Some(text) = text {
            simulation.change(scenario(text)).unwrap();
        }
        (simulation.finish(), simulation.hash())
    };
    let unchanged = continue_with(None);
    let (outcome, fresh) = finish(LANE, 4);
    assert_eq!(unchanged, (outcome, fresh.hash()));
    let changed = continue_with(Some(&more));
    assert_ne!(changed.1, unchanged.1);
    let clearance = lane(&changed.0);
    assert!(clearance.is_declared && clearance.messages_sent > 0);
    // The three robots were active for the whole time, the third only since the change.
    let (oav, ugv) = (clearance.on_station_s[0], clearance.on_station_s[1]);
    assert!(ugv < oav && oav - ugv < 31.0, "{oav} {ugv}");
    simulation = begin(LANE, 4);
    (0..150).for_each(|_| simulation.step());
    simulation.change(scenario(&more)).unwrap();
    assert_eq!((simulation.finish(), simulation.hash()), changed);
}

#[test]
fn a_statement_stands_after_a_change() {
    let (before, mut simulation) = finish(LANE, 0);
    let more = with(LANE, "items.mine.count = 12");
    simulation.change(scenario(&more)).unwrap();
    assert!(mines_left(&simulation) > 0 && is_over(&simulation));
    let (before, after) = (lane(&before).clone(), simulation.outcome());
    let after = lane(&after);
    assert_eq!(
        (after.is_declared, after.is_clear),
        (before.is_declared, before.is_clear)
    );
    assert_eq!(after.stated_risk, before.stated_risk);
}

#[test]
fn marks_reach_ground_vehicles_only_by_radio() {
    // Ground vehicles do not search: they go to what the air vehicle has marked.
    let marks = with(
        &with_mines("[[20, 8], [30, 12]]", 2),
        "clock.time_limit_s = 50\ncontrollers.station.clearance.searches = [{ requires = \"survey\" }]",
    );
    let silent = with(
        &marks,
        "robots.oav.radio = { range_m = 0.01, messages_per_step = 4 }",
    );
    let farthest_m = |text: &str, run| {
        let (_, simulation) = finish(text, run);
        let ugvs = robots(&simulation);
        let ugvs = ugvs.iter().filter(|robot| robot.id.kind == 1);
        ugvs.map(|robot| robot.at.x).fold(0.0, f64::max)
    };
    for run in 0..4 {
        let (with, without) = (farthest_m(&marks, run), farthest_m(&silent, run));
        assert!(with > 10.0 && without < 7.0, "{with} {without}");
    }
}

#[test]
fn a_robot_without_charges_does_not_neutralise() {
    let few = with(
        &with_mines("[[14, 8], [22, 10], [30, 12]]", 3),
        "robots.ugv = { count = 1, tools.neutralise.charges = 1 }",
    );
    for run in 0..3 {
        let (outcome, simulation) = finish(&few, run);
        let acts = outcome.acts.as_ref().unwrap();
        assert_eq!((acts.neutralised, mines_left(&simulation)), (1, 2));
        assert!(outcome.has_failed && !lane(&outcome).is_declared);
    }
}

#[test]
fn a_robot_that_has_destroyed_an_item_neutralises_a_second_one_within_reach() {
    let twins = with_mines("[[20, 10], [20.5, 10.3]]", 2);
    let results: Vec<(u32, bool)> = (0..10)
        .map(|run| {
            let (outcome, simulation) = finish(&twins, run);
            (mines_left(&simulation), lane(&outcome).is_declared)
        })
        .collect();
    let both = results.iter().filter(|(left, _)| *left == 0).count();
    assert!(both >= 8, "{results:?}");
}

#[test]
fn mines_at_the_border_of_the_lane_are_neutralised_if_they_are_in_it() {
    // Two are 0.1 m inside of the lane, and one 0.1 m outside.
    let border = with_mines("[[20, 15.9], [30, 4.1], [40, 16.1]]", 3);
    let cleared = (0..8).filter(|run| {
        let (outcome, simulation) = finish(&border, *run);
        let clearance = lane(&outcome);
        assert_eq!(
            clearance.is_clear,
            clearance.is_declared && mines_left(&simulation) == 0
        );
        clearance.is_clear
    });
    let cleared = cleared.count();
    assert!(cleared >= 6, "{cleared}");
}
