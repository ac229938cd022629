//! Trade while messages are late, controllers are removed, and settings change.

use crate::network::{Network, Weather};
use crate::team::{Team, brain, goal_id, station_id, task};
use base::geometry::Point;
use brain::{About, AgentId, Message, Task, TradeMessage};
use economy::{Allocation, Backup, Controller, Settings, Trade};
use std::cell::Cell;
use std::rc::Rc;
use std::sync::Arc;

const WEST: AgentId = station_id(0);
const EAST: AgentId = station_id(1);
const GOALS: u32 = 4;

/// Goals go to any price.
fn settings() -> Settings {
    Settings {
        max_drift: 0.0,
        trade: Some(Trade {
            confidence: 0.0,
            gain: 0.7,
        }),
        ..Settings::default()
    }
}

/// Robots reach the second controller only: the first one transfers its goals, which none awards.
fn transferring(settings: &Settings) -> Team {
    let settings = Settings {
        allocation: Allocation::None,
        max_goals: 5,
        ..settings.clone()
    };
    let mut team = Team::alone([1, 2], &settings, Weather::default(), 5);
    team.reaches = Box::new(|from, to, _| from.role == to.role || [from, to].contains(&EAST));
    for number in 0..GOALS {
        #[expect(clippy::cast_precision_loss, reason = "few goals")]
        team.issue(0, task(number, [number as f32, 0.0]));
    }
    while team.transfers == 0 {
        team.step();
    }
    team
}

fn change(team: &mut Team, settings: impl Fn(&Settings) -> Settings) {
    let changed = Arc::new(settings(&team.settings));
    let other = Controller::new(Arc::clone(&changed));
    team.settings = changed;
    for station in &mut team.stations {
        let controller = station.controller.take();
        station.controller = controller.map(|it| it.with_settings_of(&other));
    }
}

fn owners(team: &Team, number: u32) -> Vec<usize> {
    let stations = team.stations.iter().enumerate();
    let owners = stations.filter(|(_, it)| Team::owns(it, goal_id(number), team.now_s));
    owners.map(|(station, _)| station).collect()
}

#[test]
fn a_transfer_that_arrives_again_makes_no_second_owner() {
    let settings = Settings {
        allocation: Allocation::None,
        max_goals: 8,
        ..settings()
    };
    let mut team = Team::alone([3, 3], &settings, Weather::default(), 5);
    // Controllers in a row, each with a robot that is nearer to the goals than that of the one before.
    team.reaches = Box::new(|from, to, _| {
        let apart = from.index.abs_diff(to.index);
        apart == u32::from(from.role == to.role)
    });
    for (robot, x) in team.robots.iter_mut().zip([1000.0, 100.0, 20.0]) {
        robot.brain = Some(brain(&[7], ""));
        robot.at = Point { x, y: 0.0 };
    }
    for number in 0..8 {
        // Those of the second controller no robot can serve.
        let goal = Task {
            capability: if number < 6 { 7 } else { 9 },
            ..task(number, [0.0, 0.0])
        };
        team.issue(usize::from(number >= 6), goal);
    }
    let mut transfers: Vec<(f64, AgentId, AgentId, Message)> = Vec::new();
    for step in 0..600 {
        if !transfers.is_empty() && step % 20 == 0 {
            // With a lower maximum, the second controller has too many goals, too.
            change(&mut team, |settings| Settings {
                max_goals: 4,
                ..settings.clone()
            });
        }
        team.step();
        let now_s = team.now_s;
        for (from, to, message) in std::mem::take(&mut team.overheard) {
            if matches!(message.about, About::Trade(TradeMessage::Transfer(_))) {
                transfers.push((now_s, from, to, message));
            }
        }
        for (at_s, from, to, message) in &transfers {
            if (at_s + 2.0..at_s + 9.0).contains(&now_s) {
                team.network.send(*from, *to, *message, now_s);
            }
        }
        assert!(
            (0..8).all(|number| owners(&team, number).len() <= 1),
            "{now_s}"
        );
    }
    assert!(
        transfers.iter().any(|(_, from, ..)| *from == EAST),
        "a chain"
    );
}

#[test]
fn goals_of_a_controller_that_is_removed_in_a_transfer_are_owned_or_forgotten() {
    for steps in 0..12 {
        let mut team = transferring(&settings());
        (0..steps).for_each(|_| team.step());
        team.crash_station(0);
        if let Some(controller) = &mut team.stations[1].controller {
            controller.forget_peers(|id| id == WEST);
        }
        team.run(120.0);
        // What it has forgotten, the operator issues again.
        for number in 0..GOALS {
            let knows = team.controller(1).knows(goal_id(number));
            assert_eq!(knows, owners(&team, number) == [1], "{steps}, {number}");
        }
    }
}

#[test]
fn trade_that_ends_in_a_transfer_leaves_each_goal_with_one_owner() {
    for steps in 0..16 {
        let mut team = transferring(&settings());
        (0..steps).for_each(|_| team.step());
        change(&mut team, |settings| Settings {
            trade: None,
            ..settings.clone()
        });
        team.run(200.0);
        for number in 0..GOALS {
            assert_eq!(owners(&team, number).len(), 1, "{steps}, {number}");
        }
    }
}

#[test]
fn goals_are_served_once_if_trade_ends_in_a_transfer() {
    for steps in 0..12 {
        let settings = settings();
        let mut team = Team::alone([2, 2], &settings, Weather::default(), 5);
        let is_late = Rc::new(Cell::new(false));
        let late = Rc::clone(&is_late);
        // The robot of the first controller is in range of it only later.
        team.reaches = Box::new(move |from, to, _| {
            let is_first = from.index == 0 && to.index == 0;
            from.role == to.role || from.index == to.index && (!is_first || late.get())
        });
        team.robots[1].at = Point { x: 0.0, y: 5.0 };
        for number in 0..GOALS {
            #[expect(clippy::cast_precision_loss, reason = "few goals")]
            team.issue(0, task(number, [number as f32, 0.0]));
        }
        while team.transfers == 0 {
            team.step();
        }
        (0..steps).for_each(|_| team.step());
        change(&mut team, |settings| Settings {
            trade: None,
            ..settings.clone()
        });
        team.run(29.0);
        is_late.set(true);
        team.run(300.0);
        assert_eq!((team.done(), team.served.len()), (4, 4), "{steps}");
    }
}

#[test]
fn a_majority_that_begins_in_a_transfer_sends_no_dismissal() {
    for steps in 0..8 {
        let mut team = transferring(&settings());
        (0..steps).for_each(|_| team.step());
        change(&mut team, |settings| Settings {
            backup: Backup::Majority,
            ..settings.clone()
        });
        team.run(100.0);
        team.overheard.clear();
        team.run(50.0);
        let is_dismissal = |about: &About| matches!(about, About::Trade(TradeMessage::Dismiss(_)));
        assert!(
            !team
                .overheard
                .iter()
                .any(|(.., it)| is_dismissal(&it.about))
        );
        for number in 0..GOALS {
            assert_eq!(owners(&team, number).len(), 1, "{steps}, {number}");
        }
    }
}

#[test]
fn transfers_give_no_controller_more_than_its_maximum() {
    let mut team = transferring(&settings());
    team.issue(1, task(GOALS, [4.0, 0.0]));
    for _ in 0..600 {
        team.step();
        assert!(team.controller(1).goals().count() <= 5);
    }
}

#[test]
fn a_controller_whose_robots_failed_for_a_time_gets_goals_again() {
    let mut team = Team::alone([2, 2], &settings(), Weather::default(), 5);
    team.reaches = Box::new(|from, to, _| from.role == to.role || [from, to].contains(&EAST));
    for number in 0..5 {
        let goal = task(number, [60.0, 60.0]);
        team.issue(
            0,
            Task {
                due_s: 100.0,
                ..goal
            },
        );
    }
    while team.transfers < 5 && team.now_s < 60.0 {
        team.step();
    }
    team.crash_robot(0);
    team.crash_robot(1);
    team.run(400.0);
    team.restart_robot(0);
    team.restart_robot(1);
    let before = team.done();
    for number in 5..25 {
        team.issue(0, task(number, [5.0, 5.0]));
    }
    team.run(1500.0);
    assert_eq!(team.done() - before, 20);
}

#[test]
fn a_candidate_by_a_transfer_waits_for_leases_when_members_are_added() {
    let settings = Settings {
        service_lease_s: 4.0,
        owner_lease_s: 60.0,
        max_goals: 4,
        count: 3,
        ..settings()
    };
    let mut team = Team::new([2, 5], &settings, Weather::default(), 5);
    team.settings = Arc::new(settings.clone());
    for station in &mut team.stations {
        station.controller = Some(Controller::new(Arc::clone(&team.settings)));
    }
    team.crash_station(3);
    team.crash_station(4);
    let is_split = Rc::new(Cell::new(false));
    let split = Rc::clone(&is_split);
    // From the transfer on, the third controller does not reach the first two, and the first one has a robot.
    team.reaches = Box::new(move |from, to, _| {
        if from.role == to.role {
            return !split.get() || (from.index < 2) == (to.index < 2);
        }
        let (robot, station) = if from.is_robot() {
            (from, to)
        } else {
            (to, from)
        };
        match robot.index {
            0 => station == WEST && split.get(),
            _ => station == station_id(2),
        }
    });
    for number in 0..2 {
        team.issue(0, task(number, [500.0, 0.0]));
    }
    while team.transfers == 0 {
        team.step();
    }
    is_split.set(true);
    let sent = std::mem::take(&mut team.overheard);
    team.network = Network::new(Weather::default(), 1);
    for step in 1..300 {
        let now_s = team.now_s;
        if step == 85 {
            for (from, to, message) in &sent {
                if matches!(message.about, About::Trade(TradeMessage::Transfer(_))) {
                    team.network.send(*from, *to, *message, now_s);
                }
            }
        }
        if step == 165 {
            change(&mut team, |settings| Settings {
                count: 5,
                ..settings.clone()
            });
            for station in 3..5 {
                team.stations[station].controller =
                    Some(Controller::new(Arc::clone(&team.settings)));
            }
        }
        team.step();
        for number in 0..2 {
            let robots = team.robots.iter();
            let serving = robots.filter(|it| Team::serves(it, goal_id(number), team.now_s));
            assert!(serving.count() <= 1, "{number} in step {step}");
        }
    }
}
