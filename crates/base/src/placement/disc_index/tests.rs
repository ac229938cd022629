use super::*;
use proptest::prelude::*;

/// A layer and a radius for each kind: a tiny one, so that a large one covers many of its cells.
const KINDS: [(u8, f64); 4] = [(0, 0.2), (0, 1.5), (1, 0.2), (0, 0.0)];

fn place() -> impl Strategy<Value = Point> {
    // Also on a lattice, where robots touch and coincide.
    let lattice = (-2_i32..6, -2_i32..6).prop_map(|(x, y)| [f64::from(x), f64::from(y)]);
    let anywhere = (-2.0..12.0, -2.0..22.0).prop_map(|(x, y)| [x, y]);
    prop_oneof![lattice, anywhere].prop_map(|[x, y]| Point { x, y })
}

fn robot() -> impl Strategy<Value = (usize, Point)> {
    (0..KINDS.len(), place())
}

fn overlap(one: (usize, Point), other: (usize, Point)) -> bool {
    let [(layer, radius_m), (other_layer, other_radius_m)] = [KINDS[one.0], KINDS[other.0]];
    let clear_m = radius_m + other_radius_m - TOLERANCE_M;
    layer == other_layer && one.1.to(other.1).length() < clear_m
}

proptest! {
    #[test]
    fn a_place_is_taken_by_whoever_overlaps_it_wherever_robots_were_put(
        mut robots in prop::collection::vec(robot(), 1..200),
        moves in prop::collection::vec((0_usize..200, place()), 0..60),
        others in prop::collection::vec(robot(), 1..20),
    ) {
        let mut crowd = DiscIndex::new(KINDS, None);
        for &(kind, centre) in &robots {
            crowd.add(kind, centre);
        }
        for (at, to) in moves {
            let at = at % robots.len();
            let (kind, centre) = &mut robots[at];
            crowd.remove(*kind, *centre);
            crowd.add(*kind, to);
            *centre = to;
        }
        for other in others {
            let expected = robots.iter().any(|&robot| overlap(other, robot));
            prop_assert_eq!(crowd.is_taken(other.0, other.1), expected);
        }
    }
}

#[test]
fn on_a_torus_robots_overlap_across_its_sides() {
    let size_m = Point { x: 10.0, y: 10.0 };
    let mut crowd = DiscIndex::new(KINDS, Some(Torus { size_m }));
    crowd.add(1, Point { x: 0.5, y: 9.5 });
    for (x, y, is_taken) in [(9.5, 9.5, true), (9.5, 0.5, true), (8.0, 1.5, false)] {
        assert_eq!(crowd.is_taken(1, Point { x, y }), is_taken, "{x} {y}");
    }
    // Points are taken by discs, and never by points.
    assert!(crowd.is_taken(3, Point { x: 9.9, y: 0.0 }));
    crowd.add(3, Point { x: 5.0, y: 5.0 });
    assert!(!crowd.is_taken(3, Point { x: 5.0, y: 5.0 }));
}
