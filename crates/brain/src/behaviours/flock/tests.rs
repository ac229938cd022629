use super::*;
use crate::behaviours::BehaviourSpec;
use crate::{AgentId, Brain, BrainSpec, Percept};
use proptest::prelude::*;
use std::sync::Arc;

/// It can turn to any heading in one step of 1 s.
fn body() -> Body {
    Body {
        max_speed_m_s: 2.0,
        max_turn_rate_rad_s: 4.0,
        period_s: 1.0,
        ..Body::default()
    }
}

fn brain(flock: Flock) -> Brain {
    let spec = BrainSpec {
        behaviours: vec![BehaviourSpec::Flock(flock)],
        ..BrainSpec::default()
    };
    Brain::new(Arc::new(spec), Arc::new(body()))
}

fn at(x: f64, y: f64, course_rad: f64) -> Neighbour {
    Neighbour {
        range_m: x.hypot(y),
        bearing_rad: y.atan2(x),
        course_rad: Some(course_rad),
        age_s: 0.0,
        uncertainty_m: 0.0,
        id: AgentId::default(),
    }
}

/// The angle of its turn.
fn turn_rad(flock: Flock, neighbours: Vec<Neighbour>) -> f64 {
    let percept = Percept {
        neighbours,
        ..Percept::default()
    };
    brain(flock).step(&percept).motion.turn_rate_rad_s
}

const NOTHING: Flock = Flock {
    separation_m: 2.0,
    separation: 0.0,
    alignment: 0.0,
    cohesion: 0.0,
    averages: true,
    steering_limit: 1e9,
    noise_deg: 0.0,
    speed_m_s: None,
};

fn assert_turns(flock: Flock, neighbours: Vec<Neighbour>, expected_rad: f64) {
    let turned_rad = turn_rad(flock, neighbours);
    assert!(
        (turned_rad - expected_rad).abs() < 1e-12,
        "{turned_rad} for {expected_rad}"
    );
}

#[test]
fn alone_it_drives_straight_on() {
    assert_turns(Flock::default(), vec![], 0.0);
    let motion = brain(Flock::default()).step(&Percept::default()).motion;
    assert!((motion.speed_m_s - 2.0).abs() < 1e-12);
}

#[test]
fn it_turns_to_the_others_away_from_those_too_near_and_to_their_heading() {
    let flock = Flock {
        cohesion: 0.5,
        ..NOTHING
    };
    // Half of the mean vector to (1, 3) and (1, 5) plus its own heading: (1.5, 2).
    assert_turns(
        flock,
        vec![at(1.0, 3.0, 0.0), at(1.0, 5.0, 0.0)],
        2_f64.atan2(1.5),
    );
    let flock = Flock {
        separation: 1.0,
        ..NOTHING
    };
    // Only one of the two is too near, but the mean is over both.
    assert_turns(
        flock,
        vec![at(0.0, 1.0, 0.0), at(0.0, 5.0, 0.0)],
        (-0.5_f64).atan2(1.0),
    );
    let flock = Flock {
        alignment: 1.0,
        ..NOTHING
    };
    assert_turns(flock, vec![at(4.0, 1.0, 2.0)], 1.0);
}

#[test]
fn the_flock_of_the_comparison_of_frameworks_is_a_configuration() {
    let flock = Flock {
        separation_m: 4.0,
        separation: 0.015,
        alignment: 0.05,
        cohesion: 0.03,
        ..Flock::default()
    };
    let others = [(3.0, 1.0, 0.5), (-9.0, 7.0, -2.0), (-0.5, -1.0, 3.0)];
    // Their implementation, in the order of their lines.
    let (mut cohere, mut separate, mut matched) = ([0.0; 2], [0.0; 2], [0.0; 2]);
    for (x, y, course) in others {
        let far = f64::hypot(x, y);
        for (axis, way) in [x, y].into_iter().enumerate() {
            cohere[axis] += way;
            separate[axis] -= if far < 4.0 { way } else { 0.0 };
        }
        matched[0] += f64::cos(course);
        matched[1] += f64::sin(course);
    }
    let sum = |axis: usize| {
        cohere[axis] / 3.0 * 0.03 + separate[axis] / 3.0 * 0.015 + matched[axis] / 3.0 * 0.05
    };
    let expected_rad = sum(1).atan2(1.0 + sum(0));
    let others = others.map(|(x, y, course)| at(x, y, course));
    assert_turns(flock, others.to_vec(), expected_rad);
}

#[test]
fn with_sums_its_own_heading_counts_as_one_of_the_mean() {
    let vicsek = Flock {
        alignment: 1.0,
        averages: false,
        ..NOTHING
    };
    let courses = [0.4, 1.1, -2.5];
    let (y, x) = courses.iter().fold((0.0, 1.0), |(y, x), course: &f64| {
        (y + course.sin(), x + course.cos())
    });
    let others = courses.map(|course| at(1.0, 1.0, course));
    assert_turns(vicsek, others.to_vec(), f64::atan2(y, x));
}

#[test]
fn separation_takes_precedence_over_alignment_and_cohesion() {
    let flock = |steering_limit: f64| Flock {
        separation: 1.0,
        alignment: 1.0,
        cohesion: 1.0,
        steering_limit,
        ..NOTHING
    };
    // The requests are (0, -1) for separation, (0, 1) for alignment and (0, 1) for cohesion.
    let other = at(0.0, 1.0, std::f64::consts::FRAC_PI_2);
    let y = |limit: f64| turn_rad(flock(limit), vec![other]).tan();
    for (limit, expected) in [
        (0.0, 0.0),
        (0.5, -0.5),
        (1.0, -1.0),
        (1.5, -0.5),
        (2.5, 0.5),
        (9.0, 1.0),
    ] {
        assert!((y(limit) - expected).abs() < 1e-12, "{limit}: {}", y(limit));
    }
}

#[test]
fn noise_is_uniform_over_its_width() {
    let flock = Flock {
        noise_deg: 90.0,
        ..NOTHING
    };
    let mut brain = brain(flock);
    let mut turn_rad = |word: u32| {
        let percept = Percept {
            random_words: [word; 4],
            ..Percept::default()
        };
        brain.step(&percept).motion.turn_rate_rad_s
    };
    for (share, expected_deg) in [(0.0, -45.0), (0.25, -22.5), (0.5, 0.0), (0.75, 22.5)] {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a share of all words"
        )]
        let word = (share * 4_294_967_296.0) as u32;
        assert!(
            (turn_rad(word).to_degrees() - expected_deg).abs() < 1e-9,
            "{share}"
        );
    }
}

#[test]
fn old_and_invalid_neighbours_are_ignored() {
    let broken = [f64::NAN, f64::INFINITY, -f64::INFINITY, -1.0, 1e300];
    let one = at(0.0, 3.0, 1.0);
    let by_range = broken.map(|range_m| Neighbour { range_m, ..one });
    let by_age = broken.map(|age_s| Neighbour { age_s, ..one });
    for other in by_range.into_iter().chain(by_age) {
        assert_turns(Flock::default(), vec![other], 0.0);
    }
    for bearing_rad in [f64::NAN, f64::INFINITY, 1e300] {
        assert_turns(
            Flock::default(),
            vec![Neighbour { bearing_rad, ..one }],
            0.0,
        );
    }
    let uncoursed = [None, Some(f64::NAN), Some(f64::INFINITY), Some(1e300)];
    for course_rad in uncoursed {
        let flock = Flock {
            cohesion: 0.0,
            ..Flock::default()
        };
        assert_turns(flock, vec![Neighbour { course_rad, ..one }], 0.0);
    }
}

fn any_number() -> impl Strategy<Value = f64> {
    prop_oneof![
        -20.0..20.0,
        any::<f64>(),
        Just(f64::NAN),
        Just(f64::INFINITY)
    ]
}

prop_compose! {
    fn any_neighbour()(
        range_m in any_number(), bearing_rad in any_number(), age_s in any_number(),
        course_rad in prop::option::of(any_number()), index: u32,
    ) -> Neighbour {
        Neighbour { range_m, bearing_rad, course_rad, age_s, uncertainty_m: 0.0, id: AgentId::robot(0, index) }
    }
}

proptest! {
    #[test]
    fn commands_are_within_the_limits_for_any_percept(
        neighbours in prop::collection::vec(any_neighbour(), 0..30),
        (separation, alignment, cohesion) in (0.0..=1000.0, 0.0..=1000.0, 0.0..=1000.0),
        (steering_limit, noise_deg) in (0.0..=1e9, 0.0..=360.0), averages: bool, random_words: [u32; 4],
    ) {
        let flock = Flock {
            separation, alignment, cohesion, averages, steering_limit, noise_deg, ..NOTHING
        };
        let percept = Percept { random_words, neighbours, ..Percept::default() };
        let motion = brain(flock).step(&percept).motion;
        prop_assert!((motion.speed_m_s - 2.0).abs() < 1e-12);
        prop_assert!(motion.turn_rate_rad_s.abs() <= 4.0);
    }
}
