use super::*;
use proptest::prelude::*;

const GOAL: Point = Point { x: 10.0, y: 0.0 };

fn step<'s>(remaining_m: f64, hits: &'s [Ray], movers: &'s [Mover]) -> Step<'s> {
    Step {
        goal: GOAL,
        target: Point { x: 2.0, y: 0.0 },
        remaining_m,
        turned_rad: 0.0,
        elapsed_s: 0.1,
        max_speed_m_s: 1.0,
        hits,
        movers,
    }
}

/// A wall on one side of the robot.
fn wall(side_rad: f64) -> [Ray; 3] {
    [-0.3, 0.0, 0.3].map(|off_rad| Ray::new(side_rad + off_rad, 0.5))
}

fn mover(velocity: [f64; 2]) -> Mover {
    let velocity_m_s = Point::from(velocity);
    Mover {
        id: None,
        at: Point { x: 1.5, y: 0.2 },
        velocity_m_s,
        course: velocity_m_s.times(1.0 / velocity_m_s.length()),
        radius_m: 0.25,
        braking_m_s2: 1.0,
        age_s: 0.0,
        observations: 2,
        ..Mover::default()
    }
}

fn random(number: u32) -> RandomWords {
    RandomWords::new([number, !number, number.rotate_left(7), number ^ 0x5555])
}

/// Times that a blocked robot waits before it gives way, and gives way, in seconds.
fn wait_and_yield_s(shunting: &mut Shunting, hits: &[Ray], number: u32) -> (f64, f64) {
    let mut count = |is_yielding: bool| {
        let mut steps = 0;
        while shunting.is_yielding() == is_yielding && steps < 10_000 {
            shunting.redirect(&step(5.0, hits, &[]), random(number));
            steps += 1;
        }
        0.1 * f64::from(steps)
    };
    (count(false), count(true))
}

#[test]
fn a_robot_keeps_right_of_an_oncoming_one() {
    let mut shunting = Shunting::default();
    let aside_m = |movers: &[Mover], shunting: &mut Shunting| {
        shunting.redirect(&step(5.0, &[], movers), random(1)).y
    };
    assert!(aside_m(&[mover([-1.0, 0.0])], &mut shunting) < -0.3);
    for passing in [[1.0, 0.0], [0.0, 1.0]] {
        assert!(aside_m(&[mover(passing)], &mut shunting).abs() < 1e-12);
    }
}

#[test]
fn the_left_hand_side_of_an_aisle_gives_way_sooner_than_the_right_hand_side() {
    let wait_s = |hits: &[Ray]| wait_and_yield_s(&mut Shunting::default(), hits, 1).0;
    let [left_s, open_s, right_s] = [
        wait_s(&wall(FRAC_PI_2)),
        wait_s(&[]),
        wait_s(&wall(-FRAC_PI_2)),
    ];
    assert!((left_s - 1.2).abs() < 0.25, "{left_s}");
    assert!((open_s - 2.2).abs() < 0.25, "{open_s}");
    assert!((right_s - 6.2).abs() < 0.25, "{right_s}");
}

#[test]
fn a_robot_on_the_left_hand_side_reverses() {
    let mut shunting = Shunting::default();
    let hits = wall(FRAC_PI_2);
    block_until_it_gives_way(&mut shunting, &hits);
    let target = shunting.redirect(&step(5.0, &hits, &[]), random(1));
    assert!(target.x < -1.9, "{target:?}");
}

fn block_until_it_gives_way(shunting: &mut Shunting, hits: &[Ray]) {
    let first = (0..1000).find(|_| {
        shunting.redirect(&step(5.0, hits, &[]), random(1));
        shunting.is_yielding()
    });
    assert!(first.is_some());
}

#[test]
fn a_new_goal_resets_the_blocked_time() {
    let mut shunting = Shunting::default();
    for number in 0..1000 {
        let goal = Point {
            x: f64::from(number % 2) * 5.0,
            y: 0.0,
        };
        let step = Step {
            goal,
            ..step(5.0, &[], &[])
        };
        shunting.redirect(&step, random(number));
        assert!(!shunting.is_yielding());
    }
}

proptest! {
    #[test]
    fn it_gives_way_for_longer_each_time_up_to_eighteen_seconds(number: u32) {
        let mut shunting = Shunting::default();
        let yield_s = |_| wait_and_yield_s(&mut shunting, &[], number).1;
        let times_s: Vec<f64> = (0..8).map(yield_s).collect();
        prop_assert!(times_s.iter().all(|time_s| (0.9..=18.2).contains(time_s)), "{times_s:?}");
        prop_assert!(times_s.is_sorted_by(|one, other| *one < other + 0.15), "{times_s:?}");
        prop_assert!(times_s[7] > 2.0 * times_s[0], "{times_s:?}");
    }

    #[test]
    fn a_robot_that_makes_progress_never_gives_way(number: u32, speed_m_s in 0.3_f64..1.0) {
        let mut shunting = Shunting::default();
        let (mut remaining_m, hits) = (200.0, wall(FRAC_PI_2));
        for _ in 0..400 {
            remaining_m -= speed_m_s * 0.1;
            let target = shunting.redirect(&step(remaining_m, &hits, &[]), random(number));
            prop_assert!(!shunting.is_yielding() && target.y.abs() < 1e-12);
        }
    }
}
