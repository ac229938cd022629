//! The effect of each message on a robot.

use crate::hand::{
    CALL, MEMBER, OTHER, OWNER, TASK, assignee, award, bid, claim, refusal, robot, sent_any,
};
use crate::network::Weather;
use crate::team::{Team, goal_id, task};
use base::geometry::Point;
use brain::{About, AgentId, ContractMessage, LeaseMessage, Reason, Receiver, Renewal, Task};
use economy::Settings;

#[test]
fn a_call_is_answered_by_a_bid_with_the_time_and_the_number_of_the_call() {
    let mut robot = robot();
    let sent = robot.step(&[(OWNER, Receiver::All, CALL)]);
    let bid = bid(&sent).unwrap();
    assert_eq!((bid.goal, bid.call), (goal_id(0), 4));
    assert!((f64::from(bid.time_s) - 6.0).abs() < 1e-6, "{bid:?}");
}

#[test]
fn a_call_of_a_robot_or_with_absurd_numbers_is_no_offer() {
    let absurd = Task {
        at_m: [f32::NAN, 0.0],
        ..TASK
    };
    let absurd = About::Contract(ContractMessage::Call {
        number: 4,
        task: absurd,
    });
    for (from, call) in [(OTHER, CALL), (OWNER, absurd)] {
        let mut robot = robot();
        assert_eq!(bid(&robot.step(&[(from, Receiver::All, call)])), None);
    }
}

#[test]
fn a_call_to_one_robot_is_answered_by_a_refusal_with_the_reason() {
    let late = Task { due_s: 3.0, ..TASK };
    let special = Task {
        capability: 3,
        ..TASK
    };
    for (task, reason) in [(late, Reason::Deadline), (special, Reason::Capability)] {
        let sent = robot().take(
            OWNER,
            About::Contract(ContractMessage::Call { number: 4, task }),
        );
        assert!(
            sent.contains(&(
                OWNER.into(),
                About::Contract(ContractMessage::Refuse(refusal(4, reason)))
            )),
            "{sent:?}"
        );
    }
}

#[test]
fn an_award_makes_a_robot_drive_and_one_that_answers_no_bid_is_refused() {
    let (mut driver, _) = assignee();
    assert_eq!(driver.agent.served_goals().len(), 1);
    let sent = robot().take(OWNER, award(5));
    assert!(sent.contains(&(
        OWNER.into(),
        About::Contract(ContractMessage::Refuse(refusal(5, Reason::Lease)))
    )));
    driver.wait(1.0);
    assert!(driver.agent.last_command().motion.speed_m_s > 0.0);
}

#[test]
fn a_withdrawal_ends_the_service_and_is_answered_by_a_release() {
    let (mut robot, number) = assignee();
    robot.take(
        OTHER,
        About::Contract(ContractMessage::Withdraw(claim(number))),
    );
    robot.take(
        MEMBER,
        About::Contract(ContractMessage::Withdraw(claim(number))),
    );
    robot.take(
        OWNER,
        About::Contract(ContractMessage::Withdraw(claim(number.wrapping_sub(1)))),
    );
    assert_eq!(robot.agent.served_goals().len(), 1);
    let sent = robot.take(
        OWNER,
        About::Contract(ContractMessage::Withdraw(claim(number))),
    );
    assert!(sent_any(&sent, |sent| matches!(
        sent,
        About::Contract(ContractMessage::Release(_))
    )));
    assert_eq!(robot.agent.served_goals().len(), 0);
    // The award has no effect any more.
    robot.take(OWNER, award(number));
    assert_eq!(robot.agent.served_goals().len(), 0);
}

#[test]
fn a_release_has_the_number_of_the_award_also_after_renewals() {
    let (mut robot, number) = assignee();
    let sent = robot.wait(8.0);
    let renewal = sent.iter().rev().find_map(|(_, sent)| match sent {
        About::Lease(LeaseMessage::Renew(renewal)) => Some(renewal.number),
        _ => None,
    });
    robot.take(OWNER, About::Lease(LeaseMessage::Renewed(renewal.unwrap())));
    let sent = robot.take(
        OWNER,
        About::Contract(ContractMessage::Withdraw(claim(number))),
    );
    assert!(sent.contains(&(
        OWNER.into(),
        About::Contract(ContractMessage::Release(claim(number)))
    )));
    // A robot that never held the lease answers with the number of the withdrawal.
    let sent = robot.take(OWNER, About::Contract(ContractMessage::Withdraw(claim(99))));
    assert!(sent.contains(&(
        OWNER.into(),
        About::Contract(ContractMessage::Release(claim(99)))
    )));
}

#[test]
fn a_withdrawal_to_all_ends_the_offer_and_not_the_service() {
    let mut bidder = robot();
    bidder.step(&[(OWNER, Receiver::All, CALL)]);
    bidder.step(&[(
        OWNER,
        Receiver::All,
        About::Contract(ContractMessage::Withdraw(claim(0))),
    )]);
    assert_eq!(bid(&bidder.wait(6.0)), None);
    let (mut robot, _) = assignee();
    robot.step(&[(
        OWNER,
        Receiver::All,
        About::Contract(ContractMessage::Withdraw(claim(0))),
    )]);
    assert_eq!(robot.agent.served_goals().len(), 1);
}

#[test]
fn a_service_ends_with_its_lease_unless_it_is_renewed() {
    let (mut idle, _) = assignee();
    idle.wait(19.0);
    assert_eq!(idle.agent.served_goals().len(), 1);
    idle.wait(1.5);
    assert_eq!(idle.agent.served_goals().len(), 0);
    let (mut renewed, _) = assignee();
    let sent = renewed.wait(8.0);
    let number = sent.iter().rev().find_map(|(_, sent)| match sent {
        About::Lease(LeaseMessage::Renew(Renewal {
            number, count: 1, ..
        })) => Some(*number),
        _ => None,
    });
    renewed.take(OWNER, About::Lease(LeaseMessage::Renewed(number.unwrap())));
    renewed.wait(14.0);
    assert_eq!(renewed.agent.served_goals().len(), 1);
}

#[test]
fn leases_that_differ_are_renewed_one_by_one() {
    let (mut robot, _) = assignee();
    let sent = robot.wait(8.0);
    let number = sent.iter().rev().find_map(|(_, sent)| match sent {
        About::Lease(LeaseMessage::Renew(renewal)) => Some(renewal.number),
        _ => None,
    });
    let sent = robot.take(OWNER, About::Lease(LeaseMessage::Differs(number.unwrap())));
    let one = sent.iter().find_map(|(_, sent)| match sent {
        About::Lease(LeaseMessage::RenewOne(claim)) => Some(*claim),
        _ => None,
    });
    robot.take(OWNER, About::Lease(LeaseMessage::RenewedOne(one.unwrap())));
    robot.wait(14.0);
    assert_eq!(robot.agent.served_goals().len(), 1);
}

#[test]
fn a_robot_out_of_service_returns_its_goals_and_bids_again_when_it_is_back() {
    let (mut robot, number) = assignee();
    // Only the operator decides that.
    robot.take(OWNER, About::Contract(ContractMessage::Service(false)));
    robot.take(OTHER, About::Contract(ContractMessage::Service(false)));
    assert_eq!(robot.agent.served_goals().len(), 1);
    let sent = robot.take(
        AgentId::OPERATOR,
        About::Contract(ContractMessage::Service(false)),
    );
    let returned = About::Contract(ContractMessage::Refuse(refusal(
        number,
        Reason::OutOfService,
    )));
    assert!(sent.contains(&(OWNER.into(), returned)), "{sent:?}");
    assert_eq!(robot.agent.served_goals().len(), 0);
    let sent = robot.take(OWNER, CALL);
    let refused = About::Contract(ContractMessage::Refuse(refusal(4, Reason::OutOfService)));
    assert!(sent.contains(&(OWNER.into(), refused)), "{sent:?}");
    let sent = robot.wait(6.0);
    assert_eq!(bid(&sent), None);
    let is_report = |sent: &About| matches!(sent, About::Contract(ContractMessage::Report(_)));
    assert!(!sent_any(&sent, is_report));
    let sent = robot.take(
        AgentId::OPERATOR,
        About::Contract(ContractMessage::Service(true)),
    );
    assert!(sent_any(&sent, is_report), "it is present again");
    assert!(bid(&robot.wait(6.0)).is_some());
}

#[test]
fn an_award_that_arrives_out_of_service_is_refused() {
    let mut robot = robot();
    let sent = robot.step(&[(OWNER, Receiver::All, CALL)]);
    let number = bid(&sent).unwrap().number;
    robot.take(
        AgentId::OPERATOR,
        About::Contract(ContractMessage::Service(false)),
    );
    let sent = robot.take(OWNER, award(number));
    let refused = About::Contract(ContractMessage::Refuse(refusal(
        number,
        Reason::OutOfService,
    )));
    assert!(sent.contains(&(OWNER.into(), refused)), "{sent:?}");
}

#[test]
fn a_query_is_answered_by_a_report() {
    let sent = robot().take(OWNER, About::Contract(ContractMessage::Query {}));
    assert!(sent_any(
        &sent,
        |sent| matches!(sent, About::Contract(ContractMessage::Report(report)) if report.payload == 4)
    ));
    let (mut robot, _) = assignee();
    let sent = robot.wait(4.0);
    assert!(sent_any(
        &sent,
        |sent| matches!(sent, About::Contract(ContractMessage::Fitness(fitness)) if fitness.remaining_s > 3.0)
    ));
}

#[test]
fn a_searched_area_is_driven_lane_by_lane() {
    let mut team = Team::new([1, 1], &Settings::default(), Weather::default(), 2);
    team.issue(
        0,
        Task {
            work: brain::Work::Search,
            radius_m: 8.0,
            ..task(0, [50.0, 50.0])
        },
    );
    let mut visited = Vec::new();
    for _ in 0..2000 {
        team.step();
        visited.push(team.robots[0].at);
        if team.done() == 1 {
            break;
        }
    }
    assert_eq!(team.done(), 1);
    for [x, y] in [
        [50.0, 43.0],
        [50.0, 50.0],
        [46.0, 53.0],
        [54.0, 47.0],
        [50.0, 57.0],
    ] {
        let place = Point { x, y };
        let nearest_m = visited.iter().map(|at| at.to(place).length());
        assert!(nearest_m.fold(f64::INFINITY, f64::min) < 1.3, "{place:?}");
    }
}

#[test]
fn a_robot_sends_the_renewal_of_its_lease_before_a_bid() {
    let (mut robot, _) = assignee();
    let calls = (1..100).map(|number| {
        About::Contract(ContractMessage::Call {
            number: 4,
            task: Task {
                id: goal_id(number),
                at_m: [500.0, 0.0],
                ..TASK
            },
        })
    });
    let both = calls.filter_map(|call| {
        let sent = robot.take(OWNER, call);
        let place = |is_meant: fn(&About) -> bool| {
            let mut sent = sent.iter();
            sent.position(|(_, about)| is_meant(about))
        };
        let renewal = place(|sent| matches!(sent, About::Lease(LeaseMessage::Renew(_))))?;
        Some((
            renewal,
            place(|sent| matches!(sent, About::Contract(ContractMessage::Bid(_))))?,
        ))
    });
    let both: Vec<(usize, usize)> = both.collect();
    assert!(!both.is_empty());
    for (renewal, bid) in both {
        assert!(renewal < bid, "{renewal} {bid}");
    }
}
