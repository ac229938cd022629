//! Waypoints that a team shares.

use crate::listed;
use crate::scenarios::scenario;
use base::geometry::Point;
use sim::simulation::Simulation;

const WITHIN_M: f64 = 0.3;

/// A yard with a wall.
const YARD: &str = "
clock.time_limit_s = 1000
[world]
size_m = [30, 30]
obstacles = [{ polygon_m = [[14, 8], [14.5, 8], [14.5, 30], [14, 30]] }]
";

/// Robots of a kind that start in a corner, and the assignment of waypoints to them.
fn robots(kind: &str, at_m: &str, share: &str, more: &str) -> String {
    let waypoints_m = listed(&places());
    format!(
        "
[robots.{kind}]
radius_m = 0.25
drive = {{ max_speed_m_s = 1, max_acceleration_m_s2 = 1, max_turn_rate_deg_s = 120 }}
start.at_m = {at_m}
radio = {{ range_m = 60 }}
{more}
[robots.{kind}.sensors]
sonar = {{ kind = \"range\", rays = 24, range_m = 4 }}
gps = {{ kind = \"position\" }}
compass = {{ kind = \"heading\" }}
eye = {{ kind = \"robots\", range_m = 6 }}
[robots.{kind}.brain]
behaviours = [{{ kind = \"navigate\", assignment = \"{share}\", within_m = {WITHIN_M}, waypoints_m = {waypoints_m} }}]
"
    )
}

/// A dozen waypoints, the last of them in a remote corner.
fn places() -> Vec<Point> {
    let grid = (0..12).map(|number| Point {
        x: 3.0 + 8.0 * f64::from(number % 4),
        y: 6.0 + 9.0 * f64::from(number / 4),
    });
    grid.collect()
}

fn yard(robots: &str) -> Simulation {
    Simulation::new(scenario(&format!("{YARD}{robots}")), 1, 0).unwrap()
}

/// The robots that visited each waypoint, and the time at which all were visited, if so.
struct Visits {
    by: Vec<Vec<usize>>,
    all_s: Option<f64>,
}

fn visits(simulation: &mut Simulation, max_s: u32) -> Visits {
    let places = places();
    let mut by = vec![Vec::new(); places.len()];
    for step in 0..10 * max_s {
        simulation.step();
        let robots = simulation.state().each_robot(simulation.scenario());
        for (number, robot) in robots.enumerate() {
            let at = |place: &Point| robot.at.to(*place).length() <= WITHIN_M + 0.01;
            if let Some(place) = places.iter().position(at)
                && !by[place].contains(&number)
            {
                by[place].push(number);
            }
        }
        if by.iter().all(|by| !by.is_empty()) {
            let all_s = Some(f64::from(step) / 10.0);
            return Visits { by, all_s };
        }
    }
    Visits { by, all_s: None }
}

const CORNER: &str = "[[1, 1], [2, 1], [1, 2], [2, 2]]";

#[test]
fn a_team_visits_few_waypoints_twice_and_is_faster_than_if_each_robot_visited_all() {
    let [shared, alone] = ["shared", "all"].map(|share| {
        let mut yard = yard(&robots("rover", CORNER, share, ""));
        visits(&mut yard, 600)
    });
    let (shared_s, alone_s) = (shared.all_s.unwrap(), alone.all_s.unwrap());
    assert!(shared_s < 0.6 * alone_s, "{shared_s} {alone_s}");
    let count: usize = shared.by.iter().map(Vec::len).sum();
    assert!(count <= 15, "{:?}", shared.by);
}

#[test]
fn other_robots_visit_the_waypoints_of_robots_with_empty_batteries() {
    // Enough for about twelve metres.
    let weak = "battery = { capacity_j = 12, move_j_per_m = 1 }";
    let weak = robots("weak", "[[1, 1], [2, 1], [1, 2]]", "shared", weak);
    let alone = visits(&mut yard(&weak), 200);
    assert!(alone.all_s.is_none(), "{:?}", alone.by);
    let strong = robots("strong", "[[2, 2]]", "shared", "");
    let together = visits(&mut yard(&format!("{weak}{strong}")), 400);
    assert!(together.all_s.is_some(), "{:?}", together.by);
    assert!(
        together
            .by
            .iter()
            .any(|by| by.iter().any(|robot| *robot < 3))
    );
}
