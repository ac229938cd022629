//! Robots that do not serve what they are awarded, and goals that no robot can serve.

use crate::hand::{
    OTHER, OWNER, ROBOT, TASK, awarder, bid_of, claim, controller, refusal, sent_any,
};
use crate::team::{goal_id, robot_id};
use brain::{About, AgentId, ContractMessage, LeaseMessage, Reason, Receiver, Report, Task};

/// A goal that is reported to the operator.
fn reports(sent: &[(Receiver, About)]) -> Vec<Reason> {
    let reports = sent.iter().filter_map(|(to, sent)| match sent {
        About::Contract(ContractMessage::Stuck(refusal)) if *to == AgentId::OPERATOR.into() => {
            Some(refusal.reason)
        }
        _ => None,
    });
    reports.collect()
}

fn report(payload: u16) -> About {
    About::Contract(ContractMessage::Report(Report {
        at_m: [0.0; 2],
        speed_m_s: 1.0,
        battery: 1.0,
        goals: 1 - payload,
        payload,
    }))
}

#[test]
fn a_goal_of_a_robot_that_stays_stuck_is_withdrawn_and_reported_once() {
    let mut owner = awarder();
    owner.take(ROBOT, About::Contract(ContractMessage::Commit(claim(7))));
    let stuck = About::Contract(ContractMessage::Stuck(refusal(7, Reason::Unreachable)));
    let mut sent = owner.take(ROBOT, stuck);
    let withdrawn = (
        ROBOT.into(),
        About::Contract(ContractMessage::Withdraw(claim(7))),
    );
    for _ in 0..80 {
        // It renews its lease and reports, and cannot reach the goal.
        sent.extend(owner.take(ROBOT, report(0)));
        sent.extend(owner.take(ROBOT, About::Lease(LeaseMessage::RenewOne(claim(7)))));
        sent.extend(owner.wait(0.4));
        if sent.contains(&withdrawn) {
            break;
        }
    }
    assert!(sent.contains(&withdrawn));
    sent.extend(owner.take(ROBOT, About::Contract(ContractMessage::Release(claim(7)))));
    for _ in 0..40 {
        sent.extend(owner.take(ROBOT, report(1)));
        sent.extend(owner.wait(0.9));
    }
    assert_eq!(reports(&sent), [Reason::Unreachable]);
}

#[test]
fn a_robot_that_approaches_again_keeps_its_goal() {
    let mut owner = awarder();
    owner.take(ROBOT, About::Contract(ContractMessage::Commit(claim(7))));
    owner.take(
        ROBOT,
        About::Contract(ContractMessage::Stuck(refusal(7, Reason::Unreachable))),
    );
    let fitness = About::Contract(ContractMessage::Fitness(brain::Fitness {
        goal: goal_id(0),
        verdict: brain::Verdict::Approaching,
        remaining_s: 5.0,
    }));
    owner.wait(5.0);
    owner.take(ROBOT, fitness);
    let mut sent = Vec::new();
    for _ in 0..12 {
        sent.extend(owner.take(ROBOT, report(0)));
        sent.extend(owner.wait(1.0));
    }
    assert!(!sent_any(
        &sent,
        |it| matches!(it, About::Contract(ContractMessage::Withdraw(claim)) if claim.number == 7)
    ));
}

/// The number of awards to a robot that returns each of them, while another robot bids, too.
fn awards_of_a_liar(answer: impl Fn(u32) -> About) -> [usize; 2] {
    let mut owner = controller(OWNER);
    owner.take(
        AgentId::OPERATOR,
        About::Contract(ContractMessage::Issue(TASK)),
    );
    let (mut number, mut awards, mut call) = (0, [0, 0], 0);
    for _ in 0..600 {
        number += 1;
        let mut sent = Vec::new();
        for (robot, time_s) in [(ROBOT, 0.0), (OTHER, 60.0)] {
            let About::Contract(ContractMessage::Bid(bid)) = bid_of(number) else {
                return awards;
            };
            sent.extend(owner.take(
                robot,
                About::Contract(ContractMessage::Bid(brain::Bid {
                    time_s,
                    call,
                    ..bid
                })),
            ));
        }
        sent.extend(owner.wait(0.3));
        for (to, sent) in sent {
            match sent {
                About::Contract(ContractMessage::Call { number, .. }) => call = number,
                About::Contract(ContractMessage::Award(award)) if to == ROBOT.into() => {
                    awards[0] += 1;
                    owner.take(ROBOT, answer(award.number));
                }
                About::Contract(ContractMessage::Award(award)) if to == OTHER.into() => {
                    awards[1] += 1;
                    owner.take(
                        OTHER,
                        About::Contract(ContractMessage::Commit(claim(award.number))),
                    );
                    return awards;
                }
                _ => {}
            }
        }
    }
    awards
}

#[test]
fn a_robot_that_bids_best_and_returns_each_award_does_not_keep_others_from_the_goal() {
    let refused = |number| About::Contract(ContractMessage::Refuse(refusal(number, Reason::Lease)));
    let released = |number| About::Contract(ContractMessage::Release(claim(number)));
    for answer in [&refused as &dyn Fn(u32) -> About, &released] {
        let [liar, other] = awards_of_a_liar(answer);
        assert!(liar <= 2 && other == 1, "{liar} {other}");
    }
}

#[test]
fn expired_goals_are_reported_once_and_make_room_for_others() {
    let settings = economy::Settings {
        max_goals: 1,
        max_drift: 0.0,
        ..economy::Settings::default()
    };
    let mut owner = controller(OWNER);
    owner.agent = economy::Controller::new(std::sync::Arc::new(settings));
    owner.take(
        AgentId::OPERATOR,
        About::Contract(ContractMessage::Issue(Task { due_s: 5.0, ..TASK })),
    );
    owner.take(ROBOT, report(1));
    let sent = owner.wait(6.0);
    assert_eq!(reports(&sent), [Reason::Deadline]);
    let later = Task {
        id: goal_id(1),
        ..TASK
    };
    owner.take(
        AgentId::OPERATOR,
        About::Contract(ContractMessage::Issue(later)),
    );
    assert_eq!(owner.agent.refused(), 0);
    let sent = owner.wait(400.0);
    let is_call = |it: &About| matches!(it, About::Contract(ContractMessage::Call { task, .. }) if task.id == goal_id(0));
    assert!(!sent_any(&sent, is_call));
}

#[test]
fn a_goal_that_seventy_robots_cannot_serve_is_reported() {
    let mut owner = controller(OWNER);
    owner.take(
        AgentId::OPERATOR,
        About::Contract(ContractMessage::Issue(TASK)),
    );
    let mut sent = Vec::new();
    let present: Vec<_> = (0..70)
        .map(|index| (robot_id(index), OWNER.into(), report(1)))
        .collect();
    let mut inbox = present.clone();
    for _ in 0..2000 {
        let new = owner.step(&inbox);
        inbox = present.clone();
        for (to, call) in &new {
            if let (About::Contract(ContractMessage::Call { number, .. }), Some(robot)) =
                (call, to.agent())
            {
                let refused = refusal((*number).into(), Reason::Unreachable);
                inbox.push((
                    robot,
                    OWNER.into(),
                    About::Contract(ContractMessage::Refuse(refused)),
                ));
            }
        }
        sent.extend(new);
    }
    assert_eq!(reports(&sent), [Reason::Unreachable]);
}

#[test]
fn a_robot_that_is_back_in_service_is_a_reason_to_try_again() {
    let mut owner = controller(OWNER);
    owner.take(
        AgentId::OPERATOR,
        About::Contract(ContractMessage::Issue(TASK)),
    );
    owner.take(ROBOT, report(1));
    let mut sent = Vec::new();
    while reports(&sent).is_empty() {
        for (to, call) in owner.wait(0.5) {
            sent.push((to, call));
            if let (About::Contract(ContractMessage::Call { number, .. }), true) =
                (call, to == ROBOT.into())
            {
                let refused = refusal(number.into(), Reason::OutOfService);
                sent.extend(owner.take(ROBOT, About::Contract(ContractMessage::Refuse(refused))));
            }
        }
    }
    assert!(owner.agent.goals().next().unwrap().unserved.is_some());
    let sent = owner.take(ROBOT, report(1));
    assert!(sent_any(&sent, |it| matches!(
        it,
        About::Contract(ContractMessage::Call { .. })
    )));
}

#[test]
fn a_repeated_award_has_the_lease_for_which_its_controller_waits() {
    let mut owner = awarder();
    let longer = economy::Settings {
        service_lease_s: 600.0,
        max_drift: 0.0,
        ..economy::Settings::default()
    };
    let other = economy::Controller::new(std::sync::Arc::new(longer));
    owner.agent = owner.agent.with_settings_of(&other);
    let sent = owner.wait(1.0);
    let leases = sent.iter().filter_map(|(_, sent)| match sent {
        About::Contract(ContractMessage::Award(award)) => Some(award.lease_s),
        _ => None,
    });
    let leases: Vec<f32> = leases.collect();
    assert!(
        !leases.is_empty() && leases.iter().all(|lease_s| *lease_s < 21.0),
        "{leases:?}"
    );
}
