//! A controller with a mined lane, and robots that only send messages.

use brain::{
    About, AgentId, Command, ContractMessage, Coverage, Lane, LaneMessage, Message,
    OwnershipMessage, Percept, ReceivedMessage, Report, Task, Work,
};
use economy::{Clearance, Controller, RobotModel, Settings, Skill};
use std::sync::Arc;

const OAV: AgentId = AgentId::robot(0, 0);

fn settings() -> Settings {
    let clearance = Clearance {
        lane: Lane {
            min_m: [0.0; 2],
            max_m: [40.0, 10.0],
            cell_m: 2.0,
            hazards: 1,
        },
        free_shares: Vec::new(),
        expected: vec![2.0],
        destroy_probability: Vec::new(),
        robots: vec![RobotModel {
            search_nats: 3.0,
            ..RobotModel::default()
        }],
        declare_below: 0.01,
        interrogate_above: 0.05,
        tile_m: 10.0,
        searches: vec![Skill::default()],
        interrogate: None,
        neutralise: None,
    };
    Settings {
        clearance: Some(Arc::new(clearance)),
        ..Settings::default()
    }
}

/// A controller at a time, with the messages that it receives.
struct Station {
    controller: Controller,
    id: AgentId,
    step: u32,
}

impl Station {
    fn new(index: u32) -> Self {
        Self {
            controller: Controller::new(Arc::new(settings())),
            id: AgentId::controller(1, index),
            step: 0,
        }
    }

    fn step(&mut self, inbox: &[(AgentId, About)]) -> Vec<About> {
        self.step += 1;
        let inbox = inbox.iter().map(|(from, about)| ReceivedMessage {
            from: *from,
            age_s: 0.0,
            message: Message::to_all(*about),
        });
        let percept = Percept {
            time_s: Some(f64::from(self.step) * 0.1),
            random_words: [self.step.wrapping_mul(7919), 1, 2, self.id.index],
            id: self.id,
            inbox: inbox.collect(),
            ..Percept::default()
        };
        let mut command = Command::default();
        self.controller.step_into(&percept, &mut command);
        let sent = command
            .outbox
            .into_iter()
            .map(|message| message.about)
            .filter(About::is_of_economy);
        sent.collect()
    }

    /// The positions of its goals along the lane.
    fn goals(&self) -> Vec<f32> {
        let mut goals: Vec<Task> = self.controller.goals().map(|goal| goal.task).collect();
        assert!(goals.iter().all(|task| task.work == Work::Search));
        goals.sort_by(|one, other| one.at_m[0].total_cmp(&other.at_m[0]));
        goals.into_iter().map(|task| task.at_m[0]).collect()
    }
}

fn report() -> (AgentId, About) {
    let report = Report {
        at_m: [0.0; 2],
        speed_m_s: 1.0,
        battery: 1.0,
        goals: 0,
        payload: 4,
    };
    (OAV, About::Contract(ContractMessage::Report(report)))
}

fn searched(first: u32) -> (AgentId, About) {
    let coverage = Coverage {
        first,
        marks: 0,
        missed: [200; 16],
        driven: [0; 16],
    };
    (OAV, About::Lane(LaneMessage::Coverage(coverage)))
}

#[test]
fn a_controller_names_its_lane_and_calls_for_searches_of_its_tiles() {
    let mut station = Station::new(0);
    let mut sent = Vec::new();
    for _ in 0..30 {
        sent.extend(station.step(&[report()]));
    }
    let lanes = sent
        .iter()
        .filter(|sent| matches!(sent, About::Lane(LaneMessage::Lane(_))));
    assert_eq!(lanes.count(), 1, "every five seconds");
    assert_eq!(station.goals(), [5.0, 15.0, 25.0]);
    let calls = sent
        .iter()
        .filter(|sent| matches!(sent, About::Contract(ContractMessage::Call { .. })));
    assert!(calls.count() >= 3);
}

#[test]
fn goals_that_no_longer_lower_the_risk_are_cancelled_and_the_lane_is_declared_clear() {
    let mut station = Station::new(0);
    for _ in 0..30 {
        station.step(&[report()]);
    }
    assert!(station.controller.lane_statement().is_none());
    let before = station.controller.lane().unwrap().risk().probability;
    let all: Vec<_> = (0..112).step_by(16).map(searched).collect();
    (0..20).for_each(|_| {
        station.step(&all);
    });
    assert!(station.goals().is_empty());
    let statement = station.controller.lane_statement().unwrap();
    assert!(before > 0.8 && statement.is_clear && statement.risk < 0.01);
}

#[test]
fn two_controllers_in_range_plan_different_tiles_and_one_that_is_lost_is_replaced() {
    let mut stations = [Station::new(0), Station::new(1)];
    for _ in 0..40 {
        for (index, station) in (0..).zip(&mut stations) {
            let other = AgentId::controller(1, 1 - index);
            station.step(&[
                report(),
                (other, About::Ownership(OwnershipMessage::Present {})),
            ]);
        }
    }
    assert_eq!(stations[0].goals(), [5.0, 25.0]);
    assert_eq!(stations[1].goals(), [15.0, 35.0]);
    (0..100).for_each(|_| {
        stations[0].step(&[report()]);
    });
    assert_eq!(stations[0].goals().len(), 3);
}

#[test]
fn a_controller_of_another_kind_shares_no_lane() {
    let mut station = Station::new(0);
    let other = AgentId::controller(2, 0);
    for _ in 0..700 {
        station.step(&[(other, About::Ownership(OwnershipMessage::Present {}))]);
    }
    // Without robots in range, it gives the lane up although the other one reports nothing about it.
    assert!(station.controller.lane_statement().is_some());
    let mut station = Station::new(0);
    for _ in 0..40 {
        station.step(&[
            report(),
            (other, About::Ownership(OwnershipMessage::Present {})),
        ]);
    }
    assert_eq!(station.goals(), [5.0, 15.0, 25.0]);
}

/// Whether a station without robots in range, which another one reports a gain to, gives its lane up within two minutes.
fn gives_up(gain: Option<f32>) -> bool {
    let mut station = Station::new(0);
    let other = AgentId::controller(1, 1);
    for _ in 0..1200 {
        let mut inbox = vec![(other, About::Ownership(OwnershipMessage::Present {}))];
        inbox.extend(gain.map(|gain| (other, About::Lane(LaneMessage::Gain(gain)))));
        station.step(&inbox);
    }
    let statement = station.controller.lane_statement();
    statement.is_some_and(|statement| !statement.is_clear)
}

#[test]
fn a_lane_is_given_up_when_no_controller_in_range_has_a_goal_that_lowers_the_risk() {
    assert!(gives_up(Some(0.0)));
    assert!(!gives_up(Some(0.5)));
    assert!(!gives_up(Some(f32::NAN)) && !gives_up(Some(-1.0)));
    assert!(!gives_up(None), "the other has not reported yet");
}

#[test]
fn controllers_report_what_their_goals_may_find_to_each_other_only() {
    let mut station = Station::new(0);
    let other = AgentId::controller(1, 1);
    let mut gains = Vec::new();
    for _ in 0..200 {
        let sent = station.step(&[
            report(),
            (other, About::Ownership(OwnershipMessage::Present {})),
        ]);
        gains.extend(sent.into_iter().filter_map(|sent| match sent {
            About::Lane(LaneMessage::Gain(gain)) => Some(gain),
            _ => None,
        }));
    }
    // Two mines expected, of which half are in its tiles.
    assert!(!gains.is_empty() && gains.iter().all(|gain| (0.8..1.0).contains(gain)));
}

#[test]
fn a_controller_without_a_lane_states_nothing_about_it() {
    let mut station = Station::new(0);
    station.controller = Controller::new(Arc::new(Settings {
        clearance: None,
        ..settings()
    }));
    let sent = (0..20).flat_map(|_| station.step(&[report(), searched(0)]));
    let is_lane = |sent: &About| {
        matches!(
            sent,
            About::Lane(LaneMessage::Lane(_)) | About::Contract(ContractMessage::Call { .. })
        )
    };
    assert!(!sent.collect::<Vec<_>>().iter().any(is_lane));
    assert!(station.controller.lane().is_none());
}
