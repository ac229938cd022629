//! A valuable goal displaces one of less value when all robots are full.

use crate::network::Weather;
use crate::team::{Team, brain, goal_id, task};
use base::geometry::Point;
use brain::Task;
use economy::Settings;

/// One robot that serves one goal at a time, 100 m away, and another goal that arrives later.
fn team(later: Task) -> Team {
    let settings = Settings {
        max_drift: 0.0,
        ..Settings::default()
    };
    let mut team = Team::new([1, 1], &settings, Weather::default(), 3);
    team.robots[0].brain = Some(brain(&[], r#", "max_goals": 1"#));
    team.robots[0].at = Point::default();
    team.issue(0, task(0, [100.0, 0.0]));
    team.run(8.0);
    assert!(
        team.controller(0)
            .goals()
            .all(|goal| goal.assignee.is_some())
    );
    team.issue(0, later);
    team
}

fn valuable(value: f32) -> Task {
    Task {
        value,
        ..task(1, [0.0, 60.0])
    }
}

#[test]
fn a_goal_of_twice_the_value_is_served_first_and_then_the_other() {
    let mut team = team(valuable(2.0));
    team.run_until_done(1, 200.0);
    assert!(team.controller(0).done().eq([goal_id(1)]));
    team.run_until_done(2, 200.0);
    assert_eq!(team.done(), 2);
    assert_eq!(team.controller(0).awards(), 3);
}

#[test]
fn a_goal_of_equal_or_little_more_value_displaces_none() {
    for value in [0.5, 1.0, 1.9] {
        let mut team = team(valuable(value));
        team.run_until_done(1, 200.0);
        assert!(team.controller(0).done().eq([goal_id(0)]), "{value}");
        team.run_until_done(2, 200.0);
        assert_eq!(
            (team.done(), team.controller(0).awards()),
            (2, 2),
            "{value}"
        );
    }
}

#[test]
fn a_goal_whose_service_has_begun_is_not_displaced() {
    let mut team = team(valuable(0.0));
    // Until it is there.
    while team.robots[0].at.x < 98.0 {
        team.step();
    }
    team.issue(
        0,
        Task {
            value: 9.0,
            ..task(2, [0.0, 60.0])
        },
    );
    team.run_until_done(1, 200.0);
    assert_eq!(team.controller(0).done().next(), Some(goal_id(0)));
}

#[test]
fn a_goal_that_a_full_robot_cannot_serve_displaces_none() {
    let mut team = team(Task {
        capability: 9,
        ..valuable(9.0)
    });
    team.run_until_done(1, 200.0);
    assert!(team.controller(0).done().eq([goal_id(0)]));
    assert_eq!(team.controller(0).awards(), 1);
}

#[test]
fn among_many_goals_of_many_values_awards_are_few_and_all_are_served() {
    for seed in 0..10 {
        let settings = Settings {
            max_drift: 0.0,
            ..Settings::default()
        };
        let mut team = Team::new([2, 1], &settings, Weather::default(), seed);
        for robot in &mut team.robots {
            robot.brain = Some(brain(&[], r#", "max_goals": 1"#));
        }
        for number in 0..16_u8 {
            let at_m = [37, 61].map(|by: u16| f32::from(by * u16::from(number + 1) % 100));
            let value = f32::from(1_u8 << (number % 6));
            team.issue(
                0,
                Task {
                    value,
                    ..task(number.into(), at_m)
                },
            );
            team.run(6.0);
        }
        team.run_until_done(16, 1500.0);
        assert_eq!(team.done(), 16, "{seed}");
        let awards = team.controller(0).awards();
        assert!(awards <= 2 * 16, "{seed}: {awards}");
    }
}
