//! Serving the goals of controllers, beside other behaviours.

use crate::{body, brain, now, percept_at};
use brain::{
    About, AgentId, Award, Body, Brain, Claim, Command, CommitmentStatus, ContractMessage, GoalId,
    Issuer, Message, Other, Percept, Reason, ReceivedMessage, Task, Work,
};

const OWNER: AgentId = AgentId::controller(1, 0);

const TASK: Task = Task {
    id: GoalId {
        issuer: Issuer::Agent(AgentId::OPERATOR),
        number: 0,
    },
    at_m: [10.0, 0.0],
    radius_m: 0.5,
    value: 1.0,
    service_s: 1.0,
    due_s: f32::MAX,
    work: Work::Visit,
    capability: 0,
};

/// A robot that is stepped with messages of a controller.
struct Robot {
    brain: Brain,
    time_s: f64,
    x: f64,
    battery: Option<f64>,
}

impl Robot {
    fn new(below: &str, above: &str) -> Self {
        let spec = format!(
            r#"{{"limit_speed_to_stopping_distance": false, "behaviours": [{below} {{"kind": "serve"}} {above}]}}"#
        );
        let body = Body {
            others: vec![Other::default()],
            ..body()
        };
        Self {
            brain: brain(&spec, body),
            time_s: 0.0,
            x: 0.0,
            battery: None,
        }
    }

    /// A step; returns the messages about goals.
    fn step(&mut self, messages: &[About], touches: bool) -> Vec<About> {
        let sent = self.command(messages, touches).outbox.into_iter();
        let sent = sent
            .map(|message| message.about)
            .filter(About::is_of_economy);
        sent.collect()
    }

    fn command(&mut self, messages: &[About], touches: bool) -> Command {
        let messages = messages.iter().map(|about| (OWNER, *about));
        self.command_from(messages, touches)
    }

    /// A step with messages of several controllers.
    fn command_from(
        &mut self,
        messages: impl IntoIterator<Item = (AgentId, About)>,
        touches: bool,
    ) -> Command {
        self.time_s += 0.1;
        let inbox = messages.into_iter().map(|(from, about)| ReceivedMessage {
            from,
            age_s: 0.0,
            message: Message::to_all(about),
        });
        let percept = Percept {
            time_s: Some(self.time_s),
            inbox: inbox.collect(),
            touch: now(touches),
            battery: self.battery.and_then(now),
            ..percept_at(self.x, 0.0, 0.0)
        };
        let command = self.brain.step(&percept);
        self.x += 0.1 * command.motion.speed_m_s;
        command
    }

    fn speed_m_s(&self) -> f64 {
        self.brain.last_command().motion.speed_m_s
    }

    /// Bids for the goal and is awarded it, for a long time.
    fn win(&mut self) {
        self.win_task(TASK);
    }

    fn win_task(&mut self, task: Task) {
        let sent = self.step(
            &[About::Contract(ContractMessage::Call { number: 0, task })],
            false,
        );
        let number = sent.iter().find_map(|sent| match sent {
            About::Contract(ContractMessage::Bid(bid)) => Some(bid.number),
            _ => None,
        });
        let award = Award {
            goal: TASK.id,
            number: number.unwrap(),
            lease_s: 3600.0,
        };
        self.step(&[About::Contract(ContractMessage::Award(award))], false);
        assert_eq!(self.brain.served_goals().len(), 1);
    }
}

const CALL: About = About::Contract(ContractMessage::Call {
    number: 0,
    task: TASK,
});

/// Awards of two controllers that arrive together: otherwise the one that is received first would win each time,
/// and the goals of the other be served last, whatever their value.
#[test]
fn of_two_awards_that_arrive_together_a_robot_with_room_for_one_takes_the_better() {
    for (first, second, taken) in [(1.0, 5.0, 1), (5.0, 1.0, 0)] {
        let mut robot = Robot::new("", "");
        let spec = r#"{"behaviours": [{"kind": "serve", "max_goals": 1}]}"#;
        let body = Body {
            others: vec![Other::default()],
            ..body()
        };
        robot.brain = brain(spec, body);
        let owners = [0, 1].map(|index| AgentId::controller(1, index));
        let tasks = [(0, first), (1, second)].map(|(number, value)| Task {
            id: GoalId { number, ..TASK.id },
            value,
            ..TASK
        });
        let calls = tasks.map(|task| About::Contract(ContractMessage::Call { number: 0, task }));
        let calls = [(owners[0], calls[0]), (owners[1], calls[1])];
        let sent = robot.command_from(calls, false).outbox.into_iter();
        let bids = sent.filter_map(|message| match message.about {
            About::Contract(ContractMessage::Bid(bid)) => Some(bid),
            _ => None,
        });
        let bids: Vec<_> = bids.collect();
        let awards = [0, 1].map(|index: usize| {
            let goal = tasks[index].id;
            let bid = bids.iter().find(|bid| bid.goal == goal).unwrap();
            let award = Award {
                goal,
                number: bid.number,
                lease_s: 3600.0,
            };
            (
                owners[index],
                About::Contract(ContractMessage::Award(award)),
            )
        });
        robot.command_from(awards, false);
        let served = robot.brain.served_goals();
        let served: Vec<GoalId> = served.iter().map(|served| served.task.id).collect();
        assert_eq!(served, [tasks[taken].id]);
    }
}

#[test]
fn without_an_award_the_behaviours_below_are_active() {
    let mut robot = Robot::new(r#"{"kind": "cruise", "speed_m_s": 0.3},"#, "");
    robot.step(&[], false);
    assert!((robot.speed_m_s() - 0.3).abs() < 1e-9);
    robot.win();
    robot.step(&[], false);
    assert!(robot.speed_m_s() > 0.5);
}

#[test]
fn avoidance_outranks_service() {
    let mut robot = Robot::new("", r#", {"kind": "avoid"}"#);
    robot.win();
    robot.step(&[], false);
    assert!(robot.speed_m_s() > 0.5);
    (0..10).for_each(|_| {
        robot.step(&[], true);
    });
    assert!(robot.speed_m_s() <= 0.0, "{}", robot.speed_m_s());
}

#[test]
fn a_robot_drives_to_its_goal_stays_for_the_service_and_reports_that() {
    let mut robot = Robot::new("", "");
    robot.win();
    let mut arrived_s = None;
    for _ in 0..400 {
        let sent = robot.step(&[], false);
        if robot.x > 9.5 && arrived_s.is_none() {
            arrived_s = Some(robot.time_s);
        }
        if sent
            .iter()
            .any(|sent| matches!(sent, About::Contract(ContractMessage::Done(claim)) if claim.goal == TASK.id))
        {
            let served_s = robot.time_s - arrived_s.unwrap();
            assert!((1.0..1.5).contains(&served_s), "{served_s}");
            assert!(robot.brain.served_goals().is_empty());
            return;
        }
    }
    panic!("not done");
}

/// The announcements of the goal in all steps until a message that is about to be sent, and in it.
fn announced(robot: &mut Robot, until: impl Fn(&Command) -> bool) -> Vec<CommitmentStatus> {
    let mut statuses = Vec::new();
    for _ in 0..200 {
        let command = robot.command(&[], false);
        let own = command
            .outbox
            .iter()
            .filter_map(|message| match message.about {
                About::Goal { id, status, .. } if id == TASK.id => Some(status),
                _ => None,
            });
        statuses.extend(own);
        if until(&command) {
            break;
        }
    }
    statuses
}

fn has_done(command: &Command) -> bool {
    let mut sent = command.outbox.iter();
    sent.any(|message| matches!(message.about, About::Contract(ContractMessage::Done(_))))
}

#[test]
fn a_robot_announces_a_goal_as_done_after_its_service_and_not_at_its_arrival() {
    let mut robot = Robot::new("", "");
    robot.win();
    let statuses = announced(&mut robot, has_done);
    let (last, before) = statuses.split_last().unwrap();
    assert_eq!(*last, CommitmentStatus::Done);
    assert!(
        before
            .iter()
            .all(|status| *status == CommitmentStatus::Active),
        "{before:?}"
    );
}

#[test]
fn a_robot_stays_for_the_time_of_service_to_the_step() {
    for service_s in [0.1, 1.0, 2.0, 5.0] {
        let mut robot = Robot::new("", "");
        robot.win_task(Task { service_s, ..TASK });
        let mut arrived_s = f64::INFINITY;
        loop {
            let at_s = robot.time_s + 0.1;
            if (robot.x - 10.0).abs() <= 0.5 {
                arrived_s = arrived_s.min(at_s);
            }
            if has_done(&robot.command(&[], false)) {
                break;
            }
        }
        let stayed_s = robot.time_s - arrived_s;
        assert!(
            (stayed_s - f64::from(service_s)).abs() < 0.01,
            "{service_s} {stayed_s}"
        );
    }
}

#[test]
fn a_robot_that_does_not_come_nearer_reports_that_it_is_stuck_and_does_not_bid_again_soon() {
    let mut robot = Robot::new("", "");
    robot.win();
    let mut reasons = Vec::new();
    let mut number = 0;
    for _ in 0..400 {
        let sent = robot.step(&[], false);
        robot.x = 0.0;
        for each in sent {
            if let About::Contract(ContractMessage::Stuck(refusal)) = each {
                reasons.push(refusal.reason);
                number = refusal.number;
            }
        }
    }
    assert_eq!(reasons, [Reason::Unreachable]);
    let goal = TASK.id;
    let to = AgentId::default();
    robot.time_s += 0.1;
    let withdrawal = ReceivedMessage {
        from: OWNER,
        age_s: 0.0,
        message: Message::to(
            to,
            About::Contract(ContractMessage::Withdraw(Claim { goal, number })),
        ),
    };
    let percept = Percept {
        time_s: Some(robot.time_s),
        inbox: vec![withdrawal],
        ..percept_at(0.0, 0.0, 0.0)
    };
    robot.brain.step(&percept);
    assert!(robot.brain.served_goals().is_empty());
    let sent: Vec<About> = (0..50).flat_map(|_| robot.step(&[CALL], false)).collect();
    assert!(
        !sent
            .iter()
            .any(|sent| matches!(sent, About::Contract(ContractMessage::Bid(_))))
    );
}

#[test]
fn a_robot_does_not_bid_for_a_goal_for_which_its_battery_does_not_last() {
    for (per_step, bids) in [(0.02, false), (0.001, true)] {
        let mut robot = Robot::new("", "");
        let mut charge = 1.0;
        let mut sent = Vec::new();
        for step in 0..80 {
            charge -= if step < 60 { per_step / 2.0 } else { 0.0 };
            robot.battery = Some(charge);
            let call: &[About] = if step == 70 { &[CALL] } else { &[] };
            sent.extend(robot.step(call, false));
        }
        let has_bid = sent
            .iter()
            .any(|sent| matches!(sent, About::Contract(ContractMessage::Bid(_))));
        assert_eq!(has_bid, bids, "{per_step}");
    }
}

#[test]
fn a_robot_whose_battery_does_not_last_returns_its_goals_with_the_reason() {
    let mut robot = Robot::new("", "");
    robot.win();
    let mut sent = Vec::new();
    for step in 0..80 {
        robot.battery = Some(1.0 - 0.012 * f64::from(step));
        sent.extend(robot.step(&[], false));
        robot.x = 0.0;
    }
    let is_reason = |sent: &About| matches!(sent, About::Contract(ContractMessage::Stuck(refusal)) if refusal.reason == Reason::Battery);
    assert!(sent.iter().any(is_reason));
    assert!(
        sent.iter()
            .any(|sent| matches!(sent, About::Contract(ContractMessage::Release(_))))
    );
    assert!(robot.brain.served_goals().is_empty());
}

#[test]
fn the_state_of_service_is_part_of_the_hash() {
    let hash = |robot: &Robot| {
        let mut hash = base::hash::Hash::default();
        robot.brain.hash_beliefs(&mut hash);
        hash.value()
    };
    let [mut one, mut other] = [(); 2].map(|()| Robot::new("", ""));
    one.step(&[CALL], false);
    other.step(&[], false);
    assert_ne!(hash(&one), hash(&other));
}
