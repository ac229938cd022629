use super::*;
use crate::io::body::{Detector, RobotId};
use crate::io::message::Provenance;
use crate::io::percept::{Observation, Percept};
use crate::perception::beliefs::coverage_map::SUREST;
use crate::perception::beliefs::coverage_map::tests::detector;
use crate::perception::beliefs::{BeliefsSpec, TrustSpec};
use crate::world_of_walls::{now, rover};
use base::geometry::Rectangle;

const ME: RobotId = RobotId { kind: 0, index: 0 };
const MATE: RobotId = RobotId { kind: 0, index: 1 };

/// A robot that recognises items all around as far as 2 m, on a field of 20 m by 20 m.
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
            body,
        }
    }

    /// Stands at (8, 10), and perhaps observations.
    fn step(&mut self, observations: bool, inbox: Vec<ReceivedMessage>) {
        let look = Observation {
            sensor: 0,
            age_s: 0.0,
        };
        let percept = Percept {
            id: ME,
            position: Some(now(Point { x: 8.0, y: 10.0 })),
            heading_rad: Some(now(0.0)),
            observations: if observations { vec![look] } else { Vec::new() },
            inbox,
            ..Percept::default()
        };
        self.beliefs.take_in(&percept, &self.body, &[], [0.0, 0.0]);
    }

    /// Stands and hears nothing for so long, in seconds.
    fn wait(&mut self, for_s: f64) {
        let mut left_s = for_s - self.body.period_s / 2.0;
        while left_s > 0.0 {
            self.step(false, Vec::new());
            left_s -= self.body.period_s;
        }
    }

    /// How surely an item at a place would have been seen.
    fn seen(&self, x: f64, y: f64) -> f64 {
        let map = self.beliefs.map.as_ref().unwrap();
        1.0 - map.unseen.of(map.field.cell(Point { x, y }).unwrap())
    }
}

fn heard(about: About, confidence: f64) -> ReceivedMessage {
    ReceivedMessage {
        from: MATE,
        age_s: 0.0,
        message: Message { about, confidence },
    }
}

/// A mate tells where it is, and how often it has looked.
fn mate(x: f64, y: f64, observations: u32, confidence: f64) -> ReceivedMessage {
    let at = Point { x, y };
    let heading_rad = 0.0;
    heard(
        About::Sender {
            at,
            heading_rad,
            observations,
        },
        confidence,
    )
}

fn item(x: f64, y: f64, track_id: u32) -> ReceivedMessage {
    let provenance = Provenance {
        observer: MATE,
        track_id,
        observations: 1,
    };
    let at = Point { x, y };
    heard(
        About::Item {
            kind: 0,
            at,
            provenance,
        },
        0.95,
    )
}

/// The thesis's example: a range of 2, and a sender 5 away with a range of 2 that is quite sure.
#[test]
fn a_report_extends_the_picture_towards_its_sender_but_not_to_a_full_disc() {
    let mut robot = Robot::new(1.0, 1.0);
    robot.step(true, vec![mate(13.0, 10.0, 1, 1.0)]);
    for x in [6.2, 8.0, 9.8, 11.2, 13.0, 14.8] {
        assert!(robot.seen(x, 10.0) > SUREST - 1e-6, "{x}");
    }
    for (x, y) in [
        (8.0, 13.0),
        (8.0, 7.0),
        (4.0, 10.0),
        (10.5, 11.0),
        (12.0, 13.0),
    ] {
        assert!(robot.seen(x, y) < 0.01, "{x} {y}");
    }
}

#[test]
fn a_report_counts_as_its_confidence_times_the_trust_in_its_sender() {
    let mut robot = Robot::new(1.0, 0.8);
    robot.step(false, vec![mate(13.0, 10.0, 1, 0.5)]);
    assert!((robot.seen(13.0, 10.5) - 0.4 * SUREST).abs() < 1e-6);
}

#[test]
fn looks_of_a_lost_message_are_made_up_for_by_the_next() {
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
        assert!((robot.seen(13.0, 10.5) - expected).abs() < 1e-6);
    }
}

#[test]
fn what_a_mate_saw_on_its_way_was_seen_too() {
    let mut robot = Robot::new(1.0, 1.0);
    robot.step(false, vec![mate(4.0, 4.0, 1, 1.0)]);
    robot.wait(10.0);
    robot.step(false, vec![mate(14.0, 4.0, 40, 1.0)]);
    for x in [3.0, 6.0, 9.0, 12.0, 15.0] {
        assert!(robot.seen(x, 4.0) > SUREST - 1e-6, "{x}");
    }
    assert!(robot.seen(9.0, 7.0) < 0.01);
}

#[test]
fn who_tells_of_what_is_not_there_is_trusted_less_and_less() {
    let mut robot = Robot::new(0.8, 0.9);
    let spec = robot.beliefs.prior.trust.clone();
    let mut before = 0.9;
    for track_id in 1..5 {
        // In view, each time elsewhere.
        robot.step(
            false,
            vec![item(7.0 + 0.5 * f64::from(track_id), 9.5, track_id)],
        );
        let told = robot.beliefs.believed_items().last().unwrap().confidence;
        (0..8).for_each(|_| robot.step(true, Vec::new()));
        let trust = robot.beliefs.trust.of(MATE, &spec);
        assert!(trust < before, "{trust}");
        before = trust;
        let refuted = robot.beliefs.believed_items().last().unwrap().confidence;
        assert!(refuted < 0.1 * told, "{told} {refuted}");
    }
    assert!((before - 4.0 * 0.9 / 8.0).abs() < 1e-6, "{before}");
}

#[test]
fn who_does_not_know_where_he_is_tells_nothing_and_who_does_tells_it_once_a_second() {
    let mut robot = Robot::new(1.0, 1.0);
    let mut outbox = Vec::new();
    robot.beliefs.tell(None, 0.1, &mut outbox);
    assert!(outbox.is_empty());
    robot.step(true, Vec::new());
    for _ in 0..30 {
        robot.beliefs.tell(None, 0.1, &mut outbox);
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
fn who_turns_tells_at_once_as_others_take_it_to_look_the_way_that_it_told_last() {
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
        let body = robot.body.clone();
        robot.beliefs.take_in(&percept, &body, &[], [0.0, 0.0]);
        let mut outbox = Vec::new();
        robot.beliefs.tell(None, 0.1, &mut outbox);
        let is_sender = |message: &Message| matches!(message.about, About::Sender { .. });
        outbox.iter().any(is_sender)
    };
    let told = [0.0, 0.1, 0.5, 0.6, 0.1].map(turned);
    assert_eq!(told, [false, false, true, false, true]);
}

#[test]
fn where_one_goes_is_told_at_once_and_whether_it_has_been_there() {
    let mut robot = Robot::new(1.0, 1.0);
    robot.step(true, Vec::new());
    let goals = |robot: &mut Robot, goal: Option<Point>| {
        let mut outbox = Vec::new();
        let aim = goal.map(|at| Destination {
            at,
            tolerance_m: 0.5,
            max_speed_m_s: 1.0,
            value: 1.0,
        });
        robot.beliefs.tell(aim, 0.01, &mut outbox);
        outbox.iter().filter_map(status).collect::<Vec<_>>()
    };
    let (far, here) = (Point { x: 1.0, y: 2.0 }, Point { x: 8.3, y: 10.0 });
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

fn status(message: &Message) -> Option<(Point, CommitmentStatus)> {
    match message.about {
        About::Goal { at, status } => Some((at, status)),
        _ => None,
    }
}

#[test]
fn nonsense_is_not_believed() {
    let mut robot = Robot::new(1.0, 1.0);
    for bad in [f64::NAN, f64::INFINITY, -1.0, 1.5] {
        robot.step(
            false,
            vec![mate(13.0, 10.0, 1, bad), mate(13.0, bad * 1e8, 2, 1.0)],
        );
    }
    assert!(robot.seen(13.0, 10.5) < 1e-9);
}

/// A step, from when robots are on, and who tells in it, in which order.
type Tellers = (u32, Vec<RobotId>);

/// Who tells in each step of a time, in seconds, of robots that all stand still and have a destination somewhere.
fn tellers(own: &[RobotId], period_s: f64, for_s: f64) -> Vec<Tellers> {
    let mut told = vec![Told::default(); own.len()];
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "few"
    )]
    let steps = libm::round(for_s / period_s) as u32;
    let in_step = |step| {
        let each = own.iter().zip(&mut told);
        let telling = each.filter_map(|(id, told)| told.is_time(*id, period_s).then_some(*id));
        (step, telling.collect())
    };
    (1..=steps).map(in_step).collect()
}

fn robots(kind: u8, count: u32) -> Vec<RobotId> {
    (0..count).map(|index| RobotId { kind, index }).collect()
}

#[test]
fn whatever_the_period_each_tells_once_a_second() {
    for (period_s, apart) in [(0.1, 10..=10), (0.05, 20..=20), (0.3, 3..=4), (1.0, 1..=1)] {
        let mates = robots(0, 3);
        let steps = tellers(&mates, period_s, 60.0);
        for mate in &mates {
            let own = steps.iter().filter(|(_, all)| all.contains(mate));
            let own: Vec<u32> = own.map(|(step, _)| *step).collect();
            assert!((59..=61).contains(&own.len()), "{period_s}: {own:?}");
            assert!(
                own.windows(2).all(|two| apart.contains(&(two[1] - two[0]))),
                "{own:?}"
            );
        }
    }
}

/// Each says where it is and where it goes; of what is said in a step, four messages are heard.
#[test]
fn of_many_robots_each_is_heard_equally_often_by_one_that_hears_four_messages_a_step() {
    let mates = robots(0, 16);
    let steps = tellers(&mates, 0.1, 60.0);
    let heard = |mate: &RobotId| {
        let hears = |all: &[RobotId]| all.iter().take(2).any(|one| one == mate);
        steps.iter().filter(|(_, all)| hears(all)).count()
    };
    let counts: Vec<usize> = mates.iter().map(heard).collect();
    assert!(
        counts.iter().all(|count| (59..=60).contains(count)),
        "{counts:?}"
    );
}

#[test]
fn robots_of_several_kinds_tell_at_moments_of_their_own_too() {
    let mates = [robots(0, 5), robots(1, 5), robots(2, 5)].concat();
    let most = tellers(&mates, 0.1, 60.0)
        .into_iter()
        .map(|(_, all)| all.len())
        .max();
    assert!(most <= Some(3), "{most:?}");
}

/// A mate tells of observations of another at a place, or of his own.
fn relayed(from: RobotId, observer: RobotId, x: f64, track_id: u32) -> ReceivedMessage {
    let (at, observations) = (Point { x, y: 9.5 }, 1);
    let provenance = Provenance {
        observer,
        track_id,
        observations,
    };
    ReceivedMessage {
        from,
        ..heard(
            About::Item {
                kind: 0,
                at,
                provenance,
            },
            0.95,
        )
    }
}

#[test]
fn who_names_another_for_what_is_not_there_is_trusted_less_himself() {
    let (mut robot, innocent) = (Robot::new(0.8, 0.9), RobotId { kind: 0, index: 3 });
    let spec = robot.beliefs.prior.trust.clone();
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
    assert!((robot.beliefs.trust.of(innocent, &spec) - 0.9).abs() < 1e-6);
    assert!((robot.beliefs.trust.of(MATE, &spec) - 4.0 * 0.9 / 8.0).abs() < 1e-6);
}

#[test]
fn what_is_passed_on_after_it_was_heard_counts_for_the_first() {
    let (mut robot, other) = (Robot::new(0.8, 0.9), RobotId { kind: 0, index: 3 });
    let spec = robot.beliefs.prior.trust.clone();
    robot.step(
        false,
        vec![relayed(MATE, MATE, 8.0, 1), relayed(other, MATE, 8.0, 1)],
    );
    (0..8).for_each(|_| robot.step(true, Vec::new()));
    assert!((robot.beliefs.trust.of(other, &spec) - 0.9).abs() < 1e-6);
    assert!(robot.beliefs.trust.of(MATE, &spec) < 0.8);
}

#[test]
fn nobody_looks_oftener_than_can_be() {
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
    let most = 1.0 - libm::pow(0.99, 1.0 + MOST_LOOKS_S);
    let seen = robot.seen(13.0, 10.5);
    assert!((seen - most).abs() < 1e-5, "{seen} {most}");
}

#[test]
fn what_has_no_age_is_not_believed_and_looks_count_however_long_ago() {
    for (age_s, is_believed) in [
        (0.0, true),
        (500.0, true),
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
        assert_eq!(robot.seen(13.0, 10.5) > 0.5, is_believed, "{age_s}");
    }
}
