use super::*;
use crate::io::message::{About, Message};
use crate::perception::beliefs::BeliefsSpec;
use crate::perception::beliefs::coverage_map::DetectorScan;
use crate::perception::beliefs::coverage_map::tests::detector;
use crate::perception::beliefs::trust::{Trust, TrustSpec};
use base::geometry::Rectangle;
use base::noise::normal_pair;
use base::random::{Entity, Purpose, Stream, stream, unit};
use core::f64::consts::TAU;
use proptest::prelude::*;

const ME: RobotId = RobotId { kind: 0, index: 0 };
const PLACE: Point = Point { x: 3.0, y: 0.0 };

/// Density of items and of false alarms.
const PER_M2: f64 = 0.01;
const FALSE_PER_M2: f64 = 0.02;

/// Detects 70% all around, up to 5 m.
fn camera() -> Detector {
    Detector {
        false_alarms_per_m2: vec![FALSE_PER_M2],
        noise_m: 0.1,
        ..detector(5.0, 7.0, 0.7)
    }
}

fn pose(at: Point) -> Pose {
    Pose {
        at,
        heading_rad: 0.0,
        deviation_m: 0.0,
        deviation_rad: 0.0,
        age_s: 0.0,
    }
}

fn contact(from: Point, at: Point) -> Contact {
    let way = from.to(at);
    Contact {
        kind: 0,
        sensor: 0,
        range_m: way.length(),
        bearing_rad: libm::atan2(way.y, way.x),
        age_s: 0.0,
    }
}

fn observe(items: &mut Items, observer: RobotId, from: Point, contacts: &[Contact]) {
    observe_with(items, observer, from, (contacts, None));
}

fn observe_with(
    items: &mut Items,
    observer: RobotId,
    from: Point,
    (contacts, map): (&[Contact], Option<&Map>),
) {
    let look = OwnObservation {
        observer,
        detector: &camera(),
        pose: pose(from),
        per_m2: &[PER_M2],
    };
    items.observe(&look, contacts.iter(), map);
}

fn hit(items: &mut Items, observer: RobotId) {
    observe(
        items,
        observer,
        Point::default(),
        &[contact(Point::default(), PLACE)],
    );
}

fn miss(items: &mut Items, observer: RobotId) {
    observe(items, observer, Point::default(), &[]);
}

fn confidence(items: &Items, own: RobotId) -> f64 {
    confidence_of(&items.tracks[0], own)
}

fn sent(items: &mut Items) -> Vec<Report> {
    let mut outbox = Vec::new();
    with_initial_trust(ME, |reception| items.report(reception, &mut outbox, 100));
    let report = |message: Message| match message.about {
        About::Item {
            kind,
            at,
            provenance,
        } => Some(Report {
            kind,
            at,
            provenance,
            confidence: message.confidence,
            from: provenance.observer,
        }),
        _ => None,
    };
    outbox.into_iter().filter_map(report).collect()
}

/// The trust after nine refuted reports of a robot.
fn distrust_of(liar: RobotId) -> (Trust, TrustSpec) {
    let (mut trust, spec) = (Trust::default(), TrustSpec::default());
    (0..9).for_each(|_| trust.learn(liar, false, &spec));
    (trust, spec)
}

/// Calls a function with the initial trust in all robots.
fn with_initial_trust<T>(own: RobotId, then: impl FnOnce(&Reception) -> T) -> T {
    let (trust, spec) = (&Trust::default(), &TrustSpec::default());
    then(&Reception { own, trust, spec })
}

fn receive(items: &mut Items, own: RobotId, report: &Report) {
    with_initial_trust(own, |reception| {
        items.receive(reception, report, 0.01, &[PER_M2]);
    });
}

fn robot(index: u32) -> RobotId {
    RobotId { kind: 0, index }
}

fn report(observer: u32, confidence: f64) -> Report {
    Report {
        kind: 0,
        at: PLACE,
        provenance: Provenance {
            observer: robot(observer),
            track_id: 1,
            observations: 1,
        },
        confidence,
        from: robot(observer),
    }
}

fn random(run: u64) -> Stream {
    stream(3, run, Entity { kind: 0, index: 0 }, Purpose::Item)
}

#[test]
fn a_contact_is_weighted_by_bayes_rule() {
    let mut items = Items::default();
    hit(&mut items, ME);
    // Of all contacts at a position, 0.7 x 0.01 per square metre are items, and 0.02 are false alarms.
    let odds = 0.7 * PER_M2 / FALSE_PER_M2 / (1.0 - TAU * 0.01 * PER_M2);
    assert!((confidence(&items, ME) - odds / (1.0 + odds)).abs() < 1e-9);
    hit(&mut items, ME);
    // A second one at the same position; the standard deviation of both is 0.1 along each axis.
    let odds = odds * 0.7 / (TAU * 0.02 * FALSE_PER_M2);
    assert!((confidence(&items, ME) - odds / (1.0 + odds)).abs() < 1e-9);
    miss(&mut items, ME);
    let odds = odds * 0.3;
    assert!((confidence(&items, ME) - odds / (1.0 + odds)).abs() < 1e-9);
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
    let mut items = Items::default();
    (0..5).for_each(|_| items.observe(&look, [contact(Point::default(), PLACE)].iter(), None));
    assert!(confidence(&items, ME) > 0.99, "{}", confidence(&items, ME));
}

#[test]
fn a_contact_raises_confidence_and_a_miss_lowers_it() {
    let mut items = Items::default();
    let mut before = 0.0;
    for _ in 0..4 {
        hit(&mut items, ME);
        assert!(confidence(&items, ME) > before);
        before = confidence(&items, ME);
    }
    for _ in 0..15 {
        miss(&mut items, ME);
        assert!(confidence(&items, ME) < before);
        before = confidence(&items, ME);
    }
    assert!(before < 0.1);
}

#[test]
fn items_out_of_view_are_not_missed() {
    let mut items = Items::default();
    hit(&mut items, ME);
    let before = confidence(&items, ME);
    observe(&mut items, ME, Point { x: -3.0, y: 0.0 }, &[]);
    assert!((confidence(&items, ME) - before).abs() < 1e-12);
}

#[test]
fn a_report_is_weighted_by_the_trust_in_its_sender() {
    let mut items = Items::default();
    receive(&mut items, ME, &report(1, 0.8));
    let before = TAU * 0.01 * PER_M2;
    assert!((confidence(&items, ME) - (0.9 * 0.8 + 0.1 * before)).abs() < 1e-9);
}

#[test]
fn a_relayed_report_is_weighted_by_the_trust_in_sender_and_observer() {
    let mut items = Items::default();
    let relayed = Report {
        from: robot(2),
        ..report(1, 0.8)
    };
    receive(&mut items, ME, &relayed);
    let before = TAU * 0.01 * PER_M2;
    assert!((confidence(&items, ME) - (0.81 * 0.8 + 0.19 * before)).abs() < 1e-9);
    receive(&mut items, ME, &report(1, 0.8));
    assert!((confidence(&items, ME) - (0.9 * 0.8 + 0.1 * before)).abs() < 1e-9);
}

#[test]
fn a_sender_is_believed_no_more_than_it_is_trusted_whichever_observers_it_names() {
    let mut items = Items::default();
    for observer in 1..6 {
        let from = robot(7);
        receive(
            &mut items,
            ME,
            &Report {
                from,
                ..report(observer, 0.99)
            },
        );
    }
    assert!(items.tracks[0].count == 5 && confidence(&items, ME) < 0.901);
}

#[test]
fn a_report_of_the_observer_itself_precedes_relayed_ones() {
    let mut items = Items::default();
    let more = |from: u32| Report {
        from: robot(from),
        provenance: Provenance {
            observations: 9,
            ..report(1, 0.5).provenance
        },
        ..report(1, 1e-3)
    };
    let (trust, spec) = distrust_of(robot(7));
    let reception = Reception {
        own: ME,
        trust: &trust,
        spec: &spec,
    };
    let mut confidence_after = |report: &Report| {
        items.receive(&reception, report, 0.01, &[PER_M2]);
        items.tracks[0].confidence(&reception)
    };
    let first = confidence_after(&report(1, 0.9));
    assert!(
        (confidence_after(&more(7)) - first).abs() < 1e-12,
        "a distrusted sender is ignored"
    );
    assert!(
        confidence_after(&more(2)) < 0.1,
        "a trusted sender with more observations replaces the report"
    );
    assert!(
        (confidence_after(&report(1, 0.9)) - first).abs() < 1e-12,
        "the observer itself takes precedence"
    );
}

#[test]
fn reports_of_distrusted_robots_are_not_relayed() {
    let mut items = Items::default();
    let (trust, spec) = distrust_of(robot(7));
    let reception = Reception {
        own: ME,
        trust: &trust,
        spec: &spec,
    };
    for (track_id, from, observer) in [(1, 7, 1), (2, 1, 7), (3, 1, 2)] {
        let provenance = Provenance {
            track_id,
            ..report(observer, 0.9).provenance
        };
        let relayed = Report {
            from: robot(from),
            provenance,
            ..report(observer, 0.9)
        };
        items.receive(&reception, &relayed, 0.01, &[PER_M2]);
    }
    let mut outbox = Vec::new();
    items.report(&reception, &mut outbox, 100);
    let is_of_2 = |message: &Message| matches!(message.about, About::Item { provenance, .. } if provenance.observer == robot(2));
    assert!(
        outbox.len() == 1 && outbox.iter().all(is_of_2),
        "{outbox:?}"
    );
}

#[test]
fn contradicting_reports_give_a_confidence_between_both() {
    let mut items = Items::default();
    receive(&mut items, ME, &report(1, 0.9));
    let alone = confidence(&items, ME);
    receive(&mut items, ME, &report(2, 1e-4));
    let both = confidence(&items, ME);
    assert!(both < alone && both > 0.01, "{alone} {both}");
    receive(&mut items, ME, &report(3, 0.9));
    assert!(confidence(&items, ME) > both);
}

#[test]
fn relayed_own_observations_change_nothing() {
    let (mut mine, mut theirs) = (Items::default(), Items::default());
    hit(&mut mine, ME);
    for report in sent(&mut mine) {
        receive(&mut theirs, robot(1), &report);
    }
    let before = mine.clone().tracks;
    for report in sent(&mut theirs) {
        receive(&mut mine, ME, &report);
    }
    assert_eq!(mine.tracks, before);
}

#[test]
fn the_sources_of_an_item_are_bounded_and_own_observations_are_kept() {
    let mut items = Items::default();
    hit(&mut items, ME);
    let reports: Vec<Report> = (1..20)
        .map(|observer| report(observer, 0.3 + 0.03 * f64::from(observer)))
        .collect();
    for _ in 0..10 {
        for report in &reports {
            receive(&mut items, ME, report);
        }
    }
    assert!(items.tracks.len() == 1 && items.tracks[0].is_observed_by(ME));
    sent(&mut items);
    for _ in 0..10 {
        for report in &reports {
            receive(&mut items, ME, report);
        }
        assert!(sent(&mut items).is_empty());
    }
}

#[test]
fn all_items_are_repeated_for_robots_that_come_into_range_later() {
    let (mut items, mut later) = (Items::default(), Items::default());
    for number in 0..20 {
        let at = Point {
            x: f64::from(number),
            y: 0.0,
        };
        observe(&mut items, ME, at, &[contact(at, at)]);
        sent(&mut items);
    }
    for _ in 0..20 {
        assert!(sent(&mut items).is_empty());
        items.repeat_next();
        for report in sent(&mut items) {
            receive(&mut later, robot(1), &report);
        }
    }
    assert_eq!(later.tracks.len(), 20);
}

#[test]
fn memory_is_bounded_for_a_thousand_contacts() {
    let (mut items, mut random) = (Items::default(), random(1));
    for number in 0..1000 {
        let at = Point {
            x: 200.0 * unit(&mut random),
            y: 200.0 * unit(&mut random),
        };
        observe(
            &mut items,
            ME,
            at,
            &[contact(at, at), contact(at, at.plus(PLACE))],
        );
        receive(
            &mut items,
            ME,
            &Report {
                at,
                ..report(number, 0.4)
            },
        );
    }
    assert_eq!(items.tracks.len(), MAX_TRACKS);
    let mut outbox = Vec::new();
    with_initial_trust(ME, |reception| items.report(reception, &mut outbox, 2));
    assert_eq!(outbox.len(), 2);
}

/// Three robots observe an item and relay reports: in each step one of them observes, sends, or receives any
/// message that was ever sent. Returns their items, and each robot's last report of its own observations.
fn gossip(seed: u64, steps: u32) -> (Vec<Items>, Vec<Report>) {
    let mut random = random(seed);
    let mut team = vec![Items::default(); 3];
    let mut air: Vec<Report> = Vec::new();
    for (items, observer) in team.iter_mut().zip(0..) {
        hit(items, robot(observer));
    }
    for _ in 0..steps {
        let observer = random.bounded(3);
        let items = &mut team[observer as usize];
        match random.bounded(6) {
            0 => hit(items, robot(observer)),
            1 => miss(items, robot(observer)),
            2 => {
                let from = robot(observer);
                let told = sent(items).into_iter();
                air.extend(told.map(|report| Report { from, ..report }));
            }
            _ if air.is_empty() => {}
            _ => {
                let any = random.bounded(u32::try_from(air.len()).unwrap()) as usize;
                receive(items, robot(observer), &air[any]);
            }
        }
    }
    let last = |observer: u32| {
        let is_own =
            |report: &&Report| [report.provenance.observer, report.from] == [robot(observer); 2];
        let own = air.iter().filter(is_own);
        own.max_by_key(|report| report.provenance.observations)
            .copied()
    };
    (team, (0..3).filter_map(last).collect())
}

proptest! {
    #[test]
    fn observations_count_once_however_often_and_by_whichever_route_they_are_reported(
        seed: u64, steps in 1_u32..300,
    ) {
        let (mut team, last) = gossip(seed, steps);
        for (items, own) in team.iter_mut().zip((0..).map(robot)) {
            for report in &last {
                receive(items, own, report);
            }
            prop_assert_eq!(items.tracks.len(), 1);
            let track = &items.tracks[0];
            let observations = &track.sources[track.place_by(own)];
            let reports = last.iter().filter(|report| report.provenance.observer != own);
            let reported = reports.map(|report| {
                let prior = track.sources[track.place_by(report.provenance.observer)].prior;
                log_odds(0.9 * report.confidence + 0.1 * probability(prior)) - prior
            });
            let expected = probability(track.prior + observations.log_ratio + reported.sum::<f64>());
            prop_assert!((confidence(items, own) - expected).abs() < 1e-6, "{}", expected);
        }
    }
}

/// A random number from the Poisson distribution (Knuth, *Seminumerical algorithms*, 3.4.1).
fn poisson(mean: f64, random: &mut Stream) -> u32 {
    let (least, mut product, mut number) = (libm::exp(-mean), unit(random), 0);
    while product > least {
        product *= unit(random);
        number += 1;
    }
    number
}

/// An observation of a world, distributed as in the detector's specification.
fn model_observation(
    (items, map): (&mut Items, &mut Map),
    world: &[Point],
    from: Point,
    random: &mut Stream,
) {
    let eye = camera();
    let mut contacts = Vec::new();
    for at in world {
        let [x, y] = normal_pair([random.next_u32(), random.next_u32()]).map(|z| z * eye.noise_m);
        if from.to(*at).length() <= eye.range_m && unit(random) < 0.7 {
            contacts.push(contact(from, at.plus(Point { x, y })));
        }
    }
    for _ in 0..poisson(FALSE_PER_M2 * PI * eye.range_m * eye.range_m, random) {
        let away_m = eye.range_m * libm::sqrt(unit(random));
        let at = from.plus(direction(TAU * unit(random)).times(away_m));
        contacts.push(contact(from, at));
    }
    observe_with(items, ME, from, (&contacts, Some(map)));
    let scan = DetectorScan {
        detector: &eye,
        at: from,
        heading_rad: 0.0,
        trust: 1.0,
        observations: 1.0,
        blur_m: 0.0,
    };
    map.coverage.update(&map.field, &map.occupancy, &scan);
}

/// From -8 to 8 along both axes, in cells of half a metre.
fn field() -> Map {
    let corners = [Point { x: -8.0, y: -8.0 }, Point { x: 8.0, y: 8.0 }];
    let spec = BeliefsSpec {
        cell_m: 0.5,
        ..BeliefsSpec::default()
    };
    Map::new(&spec, &Rectangle::spanned(corners[0], corners[1]))
}

/// Confidences after some observations in many worlds, each with whether the item exists.
fn confidences(worlds: u64) -> Vec<(f64, bool)> {
    let mut all = Vec::new();
    for number in 0..worlds {
        let mut random = random(number);
        let count = poisson(PER_M2 * 256.0, &mut random);
        let mut anywhere = |half_width_m: f64| Point {
            x: half_width_m * (2.0 * unit(&mut random) - 1.0),
            y: half_width_m * (2.0 * unit(&mut random) - 1.0),
        };
        let world: Vec<Point> = (0..count).map(|_| anywhere(8.0)).collect();
        let stands: Vec<Point> = (0..=number % 5).map(|_| anywhere(2.0)).collect();
        let (mut items, mut map) = (Items::default(), field());
        for from in stands {
            model_observation((&mut items, &mut map), &world, from, &mut random);
        }
        all.extend(items.tracks.iter().map(|track| {
            let is_there = world.iter().any(|at| at.to(track.at).length() < 0.35);
            (confidence_of(track, ME), is_there)
        }));
    }
    all
}

fn confidence_of(track: &Track, own: RobotId) -> f64 {
    with_initial_trust(own, |reception| track.confidence(reception))
}

#[test]
fn confidences_are_calibrated() {
    let believed = confidences(4000);
    for tenth in 0..10 {
        let low = 0.1 * f64::from(tenth);
        let within = |confidence: f64| (low..low + 0.1).contains(&confidence);
        let bin = believed
            .iter()
            .filter(|(confidence, _)| within(*confidence));
        let expected: f64 = bin.clone().map(|(confidence, _)| confidence).sum();
        let variance: f64 = bin.clone().map(|(c, _)| c * (1.0 - c)).sum();
        let there: f64 = bin
            .map(|(_, is_there)| f64::from(u8::from(*is_there)))
            .sum();
        // 99% of all samples.
        let max = 2.58 * libm::sqrt(variance);
        assert!(variance > 1.0, "{low:.1}: too few samples");
        assert!(
            (there - expected).abs() < max,
            "{low:.1}: {there} {expected}"
        );
    }
}

impl Track {
    fn place_by(&self, own: RobotId) -> usize {
        let mut sources = self.sources[..self.count].iter();
        sources
            .position(|source| source.provenance.observer == own)
            .unwrap()
    }
}
