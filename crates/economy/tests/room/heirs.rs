//! The effect of each message between controllers.

use crate::hand::{HEIR, Hand, OWNER, TASK, claim, controller, sent_any};
use crate::team::{goal_id, station_id};
use brain::{Award, Dispatch, RobotId};
use economy::Controller;

/// An owner that is bound to its heir.
fn bound() -> Hand<Controller> {
    let mut owner = controller(OWNER);
    owner.take(RobotId::OPERATOR, Dispatch::Issue(TASK));
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
    assert!(sent.contains(&(OWNER, Dispatch::RenewedOne(claim(77)))));
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
    assert!(sent.contains(&(OWNER, Dispatch::Relieved(claim(3)))));
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
