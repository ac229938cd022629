use super::Messaging;
use super::commitment::Commitment;
use super::receive::MAX_OBSERVATION_RATE_HZ;
use crate::goals::proposal::Destination;
use crate::io::agent_id::{AgentId, Receiver};
use crate::io::body::Body;
use crate::io::body::Detector;
use crate::io::goal_id::GoalId;
use crate::io::message::CommitmentStatus;
use crate::io::message::{About, Message, Provenance};
use crate::io::percept::ReceivedMessage;
use crate::io::percept::{Observation, Percept};
use crate::perception::beliefs::Beliefs;
use crate::perception::beliefs::coverage_map::MAX_DETECTION;
use crate::perception::beliefs::coverage_map::tests::detector;
use crate::perception::beliefs::{BeliefsSpec, TrustSpec};
use crate::perception::dead_reckoning::Odometry;
use crate::world_of_walls::{now, rover};
use base::geometry::Point;
use base::geometry::Rectangle;

const ME: AgentId = AgentId::robot(0, 0);
const MATE: AgentId = AgentId::robot(0, 1);

/// A robot that detects items all around, up to 2 m, on a field of 20 m by 20 m.
fn body(probability: f64) -> Body {
    let corner = Point { x: 20.0, y: 20.0 };
    Body {
        detectors: vec![Detector {
            false_alarms_per_m2: vec![0.01],
            ..detector(2.0, 7.0, probability)
        }],
        item_kinds: vec!["mine".into()],
        field: Some(Rectangle::spanned(Point::default(), corner)),
        ..rover()
    }
}

struct Robot {
    beliefs: Beliefs,
    messaging: Messaging,
    body: Body,
}

impl Robot {
    fn new(probability: f64, trust: f64) -> Self {
        let body = body(probability);
        let spec = BeliefsSpec {
            trust: TrustSpec {
                initial: trust,
                ..TrustSpec::default()
            },
            ..BeliefsSpec::default()
        };
        Self {
            beliefs: Beliefs::new(&spec, &body),
            messaging: Messaging::new(&spec, &body),
            body,
        }
    }

    /// One step at (8, 10), with or without an observation.
    fn step(&mut self, observes: bool, inbox: Vec<ReceivedMessage>) {
        let observation = Observation {
            sensor: 0,
            age_s: 0.0,
        };
        let percept = Percept {
            id: ME,
            position: Some(now(Point { x: 8.0, y: 10.0 })),
            heading_rad: Some(now(0.0)),
            observations: if observes {
                vec![observation]
            } else {
                Vec::new()
            },
            inbox,
            ..Percept::default()
        };
        self.perceive(&percept);
    }

    fn perceive(&mut self, percept: &Percept) {
        let (body, still) = (&self.body, still(&self.body));
        self.beliefs.update(percept, body, &[], &still);
        self.messaging
            .receive(percept, body, still.elapsed_s, &mut self.beliefs);
    }

    fn broadcast(&mut self, goal: Option<Destination>, elapsed_s: f64, outbox: &mut Vec<Message>) {
        let commitment = Commitment {
            goal,
            service: None,
        };
        self.messaging
            .broadcast(&mut self.beliefs, &commitment, elapsed_s, outbox);
    }

    fn last_confidence(&self) -> f64 {
        let items = self.messaging.believed_items(&self.beliefs);
        items.last().unwrap().confidence
    }

    /// Steps without messages for a duration in seconds.
    fn wait(&mut self, for_s: f64) {
        let mut left_s = for_s - self.body.period_s / 2.0;
        while left_s > 0.0 {
            self.step(false, Vec::new());
            left_s -= self.body.period_s;
        }
    }

    /// Probability that an item at a position would have been detected.
    fn detected(&self, x: f64, y: f64) -> f64 {
        let map = self.beliefs.map.as_ref().unwrap();
        1.0 - map.coverage.of(map.field.cell(Point { x, y }).unwrap())
    }
}

fn still(body: &Body) -> Odometry {
    Odometry {
        elapsed_s: body.period_s,
        speed_m_s: 0.0,
        turned_rad: 0.0,
        is_commanded: false,
    }
}

fn received(about: About, confidence: f64) -> ReceivedMessage {
    ReceivedMessage {
        from: MATE,
        age_s: 0.0,
        message: Message {
            to: Receiver::All,
            about,
            confidence,
        },
    }
}

/// A message of a team mate about its pose and number of observations.
fn mate(x: f64, y: f64, observations: u32, confidence: f64) -> ReceivedMessage {
    let at = Point { x, y };
    let heading_rad = 0.0;
    received(
        About::Sender {
            at,
            heading_rad,
            observations,
        },
        confidence,
    )
}

/// The thesis's example: a range of 2, and a fully confident sender 5 away with a range of 2.
#[test]
fn a_report_extends_the_map_around_its_sender_but_not_to_a_full_disc() {
    let mut robot = Robot::new(1.0, 1.0);
    robot.step(true, vec![mate(13.0, 10.0, 1, 1.0)]);
    for x in [6.2, 8.0, 9.8, 11.2, 13.0, 14.8] {
        assert!(robot.detected(x, 10.0) > MAX_DETECTION - 1e-6, "{x}");
    }
    for (x, y) in [
        (8.0, 13.0),
        (8.0, 7.0),
        (4.0, 10.0),
        (10.5, 11.0),
        (12.0, 13.0),
    ] {
        assert!(robot.detected(x, y) < 0.01, "{x} {y}");
    }
}

#[test]
fn a_report_is_weighted_by_its_confidence_times_the_trust_in_its_sender() {
    let mut robot = Robot::new(1.0, 0.8);
    robot.step(false, vec![mate(13.0, 10.0, 1, 0.5)]);
    assert!((robot.detected(13.0, 10.5) - 0.4 * MAX_DETECTION).abs() < 1e-6);
}

#[test]
fn observations_of_a_lost_message_are_included_in_the_next() {
    let (mut all, mut last) = (Robot::new(0.3, 0.9), Robot::new(0.3, 0.9));
    for observations in [1, 4, 6] {
        all.step(false, vec![mate(13.0, 10.0, observations, 1.0)]);
        let is_lost = observations == 4;
        last.step(
            false,
            if is_lost {
                Vec::new()
            } else {
                vec![mate(13.0, 10.0, observations, 1.0)]
            },
        );
    }
    let expected = 0.9 * (1.0 - libm::pow(0.7, 6.0));
    for robot in [&all, &last] {
        assert!((robot.detected(13.0, 10.5) - expected).abs() < 1e-6);
    }
}

#[test]
fn observations_on_the_path_of_a_team_mate_extend_the_map() {
    let mut robot = Robot::new(1.0, 1.0);
    robot.step(false, vec![mate(4.0, 4.0, 1, 1.0)]);
    robot.wait(10.0);
    robot.step(false, vec![mate(14.0, 4.0, 40, 1.0)]);
    for x in [3.0, 6.0, 9.0, 12.0, 15.0] {
        assert!(robot.detected(x, 4.0) > MAX_DETECTION - 1e-6, "{x}");
    }
    assert!(robot.detected(9.0, 7.0) < 0.01);
}

#[test]
fn trust_in_a_sender_of_false_reports_falls() {
    let mut robot = Robot::new(0.8, 0.9);
    let mut before = 0.9;
    for track_id in 1..5 {
        // In view, at a different position each time.
        robot.step(
            false,
            vec![relayed(
                MATE,
                MATE,
                7.0 + 0.5 * f64::from(track_id),
                track_id,
            )],
        );
        let sent = robot.last_confidence();
        (0..8).for_each(|_| robot.step(true, Vec::new()));
        let trust = robot.messaging.trust.of(MATE);
        assert!(trust < before, "{trust}");
        before = trust;
        let refuted = robot.last_confidence();
        assert!(refuted < 0.1 * sent, "{sent} {refuted}");
    }
    assert!((before - 4.0 * 0.9 / 8.0).abs() < 1e-6, "{before}");
}

#[test]
fn a_robot_broadcasts_once_per_second_if_its_pose_is_known() {
    let mut robot = Robot::new(1.0, 1.0);
    let mut outbox = Vec::new();
    robot.broadcast(None, 0.1, &mut outbox);
    assert!(outbox.is_empty());
    robot.step(true, Vec::new());
    for _ in 0..30 {
        robot.broadcast(None, 0.1, &mut outbox);
    }
    let senders = outbox.iter().filter(|m| {
        matches!(
            m.about,
            About::Sender {
                observations: 1,
                ..
            }
        )
    });
    assert_eq!(senders.count(), 3, "{outbox:?}");
}

#[test]
fn a_turning_robot_broadcasts_its_heading_at_once() {
    let mut robot = Robot::new(1.0, 1.0);
    let turned = |heading_rad: f64| {
        let percept = Percept {
            id: ME,
            position: Some(now(Point { x: 8.0, y: 10.0 })),
            heading_rad: Some(now(heading_rad)),
            observations: vec![Observation {
                sensor: 0,
                age_s: 0.0,
            }],
            ..Percept::default()
        };
        robot.perceive(&percept);
        let mut outbox = Vec::new();
        robot.broadcast(None, 0.1, &mut outbox);
        let is_sender = |message: &Message| matches!(message.about, About::Sender { .. });
        outbox.iter().any(is_sender)
    };
    let sent = [0.0, 0.1, 0.5, 0.6, 0.1].map(turned);
    assert_eq!(sent, [false, false, true, false, true]);
}

#[test]
fn a_new_destination_and_an_arrival_are_broadcast_at_once() {
    let mut robot = Robot::new(1.0, 1.0);
    robot.step(true, Vec::new());
    let (far, here) = (Point { x: 1.0, y: 2.0 }, Point { x: 8.3, y: 10.0 });
    let goals = |robot: &mut Robot, goal: Option<Point>| {
        let mut outbox = Vec::new();
        let aim = goal.map(|at| Destination {
            id: GoalId {
                issuer: AgentId::default().into(),
                number: u32::from(at == here),
            },
            at,
            tolerance_m: 0.5,
            max_deviation_m: f64::INFINITY,
            is_at_hazard: false,
            max_speed_m_s: 1.0,
            value: 1.0,
        });
        robot.broadcast(aim, 0.01, &mut outbox);
        outbox.iter().filter_map(status).collect::<Vec<_>>()
    };
    assert_eq!(
        goals(&mut robot, Some(far)),
        [(far, CommitmentStatus::Active)]
    );
    assert_eq!(goals(&mut robot, Some(far)), []);
    assert_eq!(
        goals(&mut robot, Some(here)),
        [(here, CommitmentStatus::Active)]
    );
    let ended = [
        (here, CommitmentStatus::Done),
        (far, CommitmentStatus::Active),
    ];
    assert_eq!(goals(&mut robot, Some(far)), ended);
    assert_eq!(goals(&mut robot, None), [(far, CommitmentStatus::Released)]);
}

#[test]
fn a_goal_that_moves_is_broadcast_at_its_new_place_and_is_neither_done_nor_released() {
    let mut robot = Robot::new(1.0, 1.0);
    robot.step(true, Vec::new());
    let mut sent = |x| {
        let moving = Destination {
            id: GoalId::default(),
            at: Point { x, y: 10.0 },
            tolerance_m: 0.5,
            max_deviation_m: f64::INFINITY,
            is_at_hazard: false,
            max_speed_m_s: 1.0,
            value: 1.0,
        };
        let mut outbox = Vec::new();
        robot.broadcast(Some(moving), 0.01, &mut outbox);
        outbox.iter().filter_map(status).collect::<Vec<_>>()
    };
    for x in [8.1, 8.4, 9.0] {
        assert_eq!(sent(x), [(Point { x, y: 10.0 }, CommitmentStatus::Active)]);
        assert_eq!(sent(x), []);
    }
}

fn status(message: &Message) -> Option<(Point, CommitmentStatus)> {
    match message.about {
        About::Goal { at, status, .. } => Some((at, status)),
        _ => None,
    }
}

#[test]
fn invalid_messages_are_ignored() {
    let mut robot = Robot::new(1.0, 1.0);
    for bad in [f64::NAN, f64::INFINITY, -1.0, 1.5] {
        robot.step(
            false,
            vec![mate(13.0, 10.0, 1, bad), mate(13.0, bad * 1e8, 2, 1.0)],
        );
    }
    assert!(robot.detected(13.0, 10.5) < 1e-9);
}

/// A report by a team mate of its own or another robot's observations.
fn relayed(from: AgentId, observer: AgentId, x: f64, track_id: u32) -> ReceivedMessage {
    let (at, observations) = (Point { x, y: 9.5 }, 1);
    let provenance = Provenance {
        observer,
        track_id,
        observations,
    };
    ReceivedMessage {
        from,
        ..received(
            About::Item {
                kind: 0,
                at,
                provenance,
                kind_share: None,
            },
            0.95,
        )
    }
}

#[test]
fn a_false_relayed_report_lowers_the_trust_in_its_sender() {
    let (mut robot, innocent) = (Robot::new(0.8, 0.9), AgentId::robot(0, 3));
    for track_id in 1..5 {
        robot.step(
            false,
            vec![relayed(
                MATE,
                innocent,
                7.0 + 0.5 * f64::from(track_id),
                track_id,
            )],
        );
        (0..8).for_each(|_| robot.step(true, Vec::new()));
    }
    assert!((robot.messaging.trust.of(innocent) - 0.9).abs() < 1e-6);
    assert!((robot.messaging.trust.of(MATE) - 4.0 * 0.9 / 8.0).abs() < 1e-6);
}

#[test]
fn a_report_that_is_relayed_later_counts_for_its_first_sender() {
    let (mut robot, other) = (Robot::new(0.8, 0.9), AgentId::robot(0, 3));
    robot.step(
        false,
        vec![relayed(MATE, MATE, 8.0, 1), relayed(other, MATE, 8.0, 1)],
    );
    (0..8).for_each(|_| robot.step(true, Vec::new()));
    assert!((robot.messaging.trust.of(other) - 0.9).abs() < 1e-6);
    assert!(robot.messaging.trust.of(MATE) < 0.8);
}

#[test]
fn implausibly_many_observations_are_limited() {
    let mut robot = Robot::new(0.01, 1.0);
    robot.step(false, vec![mate(13.0, 10.0, 1, 1.0)]);
    robot.wait(0.9);
    robot.step(
        false,
        vec![
            mate(13.0, 10.0, 100_000, 1.0),
            mate(13.0, 10.0, 900_000, 1.0),
        ],
    );
    let most = 1.0 - libm::pow(0.99, 1.0 + MAX_OBSERVATION_RATE_HZ);
    let seen = robot.detected(13.0, 10.5);
    assert!((seen - most).abs() < 1e-5, "{seen} {most}");
}

#[test]
fn messages_with_invalid_ages_are_ignored_and_observations_count_less_with_their_age() {
    for (age_s, is_believed) in [
        (0.0, true),
        (300.0, true),
        (1200.0, false),
        (1e9, false),
        (-3.0, false),
        (f64::NAN, false),
        (f64::INFINITY, false),
    ] {
        let mut robot = Robot::new(1.0, 1.0);
        robot.step(
            false,
            vec![ReceivedMessage {
                age_s,
                ..mate(13.0, 10.0, 1, 1.0)
            }],
        );
        assert_eq!(robot.detected(13.0, 10.5) > 0.5, is_believed, "{age_s}");
    }
}
