use super::*;
use proptest::prelude::*;
use std::f64::consts::TAU;
use std::time::{Duration, Instant};

fn polygon<const N: usize>(vertices: [[f64; 2]; N]) -> Result<Polygon, PolygonError> {
    Polygon::new(&vertices.map(Point::from))
}

/// A star-shaped polygon about the origin: a vertex a radius, at equal angles.
fn star(radii: &[f64]) -> Vec<Point> {
    let turn = TAU / f64::from(u32::try_from(radii.len()).unwrap());
    let at = |(index, radius): (u32, &f64)| {
        let (sine, cosine) = crate::trig::sin_cos(turn * f64::from(index));
        Point {
            x: radius * cosine,
            y: radius * sine,
        }
    };
    (0..).zip(radii).map(at).collect()
}

#[test]
fn a_polygon_has_a_sound_number_of_vertices() {
    assert_eq!(
        polygon([[0.0, 0.0], [1.0, 0.0]]),
        Err(PolygonError::Count(2))
    );
    let many = star(&vec![1.0; Polygon::MAX_VERTICES + 1]);
    assert_eq!(Polygon::new(&many), Err(PolygonError::Count(10_001)));
    assert!(Polygon::new(&many[1..]).is_ok());
}

#[test]
fn errors_name_the_vertex() {
    let wrong = |vertices: &[[f64; 2]]| {
        let vertices: Vec<Point> = vertices.iter().copied().map(Point::from).collect();
        Polygon::new(&vertices).unwrap_err()
    };
    assert_eq!(
        wrong(&[[0.0, 0.0], [1.0, f64::NAN], [1.0, 1.0]]),
        PolygonError::Coordinate(1)
    );
    assert_eq!(
        wrong(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1e300]]),
        PolygonError::Coordinate(2)
    );
    assert_eq!(
        wrong(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 0.0]]),
        PolygonError::Repeated(3)
    );
    assert_eq!(
        wrong(&[[0.0, 0.0], [1.0, 1.0], [3.0, 3.0]]),
        PolygonError::Folded(2)
    );
    assert_eq!(
        wrong(&[[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [2.0, -1.0]]),
        PolygonError::Folded(2)
    );
    let bow_tie = wrong(&[[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 2.0]]);
    assert_eq!(bow_tie, PolygonError::Crossed(0, 2));
    assert_eq!(
        bow_tie.to_string(),
        "a polygon that does not intersect itself; the edges from vertices 0 and 2 do"
    );
    assert_eq!(
        PolygonError::Coordinate(4).to_string(),
        "a polygon with coordinates from -1e9 to 1e9; vertex 4 is outside"
    );
}

#[test]
fn a_line_that_only_touches_itself_is_no_polygon() {
    // A vertex on another edge, a vertex on another vertex, and two collinear edges that overlap.
    for touching in [
        vec![[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [2.0, 0.0], [0.0, 4.0]],
        vec![
            [0.0, 0.0],
            [4.0, 0.0],
            [2.0, 2.0],
            [4.0, 4.0],
            [0.0, 4.0],
            [2.0, 2.0],
        ],
        vec![
            [0.0, 0.0],
            [4.0, 0.0],
            [4.0, 2.0],
            [3.0, 0.0],
            [1.0, 0.0],
            [0.0, 2.0],
        ],
    ] {
        let vertices: Vec<Point> = touching.into_iter().map(Point::from).collect();
        let error = Polygon::new(&vertices).unwrap_err();
        assert!(matches!(error, PolygonError::Crossed(..)), "{error}");
    }
}

fn area_m2(polygon: &Polygon) -> f64 {
    anticlockwise_area(&polygon.vertices).abs()
}

#[test]
fn vertices_in_line_are_allowed() {
    let wall = polygon([[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]]).unwrap();
    assert!((area_m2(&wall) - 2.0).abs() < 1e-15);
}

#[test]
fn the_worst_of_large_polygons_is_checked_within_a_second() {
    // A comb whose teeth all lie side by side: every pair of edges has to be looked at.
    let teeth = u32::try_from(Polygon::MAX_VERTICES).unwrap() / 2 - 1;
    let mut comb = vec![[0.0, 0.0]];
    for tooth in 0..teeth {
        let y = 2.0 * f64::from(tooth);
        comb.extend([[1e4, y], [1.0, y + 1.0]]);
    }
    comb.push([0.0, 2.0 * f64::from(teeth)]);
    let vertices: Vec<Point> = comb.into_iter().map(Point::from).collect();
    // The fastest of some attempts: other tests run at the same time.
    let attempts = (0..5).map(|_| {
        let start = Instant::now();
        assert!(Polygon::new(&vertices).is_ok());
        start.elapsed()
    });
    let fastest = attempts.min().unwrap();
    assert!(fastest < Duration::from_secs(1), "{fastest:?}");
}

#[test]
fn the_edge_of_a_polygon_belongs_to_it_exactly() {
    let triangle = polygon([[0.0, 0.0], [3.0, 1.0], [0.0, 2.0]]).unwrap();
    assert!(triangle.contains([0.0, 1.0].into()));
    assert!(triangle.contains([3.0, 1.0].into()));
    assert!(triangle.contains([1.5, 0.5].into()));
    let below = f64::from_bits(0.5_f64.to_bits() - 1);
    assert!(!triangle.contains([1.5, below].into()));
    assert!(!triangle.contains([-0.5, 1.0].into()));
    assert!(!triangle.contains([-0.5, 0.0].into()));
}

proptest! {
    #[test]
    fn edges_have_free_space_on_their_left_whichever_way_the_vertices_ran(
        radii in prop::collection::vec(0.5..5.0, 3..30), is_reversed: bool,
    ) {
        let mut vertices = star(&radii);
        if is_reversed {
            vertices.reverse();
        }
        // With three or four vertices the origin may lie outside; then the shape is still simple.
        let solid = Polygon::new(&vertices);
        prop_assume!(solid.is_ok());
        let solid = solid.unwrap();
        for edge in solid.edges() {
            let way = edge.way();
            let step = 1e-7 / way.length();
            let middle = edge.from.plus(way.times(0.5));
            let left = middle.plus(Point { x: -way.y, y: way.x }.times(step));
            let right = middle.plus(Point { x: way.y, y: -way.x }.times(step));
            prop_assert!(!solid.contains(left));
            prop_assert!(solid.contains(right));
            prop_assert!(solid.distance_m(left) < 2e-7 && solid.distance_m(left) > 0.0);
        }
    }

    #[test]
    fn a_star_holds_the_points_between_its_centre_and_its_edge(
        radii in prop::collection::vec(0.5..5.0, 5..30),
        share in 0.0..0.999, beyond in 1.001..3.0, at in 0.0..1.0,
    ) {
        let solid = Polygon::new(&star(&radii)).unwrap();
        for edge in solid.edges() {
            let on_edge = edge.from.plus(edge.way().times(at));
            prop_assert!(solid.contains(on_edge.times(share)));
            prop_assert!(!solid.contains(on_edge.times(beyond)));
        }
    }

    #[test]
    fn the_area_is_the_share_of_points_that_lie_in_it(
        radii in prop::collection::vec(0.5..5.0, 5..30),
    ) {
        // A grid of midpoints: an edge misplaces at most the cells that it crosses.
        let solid = Polygon::new(&star(&radii)).unwrap();
        let side = 0.1;
        let cells = (-60..60).flat_map(|row| (-60..60).map(move |column| (column, row)));
        let inside = cells
            .filter(|&(column, row)| {
                let at = |index: i32| (f64::from(index) + 0.5) * side;
                solid.contains(Point { x: at(column), y: at(row) })
            })
            .count();
        let counted = f64::from(u32::try_from(inside).unwrap()) * side * side;
        let edge_m: f64 = solid.edges().map(|edge| edge.length_m()).sum();
        prop_assert!((counted - area_m2(&solid)).abs() < edge_m * side * 2.0);
    }

    #[test]
    fn swapping_two_vertices_that_are_no_neighbours_makes_a_circle_cross_itself(
        count in 5_usize..40, one: usize, apart: usize,
    ) {
        let (one, apart) = (one % count, 2 + apart % (count - 3));
        let mut vertices = star(&vec![1.0; count]);
        vertices.swap(one, (one + apart) % count);
        prop_assert!(matches!(Polygon::new(&vertices), Err(PolygonError::Crossed(..))));
    }
}
