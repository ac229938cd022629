//! Robots that act on items with their tools.

use crate::common::{go, id, read, replaced, scenario, start, step_with, with};
use base::geometry::Point;
use brain::{Act, ActKind, Acted, AgentId, Command, Percept};
use sim::judge::events::EventKind;
use sim::simulation::Simulation;

/// A flying robot that marks and a robot on the ground with all tools; a mine at (5, 5), and scrap at (9, 5).
pub(super) const LANE: &str = r#"
items.mine = { completed_by = "neutralised", placement.at_m = [[5, 5]] }
items.scrap = { target = false, placement.at_m = [[9, 5]] }
[robots.oav]
layer = "air"
start.at_m = [[3, 8]]
drive = { max_speed_m_s = 2, max_turn_rate_deg_s = 90 }
tools.mark.range_m = 20
sensors.eye = { kind = "items", range_m = 2 }
[robots.ugv]
radius_m = 0.3
payload_kg = 2
start = { at_m = [[4, 5]], heading_deg = [90] }
sensors.eye = { kind = "items", range_m = 2 }
[robots.ugv.tools]
mark.range_m = 10
confirm.range_m = 10
isolate = { range_m = 2, duration_s = 0.5 }
neutralise = { range_m = 2, duration_s = 1, charges = 2 }
"#;

pub(super) const OAV: AgentId = AgentId::robot(0, 0);
pub(super) const UGV: AgentId = AgentId::robot(1, 0);
const MINE: Point = Point { x: 5.0, y: 5.0 };
const SCRAP: Point = Point { x: 9.0, y: 5.0 };

/// A command to act at a place without moving.
pub(super) fn act(kind: ActKind, at: Point) -> Command {
    Command {
        acts: vec![Act { kind, at }],
        ..Command::default()
    }
}

fn percept(simulation: &mut Simulation, robot: AgentId) -> Percept {
    simulation.percept(robot).unwrap().unwrap()
}

/// Acts of a run with the step of each: what, on which item, and whether it succeeded.
fn acts(simulation: &mut Simulation, run: impl FnOnce(&mut Simulation)) -> Vec<Happened> {
    let reader = simulation.event_reader();
    run(simulation);
    let episodes = reader.drain();
    let events = episodes.iter().flat_map(|(_, events)| events);
    let acts = events.filter_map(|event| match event.kind {
        EventKind::Acted {
            act,
            item,
            is_success,
            ..
        } => Some((event.tick, act, item, is_success)),
        _ => None,
    });
    acts.collect()
}

type Happened = (u64, ActKind, Option<(u16, u32)>, bool);

#[test]
fn a_charge_destroys_the_item_once_the_robot_has_stood_still_for_its_duration() {
    let mut simulation = start(LANE);
    let near = Point { x: 5.2, y: 4.9 };
    let happened = acts(&mut simulation, |simulation| {
        for _ in 0..10 {
            assert!(percept(simulation, UGV).acted.is_empty());
            step_with(simulation, [(UGV, act(ActKind::Neutralise, near))]);
        }
    });
    let item = Some((0, 0));
    assert_eq!(happened, [(9, ActKind::Neutralise, item, true)]);
    let percept = percept(&mut simulation, UGV);
    let kind = ActKind::Neutralise;
    let expected = [Acted {
        kind,
        at: near,
        is_success: true,
    }];
    assert_eq!(percept.acted, expected);
    assert_eq!(percept.charges, Some(1));
    let outcome = simulation.outcome();
    let acts = outcome.acts.unwrap();
    assert_eq!((acts.neutralised, acts.left, outcome.time_s), (1, 0, 0.9));
    assert!(simulation.state().is_over(simulation.scenario()));
}

#[test]
fn robots_no_longer_detect_an_item_that_was_destroyed_even_in_a_changed_scenario() {
    let mut simulation = start(LANE);
    assert_eq!(percept(&mut simulation, UGV).contacts.len(), 1);
    for _ in 0..10 {
        step_with(&mut simulation, [(UGV, act(ActKind::Neutralise, MINE))]);
    }
    assert!(percept(&mut simulation, UGV).contacts.is_empty());
    let more = with(LANE, "robots.oav.count = 0");
    simulation.change(scenario(&more)).unwrap();
    assert!(percept(&mut simulation, id(1, 0)).contacts.is_empty());
    assert_eq!(percept(&mut simulation, id(1, 0)).charges, Some(1));
    assert_eq!(simulation.outcome().acts.unwrap().neutralised, 1);
}

#[test]
fn an_act_that_takes_time_begins_again_when_the_robot_moves_or_stops_to_act() {
    for (pause, command) in [
        ("moves", Command { ..go(0.05, 0.0) }),
        ("does nothing", Command::default()),
        ("does something else", act(ActKind::Isolate, MINE)),
    ] {
        let mut simulation = start(LANE);
        let mut paused = command.clone();
        if pause == "moves" {
            paused.acts = act(ActKind::Neutralise, MINE).acts;
        }
        let happened = acts(&mut simulation, |simulation| {
            for step in 0..16 {
                let next = act(ActKind::Neutralise, MINE);
                let next = if step == 5 { paused.clone() } else { next };
                step_with(simulation, [(UGV, next)]);
            }
        });
        let item = Some((0, 0));
        assert_eq!(happened, [(15, ActKind::Neutralise, item, true)], "{pause}");
    }
}

#[test]
fn acts_without_the_tool_out_of_range_or_without_a_charge_fail_and_change_nothing() {
    let mut simulation = start(LANE);
    let far = Point { x: 9.0, y: 9.0 };
    let happened = acts(&mut simulation, |simulation| {
        step_with(
            simulation,
            [
                (OAV, act(ActKind::Confirm, MINE)),
                (UGV, act(ActKind::Isolate, far)),
            ],
        );
        for robot in [OAV, UGV] {
            let acted = percept(simulation, robot).acted;
            assert!(acted.len() == 1 && !acted[0].is_success, "{robot:?}");
        }
        // Two charges at a place with nothing, and a third one that it does not have.
        let nothing = Point { x: 3.0, y: 5.0 };
        for _ in 0..20 {
            step_with(simulation, [(UGV, act(ActKind::Neutralise, nothing))]);
        }
        assert_eq!(percept(simulation, UGV).charges, Some(0));
        for _ in 0..20 {
            step_with(simulation, [(UGV, act(ActKind::Neutralise, MINE))]);
        }
    });
    let wasted = |tick| (tick, ActKind::Neutralise, None, false);
    assert_eq!(happened, [wasted(10), wasted(20)]);
    assert_eq!(simulation.outcome().acts.unwrap().left, 1);
}

#[test]
fn statements_are_about_the_nearest_item_within_two_metres_and_count_once() {
    let mut simulation = start(LANE);
    let at = |x| Point { x, y: 5.0 };
    for (kind, x) in [
        (ActKind::Mark, 3.1),
        (ActKind::Mark, 6.9),
        (ActKind::Mark, 14.0),
        (ActKind::Mark, 13.0),
        (ActKind::Mark, 2.9),
    ] {
        step_with(&mut simulation, [(OAV, act(kind, at(x)))]);
    }
    let acts = simulation.outcome().acts.unwrap();
    // 14 and 13 m are one place, 2.9 m another one.
    assert_eq!((acts.marked, acts.false_marks), (1, 2));
    assert_eq!((acts.unmarked_from_air, acts.met_unmarked), (0, 0));
    for _ in 0..3 {
        step_with(&mut simulation, [(UGV, act(ActKind::Confirm, SCRAP))]);
        step_with(&mut simulation, [(UGV, act(ActKind::Reject, MINE))]);
    }
    let acts = simulation.outcome().acts.unwrap();
    assert_eq!((acts.confirmed, acts.false_confirmations), (0, 1));
    step_with(&mut simulation, [(UGV, act(ActKind::Confirm, MINE))]);
    let acts = simulation.outcome().acts.unwrap();
    assert_eq!(
        (acts.confirmed, acts.false_confirmations, acts.left),
        (1, 1, 1)
    );
}

#[test]
fn a_target_that_only_the_ground_has_marked_and_met_was_missed_from_the_air() {
    let mut simulation = start(LANE);
    step_with(&mut simulation, [(UGV, act(ActKind::Mark, MINE))]);
    let acts = simulation.outcome().acts.unwrap();
    assert_eq!(
        (acts.marked, acts.unmarked_from_air, acts.met_unmarked),
        (1, 1, 1)
    );
    let blind = "robots.ugv = { brain.rate_hz = 1, start.at_m = [[15, 5]] }";
    let mut simulation = start(&with(LANE, blind));
    step_with(&mut simulation, []);
    let acts = simulation.outcome().acts.unwrap();
    assert_eq!((acts.unmarked_from_air, acts.met_unmarked), (1, 0));
}

/// Of 600 independent attempts with probability 0.3, the number of successes is within 4 standard deviations of 180
/// with a probability above 0.9999; the seed is fixed.
#[test]
fn charges_destroy_items_with_their_probability() {
    let charge = "robots.ugv.tools.neutralise = { charges = 1, success_probability = 0.3 }";
    let scenario = scenario(&with(LANE, charge));
    let mut destroyed = 0;
    for run in 0..600 {
        let mut simulation = Simulation::new(scenario.clone(), 3, run).unwrap();
        for _ in 0..10 {
            step_with(&mut simulation, [(UGV, act(ActKind::Neutralise, MINE))]);
        }
        let percept = percept(&mut simulation, UGV);
        let acts = simulation.outcome().acts.unwrap();
        assert_eq!(percept.charges, Some(0));
        assert_eq!(percept.acted[0].is_success, acts.neutralised == 1);
        assert_eq!(acts.left, 1 - acts.neutralised);
        destroyed += acts.neutralised;
    }
    let sd = (600.0_f64 * 0.3 * 0.7).sqrt();
    assert!(
        (f64::from(destroyed) - 180.0).abs() < 4.0 * sd,
        "{destroyed}"
    );
}

#[test]
fn an_item_is_complete_when_its_kind_demands_it() {
    for (by, left) in [("detected", 0), ("confirmed", 1), ("neutralised", 1)] {
        let completed = format!("items.mine.completed_by = \"{by}\"");
        let mut simulation = start(&with(LANE, &completed));
        step_with(&mut simulation, [(UGV, Command::default())]);
        assert_eq!(simulation.outcome().acts.unwrap().left, left, "{by}");
        step_with(&mut simulation, [(UGV, act(ActKind::Confirm, MINE))]);
        let is_over = simulation.state().is_over(simulation.scenario());
        assert_eq!(is_over, by != "neutralised", "{by}");
    }
}

#[test]
fn an_end_can_count_what_was_done_to_targets() {
    for (when, kind) in [
        ("marked >= 1", ActKind::Mark),
        ("confirmed >= 1", ActKind::Confirm),
        ("neutralised >= 1", ActKind::Neutralise),
        ("left == 0", ActKind::Neutralise),
    ] {
        let mut simulation = start(&with(LANE, &format!("end.when = \"{when}\"")));
        let is_over = |simulation: &Simulation| simulation.state().is_over(simulation.scenario());
        for _ in 0..10 {
            assert!(!is_over(&simulation), "{when}");
            step_with(&mut simulation, [(UGV, act(kind, MINE))]);
            if kind != ActKind::Neutralise {
                break;
            }
        }
        assert!(is_over(&simulation), "{when}");
    }
}

#[test]
fn the_hash_of_a_run_covers_what_robots_did_and_what_is_left_of_their_charges() {
    let (mut one, mut other) = (start(LANE), start(LANE));
    assert_eq!(one.state().hash(), other.state().hash());
    step_with(&mut one, [(UGV, act(ActKind::Mark, MINE))]);
    step_with(&mut other, [(UGV, Command::default())]);
    assert_ne!(one.state().hash(), other.state().hash());
}

#[test]
fn tools_without_what_they_need_and_unknown_completions_are_errors() {
    for (this, that, path) in [
        ("payload_kg = 2\n", "", "robots.ugv.payload_kg"),
        (
            "charges = 2",
            "charges = 0",
            "robots.ugv.tools.neutralise.charges",
        ),
        (", charges = 2", "", "robots.ugv.tools.neutralise.charges"),
        (
            "range_m = 20",
            "range_m = -1",
            "robots.oav.tools.mark.range_m",
        ),
        (
            "mark.range_m = 20",
            "marc.range_m = 20",
            "robots.oav.tools.marc",
        ),
        (
            "\"neutralised\"",
            "\"neutralized\"",
            "items.mine.completed_by",
        ),
        (
            "charges = 2",
            "charges = 2, success_probability = 2",
            "success_probability",
        ),
    ] {
        let errors = read(&replaced(LANE, &[(this, that)])).unwrap_err();
        assert!(errors.to_string().contains(path), "{that}: {errors}");
    }
}
