//! What robots with one errand do, from their percepts to where they have been.

use super::*;
use crate::arbitration::Arbitration;
use crate::brain::Brain;
use crate::io::body::{Detector, RobotId};
use crate::perception::beliefs::coverage_map::tests::detector;
use crate::spec::BrainSpec;
use crate::world_of_walls::{Walk, Wiring, outline, room, rover};
use base::geometry::{Point, Rectangle, Segment};
use std::sync::Arc;

const fn at(x: f64, y: f64) -> Point {
    Point { x, y }
}

/// A rover that knows where its mission is, and recognises items all around as far as 1.5 m.
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

/// A robot with one errand in a room, that knows where it is.
struct Errand {
    walk: Walk,
    brain: Brain,
    size: [f64; 2],
    /// Where it was at the end of each step.
    track: Vec<Point>,
}

impl Errand {
    fn new(errand: BehaviourSpec, size: [f64; 2], boxes: &[[f64; 4]], start: Point) -> Self {
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
            brain: brain(vec![errand], Arbitration::Subsumption, &body),
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

    /// When it first was near a place, in steps.
    fn visit(&self, place: Point) -> Option<usize> {
        self.track
            .iter()
            .position(|at| at.to(place).length() <= 0.5)
    }

    /// Share of the free places, a quarter of a metre apart, that it came nearer to than 1.5 m.
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

/// Of a box from its lower left to its upper right corner, free outside.
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

/// A wall from the lower side of a room of 16 m by 12 m up to 9 m: more than three times as wide as
/// what a rover sees.
const WALL: [f64; 4] = [7.8, 0.0, 8.2, 9.0];

#[test]
fn a_robot_goes_around_a_wall_to_its_place() {
    let place = at(13.0, 2.0);
    let errand = navigate(&[place], Assignment::All);
    let mut robot = Errand::new(errand, [16.0, 12.0], &[WALL], at(3.0, 2.0));
    robot.go(60);
    assert!(robot.visit(place).is_some(), "{:?}", robot.walk.at);
    assert!(robot.walk.min_gap_m > 0.0, "{}", robot.walk.min_gap_m);
    // And then it has nothing more to do.
    assert!(robot.walk.speed_m_s.abs() < 1e-6);
}

#[test]
fn a_robot_comes_out_of_a_deep_dead_end_without_going_astray() {
    let place = at(20.0, 12.0);
    // Three walls about where it stands, 12 m deep; the way out leads away from the place.
    let walls = [
        [4.0, 6.0, 16.4, 6.4],
        [4.0, 17.6, 16.4, 18.0],
        [16.0, 6.4, 16.4, 17.6],
    ];
    let mut robot = Errand::new(
        navigate(&[place], Assignment::All),
        [24.0, 24.0],
        &walls,
        at(15.0, 12.0),
    );
    // The way is some 42 m long.
    robot.go(90);
    assert!(robot.visit(place).is_some(), "{:?}", robot.walk.at);
    assert!(robot.walk.min_gap_m > 0.0, "{}", robot.walk.min_gap_m);
}

#[test]
fn places_are_visited_in_their_order() {
    let places = [at(2.0, 9.0), at(9.0, 9.0), at(9.0, 2.0), at(2.0, 2.0)];
    let errand = navigate(&places, Assignment::All);
    let mut robot = Errand::new(errand, [11.0, 11.0], &[], at(5.0, 5.0));
    robot.go(60);
    let visits: Vec<usize> = places.iter().map(|p| robot.visit(*p).unwrap()).collect();
    assert!(visits.is_sorted(), "{visits:?}");
}

#[test]
fn a_robot_fits_through_a_door_twice_as_wide_as_itself_wherever_its_cells_lie() {
    // A map of 4096 cells has cells of 0.4 m here: those of the door posts leave too little between
    // them.
    for off_m in [0.0, 0.1, 0.2, 0.3] {
        let walls = [
            [12.0, 0.0, 12.3, 11.5 + off_m],
            [12.0, 12.5 + off_m, 12.3, 24.0],
        ];
        let place = at(20.0, 5.0);
        let errand = navigate(&[place], Assignment::All);
        let mut robot = Errand::new(errand, [24.0, 24.0], &walls, at(6.0, 6.0));
        robot.go(150);
        assert!(robot.visit(place).is_some(), "{off_m}: {:?}", robot.walk.at);
    }
}

#[test]
fn a_place_that_is_closed_in_is_left_out() {
    let (closed, open) = (at(8.0, 6.0), at(13.0, 9.0));
    let errand = navigate(&[closed, open], Assignment::All);
    let cage = [
        [6.5, 4.5, 9.5, 4.8],
        [6.5, 7.2, 9.5, 7.5],
        [6.5, 4.5, 6.8, 7.5],
        [9.2, 4.5, 9.5, 7.5],
    ];
    let mut robot = Errand::new(errand, [16.0, 12.0], &cage, at(3.0, 5.0));
    robot.go(150);
    assert!(robot.visit(closed).is_none());
    assert!(robot.visit(open).is_some(), "{:?}", robot.walk.at);
}

#[test]
fn places_that_are_shared_are_visited_by_one_robot_each() {
    let places = [at(2.0, 2.0), at(8.0, 2.0), at(8.0, 8.0)];
    for (index, own) in [(1, 1), (5, 2)] {
        let errand = navigate(&places, Assignment::OneEach);
        let mut robot = Errand::new(errand, [10.0, 10.0], &[], at(5.0, 5.0));
        robot.walk.id = (RobotId { kind: 0, index }, 6);
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
    let errand = BehaviourSpec::Lawnmower(Lawnmower::default());
    let mut robot = Errand::new(errand, [10.0, 8.0], &[], at(2.0, 2.0));
    robot.go(45);
    assert!(robot.covered() > 0.99, "{}", robot.covered());
}

#[test]
fn two_robots_cover_a_room_together_in_half_the_time() {
    let both = [0, 1].map(|index| {
        let errand = BehaviourSpec::Lawnmower(Lawnmower::default());
        let mut robot = Errand::new(errand, [10.0, 8.0], &[], at(5.0, 4.0));
        robot.walk.id = (RobotId { kind: 0, index }, 2);
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
    let errand = BehaviourSpec::Spiral(Spiral::default());
    let mut robot = Errand::new(errand, [10.0, 8.0], &[], at(5.0, 4.0));
    robot.go(120);
    assert!(robot.covered() > 0.98, "{}", robot.covered());
    // From the middle outwards.
    let near = robot.track[..100]
        .iter()
        .map(|place| place.to(at(5.0, 4.0)).length());
    assert!(near.fold(0.0, f64::max) < 3.0);
}

/// Goes for so long in a room with a wall, and must then have looked at all of it.
fn looks_at_all_of_a_room_with_a_wall(errand: BehaviourSpec, seconds: u32) -> Errand {
    let wall = [5.0, 0.0, 5.3, 5.5];
    let mut robot = Errand::new(errand, [10.0, 8.0], &[wall], at(2.0, 2.0));
    robot.go(seconds);
    assert!(robot.covered() > 0.97, "{}", robot.covered());
    robot
}

#[test]
fn along_frontiers_one_looks_at_all_of_a_room_and_has_nothing_more_to_do() {
    let errand = BehaviourSpec::Frontier(Frontier::default());
    let robot = looks_at_all_of_a_room_with_a_wall(errand, 280);
    assert!(robot.walk.speed_m_s.abs() < 1e-6);
    let goals = robot.brain.belief_state().unwrap().goals;
    assert!(goals.is_empty(), "{goals:?}");
}

#[test]
fn who_seeks_looks_at_all_of_a_room_and_then_again_as_something_may_have_been_missed() {
    let errand = BehaviourSpec::BayesianSearch(BayesianSearch::default());
    let mut robot = looks_at_all_of_a_room_with_a_wall(errand, 120);
    for _ in 0..2 {
        robot.track.clear();
        robot.go(120);
        assert!(robot.covered() > 0.9, "{}", robot.covered());
        // In a corner it takes some seconds until it gives up a place that it cannot get to.
        let mut ways = robot.track.windows(120);
        assert!(ways.all(|way| way[0].to(way[119]).length() > 0.05));
    }
}

#[test]
fn who_holds_a_place_comes_back_to_it() {
    let errand = BehaviourSpec::HoldPosition(HoldPosition::default());
    let mut robot = Errand::new(errand, [10.0, 10.0], &[], at(3.0, 3.0));
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
fn a_robot_is_home_before_its_battery_is_empty() {
    let home = at(2.0, 2.0);
    let far = [
        at(27.0, 2.0),
        at(27.0, 4.0),
        at(3.0, 4.0),
        at(27.0, 6.0),
        at(27.0, 2.0),
    ];
    for arbitration in [Arbitration::Subsumption, Arbitration::Goals] {
        let errand = navigate(&far, Assignment::All);
        let mut robot = Errand::new(errand.clone(), [29.0, 8.0], &[], home);
        let behaviours = vec![errand, BehaviourSpec::ReturnHome(ReturnHome::default())];
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
fn who_follows_keeps_his_distance() {
    let leader = RobotId { kind: 0, index: 0 };
    let errand = BehaviourSpec::Follow(Follow::default());
    let mut robot = Errand::new(errand, [40.0, 10.0], &[], at(2.0, 5.0));
    robot.walk.id = (RobotId { kind: 0, index: 1 }, 2);
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
fn who_does_not_know_where_he_is_leaves_it_to_lower_behaviours() {
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
    for errand in errands {
        for arbitration in [Arbitration::Subsumption, Arbitration::Goals] {
            let mut robot = Errand::new(errand.clone(), [10.0, 10.0], &[], at(2.0, 5.0));
            robot.walk.wiring.position = false;
            let behaviours = vec![lower(), errand.clone()];
            robot.brain = brain(behaviours, arbitration, &robot.walk.body);
            robot.go(2);
            assert!(robot.walk.speed_m_s > 0.9, "{errand:?}");
        }
    }
}
