//! Sensor footprints for display.

use super::determinism::assert_no_effect;
use crate::common::{id, robots, start, step_with};
use brain::{Command, SensorRequest};
use sim::simulation::{Footprint, Sensors, Simulation};
use std::f64::consts::{FRAC_PI_2, PI};

/// A robot that faces along x in a field of 20 m with a wall from 12 m to 13 m.
fn at(place: &str, world: &str, more: &str) -> Simulation {
    let count = place.matches('[').count();
    start(&format!(
        "[clock]\ntime_limit_s = 100\n[world]\nsize_m = [20, 20]\n{world}\n\
         [items.mine]\ntarget = false\nplacement.at_m = [[1, 1]]\n[robots.rover]\nbrain.behaviours = []\n\
         start = {{ at_m = [{place}], heading_deg = {:?} }}\n{more}",
        vec![0.0; count]
    ))
}

const WALL: &str = "obstacles = [{ polygon_m = [[12, 2], [13, 2], [13, 18], [12, 18]] }]";
const EYE: &str = "sensors.eye = { kind = \"items\", range_m = 4 }\n";

fn footprints(simulation: &mut Simulation) -> Vec<Footprint> {
    simulation.footprints(id(0, 0), Sensors::All).unwrap()
}

fn only(simulation: &mut Simulation) -> Footprint {
    let [footprint] = footprints(simulation).try_into().unwrap();
    footprint
}

/// The range of a footprint along the nearest of its bearings.
fn along(footprint: &Footprint, bearing_rad: f64) -> f64 {
    let pairs = footprint
        .bearings_rad()
        .into_iter()
        .zip(&footprint.ranges_m);
    let off = |bearing: f64| -(bearing - bearing_rad).cos();
    *pairs
        .min_by(|one, other| off(one.0).total_cmp(&off(other.0)))
        .unwrap()
        .1
}

#[track_caller]
fn assert_near(given: f64, expected: f64) {
    assert!((given - expected).abs() < 1e-9, "{given} for {expected}");
}

#[test]
fn a_footprint_ends_at_the_wall_and_extends_beside_it() {
    let footprint = only(&mut at("[10, 10]", WALL, EYE));
    assert!(footprint.finds_items);
    assert_eq!(footprint.ranges_m.len(), 360);
    assert_near(along(&footprint, 0.0), 2.0);
    assert_near(along(&footprint, PI / 4.0), 2.0 * 2.0_f64.sqrt());
    assert_near(along(&footprint, FRAC_PI_2), 4.0);
    assert_near(along(&footprint, PI), 4.0);
}

#[test]
fn a_sensor_without_line_of_sight_sees_through_the_wall() {
    let metal = EYE.replace("4 }", "4, needs_line_of_sight = false }");
    let footprint = only(&mut at("[10, 10]", WALL, &metal));
    assert!(footprint.ranges_m == [4.0; 360]);
}

#[test]
fn obstacles_hide_items_from_a_flying_robot_and_stop_none_of_its_rays() {
    let bird = format!(
        "layer = \"air\"\n{EYE}sensors.sonar = {{ kind = \"range\", rays = 4, range_m = 3 }}\n"
    );
    let [eye, sonar] = footprints(&mut at("[10, 10]", WALL, &bird))
        .try_into()
        .unwrap();
    assert_near(along(&eye, 0.0), 2.0);
    assert!(!sonar.finds_items && sonar.ranges_m == [3.0; 360]);
    // Above an obstacle, the obstacle's outline hides everything beyond it.
    let [eye, _] = footprints(&mut at("[12.5, 10]", WALL, &bird))
        .try_into()
        .unwrap();
    assert_near(along(&eye, 0.0), 0.5);
    let pillar = "obstacles = [{ circle = { at_m = [10, 10], radius_m = 1 } }]";
    let [eye, _] = footprints(&mut at("[10.5, 10]", pillar, &bird))
        .try_into()
        .unwrap();
    assert_eq!(eye.ranges_m, [0.0; 360]);
}

#[test]
fn an_outline_has_vertices_only_where_it_bends() {
    let free = only(&mut at("[10, 10]", "", EYE)).corners();
    assert_eq!(free, [[0.0, 4.0], [2.0 * PI, 4.0]]);
    // The wall is 2 m away and visible up to 60 degrees on each side.
    let cut = only(&mut at("[10, 10]", WALL, EYE)).corners();
    let expected = [(0.0, 2.0), (60.0, 4.0), (300.0, 4.0), (360.0, 2.0)];
    assert_eq!(cut.len(), expected.len(), "{cut:?}");
    for ([bearing_rad, range_m], (bearing_deg, expected_m)) in cut.iter().zip(expected) {
        assert!(
            (bearing_rad.to_degrees() - bearing_deg).abs() < 1.01,
            "{cut:?}"
        );
        assert!((range_m - expected_m).abs() < 0.1, "{cut:?}");
    }
    let camera = EYE.replace("4 }", "4, fov_deg = 60, facing_deg = 180 }");
    let back = only(&mut at("[10, 10]", WALL, &camera)).corners();
    assert_eq!(back.len(), 2);
    assert_near(back[0][0], PI * 5.0 / 6.0);
    assert_near(back[1][0], PI * 7.0 / 6.0);
}

#[test]
fn an_outline_equals_the_visible_range_along_each_bearing() {
    let world = "obstacles = [{ polygon_m = [[12, 2], [13, 2], [11, 18]] }, { circle = { at_m = [8, 11], radius_m = 1 } }]";
    let footprint = only(&mut at("[10, 10]", world, EYE));
    let corners = footprint.corners();
    assert!(corners.len() < 100, "{}", corners.len());
    for (place, range_m) in footprint.ranges_m.iter().enumerate() {
        let bearing_rad = (place as f64).to_radians();
        let next = corners.partition_point(|[corner_rad, _]| *corner_rad < bearing_rad - 1e-9);
        let [after, before] = [corners[next.max(1)], corners[next.max(1) - 1]];
        let outline_m = if before[1] >= 4.0 && after[1] >= 4.0 {
            4.0
        } else {
            // The intersection of the bearing with the line between the vertices.
            let [a, b] = [before, after].map(|[corner_rad, range_m]| {
                let off_rad = corner_rad - bearing_rad;
                [range_m * off_rad.cos(), range_m * off_rad.sin()]
            });
            let share = if b[1] == a[1] {
                0.0
            } else {
                a[1] / (a[1] - b[1])
            };
            a[0] + share * (b[0] - a[0])
        };
        assert!(
            (outline_m - range_m).abs() < 0.01,
            "{place}: {outline_m} for {range_m}"
        );
    }
}

#[test]
fn a_sector_is_covered_from_edge_to_edge() {
    let camera = EYE.replace("4 }", "4, fov_deg = 60, facing_deg = -30 }");
    let footprint = only(&mut at("[10, 10]", WALL, &camera));
    let bearings_rad = footprint.bearings_rad();
    assert!((61..=62).contains(&bearings_rad.len()));
    assert_near(bearings_rad[0], -PI / 3.0);
    assert_near(*bearings_rad.last().unwrap(), 0.0);
    assert_near(footprint.ranges_m[0], 4.0);
    assert_near(*footprint.ranges_m.last().unwrap(), 2.0);
}

#[test]
fn rays_of_a_ring_end_at_walls_and_robots_without_errors() {
    let sonar = "sensors.sonar = { kind = \"range\", rays = 8, range_m = 3, noise_m = 0.5, miss_probability = 0.5, spurious_return_probability = 0.1 }\n";
    let ring = only(&mut at("[10, 10], [8, 10]", WALL, sonar));
    assert_near(along(&ring, 0.0), 2.0);
    assert_near(along(&ring, PI), 1.8);
    assert_near(along(&ring, FRAC_PI_2), 3.0);
    let mut simulation = at("[10, 10], [8, 10]", WALL, &format!("{EYE}{sonar}"));
    let items = simulation.footprints(id(0, 0), Sensors::Items).unwrap();
    assert!(items.len() == 1 && items[0].finds_items);
    assert_near(along(&items[0], PI), 4.0);
}

#[test]
fn in_a_periodic_world_a_wall_beyond_the_border_hides() {
    let world = format!(
        "periodic = true\n{}",
        WALL.replace("12", "1").replace("13", "2")
    );
    let footprint = only(&mut at("[18.5, 10]", &world, EYE));
    assert_near(along(&footprint, 0.0), 2.5);
    assert_near(along(&footprint, PI), 4.0);
}

#[test]
fn inactive_sensors_and_stopped_robots_have_no_footprint() {
    let mut simulation = at("[10, 10]", WALL, EYE);
    let off = SensorRequest {
        sensor: 0,
        on: false,
    };
    let command = Command {
        requests: vec![off],
        ..Command::default()
    };
    step_with(&mut simulation, [(id(0, 0), command)]);
    assert_eq!(footprints(&mut simulation), []);
    let empty = format!("{EYE}battery = {{ capacity_j = 1, idle_w = 100 }}\n");
    let mut simulation = at("[10, 10]", WALL, &empty);
    assert_eq!(footprints(&mut simulation).len(), 1);
    simulation.step();
    assert_eq!(footprints(&mut simulation), []);
    assert!(simulation.footprints(id(3, 0), Sensors::All).is_err());
}

#[test]
fn computing_footprints_has_no_effect_on_the_run() {
    assert_no_effect(|simulation, _| {
        for robot in robots(simulation) {
            simulation.footprints(robot.id, Sensors::All).unwrap();
        }
    });
}
