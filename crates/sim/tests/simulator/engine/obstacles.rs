//! Shapes of obstacles, and their copies.

use crate::common::scenario;
use base::engine::{BlockOptions, Runner};
use base::geometry::Point;
use sim::runner::Runs;
use sim::simulation::Simulation;
use sim::world::obstacles::Solid;

/// Rovers that search among these obstacles.
fn hall(obstacles: &str) -> String {
    format!(
        "world = {{ size_m = [20, 12], obstacles = [{obstacles}] }}\nitems.parcel.count = 5\n\
         [robots.rover]\ncount = 3\nradius_m = 0.3\n[robots.rover.sensors]\n\
         sonar = {{ kind = \"range\", rays = 12, range_m = 3, noise_m = 0.02 }}\n\
         camera = {{ kind = \"items\", range_m = 1.5, needs_line_of_sight = true }}\n"
    )
}

/// The state hashes of all steps of run 0, and the outcomes of some runs.
fn hashes_and_outcomes(obstacles: &str) -> (Vec<u64>, Vec<Vec<f64>>) {
    let scenario = scenario(&hall(obstacles));
    let mut simulation = Simulation::new(scenario.clone(), 7, 0).unwrap();
    let mut hashes = vec![simulation.state().hash()];
    while !simulation.state().is_over(simulation.scenario()) {
        simulation.step();
        hashes.push(simulation.state().hash());
    }
    let runs = Runs(scenario);
    (hashes, runs.run_block(7, 0..20, BlockOptions::ALONE))
}

/// The corners of each polygon.
fn corners(obstacles: &str) -> Vec<Vec<Point>> {
    let scenario = scenario(&hall(obstacles));
    let polygons = scenario.solids().iter().map(|solid| match solid {
        Solid::Polygon(polygon) => polygon.edges().map(|edge| edge.from).collect(),
        _ => panic!("no polygon: {solid:?}"),
    });
    polygons.collect()
}

#[test]
fn copies_equal_the_same_shapes_one_by_one() {
    let repeated = "{ rectangle = { at_m = [3, 3], size_m = [1, 2.5] }, \
                    repeat = { columns = 4, rows = 2, spacing_m = [4, 5.5] } }, \
                    { circle = { at_m = [1, 10], radius_m = 0.4 }, \
                    repeat = { rows = 2, spacing_m = [0, -4] } }, \
                    { polygon_m = [[5, 0], [6, 0], [5.5, 1]], repeat = { columns = 2, spacing_m = [8, 0] } }";
    let mut separate = Vec::new();
    for y in [3.0, 8.5] {
        for x in [3, 7, 11, 15] {
            separate.push(format!(
                "{{ rectangle = {{ at_m = [{x}, {y}], size_m = [1, 2.5] }} }}"
            ));
        }
    }
    for y in [10, 6] {
        separate.push(format!(
            "{{ circle = {{ at_m = [1, {y}], radius_m = 0.4 }} }}"
        ));
    }
    separate.push("{ polygon_m = [[5, 0], [6, 0], [5.5, 1]] }".to_owned());
    separate.push("{ polygon_m = [[13, 0], [14, 0], [13.5, 1]] }".to_owned());
    let separate = separate.join(", ");
    assert_eq!(
        scenario(&hall(repeated)).solids(),
        scenario(&hall(&separate)).solids()
    );
    let (hashes, outcomes) = hashes_and_outcomes(repeated);
    assert_eq!((hashes.clone(), outcomes), hashes_and_outcomes(&separate));
    assert_ne!(hashes, hashes_and_outcomes("").0);
}

#[test]
fn a_rectangle_equals_the_polygon_of_its_corners() {
    let rectangle = "{ rectangle = { at_m = [5, 6], size_m = [3, 1] } }";
    let polygon = "{ polygon_m = [[3.5, 5.5], [6.5, 5.5], [6.5, 6.5], [3.5, 6.5]] }";
    assert_eq!(hashes_and_outcomes(rectangle), hashes_and_outcomes(polygon));
}

#[test]
fn a_rectangle_is_rotated_anticlockwise_about_its_centre() {
    let rotated = corners("{ rectangle = { at_m = [5, 6], size_m = [2, 2], rotation_deg = 45 } }");
    let root = 2_f64.sqrt();
    for place in [
        [5.0 + root, 6.0],
        [5.0, 6.0 + root],
        [5.0 - root, 6.0],
        [5.0, 6.0 - root],
    ] {
        let is_near = |corner: &Point| corner.to(Point::from(place)).length() < 1e-12;
        assert!(rotated[0].iter().any(is_near), "{rotated:?}");
    }
    let long = corners("{ rectangle = { at_m = [5, 6], size_m = [4, 1], rotation_deg = 30 } }");
    let rightmost = long[0]
        .iter()
        .copied()
        .reduce(|one, other| if one.x > other.x { one } else { other });
    assert!(rightmost.unwrap().y > 6.0, "{long:?}");
}

#[test]
fn an_obstacle_has_the_index_of_the_entry_that_it_is_a_copy_of() {
    let scenario = scenario(&hall(
        "{ circle = { at_m = [9, 6], radius_m = 1 } }, \
         { rectangle = { at_m = [3, 3], size_m = [1, 1] }, repeat = { columns = 3, spacing_m = [2, 0] } }, \
         { circle = { at_m = [15, 6], radius_m = 1 } }",
    ));
    let entries: Vec<usize> = scenario.obstacles().map(|(entry, _)| entry).collect();
    assert_eq!(entries, [0, 1, 1, 1, 2]);
}
