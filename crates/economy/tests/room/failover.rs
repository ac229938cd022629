//! The effect of each message between controllers.

use crate::hand::{
    Hand, MEMBER, OTHER, OWNER, ROBOT, TASK, bid_of, claim, member, owner_of_three, sent_any, voted,
};
use crate::team::{goal_id, station_id};
use brain::{
    About, AgentId, Assignment, Award, Claim, ContractMessage, Entrust, LeaseMessage,
    OwnershipMessage, Reason, Receiver, Task,
};
use economy::{Controller, Settings};
use std::sync::Arc;

const THIRD: AgentId = station_id(2);

/// A message about the goal from one controller to another.
fn about(message: OwnershipMessage) -> About {
    About::Ownership(message)
}

fn request(number: u32) -> About {
    about(OwnershipMessage::Entrust(Entrust { number, task: TASK }))
}

fn assigned(robot: AgentId) -> About {
    let goal = goal_id(0);
    about(OwnershipMessage::Assigned(Assignment { goal, robot }))
}

/// The number of the request for the vote of a controller, if one is sent.
fn requested(sent: &[(Receiver, About)], voter: AgentId) -> Option<u32> {
    sent.iter().find_map(|(to, sent)| match sent {
        About::Ownership(OwnershipMessage::Entrust(request)) if *to == voter.into() => {
            Some(request.number)
        }
        _ => None,
    })
}

fn vote(number: u32) -> About {
    about(OwnershipMessage::Entrusted(Award {
        goal: goal_id(0),
        number,
        lease_s: 30.0,
    }))
}

/// The number of the vote that a controller sends another one, if it does.
fn vote_for(sent: &[(Receiver, About)], candidate: AgentId) -> Option<u32> {
    sent.iter().find_map(|(to, sent)| match sent {
        About::Ownership(OwnershipMessage::Entrusted(vote)) if *to == candidate.into() => {
            Some(vote.number)
        }
        _ => None,
    })
}

/// A member that has voted for the owner, and to which the owner has reported this; the third member votes for it when that
/// owner is lost.
fn successor(reports: &[About]) -> Hand<Controller> {
    let mut next = member(MEMBER, 3);
    assert_eq!(vote_for(&next.take(OWNER, request(5)), OWNER), Some(5));
    for report in reports {
        next.take(OWNER, *report);
    }
    let present = About::Ownership(OwnershipMessage::Present {});
    let mut number = None;
    for _ in 0..40 {
        let mut sent = next.wait(0.9);
        sent.extend(next.take(THIRD, present));
        number = requested(&sent, THIRD).or(number);
    }
    next.take(THIRD, vote(number.unwrap()));
    assert_eq!(next.agent.goals().count(), 1);
    next
}

#[test]
fn a_goal_is_owned_and_offered_when_a_majority_votes_for_that() {
    let is_call = |sent: &About| matches!(sent, About::Contract(ContractMessage::Call { .. }));
    for (members, needed) in [(1, 0), (2, 1), (3, 1), (4, 2), (5, 2)] {
        let mut owner = member(OWNER, members);
        let mut sent = owner.take(
            AgentId::OPERATOR,
            About::Contract(ContractMessage::Issue(TASK)),
        );
        for voter in (1..members).map(station_id) {
            sent.extend(owner.take(voter, about(OwnershipMessage::Present {})));
        }
        for (votes, voter) in (1..members).map(station_id).enumerate() {
            let is_owner = owner.agent.goals().count() == 1;
            let is_offered = sent_any(&sent, is_call);
            assert_eq!((is_owner, is_offered), (votes >= needed, votes >= needed));
            let number = requested(&sent, voter).unwrap();
            sent.extend(owner.take(voter, vote(number)));
        }
        assert_eq!(owner.agent.goals().count(), 1, "{members}");
    }
}

#[test]
fn a_controller_of_another_kind_or_a_robot_has_no_vote() {
    for from in [AgentId::controller(2, 1), ROBOT, AgentId::OPERATOR] {
        let mut owner = member(OWNER, 2);
        owner.take(
            AgentId::OPERATOR,
            About::Contract(ContractMessage::Issue(TASK)),
        );
        let mut sent = owner.take(from, about(OwnershipMessage::Present {}));
        sent.extend(owner.take(MEMBER, about(OwnershipMessage::Present {})));
        assert_eq!(requested(&sent, from), None);
        owner.take(from, vote(requested(&sent, MEMBER).unwrap()));
        assert_eq!(owner.agent.goals().count(), 0);
        let mut voter = member(MEMBER, 2);
        assert_eq!(vote_for(&voter.take(from, request(5)), from), None);
    }
}

#[test]
fn a_vote_with_an_absurd_lease_or_for_another_request_does_not_count() {
    for lease_s in [1e-6, 2.9, -1.0, 1e9, f32::NAN, f32::INFINITY] {
        let (mut owner, number) = voted(2, MEMBER);
        let absurd = about(OwnershipMessage::Entrusted(Award {
            goal: goal_id(0),
            number,
            lease_s,
        }));
        owner.take(MEMBER, absurd);
        owner.take(MEMBER, vote(number.wrapping_add(1)));
        assert_eq!(owner.agent.goals().count(), 0, "{lease_s}");
    }
}

#[test]
fn a_member_votes_for_one_owner_until_its_lease_has_ended_or_is_released() {
    let mut voter = member(MEMBER, 3);
    assert_eq!(vote_for(&voter.take(OWNER, request(5)), OWNER), Some(5));
    voter.wait(20.0);
    let sent = voter.take(OWNER, About::Lease(LeaseMessage::RenewOne(claim(77))));
    let renewed = About::Lease(LeaseMessage::RenewedOne(claim(77)));
    assert!(sent.contains(&(OWNER.into(), renewed)));
    voter.wait(25.0);
    assert_eq!(vote_for(&voter.take(THIRD, request(9)), THIRD), None);
    voter.wait(6.0);
    assert_eq!(vote_for(&voter.take(THIRD, request(9)), THIRD), Some(9));
}

#[test]
fn a_vote_that_is_released_is_free_and_the_release_of_an_earlier_request_has_no_effect() {
    let mut voter = member(MEMBER, 3);
    voter.take(OWNER, request(5));
    for (number, vote) in [(4, None), (6, None), (5, Some(9))] {
        voter.take(OWNER, about(OwnershipMessage::Release(claim(number))));
        assert_eq!(vote_for(&voter.take(THIRD, request(9)), THIRD), vote);
    }
    // A request from before the last one neither gets a vote nor makes its release count.
    let mut voter = member(MEMBER, 3);
    voter.take(OWNER, request(6));
    assert_eq!(vote_for(&voter.take(OWNER, request(5)), OWNER), None);
    voter.take(OWNER, about(OwnershipMessage::Release(claim(5))));
    assert_eq!(vote_for(&voter.take(THIRD, request(9)), THIRD), None);
}

#[test]
fn an_owner_whose_votes_end_loses_the_goal_and_reports_that() {
    let mut owner = owner_of_three();
    assert_eq!(owner.agent.goals().next().unwrap().votes.len(), 1);
    let sent = owner.wait(31.0);
    assert_eq!(owner.agent.goals().count(), 0);
    assert_eq!(owner.agent.lost().count(), 1);
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
    // The voter may still hold the vote.
    assert!(sent_any(&sent, |sent| matches!(
        sent,
        About::Ownership(OwnershipMessage::Release(_))
    )));
}

#[test]
fn an_owner_keeps_its_goal_while_a_majority_is_left() {
    let mut owner = member(OWNER, 5);
    owner.take(
        AgentId::OPERATOR,
        About::Contract(ContractMessage::Issue(TASK)),
    );
    let voters = [1, 2, 3, 4].map(station_id);
    let mut sent = Vec::new();
    for voter in voters {
        sent.extend(owner.take(voter, about(OwnershipMessage::Present {})));
    }
    for voter in voters {
        let number = requested(&sent, voter).unwrap();
        owner.take(voter, vote(number));
    }
    let renew = |owner: &mut Hand<Controller>, voters: &[AgentId], time_s: f64| {
        let end_s = owner.now_s + time_s;
        while owner.now_s < end_s {
            let sent = owner.wait(0.1);
            for (to, sent) in sent {
                if let (About::Lease(LeaseMessage::Renew(renewal)), Some(voter)) =
                    (sent, to.agent().filter(|to| voters.contains(to)))
                {
                    let renewed = About::Lease(LeaseMessage::Renewed(renewal.number));
                    owner.take(voter, renewed);
                }
            }
        }
    };
    renew(&mut owner, &voters[..2], 100.0);
    assert_eq!(owner.agent.goals().count(), 1);
    renew(&mut owner, &voters[..1], 32.0);
    assert_eq!(owner.agent.goals().count(), 0);
}

#[test]
fn a_goal_that_was_taken_over_is_awarded_when_the_leases_of_the_robots_have_ended() {
    let is_call = |sent: &About| matches!(sent, About::Contract(ContractMessage::Call { .. }));
    let mut next = successor(&[]);
    assert!(!sent_any(&next.wait(19.0), is_call));
    assert!(sent_any(&next.wait(2.0), is_call));
}

#[test]
fn a_goal_that_was_taken_over_is_done_only_by_a_robot_to_which_the_owner_has_awarded_it() {
    let mut next = successor(&[assigned(ROBOT)]);
    // A robot cannot vouch for itself.
    next.take(OTHER, assigned(OTHER));
    next.take(OTHER, About::Contract(ContractMessage::Done(claim(7))));
    assert_eq!(next.agent.done().count(), 0);
    let sent = next.take(ROBOT, About::Contract(ContractMessage::Done(claim(7))));
    assert!(next.agent.done().eq([goal_id(0)]));
    assert!(sent.contains(&(
        ROBOT.into(),
        About::Contract(ContractMessage::Withdraw(claim(7)))
    )));
    // If the messages of the owner were lost, the goal is awarded again.
    let mut next = successor(&[]);
    next.take(ROBOT, About::Contract(ContractMessage::Done(claim(7))));
    assert_eq!(next.agent.done().count(), 0);
    next.take(OWNER, assigned(ROBOT));
    next.take(ROBOT, About::Contract(ContractMessage::Done(claim(7))));
    assert_eq!(next.agent.done().count(), 1);
}

#[test]
fn an_owner_reports_each_award_to_its_voters() {
    let report = (MEMBER.into(), assigned(ROBOT));
    let mut owner = owner_of_three();
    owner.take(ROBOT, bid_of(7));
    assert!(owner.wait(2.0).contains(&report));
    let sent = owner.take(ROBOT, About::Contract(ContractMessage::Commit(claim(7))));
    assert!(sent.contains(&report));
    // One that votes after the award knows of it, too.
    let sent = owner.take(THIRD, about(OwnershipMessage::Present {}));
    let number = requested(&sent, THIRD).unwrap();
    assert!(
        owner
            .take(THIRD, vote(number))
            .contains(&(THIRD.into(), assigned(ROBOT)))
    );
}

#[test]
fn a_served_goal_has_no_candidate_any_more() {
    let mut owner = owner_of_three();
    owner.take(ROBOT, bid_of(7));
    owner.wait(2.0);
    let mut sent = owner.take(ROBOT, About::Contract(ContractMessage::Done(claim(7))));
    let ended = about(OwnershipMessage::Ended(goal_id(0)));
    assert!(sent.contains(&(MEMBER.into(), ended)));
    owner.take(MEMBER, about(OwnershipMessage::Noted(goal_id(0))));
    for _ in 0..20 {
        sent = owner.take(MEMBER, about(OwnershipMessage::Present {}));
        sent.extend(owner.wait(1.0));
        assert!(!sent.contains(&(MEMBER.into(), ended)));
    }
    let mut voter = member(MEMBER, 3);
    voter.take(OWNER, request(5));
    let sent = voter.take(OWNER, ended);
    let noted = about(OwnershipMessage::Noted(goal_id(0)));
    assert!(sent.contains(&(OWNER.into(), noted)));
    // Another one does not know that.
    let sent = voter.take(THIRD, request(8));
    assert!(sent.contains(&(THIRD.into(), ended)));
    voter.wait(100.0);
    assert!(!voter.agent.knows(goal_id(0)));
    // A candidate believes it, an owner does not.
    let mut candidate = member(THIRD, 3);
    candidate.take(
        AgentId::OPERATOR,
        About::Contract(ContractMessage::Issue(TASK)),
    );
    candidate.take(MEMBER, ended);
    assert_eq!(candidate.agent.done().count(), 1);
    let mut owner = owner_of_three();
    owner.take(MEMBER, ended);
    assert_eq!(
        (owner.agent.done().count(), owner.agent.goals().count()),
        (0, 1)
    );
}

#[test]
fn of_two_candidates_the_one_with_the_higher_serial_number_gets_the_vote_of_the_other() {
    let issue = About::Contract(ContractMessage::Issue(TASK));
    let mut lower = member(OWNER, 3);
    lower.take(AgentId::OPERATOR, issue);
    assert_eq!(vote_for(&lower.take(MEMBER, request(5)), MEMBER), Some(5));
    let mut higher = member(THIRD, 3);
    higher.take(AgentId::OPERATOR, issue);
    assert_eq!(vote_for(&higher.take(MEMBER, request(5)), MEMBER), None);
    // An owner gives its vote to no controller.
    assert_eq!(
        vote_for(&owner_of_three().take(THIRD, request(5)), THIRD),
        None
    );
}

#[test]
fn a_candidate_that_no_majority_votes_for_reports_that_and_lets_others_try() {
    let (mut owner, number) = voted(5, MEMBER);
    owner.take(MEMBER, vote(number));
    let sent = owner.wait(11.0);
    let release = about(OwnershipMessage::Release(Claim {
        goal: goal_id(0),
        number,
    }));
    assert!(sent.contains(&(MEMBER.into(), release)));
    assert_eq!(owner.agent.lost().count(), 1);
    assert_eq!(vote_for(&owner.take(THIRD, request(8)), THIRD), Some(8));
    assert_eq!(owner.agent.lost().count(), 0);
}

#[test]
fn a_controller_that_restarts_votes_for_no_controller_for_the_longest_lease() {
    let mut voter = member(MEMBER, 3);
    voter.agent = Controller::restarted(Arc::new(Settings {
        max_drift: 0.0,
        count: 3,
        ..Settings::default()
    }));
    voter.wait(1.0);
    assert_eq!(vote_for(&voter.take(OWNER, request(5)), OWNER), None);
    voter.wait(30.0);
    assert_eq!(vote_for(&voter.take(OWNER, request(5)), OWNER), Some(5));
}

#[test]
fn repeated_requests_have_one_number_so_that_a_late_vote_counts() {
    let (mut owner, number) = voted(2, MEMBER);
    let sent = owner.wait(4.5);
    assert_eq!(requested(&sent, MEMBER), Some(number));
    owner.take(MEMBER, vote(number));
    assert_eq!(owner.agent.goals().count(), 1);
}

#[test]
fn a_goal_that_is_issued_to_a_voter_stays_with_its_owner() {
    let mut voter = member(MEMBER, 3);
    voter.take(OWNER, request(5));
    let issue = About::Contract(ContractMessage::Issue(TASK));
    let mut sent = voter.take(AgentId::OPERATOR, issue);
    sent.extend(voter.take(THIRD, about(OwnershipMessage::Present {})));
    assert_eq!(requested(&sent, THIRD), None);
    assert!(voter.agent.knows(goal_id(0)));
}

#[test]
fn a_renewal_of_a_lease_is_sent_before_the_offers_of_the_step() {
    let mut owner = owner_of_three();
    let steps = (1..200).map(|number| {
        let task = Task {
            id: goal_id(number),
            ..TASK
        };
        let mut sent = owner.take(
            AgentId::OPERATOR,
            About::Contract(ContractMessage::Issue(task)),
        );
        let present = about(OwnershipMessage::Present {});
        sent = [sent, owner.take(MEMBER, present)].concat();
        sent
    });
    let place = |sent: &[(Receiver, About)], is_meant: fn(&About) -> bool| {
        sent.iter().position(|(_, about)| is_meant(about))
    };
    let places = steps.filter_map(|sent| {
        let renewal = place(&sent, |sent| {
            matches!(sent, About::Lease(LeaseMessage::Renew(_)))
        })?;
        let request = place(&sent[renewal..], |sent| {
            matches!(sent, About::Ownership(OwnershipMessage::Entrust(_)))
        })?;
        Some((renewal, request))
    });
    assert!(places.count() > 0);
}

#[test]
fn a_controller_sends_each_voter_three_renewals_per_lease() {
    let mut owner = owner_of_three();
    let mut renewals = 0;
    let end_s = owner.now_s + 300.0;
    while owner.now_s < end_s {
        for (_, sent) in owner.wait(0.1) {
            if let About::Lease(LeaseMessage::Renew(renewal)) = sent {
                renewals += 1;
                owner.take(MEMBER, About::Lease(LeaseMessage::Renewed(renewal.number)));
            }
        }
    }
    assert_eq!(owner.agent.goals().count(), 1);
    assert!((28..=31).contains(&renewals), "{renewals}");
}
