//! Robots keep clear of the items that they believe may destroy them.

use crate::common::{first, replaced, robots, scenario, start, with};
use base::geometry::Point;
use sim::run::Status;
use sim::simulation::Simulation;

/// A robot that drives along a lane, over a mine that it can detect.
const LANE: &str = r#"
items.mine = { hazard.radius_m = 0.3, completed_by = "neutralised", placement.at_m = [[10, 5]] }
[robots.ugv]
radius_m = 0.3
start = { at_m = [[2, 5]], heading_deg = [0] }
drive = { max_speed_m_s = 1, max_acceleration_m_s2 = 2, max_turn_rate_deg_s = 90 }
payload_kg = 1
tools.neutralise = { range_m = 1, charges = 1 }
sensors.place.kind = "position"
sensors.compass.kind = "heading"
sensors.eye = { kind = "items", range_m = 4, detection_probability.mine = 0.9 }
brain.behaviours = [{ kind = "navigate", waypoints_m = [[18, 5]], within_m = 0.5 }]
"#;

const MINE: Point = Point { x: 10.0, y: 5.0 };

/// The distance of the mine at which a robot of 0.3 m may be destroyed.
const DANGER_M: f64 = 0.6;

/// How a run went: the status of its robot, where it is, and its smallest distance from a place.
struct Ran {
    status: Status,
    at: Point,
    nearest_m: f64,
}

fn run(text: &str, place: Point) -> Ran {
    let mut simulation = start(text);
    let mut nearest_m = f64::INFINITY;
    for _ in 0..590 {
        simulation.step();
        nearest_m = nearest_m.min(first(&simulation).at.to(place).length());
    }
    let robot = first(&simulation);
    Ran {
        status: robot.status,
        at: robot.at,
        nearest_m,
    }
}

/// The lane with other values of its robot.
fn lane(changes: &str) -> String {
    with(LANE, &format!("robots.ugv = {{ {changes} }}"))
}

/// The lane with other goals of its robot.
fn to(goals: &str) -> String {
    lane(&format!(
        "brain.behaviours = [{{ kind = \"navigate\", {goals} }}]"
    ))
}

const BLIND: &str = "sensors.eye.detection_probability.mine = 0";

#[test]
fn a_robot_on_the_ground_drives_around_a_mine_that_it_detects() {
    let ran = run(LANE, MINE);
    assert_eq!(ran.status, Status::Active);
    assert!(ran.at.x > 17.0, "{:?}", ran.at);
    assert!(
        (DANGER_M..3.0).contains(&ran.nearest_m),
        "{}",
        ran.nearest_m
    );
}

#[test]
fn a_robot_is_destroyed_by_a_mine_that_it_does_not_detect_or_believe_in() {
    for changes in [BLIND, "brain.behaviours = [{ kind = \"cruise\" }]"] {
        assert_eq!(run(&lane(changes), MINE).status, Status::Broken);
    }
}

#[test]
fn a_robot_in_the_air_and_one_among_harmless_items_drive_straight() {
    for text in [
        lane("layer = \"air\""),
        replaced(LANE, &[("hazard.radius_m = 0.3, ", "")]),
        with(LANE, "items.mine.hazard.destroy_probability = 0"),
    ] {
        let ran = run(&text, MINE);
        assert_eq!(ran.status, Status::Active);
        assert!(ran.nearest_m < 0.1 && ran.at.x > 17.0, "{}", ran.nearest_m);
    }
}

#[test]
fn a_robot_that_stands_near_a_mine_drives_away_and_around_it() {
    // The mine is 0.62 m in front of the robot: not near enough to destroy it, but well within its disc.
    let text = lane("start.at_m = [[9.38, 5]], sensors.eye.noise_m = 0.1");
    let ran = run(&text, MINE);
    assert_eq!(ran.status, Status::Active);
    assert!(
        ran.at.x > 17.0 && ran.nearest_m > DANGER_M,
        "{}",
        ran.nearest_m
    );
}

#[test]
fn a_goal_near_a_mine_is_reached_from_outside_its_danger() {
    for (goal, within) in [
        ("[10, 5]", "1.5"),
        ("[11.5, 5]", "0.3"),
        ("[10.5, 5.1]", "1.5"),
    ] {
        let ran = run(
            &to(&format!("waypoints_m = [{goal}], within_m = {within}")),
            MINE,
        );
        assert_eq!(ran.status, Status::Active);
        assert!(ran.nearest_m > DANGER_M, "{goal}: {}", ran.nearest_m);
        let corner: Vec<f64> = goal
            .trim_matches(['[', ']'])
            .split(", ")
            .map(|part| part.parse().unwrap())
            .collect();
        let away_m = ran
            .at
            .to(Point {
                x: corner[0],
                y: corner[1],
            })
            .length();
        assert!(
            away_m <= within.parse::<f64>().unwrap() + 0.1,
            "{goal}: {:?}",
            ran.at
        );
    }
}

#[test]
fn a_goal_that_can_only_be_reached_at_a_mine_is_left() {
    let goals = to("waypoints_m = [[10.2, 5], [3, 8]], within_m = 0.3");
    let ran = run(&goals, MINE);
    assert_eq!(ran.status, Status::Active);
    let away_m = ran.at.to(Point { x: 3.0, y: 8.0 }).length();
    assert!(away_m < 0.5 && ran.nearest_m > DANGER_M, "{:?}", ran.at);
}

/// Mines across the whole lane, with no gap that is wide enough.
#[test]
fn a_robot_stops_before_a_row_of_mines_that_it_cannot_pass() {
    let row: Vec<String> = (0..10).map(|row| format!("[10, {row}.5]")).collect();
    let row = format!("items.mine.placement.at_m = [{}]", row.join(", "));
    let text = with(&lane("sensors.eye.range_m = 12"), &row);
    let ran = run(&text, Point { x: 10.0, y: 4.5 });
    assert_eq!(ran.status, Status::Active);
    assert!(ran.at.x < 10.0, "{:?}", ran.at);
}

/// The robot with the eye is in the air, and reports the mine to the one on the ground.
#[test]
fn a_mine_that_another_robot_reports_is_avoided() {
    let watch = r#"
robots.ugv.radio.range_m = 50
[robots.watch]
layer = "air"
price = 1
start.at_m = [[10, 6]]
radio.range_m = 50
sensors = { place.kind = "position", compass.kind = "heading",
    eye = { kind = "items", range_m = 4, detection_probability.mine = 0.9 } }
brain.behaviours = [{ kind = "hold_position" }]
"#;
    let mut simulation: Simulation = start(&with(&lane(BLIND), watch));
    for _ in 0..300 {
        simulation.step();
    }
    let ugv = robots(&simulation)[0];
    assert_eq!(ugv.status, Status::Active);
    assert!(ugv.at.x > 17.0, "{:?}", ugv.at);
}

/// The detector reports the same kinds of mines as of scrap: how probable a mine is follows from the numbers expected.
#[test]
fn an_item_of_uncertain_kind_is_avoided_if_a_mine_is_likely_enough() {
    for (scrap, status) in [(3, Status::Active), (19, Status::Broken)] {
        let changes = format!(
            "items.scrap = {{ target = false, placement.at_m = [[3, 9]] }}\n\
             [robots.ugv]\nbrain.beliefs.prior_count = {{ mine = 1, scrap = {scrap} }}\n\
             sensors.eye.detection_probability.scrap = 0.9\n\
             sensors.eye.confusion = {{ mine = {{ mine = 0.5, scrap = 0.5 }}, \
             scrap = {{ mine = 0.5, scrap = 0.5 }} }}"
        );
        let text = with(LANE, &changes);
        assert_eq!(run(&text, MINE).status, status, "{scrap}");
    }
}

/// A controller awards a goal at the mine to the robot, which serves it from outside and is stationary there.
#[test]
fn a_goal_of_a_controller_at_a_mine_is_served_from_outside() {
    let text = lane("radio.range_m = 50, brain.behaviours = [{ kind = \"serve\" }]");
    for (within_m, served) in [(1.5, 1), (0.5, 0)] {
        let goal = format!(
            "controllers.base = {{ start.at_m = [[1, 9]], radio.range_m = 50 }}\n\
             goals.spot = {{ within_m = {within_m}, service_s = 2, placement.at_m = [[10, 5]] }}"
        );
        let mut simulation = start(&with(&text, &goal));
        let mut nearest_m = f64::INFINITY;
        for _ in 0..590 {
            simulation.step();
            nearest_m = nearest_m.min(first(&simulation).at.to(MINE).length());
        }
        let goals = simulation.outcome().goals.unwrap();
        assert_eq!(goals.served, served, "{within_m}");
        assert!(nearest_m > DANGER_M, "{within_m}: {nearest_m}");
    }
}

/// Of 20 robots that cross a field of 40 mines, nearly all reach the other side. A blind one drives straight: with the
/// mines evenly spread, it meets 40 x 36 x 1.2 / 680 = 2.5 mines on average, and none with a probability of 0.08, so
/// that more than 6 of 20 cross with a probability below 1e-3. The seeds are fixed.
#[test]
fn a_minefield_is_crossed_between_the_mines() {
    let field = r#"
clock.time_limit_s = 200
world.size_m = [40, 20]
items.mine = { count = 40, placement = { kind = "uniform", within_m = [[3, 0], [37, 20]] } }
[robots.ugv]
start.at_m = [[1, 10]]
sensors = { eye.noise_m = 0.2, place.noise_m = 0.1 }
brain.behaviours = [{ kind = "navigate", waypoints_m = [[39, 10]], within_m = 0.5 }]
"#;
    let field = with(LANE, field);
    let [lost, across] = crossings(&field);
    assert!(lost <= 1 && across >= 18, "{lost} lost, {across} across");
    let [_, across] = crossings(&field.replace("mine = 0.9", "mine = 0"));
    assert!(across <= 6, "{across} blind robots across");
}

/// How many of 20 robots are lost in a minefield, and how many cross it.
fn crossings(field: &str) -> [u32; 2] {
    let scenario = scenario(field);
    let mut counts = [0, 0];
    for run in 0..20 {
        let mut simulation = Simulation::new(scenario.clone(), 3, run).unwrap();
        for _ in 0..1900 {
            simulation.step();
        }
        let robot = first(&simulation);
        counts[0] += u32::from(robot.status == Status::Broken);
        counts[1] += u32::from(robot.at.x > 38.0);
    }
    counts
}
