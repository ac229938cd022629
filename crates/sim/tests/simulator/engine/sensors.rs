//! Measurements of each sensor: values, rates, latencies and errors.

use crate::common::{first, go, id, start, step_with, with};
use brain::{Command, Percept, SensorRequest};
use sim::simulation::Simulation;
use std::f64::consts::{FRAC_PI_2, PI};

const STEP_S: f64 = 0.1;

const ROOM: &str = "
clock.time_limit_s = 100000
world.size_m = [20, 20]
world.obstacles = [{ polygon_m = [[13, 9], [13.5, 9], [13.5, 11], [13, 11]] }]
[robots.rover]
radius_m = 0.5
start = { at_m = [[10, 10]], heading_deg = [0] }
drive = { max_speed_m_s = 2, max_turn_rate_deg_s = 180 }
";

/// A robot with sensors in the middle of a room of 20 m, facing along x; `more` adds other kinds.
fn room(sensors: &str, more: &str) -> String {
    with(
        ROOM,
        &format!("robots.rover.sensors = {{ {sensors} }}\n{more}"),
    )
}

/// Robots of 0.1 m that do not move.
fn stones(places: &str) -> String {
    format!(
        "robots.stone = {{ start.at_m = {places}, radius_m = 0.1, \
         drive = {{ max_speed_m_s = 0, max_turn_rate_deg_s = 0 }} }}\n"
    )
}

fn rover(simulation: &mut Simulation) -> Option<Percept> {
    simulation.percept(id(0, 0)).unwrap()
}

/// The percepts of the robot over a number of steps with a constant command.
fn percepts(simulation: &mut Simulation, steps: u32, command: &Command) -> Vec<Option<Percept>> {
    let step = |_| {
        let percept = rover(simulation);
        step_with(simulation, [(id(0, 0), command.clone())]);
        percept
    };
    (0..steps).map(step).collect()
}

fn standing(text: &str, steps: u32) -> Vec<Percept> {
    let all = percepts(&mut start(text), steps, &go(0.0, 0.0));
    all.into_iter().flatten().collect()
}

/// Within five standard errors: a correct program fails less than once in a million seeds. Seeds
/// are fixed.
fn assert_mean(values: &[f64], mean: f64, deviation: f64) {
    let count = values.len() as f64;
    let found = values.iter().sum::<f64>() / count;
    assert!(
        (found - mean).abs() <= 5.0 * deviation / count.sqrt(),
        "{found} {mean}"
    );
}

/// Mean and variance of normally distributed numbers, with the same tolerance.
fn assert_normal(values: &[f64], mean: f64, deviation: f64) {
    assert_mean(values, mean, deviation);
    let squares: Vec<f64> = values.iter().map(|value| (value - mean).powi(2)).collect();
    let square = deviation * deviation;
    assert_mean(&squares, square, square * 2.0_f64.sqrt());
}

fn assert_share(hits: usize, count: usize, share: f64) {
    let values: Vec<f64> = (0..count)
        .map(|at| f64::from(u8::from(at < hits)))
        .collect();
    assert_mean(&values, share, (share * (1.0 - share)).sqrt());
}

/// The step of the newest measurement that is available at a step. Measurements occur in the first
/// step at or after each multiple of the period.
fn newest(now: u32, rate_hz: f64, latency_s: f64) -> Option<u32> {
    let is_look = |step: &u32| {
        let measurements = |step: f64| (step * STEP_S * rate_hz + 1e-9).floor();
        *step == 0
            || rate_hz * STEP_S >= 1.0
            || measurements(f64::from(*step)) > measurements(f64::from(step - 1))
    };
    let has = |step: &u32| f64::from(now - step) * STEP_S >= latency_s - 1e-9;
    (0..=now).rev().filter(is_look).find(has)
}

#[test]
fn a_reading_is_the_newest_available_measurement_with_its_age() {
    for rate_hz in [10.0, 5.0, 4.0, 3.0, 0.7] {
        for latency_s in [0.0, 0.03, 0.1, 0.25, 1.0, 2.1] {
            let timing = format!("rate_hz = {rate_hz}, latency_s = {latency_s}");
            let sensors = format!(
                "compass = {{ kind = \"heading\", {timing} }}, gps = {{ kind = \"position\", {timing} }}, \
                 sonar = {{ kind = \"range\", rays = 4, range_m = 15, {timing} }}"
            );
            let mut simulation = start(&room(&sensors, ""));
            let (mut places, mut headings) = (Vec::new(), Vec::new());
            for now in 0..60 {
                let robot = first(&simulation);
                places.push(robot.at);
                headings.push(robot.heading_rad);
                let percept = rover(&mut simulation).unwrap();
                let context = format!("{rate_hz} {latency_s} {now}: {percept:?}");
                let Some(taken) = newest(now, rate_hz, latency_s) else {
                    assert!(
                        percept.position.is_none() && percept.heading_rad.is_none(),
                        "{context}"
                    );
                    assert_eq!(percept.scans[0].age_s, None, "{context}");
                    assert!(percept.scans[0].ranges_m.is_empty(), "{context}");
                    step_with(&mut simulation, [(id(0, 0), go(0.5, 0.3))]);
                    continue;
                };
                let age_s = f64::from(now - taken) * STEP_S;
                let position = percept.position.unwrap();
                assert_eq!(position.value, places[taken as usize], "{context}");
                assert!((position.age_s - age_s).abs() < 1e-12, "{context}");
                let heading = percept.heading_rad.unwrap();
                assert_eq!(heading.value, headings[taken as usize], "{context}");
                assert!((heading.age_s - age_s).abs() < 1e-12, "{context}");
                let scan = &percept.scans[0];
                assert!((scan.age_s.unwrap() - age_s).abs() < 1e-12, "{context}");
                if taken == 0 {
                    let expected = [3.0, 10.0, 10.0, 10.0];
                    let ranges = scan.ranges_m.iter().zip(expected);
                    assert!(
                        ranges.into_iter().all(|(a, b)| (a - b).abs() < 1e-9),
                        "{context}"
                    );
                }
                step_with(&mut simulation, [(id(0, 0), go(0.5, 0.3))]);
            }
        }
    }
}

#[test]
fn measurements_drop_out_with_the_configured_probability() {
    let out = "dropout_probability = 0.3";
    let sensors = format!(
        "compass = {{ kind = \"heading\", {out} }}, gps = {{ kind = \"position\", {out} }}, \
         sonar = {{ kind = \"range\", rays = 4, range_m = 15, {out} }}, \
         eye = {{ kind = \"items\", range_m = 5, {out} }}, mates = {{ kind = \"robots\", range_m = 5, {out} }}"
    );
    let more = format!(
        "items.mine.placement.at_m = [[11, 11]]\n{}",
        stones("[[9, 9]]")
    );
    let all = standing(&room(&sensors, &more), 20_000);
    let count = |has: &dyn Fn(&Percept) -> bool| all.iter().filter(|percept| has(percept)).count();
    let has: [&dyn Fn(&Percept) -> bool; 5] = [
        &|percept| percept.heading_rad.is_some_and(|read| read.age_s == 0.0),
        &|percept| percept.position.is_some_and(|read| read.age_s == 0.0),
        &|percept| percept.scans[0].age_s == Some(0.0),
        &|percept| percept.contacts.len() == 1,
        &|percept| percept.neighbours.len() == 1,
    ];
    for has in has {
        assert_share(count(has), all.len(), 0.7);
    }
    // Sensors drop out independently of each other.
    let together = count(&|percept| has.iter().all(|has| has(percept)));
    assert_share(together, all.len(), 0.7_f64.powi(5));
}

#[test]
fn a_dropped_measurement_keeps_the_previous_value_however_many_follow() {
    let sensors = "gps = { kind = \"position\", rate_hz = 2, dropout_probability = 0.5 }";
    let all = standing(&room(sensors, ""), 4000);
    let ages = all
        .iter()
        .filter_map(|percept| percept.position.map(|read| read.age_s));
    let steps = all.iter().step_by(5);
    let fresh = steps
        .clone()
        .filter(|percept| percept.position.is_some_and(|read| read.age_s == 0.0));
    assert_share(fresh.count(), steps.count(), 0.5);
    // From the first value on. Of all steps, a share 0.5^n is at least n periods after the last value.
    assert!(ages.clone().count() > 3900);
    for (periods, share) in [(1, 0.5), (2, 0.25), (4, 0.0625)] {
        let after_s = 0.5 * f64::from(periods) - 1e-9;
        let older = ages.clone().filter(|age_s| *age_s >= after_s).count();
        let off = older as f64 / ages.clone().count() as f64 - share;
        assert!(off.abs() < 0.05, "{periods} periods: {off}");
    }
}

#[test]
fn a_late_measurement_arrives_although_others_drop_out() {
    for rate in ["", "gps.rate_hz = 4, "] {
        let late = "gps.kind = \"position\", gps.latency_s = 0.7, gps.dropout_probability = 0.6";
        let all = standing(&room(&format!("{rate}{late}"), ""), 4000);
        let ages: Vec<f64> = all
            .iter()
            .filter_map(|percept| percept.position.map(|read| read.age_s))
            .collect();
        assert!(ages.len() > 3900 && ages.iter().all(|age_s| *age_s > 0.7 - 1e-9));
        // Once it has arrived, a value grows older until the next one arrives, and is never lost.
        for pair in ages.windows(2) {
            let grown_s = pair[1] - pair[0];
            assert!(
                (grown_s - STEP_S).abs() < 1e-9 || grown_s < 1e-9,
                "{pair:?}"
            );
        }
    }
}

#[test]
fn errors_of_position_and_heading_have_the_configured_moments() {
    let sensors = "compass = { kind = \"heading\", noise_deg = 5 }, \
                   gps = { kind = \"position\", noise_m = 2 }";
    let all = standing(&room(sensors, ""), 20_000);
    let position = |axis: fn(&base::geometry::Point) -> f64| -> Vec<f64> {
        all.iter()
            .map(|percept| axis(&percept.position.unwrap().value))
            .collect()
    };
    let (x, y) = (position(|at| at.x), position(|at| at.y));
    assert_normal(&x, 10.0, 2.0);
    assert_normal(&y, 10.0, 2.0);
    let headings: Vec<f64> = all
        .iter()
        .map(|percept| percept.heading_rad.unwrap().value)
        .collect();
    assert_normal(&headings, 0.0, 5.0_f64.to_radians());
    let products: Vec<f64> = x
        .iter()
        .zip(&y)
        .map(|(x, y)| (x - 10.0) * (y - 10.0))
        .collect();
    assert_mean(&products, 0.0, 4.0);
}

#[test]
fn a_heading_is_normalised_for_any_error() {
    let sensors = "compass = { kind = \"heading\", noise_deg = 360 }";
    let all = standing(&room(sensors, ""), 1000);
    let headings = all.iter().map(|percept| percept.heading_rad.unwrap().value);
    assert!(
        headings
            .into_iter()
            .all(|heading| heading.abs() <= PI + 1e-12)
    );
}

/// The contacts of a robot in the room with mines at given positions.
fn seen(eye: &str, at_m: &str) -> Vec<(f64, f64)> {
    let eye = format!("eye = {{ kind = \"items\", {eye} }}");
    let text = room(&eye, &format!("items.mine.placement.at_m = {at_m}"));
    let percept = rover(&mut start(&text)).unwrap();
    percept
        .contacts
        .iter()
        .map(|contact| (contact.range_m, contact.bearing_rad))
        .collect()
}

#[test]
fn items_are_detected_in_range_in_the_field_of_view_and_in_line_of_sight() {
    // Ahead, left, behind and right, at 2, 2.01 and 4 m; 4 m is behind the wall.
    let places = "[[12, 10], [10, 12], [8, 10], [10, 8], [10, 12.01], [14, 10]]";
    let bearings = |sensor: &str| {
        let mut seen: Vec<i32> = seen(sensor, places)
            .iter()
            .map(|(_, rad)| rad.to_degrees().round() as i32)
            .collect();
        seen.sort_unstable();
        seen
    };
    assert_eq!(bearings("range_m = 2"), [-90, 0, 90, 180]);
    assert_eq!(bearings("range_m = 5"), [-90, 0, 90, 90, 180]);
    assert_eq!(
        bearings("range_m = 5, needs_line_of_sight = false"),
        [-90, 0, 0, 90, 90, 180]
    );
    assert_eq!(bearings("range_m = 2, fov_deg = 179"), [0]);
    assert_eq!(bearings("range_m = 2, fov_deg = 181"), [-90, 0, 90]);
    assert_eq!(
        bearings("range_m = 2, fov_deg = 100, facing_deg = 90"),
        [90]
    );
    assert_eq!(
        bearings("range_m = 2, fov_deg = 100, facing_deg = 180"),
        [180]
    );
    assert_eq!(bearings("range_m = 1.99"), [0; 0]);
    let ahead = seen("range_m = 2, fov_deg = 10", places);
    assert!((ahead[0].0 - 2.0).abs() < 1e-12 && ahead[0].1.abs() < 1e-12);
}

#[test]
fn contacts_have_the_configured_noise() {
    let sensors = "eye = { kind = \"items\", range_m = 5, noise_m = 0.5 }";
    let more = "items.mine.placement.at_m = [[10, 12]]";
    let all = standing(&room(sensors, more), 20_000);
    let place = |part: fn(f64) -> f64, turn: f64| -> Vec<f64> {
        let contacts = all.iter().map(|percept| percept.contacts[0]);
        contacts
            .map(|contact| contact.range_m * part(contact.bearing_rad + turn))
            .collect()
    };
    assert_normal(&place(libm::cos, 0.0), 0.0, 0.5);
    assert_normal(&place(libm::sin, 0.0), 2.0, 0.5);
}

#[test]
fn items_are_detected_with_the_probability_of_their_kind_and_distance() {
    let sensors = "eye = { kind = \"items\", range_m = 5, detection_probability = \
                   { mine = 0.3, flag = [[1, 0.9], [3, 0.1]], rock = { peak = 0.8, half_range_m = 2 } } }";
    let more = "[items]
mine.placement.at_m = [[9, 10]]
flag.placement.at_m = [[8, 10]]
rock.placement.at_m = [[8, 10]]
cow = { placement.at_m = [[8.5, 10]], target = false }";
    let all = standing(&room(sensors, more), 20_000);
    // Kinds are in alphabetical order: cow, flag, mine, rock.
    for (kind, share) in [(0, 0.0), (1, 0.5), (2, 0.3), (3, 0.4)] {
        let contacts = all.iter().flat_map(|percept| &percept.contacts);
        let hits = contacts.filter(|contact| contact.kind == kind).count();
        assert_share(hits, all.len(), share);
    }
    let both = |percept: &&Percept| {
        percept
            .contacts
            .iter()
            .filter(|contact| contact.kind != 2)
            .count()
            == 2
    };
    assert_share(all.iter().filter(both).count(), all.len(), 0.2);
}

#[test]
fn the_number_of_false_alarms_is_proportional_to_the_visible_area() {
    // A quarter of a circle with a radius of 4 m, for 0.2 s.
    let mean = 0.02 * FRAC_PI_2 / 2.0 * 16.0 * 0.2;
    for facing_deg in [90, -90] {
        let sensors = format!(
            "eye = {{ kind = \"items\", range_m = 4, fov_deg = 90, facing_deg = {facing_deg}, rate_hz = 5, \
             detection_probability = {{}}, false_alarm_rate_per_m2_s.mine = 0.02, noise_m = 3 }}"
        );
        let more = "items = { mine.target = false, cow.target = false }";
        let mut simulation = start(&room(&sensors, more));
        let all = percepts(&mut simulation, 40_000, &go(0.0, 0.0));
        let scans: Vec<&Percept> = all.iter().step_by(2).flatten().collect();
        let counts: Vec<f64> = scans
            .iter()
            .map(|percept| percept.contacts.len() as f64)
            .collect();
        assert_mean(&counts, mean, mean.sqrt());
        let squares: Vec<f64> = counts.iter().map(|count| (count - mean).powi(2)).collect();
        assert_mean(&squares, mean, (mean + 2.0 * mean * mean).sqrt());
        let in_between = all.iter().skip(1).step_by(2).flatten();
        assert!(
            in_between
                .into_iter()
                .all(|percept| percept.contacts.is_empty())
        );
        let contacts: Vec<_> = scans.iter().flat_map(|percept| &percept.contacts).collect();
        assert!(
            contacts
                .iter()
                .all(|contact| contact.kind == 1 && contact.range_m <= 4.0)
        );
        // Uniform over the area: a quarter lies within half the range.
        let near = contacts
            .iter()
            .filter(|contact| contact.range_m < 2.0)
            .count();
        assert_share(near, contacts.len(), 0.25);
        assert_eq!(simulation.outcome().false_alarms, contacts.len() as u64);
        assert_eq!(simulation.outcome().found, [0, 0]);
    }
}

/// A detector that reports only false alarms.
const ALARMS: &str = "eye.kind = \"items\", eye.range_m = 30, eye.detection_probability = {}, \
                      eye.false_alarm_rate_per_m2_s.mine = 0.01";

#[test]
fn false_alarms_are_in_the_visible_area() {
    // The border is 10 m away: half of a range of 20 m is beyond it or behind the wall.
    let all = standing(&room(ALARMS, "items.mine.target = false"), 4_000);
    let counts: Vec<f64> = all
        .iter()
        .map(|percept| percept.contacts.len() as f64)
        .collect();
    // Visible: the square without the shadow of a wall that is 2 m wide and 3 m away, a trapezium
    // from 3 m to 10 m with a width of 2/3 of the distance.
    let shade_m2 = (100.0 - 9.0) / 3.0;
    let mean = (400.0 - shade_m2) * 0.01 * STEP_S;
    assert_mean(&counts, mean, mean.sqrt());
}

#[test]
fn a_slow_brain_receives_every_contact_between_its_steps_once() {
    for latency_s in [0.0, 0.3, 1.5] {
        let timing = format!("latency_s = {latency_s}, range_m = 5");
        let sensors = format!(
            "eye = {{ kind = \"items\", {timing} }}, mates = {{ kind = \"robots\", rate_hz = 5, {timing} }}"
        );
        let more = stones("[[9, 9], [9, 11]]")
            + "robots.rover.brain = { rate_hz = 1, behaviours = [] }\n\
               items.mine.placement.at_m = [[11, 11]]";
        let mut simulation = start(&room(&sensors, &more));
        let (mut contacts, mut neighbours) = (Vec::new(), Vec::new());
        let mut steps = Vec::new();
        for now in 0..101_u32 {
            if let Some(percept) = rover(&mut simulation) {
                steps.push(now);
                let taken = |age_s: f64| now - (age_s / STEP_S).round() as u32;
                assert!(
                    percept
                        .contacts
                        .iter()
                        .all(|contact| contact.age_s >= latency_s - 1e-9)
                );
                contacts.extend(percept.contacts.iter().map(|contact| taken(contact.age_s)));
                neighbours.extend(
                    percept
                        .neighbours
                        .iter()
                        .map(|other| (taken(other.age_s), other.id.index)),
                );
            }
            simulation.step();
        }
        assert_eq!(
            steps,
            (0..=10).map(|number| 10 * number).collect::<Vec<_>>()
        );
        let last = 100 - (latency_s / STEP_S).round() as u32;
        contacts.sort_unstable();
        assert_eq!(
            contacts,
            (0..=last).collect::<Vec<_>>(),
            "{latency_s}: each measurement once"
        );
        let expected: Vec<(u32, u32)> = (0..=last)
            .step_by(2)
            .flat_map(|measurement| [(measurement, 0), (measurement, 1)])
            .collect();
        neighbours.sort_unstable();
        assert_eq!(neighbours, expected, "{latency_s}");
    }
}

#[test]
fn neighbours_are_in_the_order_of_measurements_and_ids() {
    let sensors = "mates = { kind = \"robots\", range_m = 8, latency_s = 0.3 }";
    let more = "robots.rover.brain = { rate_hz = 2, behaviours = [] }\n\
                robots.stone = { count = 30, radius_m = 0.1 }";
    let mut simulation = start(&room(sensors, more));
    for _ in 0..60 {
        if let Some(percept) = rover(&mut simulation) {
            let keys: Vec<_> = percept
                .neighbours
                .iter()
                .map(|other| (-(other.age_s / STEP_S).round() as i32, other.id))
                .collect();
            assert!(keys.windows(2).all(|pair| pair[0] < pair[1]), "{keys:?}");
        }
        simulation.step();
    }
}

#[test]
fn robots_of_all_layers_are_recognised_where_they_are() {
    let more = stones("[[9, 10], [14, 10], [10, 6.4]]")
        + "[robots.bird]\nradius_m = 0.1\nlayer = \"air\"\nstart.at_m = [[10, 13]]\n\
           drive = { max_speed_m_s = 0, max_turn_rate_deg_s = 0 }";
    let text = room("mates = { kind = \"robots\", range_m = 3.5 }", &more);
    // Kinds are in alphabetical order: bird, rover, stone.
    let percept = start(&text).percept(id(1, 0)).unwrap().unwrap();
    let seen: Vec<_> = percept
        .neighbours
        .iter()
        .map(|other| (other.id, other.range_m))
        .collect();
    // One of the stones is hidden, one is out of range.
    assert_eq!(seen, [(id(0, 0), 3.0), (id(2, 0), 1.0)]);
    assert!((percept.neighbours[0].bearing_rad - FRAC_PI_2).abs() < 1e-12);
    assert!((percept.neighbours[1].bearing_rad.abs() - PI).abs() < 1e-12);
}

#[test]
fn robots_are_detected_with_the_probability_of_their_distance() {
    let sensors = "mates = { kind = \"robots\", range_m = 5, noise_m = 0.1, \
                   detection_probability = [[0, 1], [4, 0.2]] }";
    let all = standing(&room(sensors, &stones("[[8, 10], [10, 14]]")), 20_000);
    for (index, share) in [(0, 0.6), (1, 0.2)] {
        let neighbours = all.iter().flat_map(|percept| &percept.neighbours);
        let of_one: Vec<_> = neighbours.filter(|other| other.id.index == index).collect();
        assert_share(of_one.len(), all.len(), share);
        let lefts: Vec<f64> = of_one
            .iter()
            .map(|other| other.range_m * libm::sin(other.bearing_rad))
            .collect();
        assert_normal(&lefts, [0.0, 4.0][index as usize], 0.1);
    }
}

#[test]
fn a_sensor_that_is_switched_off_measures_nothing_until_it_is_on_again() {
    let sensors = "compass.kind = \"heading\", eye = { kind = \"items\", range_m = 5 }, \
                   gps = { kind = \"position\", rate_hz = 5 }, \
                   sonar = { kind = \"range\", rays = 4, range_m = 15 }";
    let more = "items.mine = { target = false, placement.at_m = [[10, 12]] }";
    let mut simulation = start(&room(sensors, more));
    let switch = |numbers: &[u16], on| Command {
        requests: numbers
            .iter()
            .map(|sensor| SensorRequest {
                sensor: *sensor,
                on,
            })
            .collect(),
        ..Command::default()
    };
    let has = |percept: &Percept| {
        [
            percept.heading_rad.is_some(),
            !percept.contacts.is_empty(),
            percept.position.is_some_and(|read| read.age_s < 0.15),
            percept.scans[0].age_s.is_some(),
        ]
    };
    assert_eq!(has(&rover(&mut simulation).unwrap()), [true; 4]);
    // Everything off except the compass; indices without a sensor are ignored.
    step_with(
        &mut simulation,
        [(id(0, 0), switch(&[1, 2, 3, 4, 31, 32, 65_535], false))],
    );
    for step in 1..20 {
        let percept = rover(&mut simulation).unwrap();
        assert_eq!(has(&percept), [true, false, step < 2, false]);
        // The last reading of a slow sensor remains, with a growing age.
        let age_s = percept.position.unwrap().age_s;
        assert!((age_s - f64::from(step) * STEP_S).abs() < 1e-12);
        step_with(&mut simulation, [(id(0, 0), go(0.0, 0.0))]);
    }
    step_with(&mut simulation, [(id(0, 0), switch(&[1, 2, 3], true))]);
    let all = percepts(&mut simulation, 3, &go(0.0, 0.0));
    assert_eq!(has(all[1].as_ref().unwrap()), [true; 4]);
}

#[test]
fn false_alarms_are_inside_the_world_even_without_line_of_sight() {
    let sensors = format!("{ALARMS}, eye.needs_line_of_sight = false");
    let all = standing(&room(&sensors, "items.mine.target = false"), 4_000);
    let counts: Vec<f64> = all
        .iter()
        .map(|percept| percept.contacts.len() as f64)
        .collect();
    let mean = 400.0 * 0.01 * STEP_S;
    assert_mean(&counts, mean, mean.sqrt());
}
