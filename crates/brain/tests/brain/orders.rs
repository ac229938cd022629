//! A person's orders: goals that `correct` visits.

use crate::{body, brain, now, percept_at};
use base::geometry::Point;
use brain::{
    About, AgentId, Body, Brain, GoalId, Message, Motion, OrderAction, OrderVerdict, Percept,
    Reason, ReceivedMessage, Receiver,
};
use proptest::prelude::*;

const LAYERS: &str = r#"{"limit_speed_to_stopping_distance": false, "behaviours": [
    {"kind": "cruise", "speed_m_s": 0.5}, {"kind": "correct", "stop_when_done": true}]}"#;

fn id(number: u32) -> GoalId {
    let issuer = AgentId::OPERATOR;
    GoalId {
        issuer: issuer.into(),
        number,
    }
}

fn order(number: u32, at: [f64; 2], action: OrderAction) -> ReceivedMessage {
    let (goal, at) = (id(number), Point::from(at));
    ReceivedMessage {
        from: AgentId::OPERATOR,
        age_s: 0.0,
        message: Message {
            to: Receiver::All,
            about: About::Order { goal, at, action },
            confidence: 1.0,
        },
    }
}

fn assign(number: u32, at: [f64; 2]) -> ReceivedMessage {
    order(number, at, OrderAction::Assign)
}

fn withdraw(number: u32) -> ReceivedMessage {
    order(number, [0.0, 0.0], OrderAction::Withdraw)
}

fn verdicts(brain: &Brain) -> Vec<(u32, OrderVerdict)> {
    let goals = brain.assigned_goals().into_iter();
    goals.map(|goal| (goal.id.number, goal.verdict)).collect()
}

fn numbers(brain: &Brain) -> Vec<u32> {
    let goals = verdicts(brain).into_iter();
    goals.map(|(number, _)| number).collect()
}

/// A robot that executes its commands at once, from the origin along x.
struct Robot {
    brain: Brain,
    at: Point,
    heading_rad: f64,
    motion: Motion,
}

impl Robot {
    fn new(spec: &str, body: Body) -> Self {
        Self {
            brain: brain(spec, body),
            at: Point::default(),
            heading_rad: 0.0,
            motion: Motion::default(),
        }
    }

    fn percept(&self) -> Percept {
        Percept {
            motion: now(self.motion),
            ..percept_at(self.at.x, self.at.y, self.heading_rad)
        }
    }

    fn step(&mut self, inbox: Vec<ReceivedMessage>) {
        let percept = Percept {
            inbox,
            ..self.percept()
        };
        self.motion = self.brain.step(&percept).motion;
        self.heading_rad += self.motion.turn_rate_rad_s * 0.1;
        let (y, x) = self.heading_rad.sin_cos();
        let moved = Point { x, y }.times(self.motion.speed_m_s * 0.1);
        self.at = self.at.plus(moved);
    }

    /// Steps for a duration; returns the numbers of goals in the order of their completion.
    fn run(&mut self, for_s: u32) -> Vec<u32> {
        let mut complete = Vec::new();
        for _ in 0..10 * for_s {
            self.step(Vec::new());
            for (number, verdict) in verdicts(&self.brain) {
                if verdict == OrderVerdict::Complete && !complete.contains(&number) {
                    complete.push(number);
                }
            }
        }
        complete
    }

    fn is_standing(&self) -> bool {
        self.motion == Motion::default()
    }
}

#[test]
fn assigned_goals_are_visited_in_the_order_of_assignment() {
    let mut robot = Robot::new(LAYERS, body());
    robot.step(vec![assign(7, [4.0, 0.0]), assign(3, [4.0, 4.0])]);
    robot.step(vec![assign(5, [0.0, 4.0])]);
    let waiting = OrderVerdict::Pending;
    assert_eq!(
        verdicts(&robot.brain),
        [(7, OrderVerdict::Approaching), (3, waiting), (5, waiting)]
    );
    assert_eq!(robot.run(60), [7, 3, 5]);
    let all = [7, 3, 5].map(|number| (number, OrderVerdict::Complete));
    assert_eq!(verdicts(&robot.brain), all);
}

#[test]
fn waypoints_of_the_scenario_come_first() {
    let spec = r#"{"limit_speed_to_stopping_distance": false, "behaviours": [
        {"kind": "cruise"}, {"kind": "correct", "waypoints_m": [[6, 0]]}]}"#;
    let mut robot = Robot::new(spec, body());
    // On the way to the waypoint.
    robot.step(vec![assign(1, [3.0, 0.0])]);
    robot.run(4);
    let waypoint_and_goal = [(0, OrderVerdict::Approaching), (1, OrderVerdict::Pending)];
    assert_eq!(verdicts(&robot.brain), waypoint_and_goal);
    assert_eq!(robot.run(20), [0, 1]);
}

#[test]
fn waypoints_that_were_visited_before_the_first_order_are_complete() {
    let spec = r#"{"limit_speed_to_stopping_distance": false, "behaviours": [
        {"kind": "cruise"}, {"kind": "correct", "waypoints_m": [[2, 0], [6, 0]]}]}"#;
    let mut robot = Robot::new(spec, body());
    robot.run(4);
    assert_eq!(verdicts(&robot.brain), []);
    // It withdraws nothing that there is.
    robot.step(vec![withdraw(9)]);
    let waypoints = [(0, OrderVerdict::Complete), (1, OrderVerdict::Approaching)];
    assert_eq!(verdicts(&robot.brain), waypoints);
    assert_eq!(robot.run(20), [0, 1]);
}

#[test]
fn only_orders_of_the_operator_with_ids_of_its_own_count() {
    let mut robot = Robot::new(LAYERS, body());
    let mate = AgentId::robot(0, 1);
    let other = AgentId {
        index: 1,
        ..AgentId::OPERATOR
    };
    for (from, issuer) in [
        (mate, AgentId::OPERATOR),
        (mate, mate),
        (AgentId::OPERATOR, mate),
        (other, other),
    ] {
        let (number, at) = (1, Point { x: 4.0, y: 0.0 });
        let goal = GoalId {
            issuer: issuer.into(),
            number,
        };
        let action = OrderAction::Assign;
        let mut received = assign(1, [4.0, 0.0]);
        received.from = from;
        received.message.about = About::Order { goal, at, action };
        robot.step(vec![received]);
    }
    assert!(robot.brain.assigned_goals().is_empty() && robot.is_standing());
    robot.step(vec![assign(1, [4.0, 0.0])]);
    let mut forged = withdraw(1);
    forged.from = mate;
    robot.step(vec![forged]);
    assert_eq!(numbers(&robot.brain), [1]);
}

#[test]
fn invalid_orders_are_ignored() {
    let mut robot = Robot::new(LAYERS, body());
    for bad in [f64::NAN, f64::INFINITY, -f64::INFINITY, 1e8, -1e8] {
        robot.step(vec![assign(1, [bad, 0.0]), assign(2, [0.0, bad])]);
    }
    for bad in [f64::NAN, -0.1, f64::INFINITY] {
        let (mut uncertain, mut old) = (assign(3, [1.0, 0.0]), assign(4, [1.0, 0.0]));
        uncertain.message.confidence = bad;
        old.age_s = bad;
        robot.step(vec![uncertain, old]);
    }
    assert_eq!(robot.brain.assigned_goals(), []);
}

#[test]
fn an_order_for_a_known_goal_moves_it_and_a_repeated_one_changes_nothing() {
    let mut robot = Robot::new(LAYERS, body());
    robot.step(vec![assign(1, [2.0, 0.0]), assign(2, [5.0, 0.0])]);
    robot.run(20);
    let complete = [(1, OrderVerdict::Complete), (2, OrderVerdict::Complete)];
    robot.step(vec![assign(1, [2.0, 0.0])]);
    assert_eq!(verdicts(&robot.brain), complete);
    robot.step(vec![assign(1, [0.0, 0.0])]);
    assert_eq!(verdicts(&robot.brain)[0], (1, OrderVerdict::Approaching));
    assert_eq!(robot.brain.assigned_goals()[0].at, Point::default());
    robot.run(20);
    assert!(robot.at.length() <= 0.5 + 1e-9, "{:?}", robot.at);
    assert_eq!(verdicts(&robot.brain), complete);
}

#[test]
fn a_withdrawn_goal_is_removed() {
    let mut robot = Robot::new(LAYERS, body());
    robot.step(vec![assign(1, [9.0, 0.0]), assign(2, [9.0, 9.0])]);
    robot.step(vec![withdraw(1), withdraw(3)]);
    assert_eq!(
        verdicts(&robot.brain),
        [(2, OrderVerdict::Approaching)],
        "the other one is next"
    );
    assert!(robot.motion.turn_rate_rad_s > 0.0);
    robot.step(vec![withdraw(2)]);
    assert!(robot.brain.assigned_goals().is_empty() && robot.is_standing());
}

#[test]
fn at_most_ten_thousand_goals_are_kept() {
    let mut robot = Robot::new(LAYERS, body());
    let far = [1000.0, 0.0];
    robot.step((0..10_010).map(|number| assign(number, far)).collect());
    assert_eq!(robot.brain.assigned_goals().len(), 10_000);
    robot.step(vec![withdraw(5), assign(20_000, far)]);
    let numbers = numbers(&robot.brain);
    assert_eq!((numbers.len(), numbers.last()), (10_000, Some(&20_000)));
}

#[test]
fn a_goal_that_the_robot_does_not_reach_is_receding_then_impossible_and_tried_after_the_others() {
    let mut robot = Robot::new(LAYERS, body());
    robot.step(vec![assign(1, [9.0, 0.0]), assign(2, [0.0, 0.1])]);
    let mut seen = Vec::new();
    for _ in 0..330 {
        // Something holds the robot.
        robot.at = Point { x: 3.0, y: 0.0 };
        robot.step(Vec::new());
        let verdict = verdicts(&robot.brain)[0].1;
        if seen.last() != Some(&verdict) {
            seen.push(verdict);
        }
    }
    let as_expected = [
        OrderVerdict::Approaching,
        OrderVerdict::Receding,
        OrderVerdict::Impossible,
    ];
    assert_eq!(seen, as_expected);
    assert_eq!(robot.run(60), [2, 1]);
}

#[test]
fn an_impossible_goal_stays_impossible_until_the_robot_comes_nearer() {
    let mut robot = Robot::new(LAYERS, body());
    robot.step(vec![assign(1, [9.0, 0.0])]);
    for step in 0..1000 {
        robot.at = Point { x: 3.0, y: 0.0 };
        robot.step(Vec::new());
        let is_impossible = verdicts(&robot.brain) == [(1, OrderVerdict::Impossible)];
        if !(290..=320).contains(&step) {
            assert_eq!(is_impossible, step > 320, "{step}");
        }
    }
    robot.run(2);
    assert_eq!(verdicts(&robot.brain), [(1, OrderVerdict::Approaching)]);
}

/// The verdicts of a goal 60 m ahead, for a robot with a noisy position that moves at a speed for
/// 50 s.
fn noisy_verdicts(speed_m_s: f64) -> Vec<OrderVerdict> {
    let noise_m = 1.0;
    let noisy = Body {
        position_noise_m: noise_m,
        ..body()
    };
    let (mut brain, mut word) = (brain(LAYERS, noisy), 1_u32);
    let mut uniform = || {
        word = word.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(word >> 8) / f64::from(1_u32 << 24)
    };
    let mut found = Vec::new();
    for step in 0..500 {
        let normal_m = noise_m * ((0..12).map(|_| uniform()).sum::<f64>() - 6.0);
        let x = 0.1 * f64::from(step) * speed_m_s + normal_m;
        brain.step(&Percept {
            inbox: vec![assign(1, [60.0, 0.0])],
            ..percept_at(x, 0.0, 0.0)
        });
        found.push(verdicts(&brain)[0].1);
    }
    found
}

#[test]
fn noise_of_the_position_is_no_progress_and_hides_none() {
    assert_eq!(noisy_verdicts(0.0).last(), Some(&OrderVerdict::Impossible));
    let moving = noisy_verdicts(1.0);
    let approaching = moving
        .iter()
        .filter(|each| **each == OrderVerdict::Approaching);
    assert!(approaching.count() > 480, "{moving:?}");
}

#[test]
fn a_goal_is_reached_by_a_position_whose_deviation_is_at_most_half_of_the_distance() {
    let spec = r#"{"behaviours": [{"kind": "correct", "within_m": 0.1}]}"#;
    for (noise_m, distance_m, is_reached) in [
        (0.0, 0.09, true),
        (0.05, 0.09, true),
        (0.05, 0.11, false),
        (0.06, 0.0, false),
    ] {
        let noisy = Body {
            position_noise_m: noise_m,
            ..body()
        };
        let mut robot = Robot::new(spec, noisy);
        robot.step(vec![assign(1, [distance_m, 0.0])]);
        let is_complete = verdicts(&robot.brain) == [(1, OrderVerdict::Complete)];
        assert_eq!(is_complete, is_reached, "{noise_m} {distance_m}");
    }
}

#[test]
fn a_robot_waits_at_a_goal_until_it_knows_its_position_well_enough() {
    let spec = r#"{"behaviours": [{"kind": "cruise"}, {"kind": "correct", "within_m": 0.5}]}"#;
    let ends = |drift_m: f64| {
        let noisy = Body {
            position_noise_m: 1.0,
            position_drift_m: drift_m,
            position_drift_s: 60.0,
            ..body()
        };
        let mut robot = Robot::new(spec, noisy);
        robot.step(vec![assign(1, [0.1, 0.0])]);
        robot.run(500);
        (robot.at, robot.brain.assigned_goals()[0])
    };
    // 16 readings of a deviation of 1 m give one of 0.25 m; a drift of 0.3 m remains.
    let (_, goal) = ends(0.0);
    assert_eq!(goal.verdict, OrderVerdict::Complete);
    let (at, goal) = ends(0.3);
    assert_eq!(at, Point { x: 0.0, y: 0.0 });
    assert_eq!(
        (goal.verdict, goal.reason),
        (OrderVerdict::Impossible, Some(Reason::Position))
    );
}

#[test]
fn with_stop_when_done_the_robot_stands_until_the_next_order() {
    let mut robot = Robot::new(LAYERS, body());
    robot.run(3);
    assert!(robot.is_standing() && robot.at == Point::default());
    robot.step(vec![assign(1, [2.0, 1.0])]);
    assert!(!robot.is_standing());
    assert_eq!(robot.run(20), [1]);
    let at = robot.at;
    robot.run(5);
    assert!(robot.is_standing() && robot.at == at);
    robot.step(vec![assign(2, [2.0, 5.0])]);
    assert!(robot.run(20).contains(&2));
}

#[test]
fn without_stop_when_done_lower_behaviours_are_active_when_nothing_is_left() {
    let spec = LAYERS.replace(r#", "stop_when_done": true"#, "");
    let mut robot = Robot::new(&spec, body());
    robot.step(vec![assign(1, [2.0, 0.0])]);
    assert_eq!(robot.run(20), [1]);
    assert!((robot.motion.speed_m_s - 0.5).abs() < 1e-9 && robot.at.x > 5.0);
}

#[test]
fn orders_count_while_a_higher_behaviour_is_active() {
    let spec = r#"{"behaviours": [{"kind": "cruise"}, {"kind": "correct"}, {"kind": "avoid"}]}"#;
    let mut robot = Robot::new(spec, body());
    robot.run(2);
    let touching = Percept {
        touch: now(true),
        inbox: vec![assign(1, [0.1, 0.0])],
        ..percept_at(0.0, 0.0, 0.0)
    };
    robot.brain.step(&touching);
    assert_eq!(verdicts(&robot.brain), [(1, OrderVerdict::Complete)]);
}

#[test]
fn a_brain_without_correct_takes_no_orders() {
    let spec = r#"{"behaviours": [{"kind": "cruise"}, {"kind": "avoid"}]}"#;
    let mut robot = Robot::new(spec, body());
    robot.step(vec![assign(1, [4.0, 0.0])]);
    assert!(robot.brain.assigned_goals().is_empty());
}

#[test]
fn a_copy_of_a_brain_has_its_goals_and_continues_as_the_brain_does() {
    let mut robot = Robot::new(LAYERS, body());
    robot.step(vec![assign(1, [2.0, 0.0]), assign(2, [2.0, 3.0])]);
    robot.run(2);
    let mut copy = Robot {
        brain: robot.brain.clone(),
        ..robot
    };
    assert_eq!(copy.run(30), robot.run(30));
    assert_eq!(copy.at, robot.at);
    copy.step(vec![withdraw(1)]);
    assert_eq!(
        (numbers(&copy.brain), numbers(&robot.brain)),
        (vec![2], vec![1, 2])
    );
}

#[test]
fn an_order_has_its_documented_form() {
    let json = r#"{"from": {"role": "person", "kind": 0, "index": 0}, "age_s": 0.0, "message": {"confidence": 1.0,
        "about": {"order": {"goal": {"issuer": {"role": "person", "kind": 0, "index": 0}, "number": 3},
        "at": [1.5, 2.0], "action": "assign"}}}}"#;
    let received: ReceivedMessage = serde_json::from_str(json).unwrap();
    assert_eq!(received, assign(3, [1.5, 2.0]));
    let mut robot = Robot::new(LAYERS, body());
    robot.step(vec![received]);
    assert_eq!(
        serde_json::to_string(&robot.brain.assigned_goals()).unwrap(),
        r#"[{"id":{"issuer":{"role":"person","kind":0,"index":0},"number":3},"at":[1.5,2.0],"verdict":"approaching","reason":null}]"#
    );
}

fn sender() -> impl Strategy<Value = AgentId> {
    let any_robot = (any::<u8>(), 0_u32..3).prop_map(|(kind, index)| AgentId::robot(kind, index));
    prop_oneof![3 => Just(AgentId::OPERATOR), 2 => any_robot]
}

fn number() -> impl Strategy<Value = f64> {
    prop_oneof![6 => -20.0_f64..20.0, 1 => any::<f64>(), 1 => Just(f64::NAN)]
}

fn any_order() -> impl Strategy<Value = ReceivedMessage> {
    let about = (sender(), 0_u32..6, number(), number(), any::<bool>());
    let about = about.prop_map(|(issuer, number, x, y, is_assigned)| About::Order {
        goal: GoalId {
            issuer: issuer.into(),
            number,
        },
        at: Point { x, y },
        action: if is_assigned {
            OrderAction::Assign
        } else {
            OrderAction::Withdraw
        },
    });
    let confidence = prop_oneof![4 => 0.0_f64..=1.0, 1 => number()];
    let age_s = prop_oneof![4 => 0.0_f64..10.0, 1 => number()];
    (sender(), about, confidence, age_s).prop_map(|(from, about, confidence, age_s)| {
        ReceivedMessage {
            from,
            age_s,
            message: Message {
                to: Receiver::All,
                about,
                confidence,
            },
        }
    })
}

/// The ids that are assigned after some orders, and their places.
fn expected(orders: &[ReceivedMessage]) -> Vec<(u32, Point)> {
    let mut goals: Vec<(u32, Point)> = Vec::new();
    for received in orders {
        let About::Order { goal, at, action } = received.message.about else {
            continue;
        };
        let is_valid = received.from == AgentId::OPERATOR
            && goal.issuer == AgentId::OPERATOR.into()
            && received.age_s >= 0.0
            && received.age_s.is_finite()
            && received.message.confidence >= 0.0
            && received.message.confidence <= 1.0
            && at.x.abs().max(at.y.abs()) <= 1e7
            && !(at.x + at.y).is_nan();
        if !is_valid {
            continue;
        }
        let known = goals.iter().position(|(number, _)| *number == goal.number);
        match (action, known) {
            (OrderAction::Assign, Some(index)) => goals[index].1 = at,
            (OrderAction::Assign, None) => goals.push((goal.number, at)),
            (OrderAction::Withdraw, Some(index)) => drop(goals.remove(index)),
            (OrderAction::Withdraw, None) => {}
        }
    }
    goals
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn of_any_orders_only_valid_ones_of_the_operator_count(
        steps in proptest::collection::vec(proptest::collection::vec(any_order(), 0..6), 1..20),
    ) {
        let mut robot = Robot::new(LAYERS, body());
        for inbox in &steps {
            robot.step(inbox.clone());
            prop_assert!(robot.at.x.is_finite() && robot.at.y.is_finite());
        }
        let goals = robot.brain.assigned_goals();
        let found: Vec<_> = goals.iter().map(|goal| (goal.id.number, goal.at)).collect();
        prop_assert_eq!(found, expected(&steps.concat()));
        prop_assert!(goals.iter().all(|goal| goal.id.issuer == AgentId::OPERATOR.into()));
    }
}
