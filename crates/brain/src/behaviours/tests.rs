//! Robots with one mission, from their percepts to their paths.

use super::*;
use crate::arbitration::Arbitration;
use crate::brain::Brain;
use crate::io::agent_id::AgentId;
use crate::io::body::Detector;
use crate::perception::beliefs::coverage_map::tests::detector;
use crate::spec::BrainSpec;
use crate::world_of_walls::{Walk, Wiring, outline, room, rover};
use base::geometry::{Point, Rectangle, Segment};
use std::sync::Arc;

const fn at(x: f64, y: f64) -> Point {
    Point { x, y }
}

/// A rover that knows the mission area, with an item detector of 1.5 m range in all directions.
fn searcher(width: f64, height: f64) -> Body {
    Body {
        detectors: vec![Detector {
            needs_line_of_sight: true,
            ..detector(1.5, 7.0, 1.0)
        }],
        item_kinds: vec!["mine".into()],
        field: Some(Rectangle::spanned(Point::default(), at(width, height))),
        ..rover()
    }
}

fn brain(behaviours: Vec<BehaviourSpec>, arbitration: Arbitration, body: &Body) -> Brain {
    let spec = BrainSpec {
        arbitration,
        behaviours,
        ..BrainSpec::default()
    };
    Brain::new(Arc::new(spec), Arc::new(body.clone()))
}

/// A robot with one mission in a room, with position and heading sensors.
struct Mission {
    walk: Walk,
    brain: Brain,
    size: [f64; 2],
    /// Positions after each step.
    track: Vec<Point>,
}

impl Mission {
    fn new(mission: BehaviourSpec, size: [f64; 2], boxes: &[[f64; 4]], start: Point) -> Self {
        let body = searcher(size[0], size[1]);
        let mut walls = room(size[0], size[1]);
        walls.extend(boxes.iter().flat_map(|corners| sides(*corners)));
        let mut walk = Walk::new(body.clone(), walls, [start.x, start.y], 0.5);
        walk.wiring = Wiring {
            compass: true,
            touch: true,
            position: true,
            ..Wiring::default()
        };
        Self {
            walk,
            brain: brain(vec![mission], Arbitration::Subsumption, &body),
            size,
            track: Vec::new(),
        }
    }

    fn go(&mut self, seconds: u32) {
        for _ in 0..10 * seconds {
            self.walk.run(&mut self.brain, 1);
            self.track.push(self.walk.at);
        }
    }

    /// The first step in which it was near a place.
    fn visit(&self, place: Point) -> Option<usize> {
        self.track
            .iter()
            .position(|at| at.to(place).length() <= 0.5)
    }

    /// Share of the free points of a 0.25 m grid that it approached within 1.5 m.
    fn covered(&self) -> f64 {
        let count = |length_m: f64| {
            (0..)
                .map(|n| 0.25 * f64::from(n))
                .take_while(move |m| *m <= length_m)
        };
        let places = count(self.size[0]).flat_map(|x| count(self.size[1]).map(move |y| at(x, y)));
        let is_seen = |place: &Point| {
            let near = |at: &Point| at.to(*place).length_squared() <= 1.5 * 1.5;
            self.track.iter().step_by(3).any(near)
        };
        let (mut all, mut seen) = (0.0, 0.0);
        for place in places {
            all += 1.0;
            seen += f64::from(u8::from(is_seen(&place)));
        }
        seen / all
    }
}

/// The sides of a box given by its lower left and upper right corners, free outside.
fn sides([left, low, right, high]: [f64; 4]) -> Vec<Segment> {
    outline(&[[left, low], [left, high], [right, high], [right, low]])
}

fn navigate(places: &[Point], assignment: Assignment) -> BehaviourSpec {
    BehaviourSpec::Navigate(Navigate {
        waypoints_m: places.to_vec(),
        assignment,
        ..Navigate::default()
    })
}

/// A wall from the lower side of a room of 16 m by 12 m up to 9 m: more than three times the sensor
/// range.
const WALL: [f64; 4] = [7.8, 0.0, 8.2, 9.0];

#[test]
fn a_robot_drives_around_a_wall_to_its_waypoint() {
    let place = at(13.0, 2.0);
    let mission = navigate(&[place], Assignment::All);
    let mut robot = Mission::new(mission, [16.0, 12.0], &[WALL], at(3.0, 2.0));
    robot.go(60);
    assert!(robot.visit(place).is_some(), "{:?}", robot.walk.at);
    assert!(robot.walk.min_gap_m > 0.0, "{}", robot.walk.min_gap_m);
    // Afterwards it has nothing to do.
    assert!(robot.walk.speed_m_s.abs() < 1e-6);
}

#[test]
fn a_robot_leaves_a_deep_dead_end_without_detours() {
    let place = at(20.0, 12.0);
    // Three walls around its position, 12 m deep; the exit leads away from the waypoint.
    let walls = [
        [4.0, 6.0, 16.4, 6.4],
        [4.0, 17.6, 16.4, 18.0],
        [16.0, 6.4, 16.4, 17.6],
    ];
    let mut robot = Mission::new(
        navigate(&[place], Assignment::All),
        [24.0, 24.0],
        &walls,
        at(15.0, 12.0),
    );
    // The shortest path is about 42 m long.
    robot.go(90);
    assert!(robot.visit(place).is_some(), "{:?}", robot.walk.at);
    assert!(robot.walk.min_gap_m > 0.0, "{}", robot.walk.min_gap_m);
}

#[test]
fn waypoints_are_visited_in_order() {
    let places = [at(2.0, 9.0), at(9.0, 9.0), at(9.0, 2.0), at(2.0, 2.0)];
    let mission = navigate(&places, Assignment::All);
    let mut robot = Mission::new(mission, [11.0, 11.0], &[], at(5.0, 5.0));
    robot.go(60);
    let visits: Vec<usize> = places.iter().map(|p| robot.visit(*p).unwrap()).collect();
    assert!(visits.is_sorted(), "{visits:?}");
}

#[test]
fn a_robot_passes_a_door_of_twice_its_width_for_any_cell_alignment() {
    // A map of 4096 cells has cells of 0.4 m here: the cells of the door posts alone would leave too
    // little clearance.
    for off_m in [0.0, 0.1, 0.2, 0.3] {
        let walls = [
            [12.0, 0.0, 12.3, 11.5 + off_m],
            [12.0, 12.5 + off_m, 12.3, 24.0],
        ];
        let place = at(20.0, 5.0);
        let mission = navigate(&[place], Assignment::All);
        let mut robot = Mission::new(mission, [24.0, 24.0], &walls, at(6.0, 6.0));
        robot.go(150);
        assert!(robot.visit(place).is_some(), "{off_m}: {:?}", robot.walk.at);
    }
}

#[test]
fn an_enclosed_waypoint_is_skipped() {
    let (closed, open) = (at(8.0, 6.0), at(13.0, 9.0));
    let mission = navigate(&[closed, open], Assignment::All);
    let cage = [
        [6.5, 4.5, 9.5, 4.8],
        [6.5, 7.2, 9.5, 7.5],
        [6.5, 4.5, 6.8, 7.5],
        [9.2, 4.5, 9.5, 7.5],
    ];
    let mut robot = Mission::new(mission, [16.0, 12.0], &cage, at(3.0, 5.0));
    robot.go(150);
    assert!(robot.visit(closed).is_none());
    assert!(robot.visit(open).is_some(), "{:?}", robot.walk.at);
}

#[test]
fn a_waypoint_is_reached_after_a_wall_around_it_has_left_out_of_sight() {
    let (enclosed, open) = (at(8.0, 6.0), at(13.0, 9.0));
    let mission = navigate(&[enclosed, open], Assignment::All);
    let walls = [
        [6.5, 4.5, 9.5, 4.8],
        [6.5, 7.2, 9.5, 7.5],
        [9.2, 4.5, 9.5, 7.5],
    ];
    let door = [6.5, 4.5, 6.8, 7.5];
    let boxes = [walls[0], walls[1], walls[2], door];
    let mut robot = Mission::new(mission, [16.0, 12.0], &boxes, at(3.0, 5.0));
    robot.go(150);
    assert!(robot.visit(enclosed).is_none());
    let others = robot.walk.walls.len() - sides(door).len();
    robot.walk.walls.truncate(others);
    robot.go(250);
    assert!(robot.visit(enclosed).is_some(), "{:?}", robot.walk.at);
}

#[test]
fn shared_waypoints_are_visited_by_one_robot_each() {
    let places = [at(2.0, 2.0), at(8.0, 2.0), at(8.0, 8.0)];
    for (index, own) in [(1, 1), (5, 2)] {
        let mission = navigate(&places, Assignment::OneEach);
        let mut robot = Mission::new(mission, [10.0, 10.0], &[], at(5.0, 5.0));
        robot.walk.id = (AgentId::robot(0, index), 6);
        robot.go(30);
        for (number, place) in places.iter().enumerate() {
            assert_eq!(
                robot.visit(*place).is_some(),
                number == own,
                "{index} {number}"
            );
        }
    }
}

#[test]
fn lanes_cover_a_room() {
    let mission = BehaviourSpec::Lawnmower(Lawnmower::default());
    let mut robot = Mission::new(mission, [10.0, 8.0], &[], at(2.0, 2.0));
    robot.go(45);
    assert!(robot.covered() > 0.99, "{}", robot.covered());
}

#[test]
fn two_robots_cover_a_room_together_in_half_the_time() {
    let both = [0, 1].map(|index| {
        let mission = BehaviourSpec::Lawnmower(Lawnmower::default());
        let mut robot = Mission::new(mission, [10.0, 8.0], &[], at(5.0, 4.0));
        robot.walk.id = (AgentId::robot(0, index), 2);
        robot.go(26);
        robot
    });
    assert!(both.iter().all(|robot| robot.covered() < 0.9));
    let [mut one, other] = both;
    one.track.extend(other.track);
    assert!(one.covered() > 0.99, "{}", one.covered());
}

#[test]
fn a_spiral_covers_a_room() {
    let mission = BehaviourSpec::Spiral(Spiral::default());
    let mut robot = Mission::new(mission, [10.0, 8.0], &[], at(5.0, 4.0));
    robot.go(120);
    assert!(robot.covered() > 0.98, "{}", robot.covered());
    // From the centre outwards.
    let near = robot.track[..100]
        .iter()
        .map(|place| place.to(at(5.0, 4.0)).length());
    assert!(near.fold(0.0, f64::max) < 3.0);
}

/// Runs in a room with a wall for some seconds, and asserts that all of it was observed.
fn observe_a_room_with_a_wall(mission: BehaviourSpec, seconds: u32) -> Mission {
    let wall = [5.0, 0.0, 5.3, 5.5];
    let mut robot = Mission::new(mission, [10.0, 8.0], &[wall], at(2.0, 2.0));
    robot.go(seconds);
    assert!(robot.covered() > 0.97, "{}", robot.covered());
    robot
}

#[test]
fn frontier_observes_the_whole_room_and_then_has_nothing_to_do() {
    let mission = BehaviourSpec::Frontier(Frontier::default());
    let robot = observe_a_room_with_a_wall(mission, 280);
    assert!(robot.walk.speed_m_s.abs() < 1e-6);
    let goals = robot.brain.belief_state().unwrap().goals;
    assert!(goals.is_empty(), "{goals:?}");
}

#[test]
fn bayesian_search_observes_the_whole_room_and_then_searches_again() {
    let mission = BehaviourSpec::BayesianSearch(BayesianSearch::default());
    let mut robot = observe_a_room_with_a_wall(mission, 120);
    for _ in 0..2 {
        robot.track.clear();
        robot.go(120);
        assert!(robot.covered() > 0.9, "{}", robot.covered());
        // In a corner it takes some seconds to abandon an unreachable place.
        let mut ways = robot.track.windows(120);
        assert!(ways.all(|way| way.iter().any(|at| way[0].to(*at).length() > 0.05)));
    }
}

#[test]
fn hold_position_returns_to_its_position() {
    let mission = BehaviourSpec::HoldPosition(HoldPosition::default());
    let mut robot = Mission::new(mission, [10.0, 10.0], &[], at(3.0, 3.0));
    robot.go(3);
    assert!(robot.walk.at == at(3.0, 3.0));
    robot.walk.at = at(8.0, 6.0);
    robot.go(20);
    assert!(
        robot.walk.at.to(at(3.0, 3.0)).length() <= 1.0,
        "{:?}",
        robot.walk.at
    );
}

#[test]
fn a_robot_returns_home_before_its_battery_is_empty() {
    let home = at(2.0, 2.0);
    let far = [
        at(27.0, 2.0),
        at(27.0, 4.0),
        at(3.0, 4.0),
        at(27.0, 6.0),
        at(27.0, 2.0),
    ];
    for arbitration in [Arbitration::Subsumption, Arbitration::Goals] {
        let mission = navigate(&far, Assignment::All);
        let mut robot = Mission::new(mission.clone(), [29.0, 8.0], &[], home);
        let behaviours = vec![mission, BehaviourSpec::ReturnHome(ReturnHome::default())];
        robot.brain = brain(behaviours, arbitration, &robot.walk.body);
        robot.walk.wiring.drain = 0.01;
        robot.go(98);
        assert!(robot.visit(far[1]).is_some());
        assert!(
            robot.walk.at.to(home).length() <= 1.0,
            "{:?}",
            robot.walk.at
        );
        assert!(robot.walk.speed_m_s.abs() < 1e-6);
    }
}

#[test]
fn a_follower_keeps_its_distance() {
    let leader = AgentId::robot(0, 0);
    let mission = BehaviourSpec::Follow(Follow::default());
    let mut robot = Mission::new(mission, [40.0, 10.0], &[], at(2.0, 5.0));
    robot.walk.id = (AgentId::robot(0, 1), 2);
    for step in 0..40 {
        let gone_m = 0.7 * f64::from(step);
        robot.walk.others = vec![(leader, at(6.0 + gone_m, 5.0))];
        robot.go(1);
        let apart_m = robot.walk.at.to(robot.walk.others[0].1).length();
        assert!(apart_m > 1.2, "{apart_m}");
        assert!(step < 15 || apart_m < 3.0, "{apart_m}");
    }
}

#[test]
fn without_a_pose_lower_behaviours_are_active() {
    let lower = || BehaviourSpec::Cruise(Cruise::default());
    let place = navigate(&[at(1.0, 9.0)], Assignment::All);
    let errands = [
        place,
        BehaviourSpec::Lawnmower(Lawnmower::default()),
        BehaviourSpec::Spiral(Spiral::default()),
        BehaviourSpec::Frontier(Frontier::default()),
        BehaviourSpec::BayesianSearch(BayesianSearch::default()),
        BehaviourSpec::ReturnHome(ReturnHome {
            min_charge: 1.0,
            ..ReturnHome::default()
        }),
        BehaviourSpec::Follow(Follow::default()),
    ];
    for mission in errands {
        for arbitration in [Arbitration::Subsumption, Arbitration::Goals] {
            let mut robot = Mission::new(mission.clone(), [10.0, 10.0], &[], at(2.0, 5.0));
            robot.walk.wiring.position = false;
            let behaviours = vec![lower(), mission.clone()];
            robot.brain = brain(behaviours, arbitration, &robot.walk.body);
            robot.go(2);
            assert!(robot.walk.speed_m_s > 0.9, "{mission:?}");
        }
    }
}
