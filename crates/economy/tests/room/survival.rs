//! Controllers that fail: goals have an owner exactly if a majority of the controllers is left.

use crate::network::Weather;
use crate::team::{STEP_S, Team, goal_id};
use economy::Settings;

const GOALS: u32 = 6;

/// Probability that a controller fails.
const FAILURE: f64 = 0.3;

/// Number of runs for each number of controllers, unless the environment variable `RUNS` has another.
const RUNS: u32 = 200;

fn runs() -> u32 {
    let given = std::env::var("RUNS").ok();
    given.and_then(|runs| runs.parse().ok()).unwrap_or(RUNS)
}

/// Lets each controller fail with a probability at a random time, and waits until the others have recovered; returns the
/// numbers of controllers that are left and of goals with an owner.
fn survivors(members: u32, seed: u64) -> (u32, u32) {
    let settings = Settings {
        count: members,
        service_lease_s: 8.0,
        owner_lease_s: 10.0,
        max_drift: 0.01,
        ..Settings::default()
    };
    let mut team = Team::new([0, members], &settings, Weather::default(), seed);
    team.issue_random(GOALS, 100.0);
    let failures_s: Vec<Option<f64>> = (0..members)
        .map(|_| {
            let at_s = 10.0 + 30.0 * team.unit();
            (team.unit() < FAILURE).then_some(at_s)
        })
        .collect();
    for _ in 0..400 {
        team.step();
        for (station, at_s) in failures_s.iter().enumerate() {
            if at_s.is_some_and(|at_s| at_s <= team.now_s) {
                team.crash_station(station);
            }
        }
    }
    team.run(settings.recovery_s(GOALS, STEP_S, 0.0));
    let is_owned = |number: &u32| {
        let mut stations = team.stations.iter();
        stations.any(|station| Team::owns(station, goal_id(*number), team.now_s))
    };
    let owned = (0..GOALS).filter(is_owned).count();
    let left = failures_s.iter().filter(|at_s| at_s.is_none()).count();
    #[expect(clippy::cast_possible_truncation, reason = "few")]
    let counts = (left as u32, owned as u32);
    counts
}

/// The probability that a majority is left: a sum of the binomial distribution.
fn majority(members: u32) -> f64 {
    let choose = |chosen: u32| {
        (0..chosen).fold(1.0, |product, step| {
            product * f64::from(members - step) / f64::from(step + 1)
        })
    };
    let left = members / 2 + 1..=members;
    let exponent = |number: u32| i32::try_from(number).unwrap();
    left.map(|left| {
        choose(left) * (1.0 - FAILURE).powi(exponent(left)) * FAILURE.powi(exponent(members - left))
    })
    .sum()
}

/// Fixed seeds; of other seeds, one in 370 would be outside of three standard errors.
#[test]
#[expect(clippy::print_stdout, reason = "the measured shares, with --nocapture")]
fn goals_have_an_owner_exactly_if_a_majority_is_left_and_as_often_as_the_binomial_states() {
    let runs = runs();
    for members in 1..6 {
        let mut owned_runs = 0;
        for seed in 0..runs {
            let (left, owned) = survivors(members, seed.into());
            let expected = if left > members / 2 { GOALS } else { 0 };
            assert_eq!(owned, expected, "{left} of {members} left, seed {seed}");
            owned_runs += owned / GOALS;
        }
        let (runs, probability) = (f64::from(runs), majority(members));
        let share = f64::from(owned_runs) / runs;
        let deviation = (probability * (1.0 - probability) / runs).sqrt();
        println!("{members} controllers: {share:.3} of runs, binomial {probability:.3}");
        assert!(
            (share - probability).abs() <= 3.0 * deviation,
            "{members} controllers: {share} instead of {probability}"
        );
    }
}
