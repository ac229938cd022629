use super::*;
use base::geometry::{Rectangle, Segment};
use proptest::prelude::*;

fn field(width: f64, height: f64) -> Field {
    let corner = Point {
        x: width,
        y: height,
    };
    Field::new(&Rectangle::spanned(Point::default(), corner), 0.25, 4096)
}

/// The path of one of several parts.
fn part(track: &Track, part: [u32; 2]) -> Vec<Segment> {
    let places: Vec<Point> = (0..).map_while(|n| track.place_of_part(part, n)).collect();
    let pairs = places.iter().zip(places.iter().skip(1));
    pairs
        .map(|(from, to)| Segment {
            from: *from,
            to: *to,
        })
        .collect()
}

proptest! {
    #[test]
    fn parts_are_equal_and_together_pass_within_half_a_width_of_every_place(
        size in (2.0_f64..60.0, 2.0_f64..60.0), width_m in 0.5_f64..12.0, robots in 1_u32..12,
        (x, y) in (0.0_f64..1.0, 0.0_f64..1.0), is_across: bool,
    ) {
        let inset_m = width_m / 2.0;
        let track = Track::new(&field(size.0, size.1), [width_m, inset_m], is_across);
        let parts: Vec<Vec<Segment>> = (0..robots).map(|own| part(&track, [own, robots])).collect();
        let place = Point { x: x * size.0, y: y * size.1 };
        let away_m = parts.iter().flatten().map(|lane| lane.distance_m(place));
        let away_m = away_m.fold(f64::INFINITY, f64::min);
        // At the end of a lane, half a width ahead is covered too.
        prop_assert!(away_m <= inset_m * 2.0_f64.sqrt() + 1e-9, "{}", away_m);
        let each_m = track.length_m() / f64::from(robots);
        for part in &parts {
            let length_m: f64 = part.iter().map(Segment::length_m).sum();
            prop_assert!((length_m - each_m).abs() < 1e-6, "{} {}", length_m, each_m);
        }
    }

    #[test]
    fn where_one_part_ends_the_next_begins(
        size in (2.0_f64..60.0, 2.0_f64..60.0), width_m in 0.5_f64..12.0, robots in 2_u32..12,
    ) {
        let track = Track::new(&field(size.0, size.1), [width_m, width_m / 2.0], false);
        for own in 1..robots {
            let before = part(&track, [own - 1, robots]);
            let begins = track.place_of_part([own, robots], 0).unwrap();
            prop_assert!(before.last().unwrap().to.to(begins).length() < 1e-6);
        }
    }
}

#[test]
fn the_second_pass_runs_across_the_first() {
    let longest = |is_across| {
        let lanes = part(
            &Track::new(&field(20.0, 10.0), [2.0, 1.0], is_across),
            [0, 1],
        );
        let longer = |one: Segment, other: Segment| {
            if other.length_m() > one.length_m() {
                other
            } else {
                one
            }
        };
        lanes.into_iter().reduce(longer).unwrap().way()
    };
    let (first, second) = (longest(false), longest(true));
    assert!((first.length() - 18.0).abs() < 1e-9 && (second.length() - 8.0).abs() < 1e-9);
    assert!(first.dot(second).abs() < 1e-9);
}

#[test]
fn a_pass_is_followed_by_the_next_and_unreachable_corners_are_skipped() {
    let ready = Ready::new(&Lawnmower::default(), &crate::world_of_walls::rover());
    let field = field(20.0, 10.0);
    let mut progress = Progress::of([0, 1]);
    let first = ready.place(&mut progress, &field).unwrap();
    ready.judged(&mut progress, Verdict::Receding);
    assert_eq!(ready.place(&mut progress, &field), Some(first));
    ready.judged(&mut progress, Verdict::Impossible);
    assert_ne!(ready.place(&mut progress, &field), Some(first));
    for _ in 0..100 {
        progress.advance();
        assert!(ready.place(&mut progress, &field).is_some());
    }
    assert!(progress.passes > 1);
}
