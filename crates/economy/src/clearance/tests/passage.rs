//! Passages of simulated lanes: risks that are stated are the shares of vehicles that are lost.

use super::calibration::{neutralise, search};
use super::simulated::{Item, Random, clearance, picture};
use crate::clearance::LanePicture;
use crate::passage::{MineEffect, Passage, PlannedPassage};
use base::geometry::{Point, Segment};
use brain::{AgentId, GoalId, Lane, MARK_KINDS, Mark, MarkVerdict, Statement};

const VEHICLES: u32 = 3;
const WIDTH_M: f64 = 3.0;

/// Blind shares of both models in different worlds: the risk of a vehicle is about 1%, 4% and 10%.
const WORLDS: [[f64; 2]; 3] = [[0.2, 0.15], [0.4, 0.3], [0.6, 0.5]];
const BLIND: [f64; 2] = WORLDS[1];
const DESTROYS: f64 = 0.5;
const LANES: u64 = 12_000;

/// Limits of the stated risk of the first vehicle.
const LIMITS: [f64; 5] = [0.005, 0.02, 0.06, 0.12, 0.2];

fn passage(lane: &Lane) -> Passage {
    Passage {
        effects: [MineEffect {
            destroy_probability: DESTROYS,
            detonates: true,
        }; MARK_KINDS],
        keep_out_m: 1.0,
        ..Passage::new(lane, WIDTH_M, VEHICLES)
    }
}

/// Whether each vehicle is lost.
fn drive(path: &[Point], items: &[Item], random: &mut Random) -> Vec<bool> {
    let mut ahead: Vec<(f64, bool)> = Vec::new();
    for item in items.iter().filter(|item| item.kind == 0) {
        let mut before_m = 0.0;
        let mut nearest = (f64::INFINITY, 0.0);
        for ends in path.windows(2) {
            let piece = Segment {
                from: ends[0],
                to: ends[1],
            };
            let at = piece.nearest(item.at);
            let away_m = at.to(item.at).length();
            if away_m < nearest.0 {
                nearest = (away_m, before_m + piece.from.to(at).length());
            }
            before_m += piece.length_m();
        }
        if nearest.0 <= WIDTH_M / 2.0 {
            ahead.push((nearest.1, false));
        }
    }
    ahead.sort_by(|one, other| one.0.total_cmp(&other.0));
    let vehicles = (0..VEHICLES).map(|_| {
        let mut active = ahead.iter_mut().filter(|(_, is_gone)| !is_gone);
        let hit = active.find(|_| random.is(DESTROYS));
        hit.map(|(_, is_gone)| *is_gone = true).is_some()
    });
    vehicles.collect()
}

/// Number of lanes, stated risk and share lost, of the first and of the last vehicle.
#[derive(Debug, Default, Clone, Copy)]
struct Bin {
    lanes: f64,
    stated: [f64; 2],
    lost: [f64; 2],
}

fn bins() -> Vec<Bin> {
    let worlds = WORLDS.map(|blind| clearance([2.0, 4.0], blind));
    let passage = passage(&worlds[0].lane);
    let mut bins = vec![Bin::default(); LIMITS.len() - 1];
    for lane in 0..LANES {
        let truth = &worlds[(lane % 3) as usize];
        let mut random = Random(lane.wrapping_mul(0x1234_5678_9abc_def1));
        let mut picture = picture(truth);
        let mut items = search(truth, &mut picture, 0.0, &mut random);
        neutralise(&mut picture, &mut items);
        let planned = PlannedPassage::new(&passage, &picture).unwrap();
        let lost = drive(&planned.path, &items, &mut random);
        let stated = planned.first_risk();
        let bin = LIMITS.iter().filter(|limit| stated >= **limit).count();
        if (1..LIMITS.len()).contains(&bin) {
            let bin = &mut bins[bin - 1];
            bin.lanes += 1.0;
            let both = [
                (planned.first_risk(), lost[0]),
                (planned.last_risk(), lost[2]),
            ];
            for (place, (stated, lost)) in both.into_iter().enumerate() {
                bin.stated[place] += stated;
                bin.lost[place] += f64::from(u8::from(lost));
            }
        }
    }
    bins
}

/// By chance, one of the eight shares is outside with a probability below 2%.
#[test]
fn of_vehicles_with_a_stated_risk_that_share_is_lost() {
    let bins = bins();
    for bin in &bins {
        assert!(bin.lanes >= 150.0, "{bins:#?}");
        for (stated, lost) in bin.stated.iter().zip(bin.lost) {
            let error = (stated * (1.0 - stated / bin.lanes)).sqrt();
            let tolerance = (0.2 * stated).max(0.002 * bin.lanes) + 3.0 * error;
            assert!((lost - stated).abs() < tolerance, "{bin:?} of {bins:#?}");
        }
    }
}

/// A mark of a mine that has been confirmed at a place.
fn mark(picture: &mut LanePicture, number: u32, at: Point, verdict: Option<MarkVerdict>) {
    let robot = AgentId::robot(1, 0);
    let id = GoalId {
        issuer: robot.into(),
        number,
    };
    let at_m = [at.x as f32, at.y as f32];
    let mark = Mark {
        id,
        at_m,
        deviation_mm: 200,
        log_ratios: [20.0, 0.0, 0.0, 0.0],
        missed_since: 0,
        further: 0,
    };
    picture.take_mark(robot, &mark);
    if let Some(verdict) = verdict {
        picture.take_statement(&Statement {
            mark: id,
            at_m,
            verdict,
        });
    }
}

fn away_m(planned: &PlannedPassage, at: Point) -> f64 {
    let pieces = planned.path.windows(2).map(|ends| Segment {
        from: ends[0],
        to: ends[1],
    });
    pieces
        .map(|piece| piece.distance_m(at))
        .fold(f64::INFINITY, f64::min)
}

#[test]
fn before_any_look_the_risk_is_that_of_the_share_of_the_lane_under_the_vehicle() {
    let of = clearance([2.0, 4.0], BLIND);
    let planned = PlannedPassage::new(&passage(&of.lane), &picture(&of)).unwrap();
    // 3 m of 10 m.
    assert!((planned.mines - 0.6).abs() < 1e-3, "{}", planned.mines);
    let risk = 1.0 - (-0.6 * DESTROYS).exp();
    assert!((planned.first_risk() - risk).abs() < 1e-3);
    assert!((planned.length_m - 20.0).abs() < 1e-9);
    assert_eq!(planned.risks.len(), 3);
    assert!(
        planned.last_risk() < planned.first_risk(),
        "mines are used up"
    );
}

#[test]
fn a_path_keeps_clear_of_believed_mines_and_of_the_fence_around_isolated_ones() {
    let of = clearance([2.0, 4.0], BLIND);
    let passage = passage(&of.lane);
    let place = Point { x: 15.0, y: 0.0 };
    let with = |verdict| {
        let mut picture = picture(&of);
        mark(&mut picture, 0, place, verdict);
        PlannedPassage::new(&passage, &picture).unwrap()
    };
    let confirmed = with(Some(MarkVerdict::Confirmed));
    // Half of the width, and up to seven deviations of the position, as the rest of the lane is alike.
    let clear_m = away_m(&confirmed, place);
    assert!((1.9..3.0).contains(&clear_m), "{clear_m}");
    let isolated = with(Some(MarkVerdict::Isolated));
    assert!(away_m(&isolated, place) >= 2.4);
    let neutralised = with(Some(MarkVerdict::Neutralised));
    assert!((neutralised.first_risk() - confirmed.first_risk()).abs() < 0.02);
}

#[test]
fn isolated_marks_across_the_whole_lane_leave_no_passage() {
    let of = clearance([2.0, 4.0], BLIND);
    let mut picture = picture(&of);
    for (number, y) in (0..6).zip([-4.5, -2.7, -0.9, 0.9, 2.7, 4.5]) {
        let at = Point { x: 15.0, y };
        mark(&mut picture, number, at, Some(MarkVerdict::Isolated));
    }
    assert!(PlannedPassage::new(&passage(&of.lane), &picture).is_none());
}

#[test]
fn the_mines_of_all_kinds_are_those_of_a_cell() {
    let mut of = clearance([2.0, 4.0], BLIND);
    of.lane.hazards = 0b11;
    let mut random = Random(3);
    let mut picture = picture(&of);
    search(&of, &mut picture, 0.0, &mut random);
    for cell in 0..of.lane.cells() {
        let kinds = picture.unmarked_of_kinds(cell);
        let sum: f64 = kinds.iter().sum();
        assert!((sum - picture.unmarked(cell)).abs() < 1e-12);
        // Both are detected alike, so that their ratio is that of the prior.
        assert!((kinds[1] - 2.0 * kinds[0]).abs() < 1e-12);
    }
}

/// Of the lanes in which a mine was found, the stated share is the mean of the true one, and its interval contains the
/// true one in 95% of them or more. By chance, the mean differs by four standard errors with a probability below 0.01%.
#[test]
fn the_stated_clearance_is_the_mean_of_the_true_one_and_its_interval_holds() {
    let truth = clearance([2.0, 4.0], BLIND);
    let (mut differences, mut inside) = (Vec::new(), 0.0);
    for lane in 0..LANES {
        let mut random = Random(lane.wrapping_mul(0x1234_5678_9abc_def1));
        let mut picture = picture(&truth);
        let mut items = search(&truth, &mut picture, 0.0, &mut random);
        let mines = |items: &[Item]| items.iter().filter(|item| item.kind == 0).count() as f64;
        let before = mines(&items);
        neutralise(&mut picture, &mut items);
        let share = if before > 0.0 {
            1.0 - mines(&items) / before
        } else {
            1.0
        };
        let stated = picture.cleared()[0];
        differences.push(stated.share - share);
        let is_inside = stated.low - 1e-9 <= share && share <= stated.high + 1e-9;
        inside += f64::from(u8::from(is_inside));
    }
    let lanes = LANES as f64;
    let mean = differences.iter().sum::<f64>() / lanes;
    let squares = differences.iter().map(|one| (one - mean) * (one - mean));
    let error = (squares.sum::<f64>() / lanes / lanes).sqrt();
    assert!(mean.abs() < 0.005 + 4.0 * error, "{mean} ± {error}");
    assert!(inside / lanes > 0.95, "{}", inside / lanes);
}

/// By chance, one of the three numbers differs by four standard deviations of a Poisson number with a probability below
/// 0.02%.
#[test]
fn the_expected_mines_on_a_path_are_the_mean_of_the_true_number() {
    for blind in WORLDS {
        let truth = clearance([2.0, 4.0], blind);
        let passage = passage(&truth.lane);
        let (mut expected, mut found) = (0.0, 0.0);
        for lane in 0..3_000 {
            let mut random = Random(lane);
            let mut picture = picture(&truth);
            let mut items = search(&truth, &mut picture, 0.0, &mut random);
            neutralise(&mut picture, &mut items);
            let planned = PlannedPassage::new(&passage, &picture).unwrap();
            let is_on = |item: &Item| item.kind == 0 && away_m(&planned, item.at) <= WIDTH_M / 2.0;
            expected += planned.mines;
            found += items.iter().filter(|item| is_on(item)).count() as f64;
        }
        assert!(
            (found - expected).abs() < 4.0 * expected.sqrt(),
            "{blind:?}: {expected} {found}"
        );
    }
}
