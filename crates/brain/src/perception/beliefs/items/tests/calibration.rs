use super::*;
use crate::perception::beliefs::BeliefsSpec;
use crate::perception::beliefs::coverage_map::DetectorScan;
use crate::perception::sector::direction;
use base::geometry::Rectangle;
use base::noise::normal_pair;
use core::f64::consts::PI;

/// An observation of a world, distributed as in the detector's specification.
fn model_observation(
    (items, map): (&mut Items, &mut Map),
    world: &[Point],
    from: Point,
    random: &mut Stream,
) {
    let camera = camera();
    let mut contacts = Vec::new();
    for at in world {
        let [x, y] =
            normal_pair([random.next_u32(), random.next_u32()]).map(|z| z * camera.noise_m);
        if from.to(*at).length() <= camera.range_m && unit(random) < 0.7 {
            contacts.push(contact(from, at.plus(Point { x, y })));
        }
    }
    for _ in 0..poisson(FALSE_PER_M2 * PI * camera.range_m * camera.range_m, random) {
        let distance_m = camera.range_m * libm::sqrt(unit(random));
        let at = from.plus(direction(TAU * unit(random)).times(distance_m));
        contacts.push(contact(from, at));
    }
    observe_with(items, ME, from, (&contacts, Some(map)));
    let scan = DetectorScan {
        detector: &camera,
        at: from,
        heading_rad: 0.0,
        trust: 1.0,
        observations: 1.0,
        blur_m: 0.0,
    };
    map.coverage
        .update(&map.field, (&map.field, &map.occupancy), &scan);
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
        let positions: Vec<Point> = (0..=number % 5).map(|_| anywhere(2.0)).collect();
        let (mut items, mut map) = (Items::new(64, None), field());
        for from in positions {
            model_observation((&mut items, &mut map), &world, from, &mut random);
        }
        all.extend(believed(&items).into_iter().map(|(track, confidence)| {
            let is_there = world.iter().any(|at| at.to(track.at).length() < 0.35);
            (confidence, is_there)
        }));
    }
    all
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
