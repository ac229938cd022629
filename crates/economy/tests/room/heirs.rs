//! The effect of each message between controllers.

use crate::hand::{
    HEIR, Hand, OTHER, OWNER, ROBOT, TASK, awarder, bid_of, claim, controller, sent_any,
};
use crate::team::{goal_id, station_id};
use brain::{AgentId, Assignment, Award, Dispatch, Reason, Receiver, Task};
use economy::{Controller, Settings};
use std::sync::Arc;

/// An heir that has inherited the goal, after messages of its owner.
fn inheritor(reports: &[Dispatch]) -> Hand<Controller> {
    let mut heir = controller(HEIR);
    let sent = heir.take(OWNER, Dispatch::Entrust(TASK));
    let number = sent.iter().find_map(|(_, sent)| match sent {
        Dispatch::Entrusted(award) => Some(award.number),
        _ => None,
    });
    let binding = Award {
        goal: goal_id(0),
        number: number.unwrap(),
        lease_s: 20.0,
    };
    heir.take(OWNER, Dispatch::Bind(binding));
    for report in reports {
        heir.take(OWNER, *report);
    }
    heir.wait(31.0);
    assert_eq!(heir.agent.goals().count(), 1);
    heir
}

fn assigned(robot: AgentId) -> Dispatch {
    let goal = goal_id(0);
    Dispatch::Assigned(Assignment { goal, robot })
}

#[test]
fn an_inherited_goal_is_done_only_by_a_robot_to_which_the_owner_has_awarded_it() {
    let mut heir = inheritor(&[assigned(ROBOT)]);
    // A robot cannot vouch for itself.
    heir.take(OTHER, assigned(OTHER));
    heir.take(OTHER, Dispatch::Done(claim(7)));
    assert_eq!(heir.agent.done().count(), 0);
    let sent = heir.take(ROBOT, Dispatch::Done(claim(7)));
    assert!(heir.agent.done().eq([goal_id(0)]));
    assert!(sent.contains(&(ROBOT.into(), Dispatch::Withdraw(claim(7)))));
    // If the messages of the owner were lost, the goal is awarded again.
    let mut heir = inheritor(&[]);
    heir.take(ROBOT, Dispatch::Done(claim(7)));
    assert_eq!(heir.agent.done().count(), 0);
    heir.take(OWNER, assigned(ROBOT));
    heir.take(ROBOT, Dispatch::Done(claim(7)));
    assert_eq!(heir.agent.done().count(), 1);
}

#[test]
fn an_owner_reports_each_award_to_its_heir() {
    let report = (HEIR.into(), assigned(ROBOT));
    let mut owner = bound();
    owner.take(ROBOT, bid_of(7));
    assert!(owner.wait(2.0).contains(&report));
    let sent = owner.take(ROBOT, Dispatch::Commit(claim(7)));
    assert!(sent.contains(&report));
    // An heir that is named after the award knows of it, too.
    let mut late = awarder();
    late.take(HEIR, Dispatch::Serial(9));
    late.take(HEIR, entrusted(5));
    assert!(late.take(HEIR, entrusted(5)).contains(&report));
}

/// An owner that is bound to its heir.
fn bound() -> Hand<Controller> {
    let mut owner = controller(OWNER);
    owner.take(AgentId::OPERATOR, Dispatch::Issue(TASK));
    let sent = owner.take(HEIR, Dispatch::Serial(9));
    assert!(sent_any(&sent, |sent| matches!(sent, Dispatch::Entrust(_))));
    let sent = owner.take(HEIR, entrusted(5));
    assert!(sent_any(
        &sent,
        |sent| matches!(sent, Dispatch::Bind(award) if award.number == 5)
    ));
    owner.take(HEIR, entrusted(5));
    owner
}

fn entrusted(number: u32) -> Dispatch {
    Dispatch::Entrusted(Award {
        goal: goal_id(0),
        number,
        lease_s: 30.0,
    })
}

#[test]
fn an_owner_without_an_answer_of_its_heir_loses_the_goal_and_one_that_is_relieved_does_not() {
    let mut lost = bound();
    assert!(lost.agent.goals().next().unwrap().heir.is_some());
    lost.wait(31.0);
    assert_eq!(lost.agent.goals().count(), 0);
    assert_eq!(lost.agent.orphans().count(), 1);
    let mut relieved = bound();
    // A controller with a higher serial number is to be the heir.
    let sent = relieved.take(station_id(2), Dispatch::Serial(10));
    let relief = sent.iter().find_map(|(_, sent)| match sent {
        Dispatch::Relieve(claim) => Some(*claim),
        _ => None,
    });
    relieved.take(HEIR, Dispatch::Relieved(relief.unwrap()));
    relieved.wait(40.0);
    assert_eq!(relieved.agent.goals().count(), 1);
}

#[test]
fn an_answer_with_an_absurd_lease_or_of_no_controller_makes_no_heir() {
    for lease_s in [1e-6, 2.9, -1.0, 1e9, f32::NAN, f32::INFINITY] {
        let mut owner = controller(OWNER);
        owner.take(AgentId::OPERATOR, Dispatch::Issue(TASK));
        owner.take(HEIR, Dispatch::Serial(9));
        let answer = Award {
            goal: goal_id(0),
            number: 5,
            lease_s,
        };
        let sent = owner.take(HEIR, Dispatch::Entrusted(answer));
        assert!(!sent_any(&sent, |sent| matches!(sent, Dispatch::Bind(_))));
        owner.wait(60.0);
        assert_eq!(owner.agent.goals().count(), 1, "{lease_s}");
    }
    for from in [AgentId::OPERATOR, ROBOT, OWNER] {
        let mut owner = controller(OWNER);
        owner.take(AgentId::OPERATOR, Dispatch::Issue(TASK));
        let sent = owner.take(from, Dispatch::Serial(u32::MAX));
        assert!(!sent_any(&sent, |sent| matches!(
            sent,
            Dispatch::Entrust(_)
        )));
    }
}

#[test]
fn an_heir_answers_grants_and_inherits() {
    let mut heir = controller(HEIR);
    let sent = heir.take(OWNER, Dispatch::Entrust(TASK));
    let number = sent.iter().find_map(|(_, sent)| match sent {
        Dispatch::Entrusted(award) => Some(award.number),
        _ => None,
    });
    let number = number.unwrap();
    // A binding that names another answer has no effect.
    let bind = |number| {
        Dispatch::Bind(Award {
            goal: goal_id(0),
            number,
            lease_s: 20.0,
        })
    };
    heir.take(OWNER, bind(number.wrapping_add(1)));
    heir.wait(40.0);
    assert_eq!(heir.agent.goals().count(), 0);
    heir.take(OWNER, bind(number));
    heir.wait(20.0);
    let sent = heir.take(OWNER, Dispatch::RenewOne(claim(77)));
    assert!(sent.contains(&(OWNER.into(), Dispatch::RenewedOne(claim(77)))));
    heir.wait(29.0);
    assert_eq!(heir.agent.goals().count(), 0);
    // The owner's lease has ended, but those of its assignees may not have.
    let sent = heir.wait(20.0);
    assert_eq!(heir.agent.goals().count(), 1);
    let is_call = |sent: &Dispatch| matches!(sent, Dispatch::Call { .. });
    assert!(!sent_any(&sent, is_call));
    assert!(sent_any(&heir.wait(2.0), is_call));
    // The previous owner is in range again.
    let sent = heir.take(OWNER, Dispatch::Serial(1));
    assert!(sent_any(&sent, |sent| matches!(sent, Dispatch::Restore(_))));
    heir.take(OWNER, bind(99));
    assert_eq!(heir.agent.goals().count(), 0);
}

#[test]
fn an_heir_that_is_relieved_does_not_inherit() {
    let mut heir = controller(HEIR);
    let sent = heir.take(OWNER, Dispatch::Entrust(TASK));
    let number = sent.iter().find_map(|(_, sent)| match sent {
        Dispatch::Entrusted(award) => Some(award.number),
        _ => None,
    });
    let award = Award {
        goal: goal_id(0),
        number: number.unwrap(),
        lease_s: 20.0,
    };
    heir.take(OWNER, Dispatch::Bind(award));
    let sent = heir.take(OWNER, Dispatch::Relieve(claim(3)));
    assert!(sent.contains(&(OWNER.into(), Dispatch::Relieved(claim(3)))));
    heir.wait(100.0);
    assert_eq!(heir.agent.goals().count(), 0);
}

#[test]
fn a_returned_goal_is_owned_again_when_the_heir_grants_it() {
    let mut owner = bound();
    owner.wait(31.0);
    let sent = owner.take(HEIR, Dispatch::Restore(TASK));
    let number = sent.iter().find_map(|(_, sent)| match sent {
        Dispatch::Bind(award) => Some(award.number),
        _ => None,
    });
    owner.take(HEIR, entrusted(5));
    assert_eq!(owner.agent.goals().count(), 0);
    owner.take(HEIR, entrusted(number.unwrap()));
    assert_eq!(owner.agent.goals().count(), 1);
}

#[test]
fn a_controller_that_restarts_takes_no_goal_back_for_the_longest_lease() {
    let mut owner = controller(OWNER);
    owner.agent = Controller::restarted(Arc::new(Settings {
        max_drift: 0.0,
        ..Settings::default()
    }));
    let is_bind = |sent: &Dispatch| matches!(sent, Dispatch::Bind(_));
    owner.wait(1.0);
    assert!(!sent_any(
        &owner.take(HEIR, Dispatch::Restore(TASK)),
        is_bind
    ));
    owner.wait(30.0);
    assert!(sent_any(
        &owner.take(HEIR, Dispatch::Restore(TASK)),
        is_bind
    ));
}

#[test]
fn an_owner_answers_repeated_offers_of_its_goal_with_one_request() {
    let mut owner = controller(OWNER);
    let request = |sent: &[(Receiver, Dispatch)]| {
        sent.iter().find_map(|(_, sent)| match sent {
            Dispatch::Bind(award) => Some(award.number),
            _ => None,
        })
    };
    let first = request(&owner.take(HEIR, Dispatch::Restore(TASK)));
    owner.wait(2.0);
    let second = request(&owner.take(HEIR, Dispatch::Restore(TASK)));
    assert_eq!((first.is_some(), first), (true, second));
    // The grant of the heir arrives late.
    owner.wait(2.4);
    owner.take(HEIR, entrusted(first.unwrap()));
    assert_eq!(owner.agent.goals().count(), 1);
}

#[test]
fn a_goal_that_was_issued_again_and_inherited_has_one_owner_when_they_meet() {
    let mut owner = controller(OWNER);
    owner.take(AgentId::OPERATOR, Dispatch::Issue(TASK));
    let mut heir = inheritor(&[]);
    let mut to_heir = vec![(OWNER, HEIR.into(), Dispatch::Serial(8))];
    for _ in 0..200 {
        let sent = heir.step(&to_heir);
        let mut to_owner = vec![(HEIR, OWNER.into(), Dispatch::Serial(9))];
        to_owner.extend(sent.iter().map(|(_, sent)| (HEIR, OWNER.into(), *sent)));
        let sent = owner.step(&to_owner);
        to_heir = vec![(OWNER, HEIR.into(), Dispatch::Serial(8))];
        to_heir.extend(sent.iter().map(|(_, sent)| (OWNER, HEIR.into(), *sent)));
    }
    let owners = [&owner, &heir].map(|it| it.agent.goals().count());
    assert_eq!(owners, [1, 0]);
}

#[test]
fn a_renewal_of_a_lease_is_sent_before_the_offers_of_the_step() {
    let mut owner = bound();
    let steps = (1..200).map(|number| {
        let task = Task {
            id: goal_id(number),
            ..TASK
        };
        owner.take(AgentId::OPERATOR, Dispatch::Issue(task))
    });
    let place = |sent: &[(Receiver, Dispatch)], is_meant: fn(&Dispatch) -> bool| {
        sent.iter().position(|(_, dispatch)| is_meant(dispatch))
    };
    let places = steps.filter_map(|sent| {
        let renewal = place(&sent, |sent| matches!(sent, Dispatch::Renew(_)))?;
        Some((
            renewal,
            place(&sent, |sent| matches!(sent, Dispatch::Call { .. }))?,
        ))
    });
    let places: Vec<(usize, usize)> = places.collect();
    assert!(!places.is_empty());
    for (renewal, call) in places {
        assert!(renewal < call, "{renewal} {call}");
    }
}

#[test]
fn a_goal_that_is_lost_is_reported_to_the_operator() {
    let sent = bound().wait(31.0);
    let reports = sent.iter().filter_map(|(to, sent)| match sent {
        Dispatch::Stuck(refusal) if refusal.reason == Reason::Orphaned => Some((*to, refusal.goal)),
        _ => None,
    });
    let reports: Vec<_> = reports.collect();
    assert_eq!(reports, [(AgentId::OPERATOR.into(), goal_id(0))]);
}
