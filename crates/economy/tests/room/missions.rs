//! Missions: whether the goals are served.

use crate::network::Weather;
use crate::team::{Team, brain, goal_id, task};
use brain::{About, ContractMessage, Message, Reason, Task};
use economy::{Allocation, Controller, Settings};
use std::sync::Arc;

fn settings() -> Settings {
    Settings {
        max_drift: 0.01,
        ..Settings::default()
    }
}

#[test]
fn without_loss_every_goal_is_served_once_whatever_the_rule() {
    for allocation in [
        Allocation::Auction,
        Allocation::Nearest,
        Allocation::Optimal,
    ] {
        for stations in [1, 2] {
            let settings = Settings {
                allocation,
                ..settings()
            };
            let mut team = Team::new([4, stations], &settings, Weather::default(), 7);
            team.issue_random(20, 100.0);
            team.run_until_done(20, 600.0);
            assert_eq!(team.done(), 20, "{allocation:?} {stations}");
            assert_eq!(team.served.len(), 20, "{allocation:?} {stations}");
        }
    }
}

#[test]
fn without_allocation_goals_are_owned_and_not_served() {
    let settings = Settings {
        allocation: Allocation::None,
        ..settings()
    };
    let mut team = Team::new([2, 1], &settings, Weather::default(), 7);
    team.issue_random(5, 100.0);
    team.run(60.0);
    assert_eq!(team.controller(0).goals().count(), 5);
    assert!(
        team.controller(0)
            .goals()
            .all(|goal| goal.assignee.is_none())
    );
    assert!(team.served.is_empty());
}

#[test]
fn at_ten_percent_loss_every_goal_is_served() {
    for seed in 0..10 {
        let weather = Weather {
            loss: 0.1,
            max_delay_s: 0.5,
            ..Weather::default()
        };
        let mut team = Team::new([4, 2], &settings(), weather, seed);
        team.issue_random(20, 100.0);
        team.run_until_done(20, 900.0);
        assert_eq!(team.done(), 20, "{seed}");
    }
}

#[test]
fn a_robot_that_is_lost_loses_its_goals_to_the_others() {
    let mut team = Team::new([3, 1], &settings(), Weather::default(), 3);
    team.issue_random(12, 100.0);
    team.run(20.0);
    team.crash_robot(0);
    team.run_until_done(12, 600.0);
    assert_eq!(team.done(), 12);
    let controller = team.controller(0);
    assert!(controller.lapses() > 0 && controller.awards() == 12 + controller.lapses());
}

#[test]
fn the_loss_of_any_minority_of_controllers_loses_no_goal() {
    for (stations, lost) in [
        (3, vec![0]),
        (3, vec![2]),
        (4, vec![1]),
        (5, vec![0, 4]),
        (5, vec![1, 3]),
    ] {
        let mut team = Team::new([3, stations], &settings(), Weather::default(), 3);
        team.issue_random(12, 100.0);
        team.run(12.0);
        for station in &lost {
            team.crash_station(*station);
        }
        team.run_until_done(12, 900.0);
        assert_eq!(team.done(), 12, "{stations} {lost:?}");
        let is_lost = |message: &Message| {
            matches!(message.about, About::Contract(ContractMessage::Stuck(report))
                if report.reason == Reason::OwnershipLost)
        };
        assert!(!team.to_operator.iter().any(is_lost), "{stations} {lost:?}");
    }
}

#[test]
fn the_working_controller_with_the_highest_serial_number_takes_over() {
    for (lost, next) in [(0, 2), (1, 2), (2, 1)] {
        let mut team = Team::new([1, 3], &settings(), Weather::default(), 3);
        let far = task(0, [1e6, 0.0]);
        team.issue(lost, far);
        team.run(10.0);
        team.crash_station(lost);
        team.run(60.0);
        let owners = (0..3).filter(|it| *it != lost && team.controller(*it).goals().count() == 1);
        assert!(owners.eq([next]), "{lost}");
    }
}

#[test]
fn without_a_majority_no_controller_owns_a_goal_and_that_is_reported() {
    for (stations, lost, survivor) in [(2, vec![1], 0), (2, vec![0], 1), (3, vec![0, 1], 2)] {
        let mut team = Team::new([1, stations], &settings(), Weather::default(), 3);
        team.issue(0, task(0, [1e6, 0.0]));
        team.run(20.0);
        for station in lost {
            team.crash_station(station);
        }
        team.run(60.0);
        let controller = team.controller(survivor);
        assert_eq!(controller.goals().count(), 0);
        let lost = controller.lost().map(|task| task.id);
        assert!(lost.eq([goal_id(0)]));
        assert!(!team.to_operator.is_empty());
    }
}

#[test]
fn a_controller_without_a_majority_owns_its_goals_again_when_one_is_back() {
    let mut team = Team::new([1, 3], &settings(), Weather::default(), 3);
    team.issue(0, task(0, [1e6, 0.0]));
    team.run(20.0);
    for station in &mut team.stations {
        station.is_cut_off = true;
    }
    team.run(60.0);
    let owners = |team: &Team| {
        (0..3)
            .map(|it| team.controller(it).goals().count())
            .sum::<usize>()
    };
    assert_eq!(owners(&team), 0);
    for station in &mut team.stations {
        station.is_cut_off = false;
    }
    team.run(30.0);
    assert_eq!(owners(&team), 1);
}

#[test]
fn a_goal_that_no_robot_can_serve_is_reported_once_and_blocks_no_other() {
    let mut team = Team::new([2, 1], &settings(), Weather::default(), 5);
    team.issue(
        0,
        Task {
            capability: 9,
            ..task(99, [50.0, 50.0])
        },
    );
    team.issue_random(8, 100.0);
    team.run_until_done(8, 600.0);
    assert_eq!(team.done(), 8);
    team.run(120.0);
    assert_eq!(team.to_operator.len(), 1, "{:?}", team.to_operator);
    let unserved = |team: &Team| {
        let left: Vec<_> = team.controller(0).goals().collect();
        assert_eq!(left[0].task.id, goal_id(99));
        left[0].unserved
    };
    // From time to time it is tried again.
    let mut tries = 0;
    while unserved(&team).is_none() && tries < 60 {
        team.run(1.0);
        tries += 1;
    }
    assert_eq!(unserved(&team), Some(brain::Reason::Capability));
    // A robot that can serve it comes into range.
    team.robots[0].brain = Some(brain(&[9], ""));
    team.robots[0].id = crate::team::robot_id(7);
    team.run_until_done(9, 60.0);
    assert_eq!(team.done(), 9);
}

#[test]
fn a_full_controller_refuses_goals() {
    let settings = Settings {
        max_goals: 3,
        ..settings()
    };
    let mut team = Team::new([1, 1], &settings, Weather::default(), 5);
    team.issue_random(5, 100.0);
    team.run(1.0);
    assert_eq!(team.controller(0).refused(), 2);
    assert_eq!(team.controller(0).goals().count(), 3);
}

#[test]
fn controllers_that_join_wait_as_long_as_leases_under_earlier_settings() {
    let before = Settings {
        max_drift: 0.0,
        service_lease_s: 60.0,
        ..Settings::default()
    };
    let mut team = Team::new([2, 3], &before, Weather::default(), 5);
    team.stations[0].controller = Some(Controller::new(Arc::new(before)));
    team.crash_station(1);
    team.crash_station(2);
    team.issue(0, task(0, [1e6, 0.0]));
    // One robot reaches the first controller only, the other one the others.
    team.reaches =
        Box::new(|from, to, _| from.role == to.role || (from.index == 0) == (to.index == 0));
    team.run(5.0);
    let serves =
        |team: &Team, robot: usize| Team::serves(&team.robots[robot], goal_id(0), team.now_s);
    assert!(serves(&team, 0));
    let after = Arc::new(Settings {
        max_drift: 0.0,
        count: 3,
        service_lease_s: 2.0,
        owner_lease_s: 3.0,
        ..Settings::default()
    });
    let mut first = team.stations[0].controller.take().unwrap();
    first = first.with_settings_of(&Controller::new(Arc::clone(&after)));
    for station in [1, 2] {
        let mut joined = Controller::new(Arc::clone(&after));
        joined.join(&first);
        team.stations[station].controller = Some(joined);
    }
    team.stations[0].controller = Some(first);
    team.run(5.0);
    team.crash_station(0);
    for _ in 0..900 {
        team.step();
        assert!(!(serves(&team, 0) && serves(&team, 1)), "{}", team.now_s);
    }
    assert!(serves(&team, 1));
}

#[test]
fn many_goals_have_an_owner_or_a_candidate_and_are_not_reported_as_lost() {
    let mut team = Team::new([0, 5], &settings(), Weather::default(), 3);
    team.issue_random(600, 100.0);
    team.run(40.0);
    team.crash_station(0);
    team.run(100.0);
    let owned = (1..5).map(|station| team.controller(station).goals().count());
    assert_eq!(owned.sum::<usize>(), 600);
    let is_lost = |message: &Message| {
        matches!(message.about, About::Contract(ContractMessage::Stuck(report))
            if report.reason == Reason::OwnershipLost)
    };
    assert_eq!(team.to_operator.iter().filter(|it| is_lost(it)).count(), 0);
}
