//! Missions: whether the goals are served.

use crate::network::Weather;
use crate::team::{Team, brain, goal_id, task};
use brain::Task;
use economy::{Allocation, Settings};

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
fn the_backup_serves_the_goals_of_a_controller_that_is_lost() {
    let mut team = Team::new([3, 2], &settings(), Weather::default(), 3);
    team.issue_random(12, 100.0);
    team.run(12.0);
    team.crash_station(0);
    team.run(1.1 * (30.0 + 20.0) + 2.0);
    let known = |team: &Team| {
        let backup = team.controller(1);
        let owned = backup.goals().map(|goal| goal.task.id).chain(backup.done());
        let own = owned.filter(|goal| goal.number % 2 == 0);
        own.count()
    };
    assert_eq!(known(&team), 6);
    // The lost controller was the backup of the others: they lose their owner, unless they are done.
    team.reissue_lost(1);
    team.run_until_done(12, 600.0);
    assert_eq!(team.done(), 12);
}

#[test]
fn a_goal_whose_backup_is_lost_loses_its_owner_and_can_be_issued_again() {
    let mut team = Team::new([1, 2], &settings(), Weather::default(), 3);
    let far = Task {
        capability: 9,
        ..task(0, [50.0, 50.0])
    };
    team.issue(0, far);
    team.run(20.0);
    assert!(team.controller(0).goals().next().unwrap().backup.is_some());
    team.crash_station(1);
    team.run(40.0);
    let lost = team.controller(0).lost().map(|task| task.id);
    assert!(lost.eq([goal_id(0)]));
    assert_eq!(team.controller(0).goals().count(), 0);
    team.issue(0, far);
    team.run(1.0);
    assert_eq!(team.controller(0).goals().count(), 1);
    assert_eq!(team.controller(0).lost().count(), 0);
}

#[test]
fn a_backup_returns_the_goals_of_a_controller_that_is_in_range_again() {
    let mut team = Team::new([1, 2], &settings(), Weather::default(), 3);
    let impossible = Task {
        capability: 9,
        ..task(0, [50.0, 50.0])
    };
    team.issue(0, impossible);
    team.run(20.0);
    team.stations[0].is_cut_off = true;
    team.run(60.0);
    assert_eq!(team.controller(1).goals().count(), 1);
    assert_eq!(team.controller(0).goals().count(), 0);
    team.stations[0].is_cut_off = false;
    team.run(30.0);
    assert_eq!(team.controller(0).goals().count(), 1);
    assert_eq!(team.controller(1).goals().count(), 0);
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
