//! The effect of each message of robots on a controller.

use crate::hand::{
    Agent, Hand, MEMBER, OTHER, OWNER, ROBOT, TASK, assignee_of, award, awarder, bid_of, claim,
    controller, now, owner, refusal, sent_any,
};
use crate::team::goal_id;
use base::geometry::Point;
use brain::{
    About, AgentId, Bid, ContractMessage, Fitness, LeaseMessage, Message, OwnershipMessage,
    Percept, Reason, Receiver, Renewal, Report, Seen, Task, Verdict,
};
use economy::{Controller, Settings};

#[test]
fn issue_of_the_operator_alone_makes_a_controller_own_a_goal_and_call_for_bids() {
    for (from, count) in [(AgentId::OPERATOR, 1), (ROBOT, 0), (MEMBER, 0)] {
        let mut owner = controller(OWNER);
        let sent = owner.take(from, About::Contract(ContractMessage::Issue(TASK)));
        assert_eq!(owner.agent.goals().count(), count);
        assert_eq!(
            sent_any(&sent, |sent| matches!(
                sent,
                About::Contract(ContractMessage::Call { .. })
            )),
            count == 1
        );
    }
}

#[test]
fn the_best_bid_wins_and_a_refusal_or_release_offers_the_goal_again() {
    for answer in [
        About::Contract(ContractMessage::Refuse(refusal(7, Reason::Full))),
        About::Contract(ContractMessage::Release(claim(7))),
    ] {
        let mut owner = awarder();
        assert_eq!(assignee_of(&owner), Some(ROBOT));
        owner.take(OTHER, answer);
        assert_eq!(assignee_of(&owner), Some(ROBOT));
        let sent = owner.take(ROBOT, answer);
        assert_eq!(assignee_of(&owner), None);
        assert!(sent_any(&sent, |sent| matches!(
            sent,
            About::Contract(ContractMessage::Call { number: 1, .. })
        )));
    }
}

#[test]
fn a_release_names_its_lease_and_one_of_another_lease_has_no_effect() {
    let mut owner = awarder();
    for number in 8..3000 {
        owner.take(ROBOT, About::Lease(LeaseMessage::RenewOne(claim(number))));
    }
    owner.take(ROBOT, About::Contract(ContractMessage::Release(claim(6))));
    owner.take(
        ROBOT,
        About::Contract(ContractMessage::Release(claim(2999))),
    );
    assert_eq!(assignee_of(&owner), Some(ROBOT));
    owner.take(ROBOT, About::Contract(ContractMessage::Release(claim(7))));
    assert_eq!(assignee_of(&owner), None);
}

#[test]
fn bids_with_absurd_numbers_or_of_an_earlier_call_win_nothing() {
    let absurd = |time_s| {
        About::Contract(ContractMessage::Bid(Bid {
            goal: goal_id(0),
            number: 7,
            time_s,
            total_s: time_s,
            energy: 0.0,
            call: 0,
        }))
    };
    let old = About::Contract(ContractMessage::Bid(Bid {
        goal: goal_id(0),
        number: 7,
        time_s: 1.0,
        total_s: 1.0,
        energy: 0.0,
        call: 9,
    }));
    for bid in [absurd(f32::NAN), absurd(-1.0), absurd(f32::INFINITY), old] {
        let mut owner = controller(OWNER);
        owner.take(
            AgentId::OPERATOR,
            About::Contract(ContractMessage::Issue(TASK)),
        );
        owner.take(ROBOT, bid);
        owner.wait(2.0);
        assert_eq!(assignee_of(&owner), None, "{bid:?}");
    }
}

#[test]
fn an_award_is_repeated_until_the_commitment_and_expires_without_one() {
    let mut owner = awarder();
    let sent = owner.wait(2.0);
    assert!(sent.contains(&(ROBOT.into(), award(7))));
    owner.take(ROBOT, About::Contract(ContractMessage::Commit(claim(7))));
    assert!(!owner.wait(2.0).contains(&(ROBOT.into(), award(7))));
    let mut silent = awarder();
    silent.wait(21.0);
    assert_eq!(assignee_of(&silent), None);
}

#[test]
fn done_of_the_assignee_alone_ends_a_goal_and_is_acknowledged() {
    let mut owner = awarder();
    owner.take(OTHER, About::Contract(ContractMessage::Done(claim(7))));
    assert_eq!(owner.agent.done().count(), 0);
    let sent = owner.take(ROBOT, About::Contract(ContractMessage::Done(claim(7))));
    assert!(sent.contains(&(
        ROBOT.into(),
        About::Contract(ContractMessage::Withdraw(claim(7)))
    )));
    assert!(owner.agent.done().eq([goal_id(0)]));
    owner.take(
        AgentId::OPERATOR,
        About::Contract(ContractMessage::Issue(TASK)),
    );
    assert_eq!(owner.agent.goals().count(), 0);
}

#[test]
fn a_stuck_robot_keeps_its_goal_until_another_one_bids() {
    let mut owner = awarder();
    owner.take(ROBOT, About::Contract(ContractMessage::Commit(claim(7))));
    let stuck = About::Contract(ContractMessage::Stuck(refusal(7, Reason::Unreachable)));
    let sent = owner.take(ROBOT, stuck);
    assert!(sent_any(&sent, |sent| matches!(
        sent,
        About::Contract(ContractMessage::Call { number: 1, .. })
    )));
    owner.wait(3.0);
    assert_eq!(assignee_of(&owner), Some(ROBOT));
    let other = About::Contract(ContractMessage::Bid(Bid {
        goal: goal_id(0),
        number: 3,
        time_s: 60.0,
        total_s: 60.0,
        energy: 0.0,
        call: 1,
    }));
    let sent = owner.take(OTHER, other);
    assert!(
        sent.contains(&(
            ROBOT.into(),
            About::Contract(ContractMessage::Withdraw(claim(7)))
        )),
        "{sent:?}"
    );
    owner.take(ROBOT, About::Contract(ContractMessage::Release(claim(7))));
    owner.wait(2.0);
    assert_eq!(assignee_of(&owner), Some(OTHER));
}

#[test]
fn a_robot_that_approaches_again_keeps_its_goal() {
    let mut owner = awarder();
    owner.take(ROBOT, About::Contract(ContractMessage::Commit(claim(7))));
    owner.take(
        ROBOT,
        About::Contract(ContractMessage::Stuck(refusal(7, Reason::Unreachable))),
    );
    let fitness = Fitness {
        goal: goal_id(0),
        verdict: Verdict::Approaching,
        remaining_s: 5.0,
    };
    let sent = owner.take(ROBOT, About::Contract(ContractMessage::Fitness(fitness)));
    assert!(sent.contains(&(
        Receiver::All,
        About::Contract(ContractMessage::Withdraw(claim(0)))
    )));
    owner.take(OTHER, bid_of(3));
    owner.wait(2.0);
    assert_eq!(assignee_of(&owner), Some(ROBOT));
}

#[test]
fn a_renewal_is_granted_only_to_the_assignee() {
    let mut owner = awarder();
    let mut renewal = |from, number| {
        let sent = owner.take(from, About::Lease(LeaseMessage::RenewOne(claim(number))));
        sent.contains(&(
            from.into(),
            About::Lease(LeaseMessage::RenewedOne(claim(number))),
        ))
    };
    assert!(renewal(ROBOT, 8) && !renewal(OTHER, 9));
    let renewal_of = |count| {
        About::Lease(LeaseMessage::Renew(Renewal {
            number: 10,
            count,
            hash: [0; 2],
        }))
    };
    let sent = owner.take(ROBOT, renewal_of(1));
    assert!(sent.contains(&(ROBOT.into(), About::Lease(LeaseMessage::Differs(10)))));
    let sent = owner.take(OTHER, renewal_of(0));
    assert!(sent.contains(&(OTHER.into(), About::Lease(LeaseMessage::Renewed(10)))));
}

#[test]
fn a_report_or_a_sighting_of_another_controller_makes_a_robot_known() {
    let mut owner = controller(OWNER);
    let special = Task {
        capability: 3,
        ..TASK
    };
    owner.take(
        AgentId::OPERATOR,
        About::Contract(ContractMessage::Issue(special)),
    );
    owner.wait(15.0);
    let unserved = |owner: &Hand<Controller>| owner.agent.goals().next().unwrap().unserved;
    assert_eq!(unserved(&owner), Some(Reason::NoRobot));
    let report = Report {
        at_m: [0.0; 2],
        speed_m_s: 1.0,
        battery: 1.0,
        goals: 0,
        payload: 8,
    };
    owner.take(ROBOT, About::Contract(ContractMessage::Report(report)));
    assert_eq!(unserved(&owner), None);
    // Of two robots that could be called alone, it calls the one that is seen to be nearer.
    owner.take(OTHER, About::Contract(ContractMessage::Report(report)));
    let far = Seen {
        robot: ROBOT,
        at_m: [-50.0, 0.0],
    };
    owner.take(MEMBER, About::Ownership(OwnershipMessage::Seen(far)));
    let sent = owner.wait(15.0);
    let alone = sent.iter().find(|(to, sent)| {
        *to != Receiver::All && matches!(sent, About::Contract(ContractMessage::Call { .. }))
    });
    assert_eq!(alone.map(|(to, _)| *to), Some(OTHER.into()));
}

#[test]
fn a_new_robot_that_a_controller_sees_is_queried() {
    let mut owner = controller(OWNER);
    let neighbour = brain::Neighbour {
        range_m: 5.0,
        bearing_rad: 0.0,
        course_rad: None,
        age_s: 0.0,
        uncertainty_m: 0.0,
        id: ROBOT,
    };
    let percept = Percept {
        time_s: Some(0.5),
        id: OWNER,
        position: now(Point::default()),
        neighbours: vec![neighbour],
        ..Percept::default()
    };
    let sent = owner.agent.step(&percept).outbox;
    assert!(sent.contains(&Message::to(
        ROBOT,
        About::Contract(ContractMessage::Query {})
    )));
}
#[test]
fn an_old_percept_changes_nothing() {
    let mut owner = owner();
    owner.now_s -= 10.0;
    assert_eq!(
        owner.take(
            ROBOT,
            About::Contract(ContractMessage::Report(Report {
                at_m: [0.0; 2],
                speed_m_s: 1.0,
                battery: 1.0,
                goals: 0,
                payload: 0,
            }))
        ),
        []
    );
}

#[test]
fn a_controller_that_restarts_awards_nothing_for_the_longest_lease() {
    let settings = Settings {
        service_lease_s: 40.0,
        max_drift: 0.0,
        ..Settings::default()
    };
    let restarted = Controller::restarted(std::sync::Arc::new(settings));
    let mut owner = controller(OWNER);
    owner.agent = restarted;
    owner.take(
        AgentId::OPERATOR,
        About::Contract(ContractMessage::Issue(TASK)),
    );
    owner.take(ROBOT, bid_of(7));
    let is_call = |sent: &About| matches!(sent, About::Contract(ContractMessage::Call { .. }));
    assert!(!sent_any(&owner.wait(39.0), is_call));
    assert_eq!(assignee_of(&owner), None);
    assert!(sent_any(&owner.wait(2.0), is_call));
    owner.take(ROBOT, bid_of(8));
    owner.wait(2.0);
    assert_eq!(assignee_of(&owner), Some(ROBOT));
}

#[test]
fn a_robot_that_lets_its_lease_end_in_silence_bids_in_vain_for_a_time() {
    let mut owner = awarder();
    owner.take(ROBOT, About::Contract(ContractMessage::Commit(claim(7))));
    // Its lease ends without a message; the liar bids the shortest time again, an honest robot a longer one.
    let sent = owner.wait(25.0);
    assert_eq!(assignee_of(&owner), None);
    let called = sent.iter().rev().find_map(|(_, sent)| match sent {
        About::Contract(ContractMessage::Call { number, .. }) => Some(*number),
        _ => None,
    });
    let call = called.unwrap();
    let bid = |time_s, number| {
        About::Contract(ContractMessage::Bid(Bid {
            goal: goal_id(0),
            number,
            time_s,
            total_s: time_s,
            energy: 0.0,
            call,
        }))
    };
    owner.take(ROBOT, bid(0.0, 8));
    owner.take(OTHER, bid(60.0, 3));
    owner.wait(2.0);
    assert_eq!(assignee_of(&owner), Some(OTHER));
}
