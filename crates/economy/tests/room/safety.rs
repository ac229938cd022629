//! Safety: at every instant of true time, a goal has at most one valid owner and at most one valid
//! assignee, whatever an adversary does to messages, clocks and agents.

use crate::network::Weather;
use crate::team::{STEP_S, Team, goal_id};
use brain::{About, GoalId, Price, TradeMessage, Transfer};
use economy::{Settings, Trade};
use proptest::prelude::*;

/// Number of schedules, unless the environment variable `SCHEDULES` has another.
const SCHEDULES: u32 = 150;

/// Instants per step at which the rule is checked.
const INSTANTS: u32 = 4;

const GOALS: u32 = 4;

/// What the adversary chooses.
#[derive(Debug, Clone, Copy)]
struct Adversary {
    seed: u64,
    /// Number of controllers, whether they trade, and whether each owns its goals alone.
    members: u32,
    trades: bool,
    is_alone: bool,
    weather: Weather,
    /// Durations of leases: short, so that many end.
    service_lease_s: f64,
    owner_lease_s: f64,
    /// Probabilities per step of a crash, a restart, and a change of the radio.
    crash: f64,
    restart: f64,
    change: f64,
}

fn adversary() -> impl Strategy<Value = Adversary> {
    let weather = (0.0..1.0_f64, 0.0..0.5_f64, 0.0..30.0_f64);
    let weather = weather.prop_map(|(loss, duplication, max_delay_s)| Weather {
        min_delay_s: 0.0,
        loss: loss * loss,
        duplication,
        max_delay_s,
    });
    let faults = (0.0..0.02_f64, 0.01..0.1_f64, 0.0..0.05_f64);
    let leases = (3.0..8.0_f64, 3.0..8.0_f64);
    let team = (any::<u64>(), 2..6_u32, any::<bool>(), any::<bool>());
    (team, weather, leases, faults).prop_map(|(team, weather, leases, faults)| Adversary {
        seed: team.0,
        members: team.1,
        trades: team.2,
        is_alone: team.2 && team.3,
        weather,
        service_lease_s: leases.0,
        owner_lease_s: leases.1,
        crash: faults.0,
        restart: faults.1,
        change: faults.2,
    })
}

/// Clocks drift much.
fn settings(adversary: &Adversary) -> Settings {
    Settings {
        max_goals: if adversary.trades { 3 } else { 1000 },
        service_lease_s: adversary.service_lease_s,
        owner_lease_s: adversary.owner_lease_s,
        auction_s: 0.3,
        trade: adversary.trades.then_some(Trade {
            confidence: 0.0,
            gain: 0.99,
        }),
        max_drift: 0.1,
        ..Settings::default()
    }
}

fn disturb(team: &mut Team, adversary: &Adversary) {
    for index in 0..team.robots.len() {
        if team.unit() < adversary.crash {
            team.crash_robot(index);
        } else if team.unit() < adversary.restart {
            team.restart_robot(index);
        }
    }
    for index in 0..team.stations.len() {
        if team.unit() < adversary.crash / 2.0 {
            team.crash_station(index);
        } else if team.unit() < adversary.restart {
            team.restart_station(index);
        }
        if team.unit() < adversary.change / 2.0 {
            team.stations[index].is_cut_off ^= true;
        }
    }
    if team.unit() < adversary.change {
        let is_calm = team.unit() < 0.5;
        let loss = if is_calm { 0.0 } else { adversary.weather.loss };
        team.network.weather.loss = loss;
    }
}

#[expect(clippy::cast_precision_loss, reason = "few messages")]
fn number(count: usize) -> f64 {
    count as f64
}

/// Sends an old message between controllers again, or one about a goal with numbers of its own.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "random numbers"
)]
fn forge(team: &mut Team) {
    if team.overheard.is_empty() || team.unit() > 0.2 {
        return;
    }
    let index = (team.unit() * number(team.overheard.len())) as usize;
    let (from, to, mut message) = team.overheard[index];
    if team.unit() < 0.5 {
        let bits = (team.unit() * 4e9) as u32;
        message.about = match message.about {
            About::Trade(TradeMessage::Price(price)) => TradeMessage::Price(Price {
                number: bits,
                cost_s: 0.0,
                ..price
            })
            .into(),
            About::Trade(TradeMessage::Transfer(transfer)) => TradeMessage::Transfer(Transfer {
                price: bits,
                ..transfer
            })
            .into(),
            about => about,
        };
    }
    let now_s = team.now_s;
    team.network.send(from, to, message, now_s);
    if team.overheard.len() > 2000 {
        team.overheard.drain(..1000);
    }
}

/// Owners and assignees of a goal at a true time.
fn counts(team: &Team, goal: GoalId, true_s: f64) -> [usize; 2] {
    let owners = team
        .stations
        .iter()
        .filter(|station| Team::owns(station, goal, true_s));
    let assignees = team
        .robots
        .iter()
        .filter(|robot| Team::serves(robot, goal, true_s));
    [owners.count(), assignees.count()]
}

/// Steps in which each goal had an owner, and in which it had an assignee, and the number of transfers.
fn check(adversary: &Adversary) -> Result<[usize; 3], TestCaseError> {
    let new = if adversary.is_alone {
        Team::alone
    } else {
        Team::new
    };
    let mut team = new(
        [3, adversary.members],
        &settings(adversary),
        adversary.weather,
        adversary.seed,
    );
    if adversary.trades {
        // Two of three robots are in range of every other controller only: the rest have few bids.
        team.reaches = Box::new(move |from, to, _| {
            let (robot, station) = if from.is_robot() {
                (from, to)
            } else {
                (to, from)
            };
            from.role == to.role || station.index % 2 == 1 || robot.index == 2
        });
    }
    // Too far to be served.
    team.issue_random(GOALS, 1e6);
    let mut sums = [0, 0];
    for step in 0..800 {
        if step > 50 {
            disturb(&mut team, adversary);
            forge(&mut team);
        }
        team.step();
        for instant in 0..INSTANTS {
            let true_s = team.now_s + STEP_S * f64::from(instant) / f64::from(INSTANTS);
            for goal in (0..GOALS).map(goal_id) {
                let [owners, assignees] = counts(&team, goal, true_s);
                prop_assert!(owners <= 1, "{owners} owners of {goal:?} at {true_s} s");
                prop_assert!(
                    assignees <= 1,
                    "{assignees} assignees of {goal:?} at {true_s} s"
                );
                sums = [sums[0] + owners, sums[1] + assignees];
            }
        }
    }
    Ok([sums[0], sums[1], team.transfers])
}

fn schedules() -> u32 {
    let given = std::env::var("SCHEDULES").ok();
    given
        .and_then(|number| number.parse().ok())
        .unwrap_or(SCHEDULES)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: schedules(), max_shrink_iters: 20, ..ProptestConfig::default() })]

    #[test]
    fn a_goal_never_has_two_owners_or_two_assignees(adversary in adversary()) {
        check(&adversary)?;
    }
}

/// An adversary that is not severe.
fn mild(trades: bool, is_alone: bool) -> Adversary {
    Adversary {
        seed: 1,
        members: 3,
        trades,
        is_alone,
        weather: Weather {
            min_delay_s: 0.0,
            loss: 0.3,
            duplication: 0.3,
            max_delay_s: 3.0,
        },
        service_lease_s: 5.0,
        owner_lease_s: 6.0,
        crash: 0.001,
        restart: 0.05,
        change: 0.02,
    }
}

#[test]
fn the_adversary_does_not_prevent_trade() {
    for is_alone in [false, true] {
        let with_seed = |seed| Adversary {
            seed,
            ..mild(true, is_alone)
        };
        let transfers = (0..10).map(|seed| check(&with_seed(seed)).unwrap()[2]);
        let transfers: usize = transfers.sum();
        assert!(transfers >= 10, "{transfers} {is_alone}");
    }
}

#[test]
fn the_adversary_does_not_prevent_ownership_and_service() {
    let [owned, assigned, _] = check(&mild(false, false)).unwrap();
    let all = 800 * (GOALS * INSTANTS) as usize;
    assert!(
        owned > all / 4 && assigned > all / 6,
        "{owned} {assigned} of {all}"
    );
}
