//! Agents that are stepped by hand, and messages for them.

use crate::team::{STEP_S, brain, goal_id, robot_id, station_id};
use base::geometry::Point;
use brain::{
    About, AgentId, Award, Bid, Brain, Claim, Command, ContractMessage, GoalId, Message,
    OwnershipMessage, Percept, Reading, Reason, ReceivedMessage, Receiver, Refusal, Task,
};
use economy::{Controller, Settings};
use std::sync::Arc;

pub(crate) const ROBOT: AgentId = robot_id(0);
pub(crate) const OTHER: AgentId = robot_id(1);
pub(crate) const OWNER: AgentId = station_id(0);
pub(crate) const MEMBER: AgentId = station_id(1);

/// An agent that is stepped by hand.
pub(crate) struct Hand<A> {
    pub(crate) agent: A,
    id: AgentId,
    pub(crate) now_s: f64,
    /// The goals of which the operator acknowledges a report in the next step.
    reported: Vec<GoalId>,
}

/// The goal of a report to the operator.
pub(crate) fn reported((to, about): &(Receiver, About)) -> Option<GoalId> {
    match about {
        About::Contract(ContractMessage::Stuck(report) | ContractMessage::Refuse(report))
            if to.includes(AgentId::OPERATOR) =>
        {
            Some(report.goal)
        }
        _ => None,
    }
}

pub(crate) trait Agent {
    fn step(&mut self, percept: &Percept) -> Command;
}

impl Agent for Controller {
    fn step(&mut self, percept: &Percept) -> Command {
        let mut command = Command::default();
        self.step_into(percept, &mut command);
        command
    }
}

impl Agent for Brain {
    fn step(&mut self, percept: &Percept) -> Command {
        Brain::step(self, percept)
    }
}

impl<A: Agent> Hand<A> {
    /// A step with messages; returns those that it sends about goals, and their receivers.
    pub(crate) fn step(&mut self, inbox: &[(AgentId, Receiver, About)]) -> Vec<(Receiver, About)> {
        self.now_s += STEP_S;
        let acknowledged = self
            .reported
            .drain(..)
            .map(|goal| About::Contract(ContractMessage::Acknowledge(goal)));
        let acknowledged: Vec<_> = acknowledged
            .map(|about| (AgentId::OPERATOR, Receiver::Agent(self.id), about))
            .collect();
        let inbox = inbox.iter().chain(&acknowledged);
        let inbox = inbox.map(|(from, to, about)| ReceivedMessage {
            from: *from,
            age_s: 0.0,
            message: Message::to(*to, *about),
        });
        let percept = Percept {
            time_s: Some(self.now_s),
            id: self.id,
            position: now(Point::default()),
            heading_rad: now(0.0),
            inbox: inbox.collect(),
            ..Percept::default()
        };
        let sent = self.agent.step(&percept).outbox.into_iter();
        let sent = sent.filter(|message| message.about.is_of_economy());
        let sent = sent.map(|message| (message.to, message.about));
        let sent: Vec<(Receiver, About)> = sent.collect();
        self.reported.extend(sent.iter().filter_map(reported));
        sent
    }

    /// The same with one message to the agent.
    pub(crate) fn take(&mut self, from: AgentId, about: About) -> Vec<(Receiver, About)> {
        self.step(&[(from, self.id.into(), about)])
    }

    /// Steps without messages for a time; returns what it sends.
    pub(crate) fn wait(&mut self, time_s: f64) -> Vec<(Receiver, About)> {
        let end_s = self.now_s + time_s;
        let mut sent = Vec::new();
        while self.now_s < end_s {
            sent.extend(self.step(&[]));
        }
        sent
    }
}

#[expect(clippy::unnecessary_wraps, reason = "fields of percepts are optional")]
pub(crate) const fn now<T>(value: T) -> Option<Reading<T>> {
    Some(Reading { value, age_s: 0.0 })
}

/// A controller that owns its goals alone.
pub(crate) fn controller(id: AgentId) -> Hand<Controller> {
    member(id, 1)
}

/// A controller of a kind with a number of them.
pub(crate) fn member(id: AgentId, members: u32) -> Hand<Controller> {
    let settings = Settings {
        max_drift: 0.0,
        count: members,
        ..Settings::default()
    };
    Hand {
        agent: Controller::new(Arc::new(settings)),
        id,
        now_s: 0.0,
        reported: Vec::new(),
    }
}

/// A candidate to which the goal was issued, and the number of its request for the vote of a member.
pub(crate) fn voted(members: u32, voter: AgentId) -> (Hand<Controller>, u32) {
    let mut candidate = member(OWNER, members);
    let issue = About::Contract(ContractMessage::Issue(TASK));
    candidate.take(AgentId::OPERATOR, issue);
    let sent = candidate.take(voter, About::Ownership(OwnershipMessage::Present {}));
    let number = sent.iter().find_map(|(_, sent)| match sent {
        About::Ownership(OwnershipMessage::Entrust(request)) => Some(request.number),
        _ => None,
    });
    (candidate, number.unwrap())
}

/// One of three controllers, which owns the goal by the vote of a member.
pub(crate) fn owner_of_three() -> Hand<Controller> {
    let (mut owner, number) = voted(3, MEMBER);
    let vote = Award {
        goal: goal_id(0),
        number,
        lease_s: 30.0,
    };
    owner.take(MEMBER, About::Ownership(OwnershipMessage::Entrusted(vote)));
    assert_eq!(owner.agent.goals().count(), 1);
    owner
}

/// A robot that has received the call of a goal 10 m away.
pub(crate) fn robot() -> Hand<Brain> {
    Hand {
        agent: brain(&[], ""),
        id: ROBOT,
        now_s: 0.0,
        reported: Vec::new(),
    }
}

pub(crate) const CALL: About = About::Contract(ContractMessage::Call {
    number: 4,
    task: Task {
        at_m: [10.0, 0.0],
        ..TASK
    },
});

pub(crate) const TASK: Task = Task {
    id: brain::GoalId {
        issuer: brain::Issuer::Agent(AgentId::OPERATOR),
        number: 0,
    },
    at_m: [10.0, 0.0],
    radius_m: 1.0,
    value: 1.0,
    service_s: 1.0,
    due_s: f32::MAX,
    work: brain::Work::Visit,
    capability: 0,
};

pub(crate) fn claim(number: u32) -> Claim {
    Claim {
        goal: goal_id(0),
        number,
    }
}

pub(crate) fn award(number: u32) -> About {
    About::Contract(ContractMessage::Award(Award {
        goal: goal_id(0),
        number,
        lease_s: 20.0,
    }))
}

pub(crate) fn refusal(number: u32, reason: Reason) -> Refusal {
    Refusal {
        goal: goal_id(0),
        number,
        reason,
    }
}

/// The first bid of what is sent.
pub(crate) fn bid(sent: &[(Receiver, About)]) -> Option<Bid> {
    sent.iter().find_map(|(_, about)| match about {
        About::Contract(ContractMessage::Bid(bid)) => Some(*bid),
        _ => None,
    })
}

/// A robot that serves the goal, and the number of its bid.
pub(crate) fn assignee() -> (Hand<Brain>, u32) {
    let mut robot = robot();
    let sent = robot.step(&[(OWNER, Receiver::All, CALL)]);
    let number = bid(&sent).unwrap().number;
    assert!(robot.take(OWNER, award(number)).contains(&(
        OWNER.into(),
        About::Contract(ContractMessage::Commit(claim(number)))
    )));
    (robot, number)
}

pub(crate) fn sent_any(sent: &[(Receiver, About)], is_meant: impl Fn(&About) -> bool) -> bool {
    sent.iter().any(|(_, about)| is_meant(about))
}

/// A controller that owns the goal, and has received a bid of a robot.
pub(crate) fn owner() -> Hand<Controller> {
    let mut owner = controller(OWNER);
    owner.take(
        AgentId::OPERATOR,
        About::Contract(ContractMessage::Issue(TASK)),
    );
    owner.step(&[(ROBOT, OWNER.into(), bid_of(7))]);
    owner
}

pub(crate) fn bid_of(number: u32) -> About {
    About::Contract(ContractMessage::Bid(Bid {
        goal: goal_id(0),
        number,
        time_s: 6.0,
        total_s: 6.0,
        energy: 0.0,
        call: 0,
    }))
}

/// A controller that has awarded the goal to a robot.
pub(crate) fn awarder() -> Hand<Controller> {
    let mut owner = owner();
    assert!(owner.wait(2.0).contains(&(ROBOT.into(), award(7))));
    owner
}

pub(crate) fn assignee_of(owner: &Hand<Controller>) -> Option<AgentId> {
    Some(owner.agent.goals().next()?.assignee?.0)
}
