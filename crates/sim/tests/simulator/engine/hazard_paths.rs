//! Robots keep clear of the items that they believe may destroy them.

use crate::common::{first, replaced, robots, scenario, start};
use base::geometry::Point;
use sim::run::Status;
use sim::simulation::Simulation;

/// A robot that drives along a lane, over a mine that it can detect.
const LANE: &str = r#"
clock = { step_s = 0.1, time_limit_s = 60 }
world = { size_m = [20, 10] }
[items.mine]
count = 1
hazard = { radius_m = 0.3 }
completed_by = "neutralised"
placement = { kind = "fixed", at_m = [[10, 5]] }
[robots.ugv]
count = 1
radius_m = 0.3
start = { kind = "fixed", at_m = [[2, 5]], heading_deg = [0] }
drive = { max_speed_m_s = 1, max_acceleration_m_s2 = 2, max_turn_rate_deg_s = 90 }
payload_kg = 1
tools.neutralise = { range_m = 1, charges = 1 }
sensors.place = { kind = "position" }
sensors.compass = { kind = "heading" }
sensors.eye = { kind = "items", range_m = 4, detection_probability = { mine = 0.9 } }
[robots.ugv.brain]
behaviours = [{ kind = "navigate", waypoints_m = [[18, 5]], within_m = 0.5 }]
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

/// The lane with a string replaced.
fn lane(from: &str, to: &str) -> String {
    replaced(LANE, &[(from, to)])
}

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
    let text = lane(
        "detection_probability = { mine = 0.9 }",
        "detection_probability = { mine = 0 }",
    );
    assert_eq!(run(&text, MINE).status, Status::Broken);
    let text = lane(
        "kind = \"navigate\", waypoints_m = [[18, 5]], within_m = 0.5",
        "kind = \"cruise\"",
    );
    assert_eq!(run(&text, MINE).status, Status::Broken);
}

#[test]
fn a_robot_in_the_air_and_one_among_harmless_items_drive_straight() {
    for text in [
        lane(
            "radius_m = 0.3\nstart",
            "radius_m = 0.3\nlayer = \"air\"\nstart",
        ),
        lane("hazard = { radius_m = 0.3 }\n", ""),
        lane(
            "radius_m = 0.3 }",
            "radius_m = 0.3, destroy_probability = 0 }",
        ),
    ] {
        let ran = run(&text, MINE);
        assert_eq!(ran.status, Status::Active);
        assert!(ran.nearest_m < 0.1 && ran.at.x > 17.0, "{}", ran.nearest_m);
    }
}

#[test]
fn a_robot_that_stands_near_a_mine_drives_away_and_around_it() {
    // The mine is 0.62 m in front of the robot: not near enough to destroy it, but well within its disc.
    let text = lane("at_m = [[2, 5]]", "at_m = [[9.38, 5]]");
    let text = replaced(&text, &[("range_m = 4", "range_m = 4, noise_m = 0.1")]);
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
        let text = lane(
            "waypoints_m = [[18, 5]], within_m = 0.5",
            &format!("waypoints_m = [{goal}], within_m = {within}"),
        );
        let ran = run(&text, MINE);
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
    let goals = "waypoints_m = [[10.2, 5], [3, 8]], within_m = 0.3";
    let text = lane("waypoints_m = [[18, 5]], within_m = 0.5", goals);
    let ran = run(&text, MINE);
    assert_eq!(ran.status, Status::Active);
    let away_m = ran.at.to(Point { x: 3.0, y: 8.0 }).length();
    assert!(away_m < 0.5 && ran.nearest_m > DANGER_M, "{:?}", ran.at);
}

/// Mines across the whole lane, with no gap that is wide enough.
#[test]
fn a_robot_stops_before_a_row_of_mines_that_it_cannot_pass() {
    let row: Vec<String> = (0..10).map(|row| format!("[10, {row}.5]")).collect();
    let text = replaced(
        LANE,
        &[
            ("count = 1\nhazard", "count = 10\nhazard"),
            ("at_m = [[10, 5]]", &format!("at_m = [{}]", row.join(", "))),
            ("range_m = 4", "range_m = 12"),
        ],
    );
    let ran = run(&text, Point { x: 10.0, y: 4.5 });
    assert_eq!(ran.status, Status::Active);
    assert!(ran.at.x < 10.0, "{:?}", ran.at);
}

/// The robot with the eye is in the air, and reports the mine to the one on the ground.
#[test]
fn a_mine_that_another_robot_reports_is_avoided() {
    let blind = lane(
        ", detection_probability = { mine = 0.9 }",
        ", detection_probability = { mine = 0 }",
    );
    let radio = "radio = { range_m = 50 }\n";
    let team = format!(
        "{}\n[robots.watch]\ncount = 1\nlayer = \"air\"\nradius_m = 0.2\nprice = 1\nstart = {{ kind = \"fixed\", at_m = [[10, 6]] }}\n\
         drive = {{ max_speed_m_s = 1, max_turn_rate_deg_s = 90 }}\n{radio}\
         sensors.place = {{ kind = \"position\" }}\nsensors.compass = {{ kind = \"heading\" }}\n\
         sensors.eye = {{ kind = \"items\", range_m = 4, detection_probability = {{ mine = 0.9 }} }}\n\
         brain = {{ behaviours = [{{ kind = \"hold_position\" }}] }}\n",
        blind.replace("sensors.place", &format!("{radio}sensors.place"))
    );
    let mut simulation: Simulation = start(&team);
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
        let scrap_kind = "[items.scrap]\ncount = 1\ntarget = false\n\
                          placement = { kind = \"fixed\", at_m = [[3, 9]] }\n[robots.ugv]";
        let confused = "confusion = { mine = { mine = 0.5, scrap = 0.5 }, scrap = { mine = 0.5, scrap = 0.5 } }";
        let text = replaced(
            LANE,
            &[
                ("[robots.ugv]", scrap_kind),
                (
                    "{ mine = 0.9 }",
                    &format!("{{ mine = 0.9, scrap = 0.9 }}, {confused}"),
                ),
                (
                    "[robots.ugv.brain]",
                    &format!(
                        "[robots.ugv.brain]\nbeliefs.prior_count = {{ mine = 1, scrap = {scrap} }}"
                    ),
                ),
            ],
        );
        assert_eq!(run(&text, MINE).status, status, "{scrap}");
    }
}

/// A controller awards a goal at the mine to the robot, which serves it from outside and is stationary there.
#[test]
fn a_goal_of_a_controller_at_a_mine_is_served_from_outside() {
    let goal = |within_m: f64| {
        let text = lane(
            "kind = \"navigate\", waypoints_m = [[18, 5]], within_m = 0.5",
            "kind = \"serve\"",
        );
        let text = text.replace("sensors.place", "radio = { range_m = 50 }\nsensors.place");
        format!(
            "{text}[goals.spot]\ncount = 1\nwithin_m = {within_m}\nservice_s = 2\n\
             placement = {{ kind = \"fixed\", at_m = [[10, 5]] }}\n\
             [controllers.base]\ncount = 1\nstart = {{ kind = \"fixed\", at_m = [[1, 9]] }}\nradio = {{ range_m = 50 }}\n"
        )
    };
    for (within_m, served) in [(1.5, 1), (0.5, 0)] {
        let mut simulation = start(&goal(within_m));
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
    let field = replaced(
        LANE,
        &[
            ("size_m = [20, 10]", "size_m = [40, 20]"),
            ("count = 1\nhazard", "count = 40\nhazard"),
            (
                "{ kind = \"fixed\", at_m = [[10, 5]] }",
                "{ kind = \"uniform\", within_m = [[3, 0], [37, 20]] }",
            ),
            ("at_m = [[2, 5]]", "at_m = [[1, 10]]"),
            ("waypoints_m = [[18, 5]]", "waypoints_m = [[39, 10]]"),
            ("time_limit_s = 60", "time_limit_s = 200"),
            ("range_m = 4", "range_m = 4, noise_m = 0.2"),
            ("kind = \"position\"", "kind = \"position\", noise_m = 0.1"),
        ],
    );
    let [lost, across] = crossings(&field);
    assert!(lost <= 1 && across >= 18, "{lost} lost, {across} across");
    let [_, across] = crossings(&replaced(&field, &[("mine = 0.9", "mine = 0")]));
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
