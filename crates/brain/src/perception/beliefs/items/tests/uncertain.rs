//! Confusion of kinds and blind shares: likelihoods, and calibration against worlds drawn from the model.

use super::*;
use crate::io::body::Body;
use crate::perception::beliefs::BeliefsSpec;
use crate::perception::beliefs::coverage_map::DetectorScan;
use crate::perception::beliefs::items::kinds::KindModel;
use crate::perception::sector::direction;
use base::geometry::Rectangle;
use base::noise::normal_pair;
use core::f64::consts::PI;

/// Density of clutter and of mines: kinds 0 and 1.
const KINDS_PER_M2: [f64; 2] = [0.02, 0.01];

/// Clutter is detected more often than mines.
pub(super) const DETECTION: [f64; 2] = [0.8, 0.6];
pub(super) const CONFUSION: [[f64; 2]; 2] = [[0.7, 0.3], [0.2, 0.8]];
const BLIND: [f64; 2] = [0.0, 0.4];

fn detector_of_kinds() -> Detector {
    Detector {
        detection_probability: DETECTION.map(|p| vec![[0.0, p]]).to_vec(),
        false_alarms_per_m2: vec![FALSE_PER_M2 / 2.0; 2],
        blind_share: BLIND.to_vec(),
        confusion: CONFUSION.map(Vec::from).to_vec(),
        model: 7,
        ..camera()
    }
}

fn model_of(detector: &Detector) -> KindModel {
    let body = Body {
        detectors: vec![detector.clone()],
        ..Body::default()
    };
    KindModel::new(&body, &KINDS_PER_M2).unwrap()
}

pub(super) fn seen_as(kind: u16, at: Point) -> Contact {
    Contact {
        kind,
        ..contact(Point::default(), at)
    }
}

pub(super) fn look(
    items: &mut Items,
    detector: &Detector,
    from: Point,
    contacts: &[Contact],
    map: Option<&Map>,
) {
    let own = OwnObservation {
        observer: ME,
        detector,
        pose: pose(from),
        per_m2: &KINDS_PER_M2,
    };
    items.observe(&own, contacts.iter(), map);
}

/// The probability of an item of the stated kind, by own observations alone.
fn confidence_of(items: &Items, place: usize) -> f64 {
    let track = &items.tracks[place];
    let (_, share) = track.own_kind(items.kinds.as_deref().unwrap());
    share * probability(track.log_odds())
}

pub(super) fn beliefs() -> (Items, Detector) {
    let detector = detector_of_kinds();
    (Items::new(64, Some(model_of(&detector))), detector)
}

#[test]
fn kinds_are_weighted_by_bayes_rule() {
    let (mut items, detector) = beliefs();
    let variance_m2 = [0.01, 0.02];
    let false_per_m2 = FALSE_PER_M2 / 2.0;
    // Two contacts, the first reported as a mine and the second as clutter, and a miss.
    look(
        &mut items,
        &detector,
        Point::default(),
        &[seen_as(1, POSITION)],
        None,
    );
    look(
        &mut items,
        &detector,
        Point::default(),
        &[seen_as(0, POSITION)],
        None,
    );
    look(&mut items, &detector, Point::default(), &[], None);
    let odds = |kind: usize| {
        let contact = |reported: usize, variance_m2: f64| {
            DETECTION[kind] * CONFUSION[kind][reported] / (TAU * variance_m2 * false_per_m2)
        };
        let missed = 1.0 - DETECTION[kind];
        let visible = contact(1, variance_m2[0]) * (missed + contact(0, variance_m2[1])) * missed;
        let prior = TAU * 0.01 * KINDS_PER_M2[kind] / (1.0 - TAU * 0.01 * 0.03);
        prior * (BLIND[kind] + (1.0 - BLIND[kind]) * visible)
    };
    let (clutter, mine) = (odds(0), odds(1));
    let expected = clutter.max(mine) / (1.0 + clutter + mine);
    assert_eq!(items.tracks[0].kind, 0);
    let confidence = confidence_of(&items, 0);
    assert!(
        (confidence - expected).abs() < 1e-6,
        "{confidence} {expected}"
    );
}

#[test]
fn any_number_of_misses_leaves_the_blind_share_of_a_reported_item() {
    let (mut items, detector) = beliefs();
    look(
        &mut items,
        &detector,
        Point::default(),
        &[seen_as(1, POSITION)],
        None,
    );
    for _ in 0..100 {
        look(&mut items, &detector, Point::default(), &[], None);
    }
    let track = &items.tracks[0];
    let kinds = items.kinds.as_deref().unwrap();
    // A third of the items are mines, and the sensor is blind to 40% of those.
    assert!((track.own_log_ratio(kinds) - libm::log(0.4 / 3.0)).abs() < 1e-3);
    assert_eq!(track.kind, 1);
}

/// A tenth of the mines look like clutter to the sensor.
const ALIKE: [[f64; 2]; 2] = [[1.0, 0.0], [0.1, 0.9]];

fn detector_of_lookalikes() -> Detector {
    Detector {
        lookalike_share: ALIKE.map(Vec::from).to_vec(),
        ..detector_of_kinds()
    }
}

#[test]
fn any_number_of_reports_of_clutter_leaves_the_share_of_mines_that_look_like_it() {
    let shares = |detector: &Detector| {
        let mut items = Items::new(64, Some(model_of(detector)));
        for _ in 0..100 {
            let seen = [seen_as(0, POSITION)];
            look(&mut items, detector, Point::default(), &seen, None);
        }
        let kinds = items.kinds.as_deref().unwrap();
        let mut shares = Vec::new();
        items.tracks[0].write_kind_shares(kinds, ME, &mut shares);
        shares
    };
    // A third of the items are mines, of which the sensor detects 60%.
    let [clutter, mine] = [2.0 / 3.0, 1.0 / 3.0 * 0.6 * 0.1];
    let expected = mine / (clutter + mine);
    let alike = shares(&detector_of_lookalikes());
    assert!((alike[1] - expected).abs() < 1e-6, "{alike:?}");
    assert!(shares(&detector_of_kinds())[1] < 1e-6);
}

/// Each item is of a kind, and the sensor is blind to it, or it looks like a kind.
#[test]
fn beliefs_of_lookalikes_are_those_of_all_kinds_and_what_they_may_look_like() {
    let detector = detector_of_lookalikes();
    let mut items = Items::new(64, Some(model_of(&detector)));
    for reported in [0, 1, 0] {
        let seen = [seen_as(reported, POSITION)];
        look(&mut items, &detector, Point::default(), &seen, None);
    }
    look(&mut items, &detector, Point::default(), &[], None);
    let (track, kinds) = (&items.tracks[0], items.kinds.as_deref().unwrap());
    let ratios = track.visible_log_ratios(kinds).into_iter().map(libm::exp);
    let ratios: Vec<f64> = ratios.collect();
    let mut all = [[0.0; 3]; 2];
    for kind in 0..2 {
        let share = KINDS_PER_M2[kind] / 0.03;
        all[kind][2] = share * BLIND[kind];
        for seen in 0..2 {
            all[kind][seen] = share * (1.0 - BLIND[kind]) * ALIKE[kind][seen] * ratios[seen];
        }
    }
    let total: f64 = all.iter().flatten().sum();
    assert!((track.own_log_ratio(kinds) - libm::log(total)).abs() < 1e-9);
    let mut shares = Vec::new();
    track.write_kind_shares(kinds, ME, &mut shares);
    for kind in 0..2 {
        let expected = all[kind].iter().sum::<f64>() / total;
        assert!((shares[kind] - expected).abs() < 1e-9);
    }
    for seen in [0, 1] {
        let as_kind: f64 = all.iter().map(|each| each[seen]).sum();
        let visible = track.visible_share(kinds, &detector, seen);
        assert!((visible - as_kind / total).abs() < 1e-9);
    }
}

#[test]
fn lookalike_shares_of_zero_change_nothing() {
    let beliefs = |detector: &Detector| {
        let mut items = Items::new(64, Some(model_of(detector)));
        for reported in [0, 1, 0] {
            let seen = [seen_as(reported, POSITION)];
            look(&mut items, detector, Point::default(), &seen, None);
        }
        (items.tracks[0].evidence.clone(), confidence_of(&items, 0))
    };
    let same = Detector {
        lookalike_share: vec![vec![1.0, 0.0], vec![0.0, 1.0]],
        ..detector_of_kinds()
    };
    assert_eq!(beliefs(&same), beliefs(&detector_of_kinds()));
}

/// A belief is true if an item is at most this far away.
const NEAR_M: f64 = 0.35;

/// One item of a world: its kind, its position, and whether the sensor is blind to it.
type WorldItem = (u16, Point, bool);

fn anywhere(half_width_m: f64, random: &mut Stream) -> Point {
    let mut along = || half_width_m * (2.0 * unit(random) - 1.0);
    Point {
        x: along(),
        y: along(),
    }
}

fn world(random: &mut Stream) -> Vec<WorldItem> {
    let mut all = Vec::new();
    for kind in 0..2_u16 {
        let number = usize::from(kind);
        for _ in 0..poisson(KINDS_PER_M2[number] * 256.0, random) {
            all.push((kind, anywhere(8.0, random), unit(random) < BLIND[number]));
        }
    }
    all
}

/// The contacts of one observation, distributed as in the specification of the true detector.
fn contacts(world: &[WorldItem], from: Point, random: &mut Stream) -> Vec<Contact> {
    let mut contacts = Vec::new();
    let mut add = |kind: u16, at: Point| {
        contacts.push(Contact {
            kind,
            ..contact(from, at)
        });
    };
    for (kind, at, is_blind) in world {
        let [x, y] = normal_pair([random.next_u32(), random.next_u32()]).map(|z| z * 0.1);
        let row = CONFUSION[usize::from(*kind)];
        let reported = u16::from(unit(random) >= row[0]);
        let is_detected = unit(random) < DETECTION[usize::from(*kind)];
        if !is_blind && is_detected && from.to(*at).length() <= 5.0 {
            add(reported, at.plus(Point { x, y }));
        }
    }
    for _ in 0..poisson(FALSE_PER_M2 * PI * 25.0, random) {
        let distance_m = 5.0 * libm::sqrt(unit(random));
        let at = from.plus(direction(TAU * unit(random)).times(distance_m));
        add(u16::from(unit(random) < 0.5), at);
    }
    contacts
}

fn field() -> Map {
    let corners = [Point { x: -8.0, y: -8.0 }, Point { x: 8.0, y: 8.0 }];
    let spec = BeliefsSpec {
        cell_m: 0.5,
        ..BeliefsSpec::default()
    };
    Map::new(&spec, &Rectangle::spanned(corners[0], corners[1]))
}

/// Tracks after some observations in many worlds, with beliefs by a model of the detector: the confidence, and
/// whether an item of the stated kind is there.
fn believed(worlds: u64, assumed: &Detector) -> Vec<(f64, bool)> {
    let mut all = Vec::new();
    for number in 0..worlds {
        let mut random = random(number);
        let world = world(&mut random);
        let (mut items, mut map) = (Items::new(64, Some(model_of(assumed))), field());
        for _ in 0..=number % 10 {
            let from = anywhere(2.0, &mut random);
            let contacts = contacts(&world, from, &mut random);
            look(&mut items, assumed, from, &contacts, Some(&map));
            let scan = DetectorScan {
                detector: assumed,
                at: from,
                heading_rad: 0.0,
                trust: 1.0,
                observations: 1.0,
                blur_m: 0.0,
            };
            map.coverage
                .update(&map.field, (&map.field, &map.occupancy), &scan);
        }
        for (track, confidence) in super::believed(&items) {
            let is_it = |(kind, at, _): &WorldItem| {
                *kind == track.kind && at.to(track.at).length() < NEAR_M
            };
            all.push((confidence, world.iter().any(is_it)));
        }
    }
    all
}

/// The largest deviation of a tenth of confidences, in standard errors of independent tracks, beyond the number of
/// other items that are as near by chance.
fn largest_deviation(believed: &[(f64, bool)]) -> f64 {
    let mut largest = 0.0_f64;
    for tenth in 0..10 {
        let low = 0.1 * f64::from(tenth);
        let bin = believed
            .iter()
            .filter(|(c, _)| (low..low + 0.1).contains(c));
        let [expected, variance, there] = bin.clone().fold([0.0; 3], |sums, (c, is_there)| {
            let there = f64::from(u8::from(*is_there));
            [sums[0] + c, sums[1] + c * (1.0 - c), sums[2] + there]
        });
        let by_chance: f64 = bin
            .map(|(c, _)| (1.0 - c) * KINDS_PER_M2[0] * PI * NEAR_M * NEAR_M)
            .sum();
        if variance > 1.0 {
            let off = ((there - expected).abs() - by_chance).max(0.0);
            largest = largest.max(off / libm::sqrt(variance));
        }
    }
    largest
}

/// A correct model exceeds this in one of ten tenths for one seed in 1600. The seed is fixed.
const MAX_DEVIATION: f64 = 4.0;

const WORLDS: u64 = 3000;

#[test]
fn confidences_in_uncertain_kinds_are_calibrated() {
    let deviation = largest_deviation(&believed(WORLDS, &detector_of_kinds()));
    assert!(deviation < MAX_DEVIATION, "{deviation}");
}

#[test]
fn beliefs_that_ignore_the_blind_share_or_the_confusion_are_not_calibrated() {
    let seeing = Detector {
        blind_share: vec![],
        ..detector_of_kinds()
    };
    let identifying = Detector {
        confusion: vec![],
        ..detector_of_kinds()
    };
    for assumed in [seeing, identifying] {
        let deviation = largest_deviation(&believed(2 * WORLDS, &assumed));
        assert!(deviation > 1.5 * MAX_DEVIATION, "{deviation}");
    }
}
