//! The life of goals: none is lost, whatever is changed, refused, cut or fails.

use crate::common::{Random, scenario, start};
use brain::{AgentId, GoalId, Reason};
use sim::run::GoalStatus;
use sim::simulation::Simulation;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

const RUN: &str = r#"
clock = { time_limit_s = 200, step_s = 0.2 }
world.size_m = [40, 40]
goals.spot = { owner = "base", count = 12, within_m = 1, service_s = 2 }
[controllers.base]
count = 1
start.at_m = [[1, 1], [2, 1], [1, 2], [3, 3], [39, 39]]
radio = { range_m = 100, messages_per_step = 20 }
[robots.rover]
count = 3
start.at_m = [[10, 10], [12, 12], [30, 30]]
drive = { max_speed_m_s = 2, max_turn_rate_deg_s = 120 }
radio = { range_m = 100, messages_per_step = 20 }
sensors = { gps.kind = "position", compass.kind = "heading" }
brain.behaviours = [{ kind = "serve" }]
"#;

/// `RUN` with other values of keys.
fn with(changes: &[(&str, &str)]) -> String {
    changes.iter().fold(RUN.to_owned(), |text, (key, value)| {
        crate::common::with(&text, &format!("{key} = {value}"))
    })
}

fn text_of(values: &BTreeMap<&'static str, String>) -> String {
    let changes = values.iter().map(|(key, value)| (*key, value.as_str()));
    with(&changes.collect::<Vec<_>>())
}

fn statuses(simulation: &Simulation) -> Vec<GoalStatus> {
    simulation.state().goal_statuses(simulation.scenario())
}

fn is_over(simulation: &Simulation) -> bool {
    simulation.state().is_over(simulation.scenario())
}

fn finished(mut simulation: Simulation) -> Simulation {
    while !is_over(&simulation) {
        simulation.step();
    }
    simulation
}

fn served(simulation: &Simulation) -> u32 {
    simulation.outcome().goals.unwrap().served
}

#[test]
fn changes_do_not_lose_the_goals_that_are_being_served() {
    let text = with(&[("goals.spot.service_s", "8")]);
    let mut simulation = start(&text);
    for change in 0..8 {
        (0..60).for_each(|_| simulation.step());
        let price = format!("{change}");
        let to = crate::common::with(&text, &format!("controllers.base.price = {price}"));
        simulation.change(scenario(&to)).unwrap();
    }
    assert_eq!(served(&finished(simulation)), 12);
}

#[test]
fn goals_beyond_the_maximum_are_issued_again_when_there_is_room() {
    for count in ["1", "2"] {
        let text = with(&[
            ("controllers.base.count", count),
            ("controllers.base.max_goals", "3"),
        ]);
        let mut simulation = start(&text);
        (0..5).for_each(|_| simulation.step());
        let refused = statuses(&simulation);
        assert!(refused.contains(&GoalStatus::Reported), "{refused:?}");
        assert_eq!(served(&finished(simulation)), 12, "{count}");
    }
}

#[test]
fn reports_over_a_radio_of_one_message_per_step_arrive() {
    let text = with(&[
        ("robots.rover.out_of_service", "[0, 1, 2]"),
        ("controllers.base.radio.messages_per_step", "1"),
    ]);
    let simulation = finished(start(&text));
    assert_eq!(statuses(&simulation), [GoalStatus::Reported; 12]);
}

#[test]
fn robots_with_noisy_positions_serve_no_goal_in_error() {
    let noise = ("robots.rover.sensors.gps.noise_m", "2");
    for within_m in ["0.4", "1.5"] {
        let more = [
            ("goals.spot.within_m", within_m),
            ("clock.time_limit_s", "900"),
        ];
        let text = with(&[noise, more[0], more[1], ("goals.spot.service_s", "0")]);
        let goals = finished(start(&text)).outcome().goals.unwrap();
        assert_eq!((goals.served, goals.done_in_error), (12, 0), "{within_m}");
    }
}

#[test]
fn goals_that_only_a_lost_controller_knew_are_unknown() {
    let text = with(&[("robots.rover.out_of_service", "[0, 1, 2]")]);
    let mut simulation = start(&text);
    (0..3).for_each(|_| simulation.step());
    assert_eq!(statuses(&simulation), [GoalStatus::Owned; 12]);
    let failed = crate::common::with(&text, "controllers.base.failed = [0]");
    simulation.change(scenario(&failed)).unwrap();
    assert_eq!(statuses(&simulation), [GoalStatus::Unknown; 12]);
    let goals = simulation.outcome().goals.unwrap();
    assert_eq!((goals.balance.unknown, goals.balance.issued()), (12, 12));
}

#[test]
fn a_robot_reports_the_goals_that_only_a_lost_controller_could_award_again() {
    let slow = [
        ("goals.spot.service_s", "60"),
        ("controllers.base.service_lease_s", "70"),
        (
            "robots.rover.brain.behaviours",
            "[{ kind = \"serve\", max_goals = 2 }]",
        ),
    ];
    let mut simulation = start(&with(&slow));
    let awarded = |simulation: &Simulation| {
        let statuses = statuses(simulation).into_iter();
        let is_awarded = |status| matches!(status, GoalStatus::Awarded | GoalStatus::InService);
        statuses.map(is_awarded).collect::<Vec<bool>>()
    };
    (0..60).for_each(|_| simulation.step());
    let before = awarded(&simulation);
    assert!(before.contains(&true) && before.contains(&false));
    let failed = with(&[
        slow[0],
        slow[1],
        slow[2],
        ("controllers.base.failed", "[0]"),
    ]);
    simulation.change(scenario(&failed)).unwrap();
    let simulation = finished(simulation);
    let goals = simulation.state().each_goal(simulation.scenario());
    let ends: Vec<_> = goals.map(|goal| (goal.status, goal.unserved)).collect();
    let reported = (GoalStatus::Reported, Some(Reason::Lease));
    for (end, was_awarded) in ends.iter().zip(before) {
        // A robot may end a service that it has begun.
        let is_known = *end == reported || *end == (GoalStatus::Served, None);
        assert!(is_known == was_awarded, "{end:?}");
        assert!(
            was_awarded || *end == (GoalStatus::Unknown, None),
            "{end:?}"
        );
    }
    assert!(ends.contains(&reported));
}

/// Which working controllers know a goal, and which robots hold its lease, as they state it themselves.
fn knowing(simulation: &Simulation) -> BTreeSet<(GoalId, AgentId)> {
    let state = simulation.state();
    let controllers = state.each_controller().filter(|each| each.is_working);
    let owned = controllers.flat_map(|each| {
        let goals = each.goals.into_iter().map(|owned| owned.task.id);
        let all = goals.chain(each.lost.into_iter().map(|task| task.id));
        all.map(|goal| (goal, each.id)).collect::<Vec<_>>()
    });
    let robots = state.each_robot(simulation.scenario());
    let robots = robots.filter(|robot| robot.status == sim::run::Status::Active);
    let served = robots.flat_map(|robot| {
        let goals = state.served_goals(robot.id).into_iter();
        goals.map(move |served| (served.task.id, robot.id))
    });
    owned.chain(served).collect()
}

/// The robots and controllers that work.
fn working(simulation: &Simulation) -> BTreeSet<AgentId> {
    let state = simulation.state();
    let controllers = state.each_controller().filter(|each| each.is_working);
    let robots = state.each_robot(simulation.scenario());
    let robots = robots.filter(|robot| robot.status == sim::run::Status::Active);
    let robots: Vec<AgentId> = robots.map(|robot| robot.id).collect();
    controllers.map(|each| each.id).chain(robots).collect()
}

/// A run in which anything happens at random steps.
struct Fuzzed {
    random: Random,
    simulation: Simulation,
    values: BTreeMap<&'static str, String>,
    /// The state of each goal, and what is known of it, after the last step.
    statuses: Vec<GoalStatus>,
    knowing: BTreeSet<(GoalId, AgentId)>,
}

impl Fuzzed {
    fn new(seed: u64) -> Self {
        let mut random = Random::new(seed);
        let mut any = |values: &[&'static str]| random.one_of(values);
        let changes = [
            ("clock.time_limit_s", "80"),
            ("controllers.base.count", any(&["1", "2", "3", "5"])),
            (
                "controllers.base.backup",
                any(&["\"none\"", "\"majority\"", "\"majority\""]),
            ),
            ("controllers.base.max_goals", any(&["0", "2", "5", "1000"])),
            // Controllers with few goals at most are overloaded soon, and trade.
            (
                "controllers.base.trade",
                any(&["{ gain = 0.99, confidence = 0 }", "{}"]),
            ),
            ("controllers.base.owner_lease_s", any(&["4", "6", "30"])),
            ("controllers.base.service_lease_s", any(&["10", "20"])),
            (
                "controllers.base.radio.messages_per_step",
                any(&["1", "2", "20"]),
            ),
            ("controllers.base.radio.range_m", any(&["15", "100"])),
            (
                "controllers.base.radio.loss_probability",
                any(&["0", "0.3"]),
            ),
            ("robots.rover.radio.messages_per_step", any(&["1", "20"])),
            ("goals.spot.service_s", any(&["0", "2", "6"])),
            ("goals.spot.every_s", any(&["0", "3"])),
        ];
        let values = changes.map(|(key, value)| (key, value.to_owned()));
        let mut values = BTreeMap::from(values);
        if values["controllers.base.count"] == "1" || random.below(2) == 0 {
            values.remove("controllers.base.trade");
        }
        Self {
            simulation: start(&text_of(&values)),
            random,
            values,
            statuses: vec![GoalStatus::Pending; 12],
            knowing: BTreeSet::new(),
        }
    }

    /// Lets something happen.
    fn disturb(&mut self) {
        let index = self.random.below(5).to_string();
        let failed = format!("[{index}]");
        let mut any = |values: &[&'static str]| self.random.one_of(values).to_owned();
        let changes = [
            ("controllers.base.price", index),
            (
                "controllers.base.allocation",
                any(&["\"nearest\"", "\"optimal\"", "\"none\""]),
            ),
            ("controllers.base.count", any(&["1", "2", "3", "5"])),
            (
                "controllers.base.backup",
                any(&["\"none\"", "\"majority\""]),
            ),
            ("controllers.base.max_goals", any(&["0", "2", "5", "1000"])),
            (
                "controllers.base.trade",
                any(&["{ gain = 0.99, confidence = 0 }", "{ gain = 0.1 }"]),
            ),
            (
                "controllers.base.radio.loss_probability",
                any(&["0.9", "0"]),
            ),
            ("controllers.base.failed", failed.clone()),
            (
                "controllers.aide",
                any(&[
                    "{ count = 0, start.at_m = [[3, 3]], radio.range_m = 60 }",
                    "{ count = 1, start.at_m = [[3, 3]], radio.range_m = 60 }",
                ]),
            ),
            ("robots.rover.failed", failed.clone()),
            ("robots.rover.out_of_service", failed),
            ("robots.rover.radius_m", any(&["0.2", "0.3"])),
            (
                "robots.rover.brain.behaviours",
                any(&[
                    "[{ kind = \"serve\" }]",
                    "[{ kind = \"serve\", max_goals = 2 }, { kind = \"avoid\" }]",
                ]),
            ),
            ("goals.spot.service_s", any(&["0", "2", "6"])),
        ];
        let number = self.random.below(14) as usize;
        let (key, value) = changes.into_iter().nth(number).unwrap();
        let mut values = self.values.clone();
        values.insert(key, value);
        // Not every controller exists, and not every key changes while goals are known.
        let Ok(to) = crate::common::read(&text_of(&values)) else {
            return;
        };
        if self.simulation.change(Arc::new(to)).is_ok() {
            self.values = values;
        }
    }

    /// Checks the states of all goals after a step.
    fn check(&mut self, seed: u64) {
        let simulation = &self.simulation;
        let (now, known, working) = (
            statuses(simulation),
            knowing(simulation),
            working(simulation),
        );
        let goals = simulation.state().each_goal(simulation.scenario());
        for (goal, (was, is)) in goals.zip(self.statuses.iter().zip(&now)) {
            let at = format!(
                "seed {seed}, {:.1} s, goal {}",
                simulation.time_s(),
                goal.index
            );
            assert!(
                *was != GoalStatus::Served || *is == *was,
                "{at}: served no more"
            );
            assert!(
                *was == GoalStatus::Pending || *is != GoalStatus::Pending,
                "{at}: not issued"
            );
            if *is != GoalStatus::Unknown {
                continue;
            }
            assert!(
                !known.iter().any(|(id, _)| *id == goal.id),
                "{at}: an agent knows it"
            );
            let before = self.knowing.iter().filter(|(id, _)| *id == goal.id);
            let mut forgotten = before.filter(|(_, agent)| working.contains(agent));
            assert_eq!(forgotten.next(), None, "{at}: an agent that works knew it");
        }
        self.check_one_of_each(seed);
        let goals = simulation.outcome().goals.unwrap();
        let others = goals.balance.open + goals.balance.reported + goals.balance.unknown;
        let issued = goals.balance.issued();
        assert_eq!(goals.served + goals.expired + others, issued, "seed {seed}");
        (self.statuses, self.knowing) = (now, known);
    }

    /// Checks that each goal has at most one owner, and one robot.
    fn check_one_of_each(&self, seed: u64) {
        let state = self.simulation.state();
        let controllers = state.each_controller().filter(|each| each.is_working);
        let owned = controllers.flat_map(|each| each.goals.into_iter().map(|owned| owned.task.id));
        let robots = state.each_robot(self.simulation.scenario());
        let robots = robots.filter(|robot| robot.status == sim::run::Status::Active);
        let served = robots.flat_map(|robot| {
            let goals = state.served_goals(robot.id).into_iter();
            goals.map(|served| served.task.id).collect::<Vec<_>>()
        });
        for (what, ids) in [
            ("owner", owned.collect::<Vec<_>>()),
            ("robot", served.collect()),
        ] {
            let all: BTreeSet<GoalId> = ids.iter().copied().collect();
            let at = self.simulation.time_s();
            assert_eq!(
                all.len(),
                ids.len(),
                "seed {seed}, {at:.1} s: one {what} of each goal"
            );
        }
    }
}

/// `GOAL_RUNS` runs, by default as many as take a few seconds.
#[test]
fn no_goal_is_lost_whatever_is_changed_refused_cut_or_fails() {
    let runs = std::env::var("GOAL_RUNS").map_or(40, |runs| runs.parse().unwrap());
    for seed in 0..runs {
        let mut run = Fuzzed::new(seed);
        while !is_over(&run.simulation) {
            run.simulation.step();
            if run.random.below(60) == 0 {
                run.disturb();
            }
            run.check(seed);
        }
    }
}

#[test]
fn controllers_have_other_ids_than_robots() {
    let simulation = start(RUN);
    let controllers = simulation.state().each_controller().map(|each| each.id);
    assert_eq!(controllers.collect::<Vec<_>>(), [AgentId::controller(1, 0)]);
}
