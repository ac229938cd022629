use super::*;
use crate::random::MAX_INDEX;
use proptest::prelude::*;
use std::time::{Duration, Instant};

/// A context for a square world from (0, 0).
fn draws(side_m: f64, things: EntityClass) -> PlacementContext {
    PlacementContext {
        seed: 7,
        run: 0,
        world: Rectangle::spanned(Point::default(), [side_m, side_m].into()),
        torus: None,
        things,
    }
}

fn item(index: u32) -> Entity {
    Entity { kind: 2, index }
}

const ANYWHERE: Placement = Placement::Uniform { within_m: None };

fn clustered(clusters: u32, spread_m: f64) -> Placement {
    Placement::Clustered {
        clusters,
        spread_m,
        within_m: None,
    }
}

fn places(
    placement: &Placement,
    draws: &PlacementContext,
    count: u32,
    free: fn(Point) -> bool,
) -> Vec<Point> {
    (0..count)
        .map(|index| placement.place(draws, item(index), free).unwrap())
        .collect()
}

/// The statistic of Pearson's test that all cells are as likely.
fn chi_squared(counts: &[u32]) -> f64 {
    let expected =
        f64::from(counts.iter().sum::<u32>()) / f64::from(u32::try_from(counts.len()).unwrap());
    let off = |&count: &u32| (f64::from(count) - expected).powi(2) / expected;
    counts.iter().map(off).sum()
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "of a small number"
)]
fn cell(value: f64) -> usize {
    value as usize
}

#[test]
fn uniform_places_are_uniform_over_what_is_free() {
    // Of 10 x 10 cells the four in the middle are solid. Pearson's statistic of 96 cells is above
    // 176 in one of a million seeds.
    let free = |at: Point| !((4.0..6.0).contains(&at.x) && (4.0..6.0).contains(&at.y));
    let mut counts = [0; 100];
    for place in places(&ANYWHERE, &draws(10.0, EntityClass::Items), 96_000, free) {
        counts[cell(place.x) * 10 + cell(place.y)] += 1;
    }
    let solid = [44, 45, 54, 55];
    assert!(solid.iter().all(|&cell| counts[cell] == 0));
    let open: Vec<u32> = (0..100)
        .filter(|cell| !solid.contains(cell))
        .map(|cell| counts[cell])
        .collect();
    let statistic = chi_squared(&open);
    assert!(statistic < 176.0, "{statistic}");
}

#[test]
fn a_cluster_is_a_round_normal_distribution_of_the_stated_spread() {
    // About the centre, exp(-d^2 / 2 s^2) and the angle are uniform and independent. Pearson's
    // statistic of 64 cells is above 131 in one of a million seeds.
    let draws = draws(1e6, EntityClass::Items);
    let placement = clustered(1, 2.5);
    let centre = match placement.candidates(&draws, item(0), |_| true).unwrap() {
        Candidates::Normal { centre, .. } => centre,
        other => panic!("{other:?}"),
    };
    let mut counts = [0; 64];
    for place in places(&placement, &draws, 64_000, |_| true) {
        let way = centre.to(place);
        let share = libm::exp(-way.length_squared() / (2.0 * 2.5 * 2.5));
        let turn = libm::atan2(way.y, way.x) / std::f64::consts::TAU + 0.5;
        counts[cell(share * 7.999_999) * 8 + cell(turn * 7.999_999)] += 1;
    }
    let statistic = chi_squared(&counts);
    assert!(statistic < 131.0, "{statistic}");
}

#[test]
fn clusters_have_equal_numbers_and_centres_of_their_own() {
    let draws = draws(1e4, EntityClass::Items);
    let placement = clustered(3, 0.1);
    let places = places(&placement, &draws, 30, |_| true);
    // Centres ten metres apart, members within six spreads: the chance of either is above 0.99999.
    for (index, place) in places.iter().enumerate() {
        for (other_index, other) in places.iter().enumerate() {
            let is_near = place.to(*other).length() < 1.2;
            assert_eq!(
                is_near,
                index % 3 == other_index % 3,
                "{index} {other_index}"
            );
        }
    }
}

#[test]
fn centres_and_members_are_within_and_free() {
    let within = Rectangle::spanned([2.0, 2.0].into(), [4.0, 4.0].into());
    let placement = Placement::Clustered {
        clusters: 50,
        spread_m: 3.0,
        within_m: Some(within),
    };
    let free = |at: Point| at.x + at.y > 6.0;
    for place in places(&placement, &draws(10.0, EntityClass::Robots), 1000, free) {
        assert!(within.contains(place) && free(place), "{place:?}");
    }
}

#[test]
fn a_full_world_is_an_error_and_not_an_endless_search() {
    for placement in [ANYWHERE, clustered(1, 1.0)] {
        let place = placement.place(&draws(10.0, EntityClass::Items), item(0), |_| false);
        assert_eq!(place, Err(PlacementError::NoneFree));
    }
    assert_eq!(
        PlacementError::NoneFree.to_string(),
        "no free position found after 10000 tries"
    );
}

#[test]
fn given_places_and_headings_are_kept() {
    let placement: Placement =
        serde_json::from_str(r#"{"kind": "fixed", "at_m": [[1, 2], [3, 4]], "heading_deg": [90]}"#)
            .unwrap();
    let draws = draws(10.0, EntityClass::Robots);
    assert_eq!(
        placement.place(&draws, item(1), |_| true),
        Ok([3.0, 4.0].into())
    );
    assert_eq!(
        placement.place(&draws, item(1), |_| false),
        Err(PlacementError::Taken)
    );
    assert_eq!(
        placement.place(&draws, item(2), |_| true),
        Err(PlacementError::NotGiven(2))
    );
    let quarter = std::f64::consts::FRAC_PI_2;
    assert!((placement.heading_rad(&draws, item(0)) - quarter).abs() < 1e-15);
    // The second has no heading of its own: a random one.
    assert_eq!(
        placement.heading_rad(&draws, item(1)).to_bits(),
        ANYWHERE.heading_rad(&draws, item(1)).to_bits()
    );
}

#[test]
fn headings_are_uniform() {
    // Pearson's statistic of 36 cells is above 95 in one of a million seeds.
    let draws = draws(10.0, EntityClass::Robots);
    let mut counts = [0; 36];
    for index in 0..36_000 {
        let turn = ANYWHERE.heading_rad(&draws, item(index)) / std::f64::consts::TAU + 0.5;
        counts[cell(turn * 36.0)] += 1;
    }
    let statistic = chi_squared(&counts);
    assert!(statistic < 95.0, "{statistic}");
}

#[test]
fn places_are_the_same_bytes_for_ever() {
    let clustered = clustered(2, 1.5);
    let bits = |placement: &Placement, things| {
        let place = placement
            .place(&draws(25.0, things), item(3), |_| true)
            .unwrap();
        [place.x.to_bits(), place.y.to_bits()]
    };
    // Computed apart, from Philox's definition and the C library's logarithm and sines.
    let item = [4_618_961_522_757_686_220, 4_625_356_342_565_807_238];
    let robot = [4_620_789_145_511_727_820, 4_621_332_259_097_494_631];
    let member = [4_620_825_315_978_357_982, 4_612_217_385_491_541_848];
    assert_eq!(bits(&ANYWHERE, EntityClass::Items), item);
    assert_eq!(bits(&ANYWHERE, EntityClass::Robots), robot);
    assert_eq!(bits(&clustered, EntityClass::Items), member);
}

#[test]
fn what_a_person_may_write_is_in_the_schema() {
    let schema = serde_json::to_string(&schemars::schema_for!(Placement)).unwrap();
    for part in [
        "\"fixed\"",
        "\"uniform\"",
        "\"clustered\"",
        "\"within_m\"",
        "\"minItems\":2",
    ] {
        assert!(schema.contains(part), "{part} in {schema}");
    }
    let unknown = r#"{"kind": "uniform", "whithin_m": [[0, 0], [1, 1]]}"#;
    assert!(serde_json::from_str::<Placement>(unknown).is_err());
}

fn group(kind: u8, count: u32, radius_m: f64, placement: &Placement) -> Group<'_> {
    Group {
        kind,
        key: kind.into(),
        count,
        radius_m,
        layer: 0,
        placement,
    }
}

/// The first two robots of the same layer that overlap.
fn overlap(groups: &[Group], places: &[Vec<Point>]) -> Option<(Point, Point)> {
    let robots: Vec<(f64, u8, Point)> = groups
        .iter()
        .zip(places)
        .flat_map(|(group, places)| places.iter().map(|&at| (group.radius_m, group.layer, at)))
        .collect();
    robots
        .iter()
        .enumerate()
        .find_map(|(index, &(radius, layer, at))| {
            robots[..index]
                .iter()
                .find(|(other, other_layer, place)| {
                    layer == *other_layer && at.to(*place).length() < radius + other - 1e-9
                })
                .map(|&(_, _, place)| (at, place))
        })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn no_robot_of_a_team_overlaps_another_in_its_layer(
        seed: u64, counts in prop::array::uniform3(0_u32..40),
        radii in prop::array::uniform3(0.01_f64..0.5), is_air: bool,
    ) {
        let draws = PlacementContext { seed, ..draws(20.0, EntityClass::Robots) };
        let clustered = clustered(2, 5.0);
        let placements = [&ANYWHERE, &clustered, &ANYWHERE];
        let mut groups: Vec<Group> = (0..3)
            .map(|at| group(u8::try_from(at).unwrap(), counts[at], radii[at], placements[at]))
            .collect();
        groups[2].layer = u8::from(is_air);
        let free = |group: &Group, at: Point| at.x > group.radius_m;
        let places = team(&draws, &groups, free).unwrap();
        prop_assert_eq!(overlap(&groups, &places), None);
        for (places, group) in places.iter().zip(&groups) {
            prop_assert_eq!(places.len(), group.count as usize);
            prop_assert!(places.iter().all(|&at| free(group, at)));
        }
    }

    #[test]
    fn one_robot_more_moves_only_those_that_it_really_hinders(
        seed: u64, counts in prop::array::uniform3(1_u32..60), grown in 0_usize..3,
    ) {
        let draws = PlacementContext { seed, ..draws(12.0, EntityClass::Robots) };
        let mut groups: Vec<Group> = (0..3)
            .map(|at| group(u8::try_from(at).unwrap(), counts[at], 0.2, &ANYWHERE))
            .collect();
        let before = team(&draws, &groups, |_, _| true).unwrap();
        groups[grown].count += 1;
        let after = team(&draws, &groups, |_, _| true).unwrap();
        for at in 0..=grown {
            prop_assert_eq!(&before[at][..], &after[at][..counts[at] as usize]);
        }
        // Places that were taken or left, in the order in which the robots were put down.
        let mut taken = vec![after[grown][counts[grown] as usize]];
        let mut left = Vec::new();
        for (old, new) in (grown + 1..3).flat_map(|at| before[at].iter().zip(&after[at])) {
            let overlaps = |place: &Point, others: &[Point]| {
                others.iter().any(|other| other.to(*place).length() < 0.4)
            };
            if old != new {
                prop_assert!(overlaps(old, &taken) || overlaps(new, &left));
                taken.push(*new);
                left.push(*old);
            }
        }
    }

    #[test]
    fn a_place_depends_on_its_own_kind_and_index(
        seed: u64, run: u64, kind: u32, index in 0..MAX_INDEX - 1,
    ) {
        let clustered = clustered(1 << 20, 1.0);
        let there = PlacementContext { seed, run, ..draws(1e3, EntityClass::Items) };
        for placement in [&ANYWHERE, &clustered] {
            let place = |draws: PlacementContext, kind, index| {
                placement.place(&draws, Entity { kind, index }, |_| true).unwrap()
            };
            let here = place(there, kind, index);
            prop_assert_eq!(here, place(there, kind, index));
            prop_assert_ne!(here, place(there, kind ^ 1, index));
            prop_assert_ne!(here, place(there, kind, index + 1));
            prop_assert_ne!(here, place(PlacementContext { run: run ^ 1, ..there }, kind, index));
            prop_assert_ne!(here, place(PlacementContext { seed: seed ^ 1, ..there }, kind, index));
            prop_assert_ne!(here, place(PlacementContext { things: EntityClass::Robots, ..there }, kind, index));
        }
    }
}

#[test]
fn given_places_come_before_drawn_ones_whatever_the_order_of_the_groups() {
    let middle = Placement::Fixed {
        at_m: vec![[1.0, 1.0].into()],
        heading_deg: None,
    };
    let groups = [group(0, 3, 0.4, &ANYWHERE), group(1, 1, 0.4, &middle)];
    for seed in 0..200 {
        let draws = PlacementContext {
            seed,
            ..draws(3.0, EntityClass::Robots)
        };
        let places = team(&draws, &groups, |_, _| true).unwrap();
        assert_eq!(places[1], [[1.0, 1.0].into()]);
        assert_eq!(overlap(&groups, &places), None);
    }
}

#[test]
fn fixed_places_may_touch_and_may_not_overlap() {
    let row = |step: f64| Placement::Fixed {
        at_m: (0..10)
            .map(|index| [step * f64::from(index), 0.0].into())
            .collect(),
        heading_deg: None,
    };
    let draws = draws(10.0, EntityClass::Robots);
    assert!(team(&draws, &[group(0, 10, 0.15, &row(0.3))], |_, _| true).is_ok());
    let error = team(&draws, &[group(0, 10, 0.15, &row(0.299))], |_, _| true).unwrap_err();
    assert_eq!(
        error.to_string(),
        "robot 1 of kind 0: its position is not free"
    );
}

#[test]
fn a_team_that_does_not_fit_is_an_error() {
    let error = team(
        &draws(1.0, EntityClass::Robots),
        &[group(4, 9, 0.5, &ANYWHERE)],
        |_, _| true,
    );
    let error = error.unwrap_err();
    assert_eq!((error.kind, error.why), (4, PlacementError::NoneFree));
}

#[test]
fn a_million_robots_are_placed_in_seconds() {
    let large = group(1, 10, 20.0, &ANYWHERE);
    let clustered = clustered(5, 200.0);
    let groups = [
        group(0, 1_000_000, 0.25, &ANYWHERE),
        large,
        group(2, 50_000, 0.1, &clustered),
    ];
    let start = Instant::now();
    let free = |group: &Group, at: Point| group.kind != 1 || at.x < 0.0;
    let whole = PlacementContext {
        world: Rectangle::spanned([-50.0, 0.0].into(), [2000.0, 2000.0].into()),
        ..draws(1.0, EntityClass::Robots)
    };
    let places = team(&whole, &groups, |group, at| {
        free(group, at) && (group.kind == 1 || at.x > 25.0)
    });
    assert_eq!(places.unwrap()[0].len(), 1_000_000);
    assert!(
        start.elapsed() < Duration::from_secs(20),
        "{:?}",
        start.elapsed()
    );
}
