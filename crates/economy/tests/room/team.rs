//! Robots without shape and controllers, each with a clock of its own.

use crate::hand::reported;
use crate::network::{Network, Weather, random, unit};
use base::geometry::Point;
use base::random::Stream;
use brain::{
    About, AgentId, Body, Brain, BrainSpec, Command, ContractMessage, GoalId, Message, Other,
    Percept, Reading, ReceivedMessage, Task, TradeMessage, Work,
};
use economy::{Backup, Controller, Settings};
use std::collections::BTreeSet;
use std::sync::Arc;

pub(crate) const STEP_S: f64 = 0.1;

/// A clock with an offset and a drift.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Clock {
    pub(crate) offset_s: f64,
    pub(crate) rate: f64,
}

impl Clock {
    fn read(&self, true_s: f64) -> f64 {
        self.offset_s + self.rate * true_s
    }
}

/// A robot that moves at once as it is commanded.
pub(crate) struct Robot {
    pub(crate) id: AgentId,
    pub(crate) brain: Option<Brain>,
    pub(crate) at: Point,
    heading_rad: f64,
    pub(crate) clock: Clock,
    stepped_s: f64,
    pub(crate) battery: Option<f64>,
}

pub(crate) struct Station {
    pub(crate) id: AgentId,
    pub(crate) controller: Option<Controller>,
    pub(crate) clock: Clock,
    pub(crate) is_cut_off: bool,
}

/// Whether a message of one agent reaches another.
pub(crate) type Reach = dyn Fn(AgentId, AgentId, &Message) -> bool;

/// All agents, and the true time.
pub(crate) struct Team {
    pub(crate) now_s: f64,
    pub(crate) robots: Vec<Robot>,
    pub(crate) stations: Vec<Station>,
    pub(crate) network: Network,
    pub(crate) settings: Arc<Settings>,
    /// The robots that have reported that they served a goal, and the number of messages so far.
    pub(crate) served: BTreeSet<(GoalId, AgentId)>,
    pub(crate) messages: usize,
    /// Number of transfers that were sent.
    pub(crate) transfers: usize,
    /// Messages of controllers to the operator.
    pub(crate) to_operator: Vec<Message>,
    /// The calls for bids to all, and their times.
    pub(crate) calls: Vec<(f64, GoalId)>,
    issued: Vec<(usize, Task)>,
    /// Whether a message of one agent to another arrives, unless the network loses it.
    pub(crate) reaches: Box<Reach>,
    /// The messages between controllers, of which an adversary sends some again.
    pub(crate) overheard: Vec<(AgentId, AgentId, Message)>,
    /// The reports that the operator acknowledges, and the controllers that sent them.
    reported: Vec<(AgentId, GoalId)>,
    /// The goals that any controller has known to be done.
    done: BTreeSet<GoalId>,
    brain: Brain,
    random_stream: Stream,
}

pub(crate) const fn robot_id(index: u32) -> AgentId {
    AgentId::robot(0, index)
}

pub(crate) const fn station_id(index: u32) -> AgentId {
    AgentId::controller(1, index)
}

pub(crate) fn goal_id(number: u32) -> GoalId {
    let issuer = AgentId::OPERATOR;
    GoalId {
        issuer: issuer.into(),
        number,
    }
}

pub(crate) fn task(number: u32, at_m: [f32; 2]) -> Task {
    Task {
        id: goal_id(number),
        at_m,
        radius_m: 1.0,
        value: 1.0,
        service_s: 1.0,
        due_s: f32::MAX,
        work: Work::Visit,
        capability: 0,
    }
}

pub(crate) fn brain(capabilities: &[u8], serve: &str) -> Brain {
    let spec = format!(
        r#"{{"limit_speed_to_stopping_distance": false, "behaviours": [{{"kind": "serve"{serve}}}]}}"#
    );
    let spec: BrainSpec = serde_json::from_str(&spec).unwrap();
    let body = Body {
        radius_m: 0.25,
        max_speed_m_s: 2.0,
        max_acceleration_m_s2: f64::INFINITY,
        max_turn_rate_rad_s: 20.0,
        period_s: STEP_S,
        others: vec![Other::default()],
        capabilities: capabilities.to_vec(),
        ..Body::default()
    };
    Brain::new(Arc::new(spec), Arc::new(body))
}

#[expect(clippy::unnecessary_wraps, reason = "fields of percepts are optional")]
const fn now<T>(value: T) -> Option<Reading<T>> {
    Some(Reading { value, age_s: 0.0 })
}

impl Team {
    /// Robots at random places of a square, and controllers.
    pub(crate) fn new(
        [robots, stations]: [u32; 2],
        settings: &Settings,
        weather: Weather,
        seed: u64,
    ) -> Self {
        let mut random_stream = random(seed ^ 0x5eed);
        let mut clock = || {
            let drift = settings.max_drift * (2.0 * unit(&mut random_stream) - 1.0);
            Clock {
                offset_s: 100.0 * (unit(&mut random_stream) - 0.5),
                rate: 1.0 + drift,
            }
        };
        let clocks: Vec<Clock> = (0..robots + stations).map(|_| clock()).collect();
        let settings = Arc::new(Settings {
            count: stations,
            ..settings.clone()
        });
        let brain = brain(&[], "");
        let robots = (0..robots).map(|index| Robot {
            id: robot_id(index),
            brain: Some(brain.clone()),
            at: Point {
                x: 100.0 * unit(&mut random_stream),
                y: 100.0 * unit(&mut random_stream),
            },
            heading_rad: 0.0,
            clock: clocks[index as usize],
            stepped_s: 0.0,
            battery: None,
        });
        let robots: Vec<Robot> = robots.collect();
        let stations = (0..stations).map(|index| Station {
            id: station_id(index),
            controller: Some(Controller::new(Arc::clone(&settings))),
            clock: clocks[robots.len() + index as usize],
            is_cut_off: false,
        });
        Self {
            now_s: 0.0,
            stations: stations.collect(),
            robots,
            network: Network::new(weather, seed),
            settings,
            served: BTreeSet::new(),
            messages: 0,
            transfers: 0,
            to_operator: Vec::new(),
            calls: Vec::new(),
            issued: Vec::new(),
            reaches: Box::new(|_, _, _| true),
            overheard: Vec::new(),
            reported: Vec::new(),
            done: BTreeSet::new(),
            brain,
            random_stream,
        }
    }

    /// The same with controllers that own their goals alone.
    pub(crate) fn alone(
        counts: [u32; 2],
        settings: &Settings,
        weather: Weather,
        seed: u64,
    ) -> Self {
        let mut team = Self::new(counts, settings, weather, seed);
        team.settings = Arc::new(Settings {
            backup: Backup::None,
            ..Settings::clone(&team.settings)
        });
        for station in &mut team.stations {
            station.controller = Some(Controller::new(Arc::clone(&team.settings)));
        }
        team
    }

    /// Issues goals at random places of a square, in turns to the controllers.
    pub(crate) fn issue_random(&mut self, count: u32, size_m: f64) {
        for number in 0..count {
            #[expect(clippy::cast_possible_truncation, reason = "messages are short")]
            let mut along_m = || (size_m * unit(&mut self.random_stream)) as f32;
            let at_m = [along_m(), along_m()];
            let station = number as usize % self.stations.len();
            self.issue(station, task(number, at_m));
        }
    }

    pub(crate) fn issue(&mut self, station: usize, task: Task) {
        self.issued.push((station, task));
    }

    /// The places of the goals that are issued in the next step.
    pub(crate) fn issued_places(&self) -> Vec<Point> {
        self.issued.iter().map(|(_, task)| task.at()).collect()
    }

    /// The places of the goals that each robot serves.
    pub(crate) fn served_places(&self) -> Vec<Vec<Point>> {
        let served = self.robots.iter().map(|robot| {
            let goals = robot.brain.iter().flat_map(Brain::served_goals);
            goals.map(|goal| goal.task.at()).collect()
        });
        served.collect()
    }

    /// From 0 to 1.
    pub(crate) fn unit(&mut self) -> f64 {
        unit(&mut self.random_stream)
    }

    pub(crate) fn crash_robot(&mut self, index: usize) {
        self.robots[index].brain = None;
    }

    pub(crate) fn restart_robot(&mut self, index: usize) {
        let fresh = self.brain.clone();
        self.robots[index].brain.get_or_insert(fresh);
    }

    pub(crate) fn crash_station(&mut self, index: usize) {
        self.stations[index].controller = None;
    }

    pub(crate) fn restart_station(&mut self, index: usize) {
        let settings = Arc::clone(&self.settings);
        let controller = &mut self.stations[index].controller;
        controller.get_or_insert_with(|| Controller::restarted(settings));
    }

    pub(crate) fn controller(&self, index: usize) -> &Controller {
        self.stations[index].controller.as_ref().expect("it works")
    }

    /// Whether a robot holds the lease of a goal at the true time.
    pub(crate) fn serves(robot: &Robot, goal: GoalId, true_s: f64) -> bool {
        let Some(brain) = &robot.brain else {
            return false;
        };
        let passed_s = robot.clock.rate * (true_s - robot.stepped_s);
        let served = brain.served_goals();
        let mut served = served.iter().filter(|served| served.task.id == goal);
        served.any(|served| served.lease_s > passed_s)
    }

    /// Whether a controller owns a goal at the true time.
    pub(crate) fn owns(station: &Station, goal: GoalId, true_s: f64) -> bool {
        let controller = station.controller.as_ref();
        controller.is_some_and(|controller| controller.owns_at(goal, station.clock.read(true_s)))
    }

    /// Number of goals that are done.
    pub(crate) fn done(&self) -> usize {
        self.done.len()
    }

    /// Whether any controller has known a goal to be done.
    pub(crate) fn is_done(&self, goal: GoalId) -> bool {
        self.done.contains(&goal)
    }

    pub(crate) fn run(&mut self, time_s: f64) {
        let end_s = self.now_s + time_s;
        while self.now_s < end_s {
            self.step();
        }
    }

    /// Takes steps until a number of goals is done, at most for a time.
    pub(crate) fn run_until_done(&mut self, goals: usize, time_s: f64) {
        let end_s = self.now_s + time_s;
        while self.now_s < end_s && self.done() < goals {
            self.step();
        }
    }

    pub(crate) fn step(&mut self) {
        self.now_s += STEP_S;
        for index in 0..self.robots.len() {
            self.step_robot(index);
        }
        for index in 0..self.stations.len() {
            self.step_station(index);
        }
        self.issued.clear();
        let working = self.stations.iter();
        let working = working.filter_map(|station| station.controller.as_ref());
        self.done.extend(working.flat_map(Controller::done));
    }

    fn step_robot(&mut self, index: usize) {
        let inbox = self.network.arrived(self.robots[index].id, self.now_s);
        let random_words = [0; 4].map(|_: u32| self.random_stream.next_u32());
        #[expect(clippy::cast_possible_truncation, reason = "few robots")]
        let team_size = self.robots.len() as u32;
        let robot = &mut self.robots[index];
        let Some(brain) = robot.brain.as_mut() else {
            return;
        };
        let percept = Percept {
            time_s: Some(robot.clock.read(self.now_s)),
            random_words,
            id: robot.id,
            team_size,
            position: now(robot.at),
            heading_rad: now(robot.heading_rad),
            battery: robot.battery.and_then(now),
            inbox,
            ..Percept::default()
        };
        let command = brain.step(&percept);
        robot.stepped_s = self.now_s;
        robot.heading_rad += command.motion.turn_rate_rad_s * STEP_S;
        robot.heading_rad = base::trig::wrapped(robot.heading_rad);
        let (sin, cos) = robot.heading_rad.sin_cos();
        let way = Point { x: cos, y: sin };
        robot.at = robot.at.plus(way.times(command.motion.speed_m_s * STEP_S));
        let id = robot.id;
        self.send_all(id, false, &command);
    }

    fn step_station(&mut self, index: usize) {
        let id = self.stations[index].id;
        let mut inbox = self.network.arrived(id, self.now_s);
        let issued = self.issued.iter().filter(|(station, _)| *station == index);
        inbox.extend(issued.map(|(_, task)| ReceivedMessage {
            from: AgentId::OPERATOR,
            age_s: 0.0,
            message: Message::to(id, About::Contract(ContractMessage::Issue(*task))),
        }));
        let reported = self.reported.extract_if(.., |(from, _)| *from == id);
        inbox.extend(reported.map(|(_, goal)| ReceivedMessage {
            from: AgentId::OPERATOR,
            age_s: 0.0,
            message: Message::to(id, About::Contract(ContractMessage::Acknowledge(goal))),
        }));
        let random_words = [0; 4].map(|_: u32| self.random_stream.next_u32());
        let station = &mut self.stations[index];
        let Some(controller) = station.controller.as_mut() else {
            return;
        };
        if station.is_cut_off {
            inbox.retain(|received| received.from == AgentId::OPERATOR);
        }
        let percept = Percept {
            time_s: Some(station.clock.read(self.now_s)),
            random_words,
            id,
            inbox,
            ..Percept::default()
        };
        let mut command = Command::default();
        controller.step_into(&percept, &mut command);
        let is_cut_off = station.is_cut_off;
        self.send_all(id, is_cut_off, &command);
    }

    fn send_all(&mut self, from: AgentId, is_cut_off: bool, command: &Command) {
        for message in &command.outbox {
            if let About::Contract(ContractMessage::Done(claim)) = message.about {
                self.served.insert((claim.goal, from));
            }
            if let About::Contract(ContractMessage::Call { task, .. }) = message.about {
                self.calls.push((self.now_s, task.id));
            }
            if let About::Trade(TradeMessage::Transfer(_)) = message.about {
                self.transfers += 1;
            }
            if message.to == AgentId::OPERATOR.into() {
                self.to_operator.push(*message);
            }
            let goal = reported(&(message.to, message.about));
            self.reported.extend(goal.map(|goal| (from, goal)));
            self.messages += 1;
            if is_cut_off {
                continue;
            }
            let robots = self.robots.iter().map(|robot| robot.id);
            let all = robots.chain(self.stations.iter().map(|station| station.id));
            let receivers = all.filter(|to| *to != from);
            let receivers = receivers.filter(|to| message.to.includes(*to));
            let receivers: Vec<AgentId> = receivers.collect();
            for to in receivers {
                if !(self.reaches)(from, to, message) {
                    continue;
                }
                if from.is_controller() && to.is_controller() {
                    self.overheard.push((from, to, *message));
                }
                self.network.send(from, to, *message, self.now_s);
            }
        }
    }
}
