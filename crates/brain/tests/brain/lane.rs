//! What a robot reports of a mined lane, and how it interrogates marks.

use crate::{body, brain, percept_at};
use base::geometry::{Point, Rectangle};
use brain::{
    About, AgentId, Award, Body, Brain, Command, Contact, ContractMessage, Coverage, Detector,
    GoalId, Lane, LaneMessage, Mark, MarkVerdict, Message, Observation, Other, Percept, Reason,
    ReceivedMessage, Statement, Task, Work,
};

const OWNER: AgentId = AgentId::controller(1, 0);

const MATE: AgentId = AgentId::robot(0, 7);

const LANE: Lane = Lane {
    min_m: [0.0; 2],
    max_m: [20.0, 8.0],
    cell_m: 2.0,
    hazards: 1,
};

/// A robot at (5, 5) that detects items within 3 m with a probability of one half.
struct Robot {
    brain: Brain,
    step: u32,
    heading_rad: f64,
}

impl Robot {
    fn new() -> Self {
        Self::among(Vec::new())
    }

    /// The same, which each kind of items may destroy within a distance.
    fn among(hazards_m: Vec<Option<f64>>) -> Self {
        let detector = Detector {
            range_m: 3.0,
            width_rad: 7.0,
            detection_probability: vec![vec![[0.0, 0.5]], vec![[0.0, 0.5]]],
            false_alarms_per_m2: vec![1e-3; 2],
            noise_m: 0.1,
            ..Detector::default()
        };
        let corner = Point { x: 20.0, y: 20.0 };
        let body = Body {
            sensors: vec!["detector".to_owned()],
            detectors: vec![detector],
            item_kinds: vec!["mine".to_owned(), "clutter".to_owned()],
            others: vec![Other::default()],
            hazards_m,
            field: Some(Rectangle::spanned(Point::default(), corner)),
            ..body()
        };
        let spec =
            r#"{"limit_speed_to_stopping_distance": false, "behaviours": [{"kind": "serve"}]}"#;
        Self {
            brain: brain(spec, body),
            step: 0,
            heading_rad: 0.0,
        }
    }

    /// A step with a measurement; `contacts` are kinds and distances ahead.
    fn command(&mut self, messages: &[(AgentId, About)], contacts: &[(u16, f64)]) -> Command {
        self.step += 1;
        let inbox = messages.iter().map(|(from, about)| ReceivedMessage {
            from: *from,
            age_s: 0.0,
            message: Message::to(AgentId::default(), *about),
        });
        let contacts = contacts.iter().map(|(kind, range_m)| Contact {
            kind: *kind,
            sensor: 0,
            range_m: *range_m,
            bearing_rad: -self.heading_rad,
            age_s: 0.0,
        });
        let percept = Percept {
            time_s: Some(0.1 * f64::from(self.step)),
            inbox: inbox.collect(),
            observations: vec![Observation {
                sensor: 0,
                age_s: 0.0,
            }],
            contacts: contacts.collect(),
            ..percept_at(5.0, 5.0, self.heading_rad)
        };
        let command = self.brain.step(&percept);
        self.heading_rad += 0.1 * command.motion.turn_rate_rad_s;
        command
    }

    fn step(&mut self, messages: &[About], contacts: &[(u16, f64)]) -> Vec<About> {
        let messages = messages.iter();
        let messages: Vec<_> = messages.map(|about| (OWNER, *about)).collect();
        let sent = self.command(&messages, contacts).outbox.into_iter();
        let sent = sent
            .map(|message| message.about)
            .filter(About::is_of_economy);
        sent.collect()
    }

    /// Some steps after a lane has been named; returns all messages.
    fn steps(&mut self, count: u32, contacts: &[(u16, f64)]) -> Vec<About> {
        let mut sent = self.step(&[About::Lane(LaneMessage::Lane(LANE))], contacts);
        (1..count).for_each(|_| sent.extend(self.step(&[], contacts)));
        sent
    }

    /// Is awarded the interrogation of a mark; returns whether it accepts.
    fn interrogate(&mut self, work: Work) -> Result<(), Reason> {
        let task = Task {
            id: GoalId {
                issuer: OWNER.into(),
                number: 3,
            },
            at_m: [6.0, 5.0],
            radius_m: 1.5,
            value: 1.0,
            service_s: 1.0,
            due_s: f32::MAX,
            work,
            capability: 0,
        };
        let sent = self.step(
            &[About::Contract(ContractMessage::Call { number: 0, task })],
            &[],
        );
        for sent in sent {
            match sent {
                About::Contract(ContractMessage::Bid(bid)) => {
                    let award = Award {
                        goal: task.id,
                        number: bid.number,
                        lease_s: 3600.0,
                    };
                    self.step(&[About::Contract(ContractMessage::Award(award))], &[]);
                    return Ok(());
                }
                About::Contract(ContractMessage::Refuse(refusal)) => return Err(refusal.reason),
                _ => {}
            }
        }
        Err(Reason::Lease)
    }
}

/// The last value that is reported of the cell at a position.
fn nats(sent: &[About], x: f64, y: f64) -> f64 {
    nats_of(LANE, sent, x, y)
}

fn nats_of(lane: Lane, sent: &[About], x: f64, y: f64) -> f64 {
    let cell = lane.cell_at(Point { x, y }).unwrap();
    let mut steps = sent.iter().filter_map(|sent| match sent {
        About::Lane(LaneMessage::Coverage(Coverage { first, missed, .. })) => {
            let index = cell.checked_sub(*first as usize)?;
            missed.get(index).copied()
        }
        _ => None,
    });
    Coverage::nats(Coverage::sixteenths(steps.next_back().unwrap_or_default()))
}

fn marks(sent: &[About]) -> Vec<Mark> {
    let marks = sent.iter().filter_map(|sent| match sent {
        About::Lane(LaneMessage::Mark(mark)) => Some(*mark),
        _ => None,
    });
    marks.collect()
}

fn statements(sent: &[About]) -> Vec<Statement> {
    let statements = sent.iter().filter_map(|sent| match sent {
        About::Lane(LaneMessage::Statement(statement)) => Some(*statement),
        _ => None,
    });
    statements.collect()
}

#[test]
fn a_robot_reports_the_looks_at_cells_in_its_view_only() {
    let sent = Robot::new().steps(12, &[]);
    // After eleven looks, each with a probability of one half, the second report.
    let expected = 11.0 * 2.0_f64.ln();
    assert!(
        (nats(&sent, 5.0, 5.0) - expected).abs() < 0.1,
        "{}",
        nats(&sent, 5.0, 5.0)
    );
    assert!(nats(&sent, 15.0, 5.0) < 1e-9);
}

#[test]
fn a_robot_reports_the_ground_where_a_mine_would_have_destroyed_it() {
    let driven = |hazards_m: [Option<f64>; 2], x: f64| {
        let sent = Robot::among(hazards_m.to_vec()).steps(12, &[]);
        let cell = LANE.cell_at(Point { x, y: 5.0 }).unwrap();
        let mut of_cell = sent.iter().filter_map(|sent| match sent {
            About::Lane(LaneMessage::Coverage(Coverage { first, driven, .. })) => {
                driven.get(cell.checked_sub(*first as usize)?).copied()
            }
            _ => None,
        });
        of_cell.next_back().unwrap_or_default()
    };
    assert!(driven([Some(0.8), None], 5.0) > 200);
    assert_eq!(driven([Some(0.8), None], 15.0), 0);
    assert_eq!(driven([None, Some(0.8)], 5.0), 0, "clutter is not cleared");
}

#[test]
fn a_robot_that_knows_no_lane_reports_nothing_about_one() {
    let mut robot = Robot::new();
    let sent: Vec<_> = (0..30).flat_map(|_| robot.step(&[], &[(0, 1.0)])).collect();
    let is_report = |sent: &About| {
        matches!(
            sent,
            About::Lane(LaneMessage::Coverage(_) | LaneMessage::Mark(_))
        )
    };
    assert!(!sent.iter().any(is_report));
}

#[test]
fn looks_of_team_mates_are_not_reported_as_own() {
    let mut robot = Robot::new();
    robot.step(&[About::Lane(LaneMessage::Lane(LANE))], &[]);
    let mate = About::Sender {
        at: Point { x: 15.0, y: 5.0 },
        heading_rad: 0.0,
        observations: 5,
    };
    let mut sent = Vec::new();
    for _ in 0..15 {
        let outbox = robot.command(&[(MATE, mate)], &[]).outbox;
        sent.extend(
            outbox
                .into_iter()
                .map(|message| message.about)
                .filter(About::is_of_economy),
        );
    }
    assert!(nats(&sent, 5.0, 5.0) > 1.0 && nats(&sent, 15.0, 5.0) < 1e-9);
}

#[test]
fn reports_are_sent_once_a_second_with_a_bounded_number_of_messages() {
    let sent = Robot::new().steps(50, &[(0, 1.0)]);
    let reports = sent
        .iter()
        .filter(|sent| matches!(sent, About::Lane(LaneMessage::Coverage(_))));
    // Three blocks of cells, five seconds.
    assert_eq!(reports.count(), 15);
    assert!(marks(&sent).len() <= 10);
}

/// The mark of one contact after a number of looks, as reported after eleven looks.
fn mark_after(looks: u32) -> Mark {
    let mut robot = Robot::new();
    robot.step(&[About::Lane(LaneMessage::Lane(LANE))], &[]);
    (0..looks).for_each(|_| assert_eq!(marks(&robot.step(&[], &[])), []));
    robot.step(&[], &[(0, 1.0)]);
    let sent = robot.steps(9 - looks, &[]);
    let mut counts = sent.iter().filter_map(|sent| match sent {
        About::Lane(LaneMessage::Coverage(coverage)) => Some(coverage.marks),
        _ => None,
    });
    assert_eq!(counts.next_back(), Some(1));
    *marks(&sent).last().unwrap()
}

#[test]
fn a_mark_has_the_evidence_of_all_own_looks_before_and_after_the_contact() {
    let (early, late) = (mark_after(0), mark_after(6));
    assert_eq!(late.id.issuer, AgentId::default().into());
    assert!((late.at_m[0] - 6.0).abs() < 0.1 && late.deviation_m() < 0.5);
    assert!(late.log_ratios[1] < -10.0, "it is no clutter");
    let contact = (0.5 / (core::f32::consts::TAU * 0.01 * 1e-3)).ln();
    for mark in [early, late] {
        let expected = contact - 10.0 * 2.0_f32.ln();
        assert!((mark.log_ratios[0] - expected).abs() < 0.2, "{mark:?}");
    }
}

#[test]
fn a_robot_confirms_a_mark_at_which_it_detects_a_mine_and_rejects_others() {
    for (contacts, verdict) in [
        (&[(0, 1.0)][..], MarkVerdict::Confirmed),
        (&[(1, 1.0)][..], MarkVerdict::Rejected),
        (&[][..], MarkVerdict::Rejected),
    ] {
        let mut robot = Robot::new();
        robot.step(&[About::Lane(LaneMessage::Lane(LANE))], &[]);
        assert_eq!(robot.interrogate(Work::Interrogate), Ok(()));
        let sent = robot.steps(100, contacts);
        let stated = statements(&sent);
        assert_eq!(stated.len(), 6, "repeated, as messages are lost");
        assert!(stated.iter().all(|stated| stated.verdict == verdict));
        assert_eq!((stated[0].mark.number, stated[0].at_m), (3, [6.0, 5.0]));
    }
}

#[test]
fn a_robot_faces_the_mark_that_it_interrogates() {
    let mut robot = Robot::new();
    robot.heading_rad = 2.0;
    robot.step(&[], &[]);
    assert_eq!(robot.interrogate(Work::Interrogate), Ok(()));
    (0..8).for_each(|_| {
        robot.step(&[], &[]);
    });
    assert!(robot.heading_rad < 1.2, "{}", robot.heading_rad);
}

#[test]
fn a_robot_refuses_to_neutralise_without_a_tool() {
    let refused = Robot::new().interrogate(Work::Neutralise);
    assert_eq!(refused, Err(Reason::Capability));
}

/// Where a mine is tracked, a contact of a second one would be taken for one of the first.
#[test]
fn looks_at_a_mine_are_no_search_for_a_second_one_beside_it() {
    let lane = Lane {
        min_m: [4.0; 2],
        max_m: [8.0, 6.0],
        cell_m: 0.5,
        hazards: 1,
    };
    let looks = 20.0 * 2.0_f64.ln();
    let beside = |kind: u16| {
        let mut robot = Robot::new();
        let mut sent = robot.step(&[About::Lane(LaneMessage::Lane(lane))], &[(kind, 1.0)]);
        (0..30).for_each(|_| sent.extend(robot.step(&[], &[(kind, 1.0)])));
        assert!(nats_of(lane, &sent, 7.4, 5.2) > looks.min(15.9) - 1.0);
        nats_of(lane, &sent, 6.2, 5.2)
    };
    let (mine, clutter) = (beside(0), beside(1));
    assert!(mine < 0.2 * looks, "{mine}");
    // Clutter stays: two contacts in one look show a second item.
    assert!(mine < clutter && clutter < 0.9 * looks, "{mine} {clutter}");
}

#[test]
fn the_mark_of_an_item_that_another_robot_has_destroyed_counts_the_looks_since_then() {
    let mut robot = Robot::new();
    let before = *marks(&robot.steps(20, &[(0, 1.0)])).last().unwrap();
    assert_eq!(before.missed_since, 0);
    let destroyed = Statement {
        mark: before.id,
        at_m: before.at_m,
        verdict: MarkVerdict::Neutralised,
    };
    robot.step(&[About::Lane(LaneMessage::Statement(destroyed))], &[]);
    let sent = robot.steps(30, &[]);
    let after = marks(&sent);
    let after = after.iter().rfind(|mark| mark.id == before.id).unwrap();
    let bits = |mark: &Mark| mark.log_ratios.map(f32::to_bits);
    assert_eq!(bits(after), bits(&before));
    let missed = after.missed_since_nats();
    assert!(missed > 10.0 * 2.0_f64.ln(), "{missed}");
}

#[test]
fn what_is_detected_where_a_mine_has_been_destroyed_has_a_mark_of_its_own() {
    let mut robot = Robot::new();
    let before = *marks(&robot.steps(20, &[(0, 1.0)])).last().unwrap();
    let destroyed = Statement {
        mark: before.id,
        at_m: before.at_m,
        verdict: MarkVerdict::Neutralised,
    };
    robot.step(&[About::Lane(LaneMessage::Statement(destroyed))], &[]);
    let sent = robot.steps(30, &[(0, 1.1)]);
    let new = marks(&sent);
    let new = new.iter().rfind(|mark| mark.id != before.id).unwrap();
    // The looks at the first mine are no evidence against the second.
    assert!(new.log_ratios[0] > 10.0, "{new:?}");
}
