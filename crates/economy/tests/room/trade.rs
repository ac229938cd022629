//! Trade: goals go to the controller that can have them served, whatever is lost, fails or lies.

use crate::network::Weather;
use crate::team::{Team, brain, goal_id, station_id, task};
use brain::{
    About, AgentId, Award, Claim, Entrust, LeaseMessage, Message, OwnershipMessage, Price, Task,
    TradeMessage,
};
use economy::{Allocation, Settings, Trade};

const WEST: AgentId = station_id(0);
const EAST: AgentId = station_id(1);

fn settings() -> Settings {
    Settings {
        max_drift: 0.0,
        trade: Some(Trade::default()),
        ..Settings::default()
    }
}

/// Robots reach only the controller of their half; controllers reach each other.
fn in_halves(from: AgentId, to: AgentId, _: &Message) -> bool {
    let halves = [from, to].map(|id| id.index % 2);
    from.role == to.role || halves[0] == halves[1] || [from, to].contains(&station_id(2))
}

/// A goal in one half, which only the robots of that half can serve.
fn goal_in(half: u8, number: u32) -> Task {
    let [across_m, along_m] = [number % 5, number / 5].map(|it| 10.0 * f64::from(it));
    let start_m = if half == 0 { 0.0 } else { 200.0 };
    #[expect(clippy::cast_possible_truncation, reason = "messages are short")]
    let at_m = [start_m + across_m, along_m].map(|along_m| along_m as f32);
    Task {
        capability: half + 1,
        ..task(number, at_m)
    }
}

/// Two halves of a field with two robots each, and goals that are dealt to the controllers in turn: half of them wrongly.
fn halves(stations: u32, is_alone: bool, settings: &Settings) -> Team {
    let new = if is_alone { Team::alone } else { Team::new };
    let mut team = new([4, stations], settings, Weather::default(), 5);
    team.reaches = Box::new(in_halves);
    for (robot, half) in (0..4).zip([0, 1].into_iter().cycle()) {
        team.robots[robot].brain = Some(brain(&[half + 1], ""));
        team.robots[robot].at = goal_in(half, 0).at();
    }
    for number in 0..20 {
        let half = u8::try_from(number / 2 % 2).unwrap();
        team.issue((number % 2) as usize, goal_in(half, number));
    }
    team
}

/// The controllers that own a goal.
fn owners(team: &Team, number: u32) -> usize {
    let stations = team.stations.iter();
    stations
        .filter(|station| Team::owns(station, goal_id(number), team.now_s))
        .count()
}

#[test]
fn goals_that_are_dealt_wrongly_are_served_with_trade_and_never_without() {
    for (stations, is_alone) in [(2, false), (3, false), (2, true)] {
        let mut team = halves(stations, is_alone, &settings());
        team.run_until_done(20, 400.0);
        assert_eq!(team.done(), 20, "{stations} {is_alone}");
        assert_eq!(team.served.len(), 20, "each is served once");
        let moves = |station: usize| team.controller(station).transfers();
        assert!(moves(0) >= 5 && moves(1) >= 5);
        let without = Settings {
            trade: None,
            ..settings()
        };
        let mut team = halves(stations, is_alone, &without);
        team.run(400.0);
        assert_eq!(team.done(), 10, "{stations} {is_alone}");
    }
}

/// The kinds of messages of a transfer.
const STEPS: [fn(&About) -> bool; 9] = [
    |about| matches!(about, About::Trade(TradeMessage::Offer(_))),
    |about| matches!(about, About::Trade(TradeMessage::Price(_))),
    |about| matches!(about, About::Trade(TradeMessage::Decline(_))),
    |about| matches!(about, About::Trade(TradeMessage::Transfer(_))),
    |about| matches!(about, About::Ownership(OwnershipMessage::Entrust(_))),
    |about| matches!(about, About::Ownership(OwnershipMessage::Entrusted(_))),
    |about| matches!(about, About::Ownership(OwnershipMessage::Release(_))),
    |about| matches!(about, About::Trade(TradeMessage::Dismiss(_))),
    |about| matches!(about, About::Trade(TradeMessage::Dismissed(_))),
];

/// Lets a team work, and checks that no goal has two owners at any step.
fn run_safely(team: &mut Team, time_s: f64) {
    let end_s = team.now_s + time_s;
    while team.now_s < end_s {
        team.step();
        for number in 0..20 {
            assert!(owners(team, number) <= 1, "{number} at {:.1} s", team.now_s);
        }
    }
}

#[test]
fn a_cut_at_any_step_of_a_swap_neither_duplicates_nor_loses_a_goal() {
    for (stations, is_alone) in [(2, false), (3, false), (2, true)] {
        for (step, is_cut) in STEPS.into_iter().enumerate() {
            let mut team = halves(stations, is_alone, &settings());
            run_safely(&mut team, 10.0);
            // From here on, no message of this kind arrives for longer than any lease.
            team.reaches = Box::new(move |from, to, message| {
                in_halves(from, to, message) && !is_cut(&message.about)
            });
            run_safely(&mut team, 45.0);
            team.reaches = Box::new(in_halves);
            run_safely(&mut team, 500.0);
            assert_eq!(team.done(), 20, "step {step}, {stations} {is_alone}");
        }
    }
}

#[test]
fn a_controller_that_fails_at_any_time_of_a_swap_loses_no_goal_of_three() {
    for lost in 0..3 {
        for at_s in [9.0, 11.0, 12.0, 12.6, 13.2, 14.0, 16.0, 20.0] {
            let mut team = halves(3, false, &settings());
            run_safely(&mut team, at_s);
            team.crash_station(lost);
            run_safely(&mut team, 150.0);
            let is_known = |number: &u32| {
                let mut left = team.stations.iter().filter_map(|it| it.controller.as_ref());
                let goal = goal_id(*number);
                left.any(|it| it.knows(goal)) || team.is_done(goal)
            };
            let known = (0..20).filter(is_known).count();
            assert_eq!(known, 20, "{lost} at {at_s} s");
        }
    }
}

#[test]
fn goals_move_a_bounded_number_of_times() {
    // No goal is awarded, and one controller has more than half of its maximum number.
    let settings = Settings {
        allocation: Allocation::None,
        max_goals: 30,
        trade: Some(Trade {
            confidence: 0.0,
            gain: 0.7,
        }),
        ..settings()
    };
    let mut team = Team::new([4, 3], &settings, Weather::default(), 5);
    // Robots reach only one of the others.
    team.reaches = Box::new(|from, to, _| {
        let (robot, station) = if from.is_robot() {
            (from, to)
        } else {
            (to, from)
        };
        from.role == to.role || station.index == 1 + robot.index % 2
    });
    for number in 0..20 {
        team.issue(0, task(number, goal_in(0, number).at_m));
    }
    let moves = |team: &Team| -> u32 {
        let stations = 0..3;
        stations.map(|it| team.controller(it).transfers()).sum()
    };
    team.run(900.0);
    let first = moves(&team);
    // A price is at least 1 s, and at most that of a robot 300 m away: ln(150 / 1) / ln(1 / 0.7) = 14.
    assert!(first > 0 && first <= 20 * 15, "{first}");
    team.run(900.0);
    assert_eq!(moves(&team), first);
}

/// A controller that promises to have each goal served at once, owns it, and does nothing.
fn lie(team: &mut Team, liar: AgentId, number: &mut u32) {
    let received: Vec<(AgentId, AgentId, Message)> = std::mem::take(&mut team.overheard);
    for (from, to, message) in received {
        if to != liar {
            continue;
        }
        *number += 1;
        let answer: About = match message.about {
            About::Trade(TradeMessage::Offer(offer)) => TradeMessage::Price(Price {
                goal: offer.task.id,
                number: *number,
                cost_s: 0.0,
            })
            .into(),
            About::Trade(TradeMessage::Transfer(transfer)) => {
                let task = goal_in(0, transfer.goal.number);
                OwnershipMessage::Entrust(Entrust {
                    number: *number,
                    task,
                })
                .into()
            }
            About::Ownership(OwnershipMessage::Entrusted(Award { goal, .. }))
            | About::Lease(LeaseMessage::RenewedOne(Claim { goal, .. })) => {
                LeaseMessage::RenewOne(Claim {
                    goal,
                    number: *number,
                })
                .into()
            }
            About::Ownership(OwnershipMessage::Entrust(Entrust { number, task })) => {
                OwnershipMessage::Entrusted(Award {
                    goal: task.id,
                    number,
                    lease_s: 30.0,
                })
                .into()
            }
            About::Lease(LeaseMessage::Renew(renewal)) => {
                LeaseMessage::Renewed(renewal.number).into()
            }
            _ => continue,
        };
        let now_s = team.now_s;
        team.network
            .send(liar, from, Message::to(from, answer), now_s);
    }
}

#[test]
fn a_controller_that_promises_everything_and_serves_nothing_gets_at_most_five_goals_of_a_hundred() {
    for (stations, is_alone) in [(2, true), (2, false), (3, false), (3, true), (6, false)] {
        let new = if is_alone { Team::alone } else { Team::new };
        let mut team = new([0, stations], &settings(), Weather::default(), 5);
        let liar = station_id(stations - 1);
        team.crash_station(stations as usize - 1);
        for number in 0..100 {
            let station = number as usize % (stations as usize - 1);
            team.issue(station, goal_in(0, number));
        }
        let present = About::Ownership(OwnershipMessage::Present {});
        let mut number = 0;
        for step in 0..8000_u32 {
            if step % 20 == 0 {
                for to in (0..stations - 1).map(station_id) {
                    let now_s = team.now_s;
                    team.network.send(liar, to, Message::to(to, present), now_s);
                }
            }
            lie(&mut team, liar, &mut number);
            team.step();
        }
        let given = (0..stations as usize - 1).map(|it| team.controller(it).transfers());
        let given: u32 = given.sum();
        assert!((1..=5).contains(&given), "{given} of {stations} {is_alone}");
    }
}

#[test]
fn an_owner_answers_neither_a_price_without_an_offer_nor_a_transfer_without_a_price() {
    let mut team = halves(2, true, &settings());
    team.run(5.0);
    let goal = goal_id(2);
    let forged: [About; 2] = [
        TradeMessage::Price(Price {
            goal,
            number: 3,
            cost_s: 0.0,
        })
        .into(),
        TradeMessage::Transfer(brain::Transfer {
            goal,
            price: 3,
            lease: 0,
            limit_s: 1.0,
        })
        .into(),
    ];
    for about in forged {
        for (from, to) in [(WEST, EAST), (EAST, WEST)] {
            let now_s = team.now_s;
            team.network.send(from, to, Message::to(to, about), now_s);
        }
    }
    team.run(1.0);
    let moves = [0, 1].map(|station| team.controller(station).transfers());
    assert_eq!((moves, owners(&team, 2)), ([0, 0], 1));
}
