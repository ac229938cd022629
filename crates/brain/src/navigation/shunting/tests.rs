use super::*;
use proptest::prelude::*;

const AIM: Point = Point { x: 10.0, y: 0.0 };

fn step<'s>(away_m: f64, hits: &'s [Ray], movers: &'s [Mover]) -> Step<'s> {
    Step {
        aim: AIM,
        way: Point { x: 2.0, y: 0.0 },
        left_m: away_m,
        turned_rad: 0.0,
        period_s: 0.1,
        max_speed_m_s: 1.0,
        hits,
        movers,
    }
}

/// The wall of an aisle on one side.
fn wall(side_rad: f64) -> [Ray; 3] {
    [-0.3, 0.0, 0.3].map(|off_rad| Ray::new(side_rad + off_rad, 0.5))
}

fn coming(velocity: [f64; 2]) -> Mover {
    let velocity_m_s = Point::from(velocity);
    Mover {
        id: None,
        at: Point { x: 1.5, y: 0.2 },
        velocity_m_s,
        course: velocity_m_s.times(1.0 / velocity_m_s.length()),
        radius_m: 0.25,
        braking_m_s2: 1.0,
        age_s: 0.0,
        looks: 2,
    }
}

fn dice(number: u32) -> RandomWords {
    RandomWords::new([number, !number, number.rotate_left(7), number ^ 0x5555])
}

/// After how many seconds of standing it gives way, and for how long.
fn stuck_s(shunting: &mut Shunting, hits: &[Ray], number: u32) -> (f64, f64) {
    let mut count = |gives_way: bool| {
        let mut steps = 0;
        while shunting.gives_way() == gives_way && steps < 10_000 {
            shunting.instead(&step(5.0, hits, &[]), dice(number));
            steps += 1;
        }
        0.1 * f64::from(steps)
    };
    (count(false), count(true))
}

#[test]
fn who_meets_another_head_on_keeps_right() {
    let mut shunting = Shunting::default();
    let ahead = |movers: &[Mover], shunting: &mut Shunting| {
        shunting.instead(&step(5.0, &[], movers), dice(1)).y
    };
    assert!(ahead(&[coming([-1.0, 0.0])], &mut shunting) < -0.3);
    for passing in [[1.0, 0.0], [0.0, 1.0]] {
        assert!(ahead(&[coming(passing)], &mut shunting).abs() < 1e-12);
    }
}

#[test]
fn the_left_hand_side_of_an_aisle_gives_way_sooner_than_the_right_hand_side() {
    let first_s = |hits: &[Ray]| stuck_s(&mut Shunting::default(), hits, 1).0;
    let [left_s, nowhere_s, right_s] = [
        first_s(&wall(FRAC_PI_2)),
        first_s(&[]),
        first_s(&wall(-FRAC_PI_2)),
    ];
    assert!((left_s - 1.2).abs() < 0.25, "{left_s}");
    assert!((nowhere_s - 2.2).abs() < 0.25, "{nowhere_s}");
    assert!((right_s - 6.2).abs() < 0.25, "{right_s}");
}

#[test]
fn the_one_on_the_left_goes_straight_back() {
    let mut shunting = Shunting::default();
    let hits = wall(FRAC_PI_2);
    stuck_until_it_gives_way(&mut shunting, &hits);
    let way = shunting.instead(&step(5.0, &hits, &[]), dice(1));
    assert!(way.x < -1.9, "{way:?}");
}

fn stuck_until_it_gives_way(shunting: &mut Shunting, hits: &[Ray]) {
    let give_up = (0..1000).find(|_| {
        shunting.instead(&step(5.0, hits, &[]), dice(1));
        shunting.gives_way()
    });
    assert!(give_up.is_some());
}

#[test]
fn another_aim_begins_anew() {
    let mut shunting = Shunting::default();
    for number in 0..1000 {
        let aim = Point {
            x: f64::from(number % 2) * 5.0,
            y: 0.0,
        };
        let step = Step {
            aim,
            ..step(5.0, &[], &[])
        };
        shunting.instead(&step, dice(number));
        assert!(!shunting.gives_way());
    }
}

proptest! {
    #[test]
    fn it_gives_way_for_longer_each_time_but_no_longer_than_eighteen_seconds(number: u32) {
        let mut shunting = Shunting::default();
        let times_s: Vec<f64> = (0..8).map(|_| stuck_s(&mut shunting, &[], number).1).collect();
        prop_assert!(times_s.iter().all(|time_s| (0.9..=18.2).contains(time_s)), "{times_s:?}");
        prop_assert!(times_s.is_sorted_by(|one, other| *one < other + 0.15), "{times_s:?}");
        prop_assert!(times_s[7] > 2.0 * times_s[0], "{times_s:?}");
    }

    #[test]
    fn who_gets_on_never_gives_way(number: u32, speed_m_s in 0.3_f64..1.0) {
        let mut shunting = Shunting::default();
        let mut away_m = 200.0;
        for _ in 0..400 {
            away_m -= speed_m_s * 0.1;
            let way = shunting.instead(&step(away_m, &wall(FRAC_PI_2), &[]), dice(number));
            prop_assert!(!shunting.gives_way() && way.y.abs() < 1e-12);
        }
    }
}
