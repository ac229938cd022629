//! Closed forms of search theory.

use super::simulated::{Random, Searcher, Sensor, clearance, items, picture};
use crate::clearance::{Clearance, LanePicture};
use brain::{AgentId, Coverage};

const SENSOR: Sensor = Sensor {
    detection: 0.3,
    is_right: 0.9,
    false_alarms_per_m2: 1e-9,
    noise_m: 0.05,
};

const ROBOT: AgentId = AgentId::robot(0, 0);

/// A lane without clutter, of which a robot has looked at each cell a number of times.
fn searched(clearance: &Clearance, kinds: &[u8], looks: impl Fn(usize) -> u32) -> LanePicture {
    let mut picture = picture(clearance);
    let nats = -(1.0 - SENSOR.detection).ln();
    for kind in kinds {
        for first in (0..clearance.lane.cells()).step_by(16) {
            let coverage = Coverage {
                first: first as u32,
                marks: 0,
                missed: core::array::from_fn(|cell| {
                    Coverage::steps(nats * f64::from(looks(first + cell)))
                }),
                driven: [0; 16],
            };
            picture.take_coverage(AgentId::robot(*kind, 0), &coverage);
        }
    }
    picture
}

#[test]
fn before_any_look_the_risk_is_that_of_the_prior() {
    let risk = picture(&clearance([3.0, 5.0], [0.1, 0.1])).risk();
    assert!((risk.expected() - 3.0).abs() < 1e-9);
    assert!((risk.probability - (1.0 - (-3.0_f64).exp())).abs() < 1e-9);
}

#[test]
fn without_mines_there_is_no_risk() {
    let picture = searched(&clearance([0.0, 5.0], [0.1, 0.1]), &[0], |_| 3);
    assert!(picture.risk().probability.abs() < 1e-12);
}

/// A mine would have destroyed the robot with a probability of 0.8, also one to which its sensors are blind.
#[test]
fn ground_that_has_been_driven_over_has_fewer_mines() {
    let mut clearance = clearance([3.0, 5.0], [1.0, 1.0]);
    clearance.destroy_probability = vec![0.8, 0.0];
    let mut picture = picture(&clearance);
    let mut expected_after = |index: u32, share: f64| {
        for first in (0..clearance.lane.cells()).step_by(16) {
            let coverage = Coverage {
                first: first as u32,
                marks: 0,
                missed: [0; 16],
                driven: [Coverage::parts(share); 16],
            };
            picture.take_coverage(AgentId::robot(1, index), &coverage);
        }
        picture.risk().expected()
    };
    assert!((expected_after(0, 0.6) - 3.0 * 0.52).abs() < 1e-9);
    // The other robot may have driven along the same path.
    assert!((expected_after(1, 0.4) - 3.0 * 0.52).abs() < 1e-9);
    assert!((expected_after(1, 1.0) - 3.0 * 0.2).abs() < 1e-9);
}

/// The floor of the risk with 8 mines and a joint blind share of 2% is 15%, with 12 mines and 5% 45%, and with 8 mines
/// and 0.3% 2.4%.
#[test]
fn the_risk_never_falls_below_the_floor_of_joint_blindness() {
    for (expected, blind, floor) in [
        (8.0, [0.02, 1.0], 0.148),
        (12.0, [0.25, 0.2], 0.451),
        (8.0, [0.06, 0.05], 0.0237),
    ] {
        let clearance = clearance([expected, 0.0], blind);
        assert!((clearance.floor() - floor).abs() < 1e-3);
        let risk = searched(&clearance, &[0, 1], |_| 40).risk().probability;
        assert!(risk >= clearance.floor() && risk < clearance.floor() + 1e-3);
        let one_model = searched(&clearance, &[1], |_| 40).risk().probability;
        assert!(one_model > risk + 0.1);
    }
}

/// Lanes in which many were found have as many left as others: 20,000 lanes, a tolerance of more than
/// four standard errors.
#[test]
fn the_expected_number_left_does_not_depend_on_how_many_were_found() {
    let clearance = clearance([3.0, 0.0], [0.2, 0.2]);
    let mut left = [[0.0; 2]; 2];
    let mut stated = 0.0;
    for lane in 0..20_000 {
        let mut random = Random(lane << 20);
        let mut items = items(&clearance, &mut random);
        let mut picture = picture(&clearance);
        let searcher = Searcher {
            id: ROBOT,
            sensor: &SENSOR,
            loss: 0.0,
            looks: vec![3; clearance.lane.cells()],
        };
        searcher.search(&mut items, &mut picture, &mut random);
        let found = items.iter().filter(|item| item.is_marked).count();
        let [lanes, sum] = &mut left[usize::from(found >= 2)];
        *lanes += 1.0;
        *sum += (items.len() - found) as f64;
        stated = picture.risk().unmarked;
    }
    // 1 - P, the share that is not found.
    let missed = 0.2 + 0.8 * 0.7_f64.powi(3);
    assert!((stated - 3.0 * missed).abs() < 0.05);
    for [lanes, sum] in left {
        assert!(
            lanes > 5000.0 && (sum / lanes - 3.0 * missed).abs() < 0.07,
            "{left:?}"
        );
    }
}

/// 4,000 lanes with 3 mines each: the standard error is 0.4%.
#[test]
fn the_share_found_never_exceeds_the_visible_share() {
    let clearance = clearance([3.0, 0.0], [0.2, 0.2]);
    let (mut all, mut found) = (0.0, 0.0);
    for lane in 0..4000 {
        let mut random = Random(lane << 20);
        let mut items = items(&clearance, &mut random);
        let searcher = Searcher {
            id: ROBOT,
            sensor: &SENSOR,
            loss: 0.0,
            looks: vec![40; clearance.lane.cells()],
        };
        searcher.search(&mut items, &mut picture(&clearance), &mut random);
        all += items.len() as f64;
        found += items.iter().filter(|item| item.is_marked).count() as f64;
    }
    assert!((found / all - 0.8).abs() < 0.016, "{}", found / all);
}

/// Share of the items of a lane without a mark after an effort of some passes, at random or in lanes.
#[test]
fn a_random_search_takes_the_effort_of_the_closed_form() {
    let mut wide = clearance([1.0, 0.0], [0.0, 0.0]);
    wide.lane.max_m = [405.0, 195.0];
    let lanes = |passes| searched(&wide, &[0], |_| passes).risk().unmarked;
    for passes in [1, 4] {
        assert!((lanes(passes) / 0.7_f64.powi(passes as i32) - 1.0).abs() < 0.04);
        let effort = f64::from(passes) * -(0.7_f64.ln()) / 0.3;
        let mut random = Random(7);
        let looks: Vec<u32> = (0..wide.lane.cells())
            .map(|_| random.poisson(effort))
            .collect();
        let at_random = searched(&wide, &[0], |cell| looks.get(cell).copied().unwrap_or(0));
        let ratio = at_random.risk().unmarked / lanes(passes);
        assert!((ratio - 1.0).abs() < 0.06, "{passes} {ratio}");
    }
}
