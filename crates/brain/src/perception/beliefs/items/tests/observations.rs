use super::*;

#[test]
fn a_contact_is_weighted_by_bayes_rule() {
    let mut items = Items::new(64, None);
    hit(&mut items, ME);
    // Of all contacts at a position, 0.7 x 0.01 per square metre are items, and 0.02 are false
    // alarms.
    let odds = 0.7 * PER_M2 / FALSE_PER_M2 / (1.0 - TAU * 0.01 * PER_M2);
    assert!((confidence(&items) - odds / (1.0 + odds)).abs() < 1e-9);
    hit(&mut items, ME);
    // A second one at the same position; the standard deviation of both is 0.1 along each axis.
    let odds = odds * (0.3 + 0.7 / (TAU * 0.02 * FALSE_PER_M2));
    assert!((confidence(&items) - odds / (1.0 + odds)).abs() < 1e-9);
    miss(&mut items, ME);
    let odds = odds * 0.3;
    assert!((confidence(&items) - odds / (1.0 + odds)).abs() < 1e-9);
    assert_eq!(items.tracks.len(), 1);
}

#[test]
fn repeated_contacts_without_false_alarms_prove_even_rare_items() {
    let sure = Detector {
        false_alarms_per_m2: vec![0.0],
        ..camera()
    };
    let look = OwnObservation {
        observer: ME,
        detector: &sure,
        pose: pose(Point::default()),
        per_m2: &[1e-7],
    };
    let mut items = Items::new(64, None);
    (0..5).for_each(|_| items.observe(&look, [contact(Point::default(), POSITION)].iter(), None));
    assert!(confidence(&items) > 0.99, "{}", confidence(&items));
}

#[test]
fn a_contact_raises_confidence_and_a_miss_lowers_it() {
    let mut items = Items::new(64, None);
    let mut before = 0.0;
    for _ in 0..4 {
        hit(&mut items, ME);
        assert!(confidence(&items) > before);
        before = confidence(&items);
    }
    for _ in 0..15 {
        miss(&mut items, ME);
        assert!(confidence(&items) < before);
        before = confidence(&items);
    }
    assert!(before < 0.1);
}

#[test]
fn items_out_of_view_are_not_missed() {
    let mut items = Items::new(64, None);
    hit(&mut items, ME);
    let before = confidence(&items);
    observe(&mut items, ME, Point { x: -3.0, y: 0.0 }, &[]);
    assert!((confidence(&items) - before).abs() < 1e-12);
}

#[test]
fn more_than_64_items_are_tracked_if_the_limit_allows_it() {
    let each = |number: u32| Point {
        x: 2.0 * f64::from(number),
        y: 0.0,
    };
    for (limit, expected) in [(64, 64), (300, 200)] {
        let mut items = Items::new(limit, None);
        for _ in 0..2 {
            for number in 0..200 {
                let at = each(number);
                observe(&mut items, ME, at, &[contact(at, at.plus(POSITION))]);
            }
        }
        assert_eq!(items.tracks.len(), expected);
        let reported = |number: u32| {
            let at = each(number).plus(POSITION);
            items
                .tracks
                .iter()
                .any(|track| track.at.to(at).length() < 0.5)
        };
        assert_eq!((0..200).all(reported), limit == 300);
    }
}
