use super::*;
use crate::navigation::path::Wavefront;
use crate::navigation::reachable::HEADINGS;
use crate::perception::beliefs::BeliefsSpec;
use crate::perception::beliefs::coverage_map::tests::map;
use crate::perception::beliefs::items::track::log_odds;
use crate::perception::beliefs::occupancy::Occupancy;
use base::geometry::Rectangle;
use proptest::prelude::*;

const SIDE_M: f64 = 10.0;

fn hazards(discs: &[(f64, f64, f64)]) -> Hazards {
    let disc = |(x, y, radius_m): &(f64, f64, f64)| Disc {
        centre: Point { x: *x, y: *y },
        radius_m: *radius_m,
    };
    Hazards {
        discs: discs.iter().map(disc).collect(),
        min_radii_m: discs.iter().map(|(_, _, radius_m)| *radius_m).collect(),
        shares: Vec::new(),
    }
}

fn point() -> impl Strategy<Value = Point> {
    (0.0..SIDE_M, 0.0..SIDE_M).prop_map(|(x, y)| Point { x, y })
}

fn some() -> impl Strategy<Value = Hazards> {
    let disc = (0.0..SIDE_M, 0.0..SIDE_M, 0.3..2.0);
    proptest::collection::vec(disc, 0..6).prop_map(|discs| hazards(&discs))
}

fn field(cell_m: f64) -> Field {
    let corner = Point {
        x: SIDE_M,
        y: SIDE_M,
    };
    Field::new(
        &Rectangle::spanned(Point::default(), corner),
        cell_m,
        10_000,
    )
}

fn pose(at: Point, heading_rad: f64) -> Pose {
    Pose {
        at,
        heading_rad,
        deviation_m: 0.1,
        deviation_rad: 0.01,
        age_s: 0.0,
    }
}

/// A body that an item of the second kind may destroy at 0.5 m, and its beliefs in one item of a kind.
fn believed(kind: u16, log_ratio: f64, variance_m2: f64) -> Hazards {
    let body = Body {
        radius_m: 0.25,
        item_kinds: vec!["scrap".to_owned(), "mine".to_owned()],
        hazards_m: vec![None, Some(0.5)],
        ..Body::default()
    };
    let mut beliefs = Beliefs::new(&BeliefsSpec::default(), &body);
    let mut track = Track::new(kind, Point { x: 3.0, y: 4.0 }, variance_m2, 0.01);
    track.prior = 0.0;
    track.count = 1;
    track.sources[0].log_ratio = log_ratio;
    beliefs.items.add_track(track);
    let mut hazards = Hazards::default();
    hazards.update(&beliefs, &body);
    hazards
}

fn disc(radius_m: f64) -> Vec<Disc> {
    hazards(&[(3.0, 4.0, radius_m)]).discs
}

#[test]
fn an_item_has_a_disc_if_its_kind_is_a_danger_and_it_is_likely_enough() {
    let likely = log_odds(MIN_PROBABILITY + 0.01);
    assert_eq!(
        believed(1, likely, 0.04).discs,
        disc(0.75 + (CONTROL_M + 0.4))
    );
    assert_eq!(believed(0, likely, 0.04).discs, []);
    let unlikely = log_odds(MIN_PROBABILITY - 0.01);
    assert_eq!(believed(1, unlikely, 0.04).discs, []);
}

#[test]
fn the_margin_of_a_disc_is_limited() {
    for variance_m2 in [100.0, f64::INFINITY] {
        assert_eq!(
            believed(1, 3.0, variance_m2).discs,
            disc(0.75 + MAX_MARGIN_M)
        );
    }
}

#[test]
fn an_item_of_uncertain_kind_is_a_danger_by_all_kinds_that_it_may_be() {
    let hazards_m = [None, Some(0.5), Some(3.0)];
    for (shares, danger) in [
        ([0.7, 0.3, 0.0], Some(0.5)),
        // More probably scrap than any of the mines.
        ([0.7, 0.22, 0.08], Some(0.5)),
        ([0.7, 0.0, 0.3], Some(3.0)),
        ([0.95, 0.02, 0.03], None),
    ] {
        assert_eq!(danger_m(&hazards_m, &shares, 0.9), danger, "{shares:?}");
        assert_eq!(danger_m(&hazards_m, &shares, 0.1), None, "{shares:?}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn an_end_is_within_the_tolerance_of_its_goal_and_outside_all_discs(
        hazards in some(), goal in point(), robot in point(), tolerance_m in 0.0..3.0_f64,
    ) {
        if let Some(end) = hazards.end((goal, tolerance_m), robot, |_| true) {
            prop_assert!(goal.to(end).length() < tolerance_m);
            prop_assert!(!hazards.contain(end));
        }
    }

    #[test]
    fn an_end_exists_if_the_tolerance_is_larger_than_a_single_disc(
        radius_m in 0.3..2.0_f64, away in (-1.0..1.0_f64, -1.0..1.0_f64), robot in point(),
    ) {
        let hazards = hazards(&[(5.0, 5.0, radius_m)]);
        let goal = Point { x: 5.0 + away.0, y: 5.0 + away.1 };
        let out_m = radius_m - Point { x: away.0, y: away.1 }.length();
        // The nearest of 24 directions leads out at most 4% later.
        let tolerance_m = out_m.max(0.0) * 1.05 + 0.15 * radius_m + 0.1;
        prop_assert!(hazards.end((goal, tolerance_m), robot, |_| true).is_some());
    }

    #[test]
    fn a_robot_inside_a_disc_may_move_away_from_its_item_but_not_towards_it(
        away in (-1.0..1.0_f64, -1.0..1.0_f64), heading_rad in -3.0..3.0_f64,
    ) {
        let at = Point { x: 5.0 + away.0, y: 5.0 + away.1 };
        let hazards = hazards(&[(5.0, 5.0, 1.5)]);
        let mut reachable = Reachable::default();
        reachable.update(&[], &[], (0.25, 1.0));
        hazards.limit(&mut reachable, &pose(at, heading_rad));
        let free = reachable.free_m.iter().filter(|free_m| **free_m > 0.0).count();
        prop_assert!((HEADINGS / 2 - 1..HEADINGS).contains(&free), "{free}");
    }

    #[test]
    fn lines_between_open_neighbours_keep_clear(hazards in some(), cell_m in 0.25..2.0_f64) {
        let field = field(cell_m);
        let blocked: Vec<usize> = hazards.cells(&field, true).collect();
        for cell in (0..field.cells()).filter(|cell| !blocked.contains(cell)) {
            for next in field.around(cell, 1).filter(|next| !blocked.contains(next)) {
                prop_assert!(hazards.are_clear_between(field.centre(cell), field.centre(next)));
            }
        }
    }

    #[test]
    fn a_path_from_outside_enters_no_disc(hazards in some(), from in point(), to in point()) {
        let field = field(0.25);
        let map = Occupancy::new(&field);
        prop_assume!(!hazards.contain(from) && !hazards.contain(to));
        let mut wavefront = Wavefront::default();
        wavefront.avoid(&hazards, true);
        wavefront.expand((&field, &map), to, 0.3, |_, _| true);
        let mut at = from;
        for _ in 0..200 {
            let Some(next) = wavefront.waypoint(&field, &map, at) else {
                break;
            };
            // The first step is from anywhere in a cell to the centre of the next.
            let is_first = at == from;
            prop_assert!(is_first || hazards.are_clear_between(at, next), "{at:?} {next:?}");
            at = next;
        }
    }
}

#[test]
fn a_path_out_of_a_disc_leads_away_from_its_item() {
    let hazards = hazards(&[(5.0, 5.0, 1.5)]);
    let map = map();
    let mut wavefront = Wavefront::default();
    wavefront.avoid(&hazards, true);
    wavefront.expand(
        (&map.field, &map.occupancy),
        Point { x: 9.0, y: 5.0 },
        0.3,
        |_, _| true,
    );
    let at = Point { x: 4.2, y: 5.1 };
    let out = wavefront.waypoint(&map.field, &map.occupancy, at).unwrap();
    assert!(
        !hazards.contain(out) && hazards.are_clear_between(at, out),
        "{out:?}"
    );
}

#[test]
fn a_robot_between_three_items_leaves_their_discs() {
    let hazards = hazards(&[(5.0, 6.0, 1.5), (4.0, 4.5, 1.5), (6.0, 4.5, 1.5)]);
    let map = map();
    let mut wavefront = Wavefront::default();
    wavefront.avoid(&hazards, true);
    wavefront.expand(
        (&map.field, &map.occupancy),
        Point { x: 9.0, y: 9.0 },
        0.3,
        |_, _| true,
    );
    let at = Point { x: 5.0, y: 5.0 };
    let out = wavefront.waypoint(&map.field, &map.occupancy, at);
    assert!(out.is_some_and(|out| !hazards.contain(out)), "{out:?}");
    let mut reachable = Reachable::default();
    reachable.update(&[], &[], (0.25, 1.0));
    hazards.limit(&mut reachable, &pose(at, 0.0));
    assert!(reachable.free_m.iter().any(|free_m| *free_m > 1.0));
}

proptest! {
    #[test]
    fn work_at_an_item_never_ends_nearer_than_it_is_safe(
        place in point(),
        within_m in 0.1_f64..3.0,
        robot in point(),
        all in some(),
    ) {
        let mut near = all.clone();
        near.min_radii_m = all.discs.iter().map(|disc| disc.radius_m / 2.0).collect();
        near.admit(place, within_m);
        for (now, before) in near.discs.iter().zip(&all.discs) {
            prop_assert!(now.radius_m <= before.radius_m && now.radius_m >= before.radius_m / 2.0);
            let is_at_place = before.centre.to(place).length() < before.radius_m;
            prop_assert!(is_at_place || now == before);
        }
        if let Some(end) = near.end((place, within_m), robot, |_| true) {
            prop_assert!(place.to(end).length() <= within_m);
            for disc in &all.discs {
                prop_assert!(disc.centre.to(end).length() >= disc.radius_m / 2.0);
            }
        }
    }
}

#[test]
fn a_robot_goes_only_as_near_as_its_work_needs() {
    let at = Point { x: 5.0, y: 5.0 };
    let radius_m = |within_m: f64| {
        let mut near = hazards(&[(5.0, 5.0, 1.6)]);
        near.min_radii_m = vec![1.0];
        near.admit(at, within_m);
        near.discs[0].radius_m
    };
    for (within_m, expected_m) in [(2.0, 1.6), (1.5, 1.3), (0.5, 1.0)] {
        assert!((radius_m(within_m) - expected_m).abs() < 1e-9, "{within_m}");
    }
}
