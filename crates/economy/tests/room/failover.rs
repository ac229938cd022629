//! The effect of each message between controllers.

use crate::hand::{
    BACKUP, Hand, OTHER, OWNER, ROBOT, TASK, awarder, bid_of, claim, controller, sent_any,
};
use crate::team::{goal_id, station_id};
use brain::{
    About, AgentId, Assignment, Award, ContractMessage, LeaseMessage, OwnershipMessage, Reason,
    Receiver, Task,
};
use economy::{Controller, Settings};
use std::sync::Arc;

/// A backup that has taken over the goal, after messages of its owner.
fn successor(reports: &[About]) -> Hand<Controller> {
    let mut backup = controller(BACKUP);
    let sent = backup.take(OWNER, About::Ownership(OwnershipMessage::Entrust(TASK)));
    let number = sent.iter().find_map(|(_, sent)| match sent {
        About::Ownership(OwnershipMessage::Entrusted(award)) => Some(award.number),
        _ => None,
    });
    let binding = Award {
        goal: goal_id(0),
        number: number.unwrap(),
        lease_s: 20.0,
    };
    backup.take(OWNER, About::Ownership(OwnershipMessage::Bind(binding)));
    for report in reports {
        backup.take(OWNER, *report);
    }
    backup.wait(31.0);
    assert_eq!(backup.agent.goals().count(), 1);
    backup
}

fn assigned(robot: AgentId) -> About {
    let goal = goal_id(0);
    About::Ownership(OwnershipMessage::Assigned(Assignment { goal, robot }))
}

#[test]
fn an_inherited_goal_is_done_only_by_a_robot_to_which_the_owner_has_awarded_it() {
    let mut backup = successor(&[assigned(ROBOT)]);
    // A robot cannot vouch for itself.
    backup.take(OTHER, assigned(OTHER));
    backup.take(OTHER, About::Contract(ContractMessage::Done(claim(7))));
    assert_eq!(backup.agent.done().count(), 0);
    let sent = backup.take(ROBOT, About::Contract(ContractMessage::Done(claim(7))));
    assert!(backup.agent.done().eq([goal_id(0)]));
    assert!(sent.contains(&(
        ROBOT.into(),
        About::Contract(ContractMessage::Withdraw(claim(7)))
    )));
    // If the messages of the owner were lost, the goal is awarded again.
    let mut backup = successor(&[]);
    backup.take(ROBOT, About::Contract(ContractMessage::Done(claim(7))));
    assert_eq!(backup.agent.done().count(), 0);
    backup.take(OWNER, assigned(ROBOT));
    backup.take(ROBOT, About::Contract(ContractMessage::Done(claim(7))));
    assert_eq!(backup.agent.done().count(), 1);
}

#[test]
fn an_owner_reports_each_award_to_its_backup() {
    let report = (BACKUP.into(), assigned(ROBOT));
    let mut owner = bound();
    owner.take(ROBOT, bid_of(7));
    assert!(owner.wait(2.0).contains(&report));
    let sent = owner.take(ROBOT, About::Contract(ContractMessage::Commit(claim(7))));
    assert!(sent.contains(&report));
    // A backup that is named after the award knows of it, too.
    let mut late = awarder();
    late.take(BACKUP, About::Ownership(OwnershipMessage::Serial(9)));
    late.take(BACKUP, entrusted(5));
    assert!(late.take(BACKUP, entrusted(5)).contains(&report));
}

/// An owner that is bound to its backup.
fn bound() -> Hand<Controller> {
    let mut owner = controller(OWNER);
    owner.take(
        AgentId::OPERATOR,
        About::Contract(ContractMessage::Issue(TASK)),
    );
    let sent = owner.take(BACKUP, About::Ownership(OwnershipMessage::Serial(9)));
    assert!(sent_any(&sent, |sent| matches!(
        sent,
        About::Ownership(OwnershipMessage::Entrust(_))
    )));
    let sent = owner.take(BACKUP, entrusted(5));
    assert!(sent_any(
        &sent,
        |sent| matches!(sent, About::Ownership(OwnershipMessage::Bind(award)) if award.number == 5)
    ));
    owner.take(BACKUP, entrusted(5));
    owner
}

fn entrusted(number: u32) -> About {
    About::Ownership(OwnershipMessage::Entrusted(Award {
        goal: goal_id(0),
        number,
        lease_s: 30.0,
    }))
}

#[test]
fn an_owner_without_an_answer_of_its_backup_loses_the_goal_and_one_that_is_relieved_does_not() {
    let mut lost = bound();
    assert!(lost.agent.goals().next().unwrap().backup.is_some());
    lost.wait(31.0);
    assert_eq!(lost.agent.goals().count(), 0);
    assert_eq!(lost.agent.lost().count(), 1);
    let mut relieved = bound();
    // A controller with a higher serial number is to be the backup.
    let sent = relieved.take(
        station_id(2),
        About::Ownership(OwnershipMessage::Serial(10)),
    );
    let relief = sent.iter().find_map(|(_, sent)| match sent {
        About::Ownership(OwnershipMessage::Relieve(claim)) => Some(*claim),
        _ => None,
    });
    relieved.take(
        BACKUP,
        About::Ownership(OwnershipMessage::Relieved(relief.unwrap())),
    );
    relieved.wait(40.0);
    assert_eq!(relieved.agent.goals().count(), 1);
}

#[test]
fn an_answer_with_an_absurd_lease_or_of_no_controller_makes_no_backup() {
    for lease_s in [1e-6, 2.9, -1.0, 1e9, f32::NAN, f32::INFINITY] {
        let mut owner = controller(OWNER);
        owner.take(
            AgentId::OPERATOR,
            About::Contract(ContractMessage::Issue(TASK)),
        );
        owner.take(BACKUP, About::Ownership(OwnershipMessage::Serial(9)));
        let answer = Award {
            goal: goal_id(0),
            number: 5,
            lease_s,
        };
        let sent = owner.take(
            BACKUP,
            About::Ownership(OwnershipMessage::Entrusted(answer)),
        );
        assert!(!sent_any(&sent, |sent| matches!(
            sent,
            About::Ownership(OwnershipMessage::Bind(_))
        )));
        owner.wait(60.0);
        assert_eq!(owner.agent.goals().count(), 1, "{lease_s}");
    }
    for from in [AgentId::OPERATOR, ROBOT, OWNER] {
        let mut owner = controller(OWNER);
        owner.take(
            AgentId::OPERATOR,
            About::Contract(ContractMessage::Issue(TASK)),
        );
        let sent = owner.take(from, About::Ownership(OwnershipMessage::Serial(u32::MAX)));
        assert!(!sent_any(&sent, |sent| matches!(
            sent,
            About::Ownership(OwnershipMessage::Entrust(_))
        )));
    }
}

#[test]
fn a_backup_answers_grants_and_takes_over() {
    let mut backup = controller(BACKUP);
    let sent = backup.take(OWNER, About::Ownership(OwnershipMessage::Entrust(TASK)));
    let number = sent.iter().find_map(|(_, sent)| match sent {
        About::Ownership(OwnershipMessage::Entrusted(award)) => Some(award.number),
        _ => None,
    });
    let number = number.unwrap();
    // A binding that names another answer has no effect.
    let bind = |number| {
        About::Ownership(OwnershipMessage::Bind(Award {
            goal: goal_id(0),
            number,
            lease_s: 20.0,
        }))
    };
    backup.take(OWNER, bind(number.wrapping_add(1)));
    backup.wait(40.0);
    assert_eq!(backup.agent.goals().count(), 0);
    backup.take(OWNER, bind(number));
    backup.wait(20.0);
    let sent = backup.take(OWNER, About::Lease(LeaseMessage::RenewOne(claim(77))));
    assert!(sent.contains(&(
        OWNER.into(),
        About::Lease(LeaseMessage::RenewedOne(claim(77)))
    )));
    backup.wait(29.0);
    assert_eq!(backup.agent.goals().count(), 0);
    // The owner's lease has ended, but those of its assignees may not have.
    let sent = backup.wait(20.0);
    assert_eq!(backup.agent.goals().count(), 1);
    let is_call = |sent: &About| matches!(sent, About::Contract(ContractMessage::Call { .. }));
    assert!(!sent_any(&sent, is_call));
    assert!(sent_any(&backup.wait(2.0), is_call));
    // The previous owner is in range again.
    let sent = backup.take(OWNER, About::Ownership(OwnershipMessage::Serial(1)));
    assert!(sent_any(&sent, |sent| matches!(
        sent,
        About::Ownership(OwnershipMessage::Restore(_))
    )));
    backup.take(OWNER, bind(99));
    assert_eq!(backup.agent.goals().count(), 0);
}

#[test]
fn a_backup_that_is_relieved_does_not_take_over() {
    let mut backup = controller(BACKUP);
    let sent = backup.take(OWNER, About::Ownership(OwnershipMessage::Entrust(TASK)));
    let number = sent.iter().find_map(|(_, sent)| match sent {
        About::Ownership(OwnershipMessage::Entrusted(award)) => Some(award.number),
        _ => None,
    });
    let award = Award {
        goal: goal_id(0),
        number: number.unwrap(),
        lease_s: 20.0,
    };
    backup.take(OWNER, About::Ownership(OwnershipMessage::Bind(award)));
    let sent = backup.take(OWNER, About::Ownership(OwnershipMessage::Relieve(claim(3))));
    assert!(sent.contains(&(
        OWNER.into(),
        About::Ownership(OwnershipMessage::Relieved(claim(3)))
    )));
    backup.wait(100.0);
    assert_eq!(backup.agent.goals().count(), 0);
}

#[test]
fn a_returned_goal_is_owned_again_when_the_backup_grants_it() {
    let mut owner = bound();
    owner.wait(31.0);
    let sent = owner.take(BACKUP, About::Ownership(OwnershipMessage::Restore(TASK)));
    let number = sent.iter().find_map(|(_, sent)| match sent {
        About::Ownership(OwnershipMessage::Bind(award)) => Some(award.number),
        _ => None,
    });
    owner.take(BACKUP, entrusted(5));
    assert_eq!(owner.agent.goals().count(), 0);
    owner.take(BACKUP, entrusted(number.unwrap()));
    assert_eq!(owner.agent.goals().count(), 1);
}

#[test]
fn a_controller_that_restarts_takes_no_goal_back_for_the_longest_lease() {
    let mut owner = controller(OWNER);
    owner.agent = Controller::restarted(Arc::new(Settings {
        max_drift: 0.0,
        ..Settings::default()
    }));
    let is_bind = |sent: &About| matches!(sent, About::Ownership(OwnershipMessage::Bind(_)));
    owner.wait(1.0);
    assert!(!sent_any(
        &owner.take(BACKUP, About::Ownership(OwnershipMessage::Restore(TASK))),
        is_bind
    ));
    owner.wait(30.0);
    assert!(sent_any(
        &owner.take(BACKUP, About::Ownership(OwnershipMessage::Restore(TASK))),
        is_bind
    ));
}

#[test]
fn an_owner_answers_repeated_offers_of_its_goal_with_one_request() {
    let mut owner = controller(OWNER);
    let request = |sent: &[(Receiver, About)]| {
        sent.iter().find_map(|(_, sent)| match sent {
            About::Ownership(OwnershipMessage::Bind(award)) => Some(award.number),
            _ => None,
        })
    };
    let first = request(&owner.take(BACKUP, About::Ownership(OwnershipMessage::Restore(TASK))));
    owner.wait(2.0);
    let second = request(&owner.take(BACKUP, About::Ownership(OwnershipMessage::Restore(TASK))));
    assert_eq!((first.is_some(), first), (true, second));
    // The grant of the backup arrives late.
    owner.wait(2.4);
    owner.take(BACKUP, entrusted(first.unwrap()));
    assert_eq!(owner.agent.goals().count(), 1);
}

#[test]
fn a_goal_that_was_issued_again_and_inherited_has_one_owner_when_they_meet() {
    let mut owner = controller(OWNER);
    owner.take(
        AgentId::OPERATOR,
        About::Contract(ContractMessage::Issue(TASK)),
    );
    let mut backup = successor(&[]);
    let mut to_backup = vec![(
        OWNER,
        BACKUP.into(),
        About::Ownership(OwnershipMessage::Serial(8)),
    )];
    for _ in 0..200 {
        let sent = backup.step(&to_backup);
        let mut to_owner = vec![(
            BACKUP,
            OWNER.into(),
            About::Ownership(OwnershipMessage::Serial(9)),
        )];
        to_owner.extend(sent.iter().map(|(_, sent)| (BACKUP, OWNER.into(), *sent)));
        let sent = owner.step(&to_owner);
        to_backup = vec![(
            OWNER,
            BACKUP.into(),
            About::Ownership(OwnershipMessage::Serial(8)),
        )];
        to_backup.extend(sent.iter().map(|(_, sent)| (OWNER, BACKUP.into(), *sent)));
    }
    let owners = [&owner, &backup].map(|it| it.agent.goals().count());
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
        owner.take(
            AgentId::OPERATOR,
            About::Contract(ContractMessage::Issue(task)),
        )
    });
    let place = |sent: &[(Receiver, About)], is_meant: fn(&About) -> bool| {
        sent.iter().position(|(_, about)| is_meant(about))
    };
    let places = steps.filter_map(|sent| {
        let renewal = place(&sent, |sent| {
            matches!(sent, About::Lease(LeaseMessage::Renew(_)))
        })?;
        Some((
            renewal,
            place(&sent, |sent| {
                matches!(sent, About::Contract(ContractMessage::Call { .. }))
            })?,
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
        About::Contract(ContractMessage::Stuck(refusal))
            if refusal.reason == Reason::OwnershipLost =>
        {
            Some((*to, refusal.goal))
        }
        _ => None,
    });
    let reports: Vec<_> = reports.collect();
    assert_eq!(reports, [(AgentId::OPERATOR.into(), goal_id(0))]);
}
