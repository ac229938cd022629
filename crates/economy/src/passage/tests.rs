//! Tests of paths and risks, without a simulated lane.

use super::risk::Contents;
use super::search::Search;
use super::settings::{MineEffect, Passage};
use crate::passage::PassageGrid;
use base::geometry::{Point, Rectangle};
use brain::{Lane, MARK_KINDS};

/// Random numbers, by `SplitMix64`.
struct Random(u64);

impl Random {
    #[expect(clippy::cast_precision_loss, reason = "53 bits")]
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut word = self.0;
        word = (word ^ word >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        word = (word ^ word >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((word ^ word >> 31) >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn poisson(&mut self, mean: f64) -> u32 {
        let (limit, mut product, mut count) = ((-mean).exp(), self.unit(), 0);
        while product > limit {
            product *= self.unit();
            count += 1;
        }
        count
    }
}

fn effects(of: &[(f64, bool)]) -> [MineEffect; MARK_KINDS] {
    core::array::from_fn(|kind| {
        let of = of.get(kind).copied().unwrap_or_default();
        MineEffect {
            destroy_probability: of.0,
            detonates: of.1,
        }
    })
}

fn contents(unmarked: [f64; 2], marks: &[(f64, [f64; 2])]) -> Contents {
    let kinds = |[one, other]: [f64; 2]| [one, other, 0.0, 0.0];
    Contents {
        unmarked: kinds(unmarked),
        marks: marks
            .iter()
            .map(|(along, mines)| (*along, kinds(*mines)))
            .collect(),
    }
}

/// How many of a number of simulated convoys lose each vehicle.
fn simulated(
    of: &Contents,
    effects: &[MineEffect; MARK_KINDS],
    vehicles: usize,
    convoys: u32,
) -> Vec<u32> {
    let mut random = Random(7);
    let mut lost = vec![0; vehicles];
    for _ in 0..convoys {
        let mut mines: Vec<(f64, usize, bool)> = Vec::new();
        for (kind, expected) in of.unmarked.iter().enumerate() {
            for _ in 0..random.poisson(*expected) {
                mines.push((random.unit(), kind, false));
            }
        }
        for (along, probabilities) in &of.marks {
            let mut draw = random.unit();
            for (kind, probability) in probabilities.iter().enumerate() {
                if (0.0..*probability).contains(&draw) {
                    mines.push((*along, kind, false));
                }
                draw -= probability;
            }
        }
        mines.sort_by(|one, other| one.0.total_cmp(&other.0));
        for lost in &mut lost {
            for (_, kind, is_gone) in &mut mines {
                let effect = &effects[*kind];
                if !*is_gone && random.unit() < effect.destroy_probability {
                    *lost += 1;
                    *is_gone = effect.detonates;
                    break;
                }
            }
        }
    }
    lost
}

#[test]
fn the_risk_of_the_first_vehicle_is_that_of_independent_mines() {
    let of = contents([0.3, 0.1], &[(0.2, [0.4, 0.1]), (0.9, [0.05, 0.0])]);
    let effects = effects(&[(0.8, true), (0.5, false)]);
    let passes =
        (-(0.3 * 0.8 + 0.1 * 0.5_f64)).exp() * (1.0 - 0.4 * 0.8 - 0.1 * 0.5) * (1.0 - 0.05 * 0.8);
    let risks = of.risks(&effects, 3);
    assert!((risks[0] - (1.0 - passes)).abs() < 1e-12, "{risks:?}");
    assert!((of.expected() - 0.95).abs() < 1e-12);
}

#[test]
fn if_each_mine_destroys_a_vehicle_the_nth_is_lost_with_n_mines() {
    let mean = 1.7_f64;
    let risks = contents([mean, 0.0], &[]).risks(&effects(&[(1.0, true)]), 4);
    let (mut term, mut fewer) = ((-mean).exp(), 0.0);
    for (number, risk) in (1_u32..).zip(risks) {
        fewer += term;
        assert!((risk - (1.0 - fewer)).abs() < 1e-12, "{number}: {risk}");
        term *= mean / f64::from(number);
    }
}

#[test]
fn mines_that_stay_are_as_dangerous_to_the_last_vehicle_as_to_the_first() {
    let of = contents([0.6, 0.0], &[(0.5, [0.3, 0.0])]);
    let risks = of.risks(&effects(&[(0.4, false)]), 5);
    let expected = 1.0 - (-0.6 * 0.4_f64).exp() * (1.0 - 0.3 * 0.4);
    for risk in risks {
        assert!((risk - expected).abs() < 1e-12);
    }
}

/// By chance, one of the ten shares differs by four standard errors with a probability of 0.06%.
#[test]
fn risks_are_the_shares_of_simulated_convoys() {
    let (vehicles, convoys) = (5_u16, 200_000);
    let cases = [
        (
            contents([1.5, 0.0], &[(0.5, [0.6, 0.0])]),
            effects(&[(0.6, true)]),
        ),
        // The order of mines matters here: where, in each part of the path, is left open.
        (
            contents([0.8, 0.7], &[(0.1, [0.3, 0.5]), (0.8, [0.0, 0.9])]),
            effects(&[(0.9, true), (0.3, false)]),
        ),
    ];
    for (of, effects) in cases {
        let stated = of.risks(&effects, vehicles.into());
        let lost = simulated(&of, &effects, vehicles.into(), convoys);
        for (stated, lost) in stated.iter().zip(lost) {
            let share = f64::from(lost) / f64::from(convoys);
            let error = (stated * (1.0 - stated) / f64::from(convoys)).sqrt();
            assert!((share - stated).abs() < 4.0 * error, "{stated} {share}");
        }
    }
}

#[test]
fn with_very_many_mines_all_vehicles_are_lost_and_with_none_no_vehicle_is() {
    let of = effects(&[(0.01, true)]);
    let risks = contents([1e7, 0.0], &[]).risks(&of, 100);
    assert!(risks.iter().all(|risk| *risk > 1.0 - 1e-9), "{risks:?}");
    assert!(
        contents([0.0, 0.0], &[])
            .risks(&of, 3)
            .iter()
            .all(|risk| *risk == 0.0)
    );
}

const LANE: Lane = Lane {
    min_m: [5.0, 10.0],
    max_m: [35.0, 20.0],
    cell_m: 1.0,
    hazards: 1,
};

/// The cells of the best path, and its danger by the sum over the rows that it covers, if it is straight.
fn path(
    passage: &Passage,
    danger: &[f64],
    is_blocked: &dyn Fn(Point) -> bool,
) -> Option<Vec<Point>> {
    let grid = &passage.grid;
    let is_free = |cell: usize| grid.is_inside(cell) && !is_blocked(grid.centre(cell));
    let search = Search {
        grid,
        danger,
        is_free: &is_free,
        width_m: passage.width_m,
    };
    let cells = search.path()?;
    Some(cells.into_iter().map(|cell| grid.centre(cell)).collect())
}

/// Danger where `of` is, on top of some everywhere.
fn danger(passage: &Passage, of: impl Fn(Point) -> f64) -> Vec<f64> {
    let cells = 0..passage.grid.cells();
    cells
        .map(|cell| 1e-6 + of(passage.grid.centre(cell)))
        .collect()
}

#[test]
fn without_a_reason_the_path_is_straight_through_the_middle() {
    let passage = Passage::new(&LANE, 3.0, 1);
    let path = path(&passage, &danger(&passage, |_| 0.0), &|_| false).unwrap();
    assert!(path.iter().all(|at| (at.y - 15.0).abs() < 0.01), "{path:?}");
    assert_eq!(path.len(), 60);
}

#[test]
fn a_path_keeps_clear_of_danger_within_its_width() {
    let passage = Passage::new(&LANE, 3.0, 1);
    let mine = |at: Point| {
        if at.to(Point { x: 20.0, y: 15.4 }).length() < 0.4 {
            1.0
        } else {
            0.0
        }
    };
    let path = path(&passage, &danger(&passage, mine), &|_| false).unwrap();
    let near = path
        .iter()
        .map(|at| at.to(Point { x: 20.0, y: 15.4 }).length());
    let near = near.fold(f64::INFINITY, f64::min);
    // Half of the width, and the size of the mine.
    assert!((1.5..2.8).contains(&near), "{near}");
    assert!(
        path.iter().all(|at| at.y < 15.1),
        "on the side with more room: {path:?}"
    );
}

/// Danger without a pattern: no straight path has a lower cost than the one that was found.
#[test]
fn no_straight_path_is_safer() {
    let passage = Passage::new(&LANE, 2.0, 1);
    let grid = &passage.grid;
    for seed in 0..20 {
        let mut random = Random(seed);
        let danger: Vec<f64> = (0..grid.cells()).map(|_| random.unit().powi(6)).collect();
        let found = path(&passage, &danger, &|_| false).unwrap();
        let cost_of = |path: &[Point]| {
            let covered = (0..grid.cells()).map(|cell| {
                let away_m = path.iter().map(|at| at.to(grid.centre(cell)).length());
                if away_m.fold(f64::INFINITY, f64::min) < 1.0 {
                    danger[cell]
                } else {
                    0.0
                }
            });
            covered.sum::<f64>()
        };
        let own = cost_of(&found);
        for row in (0..grid.rows).filter(|row| grid.is_inside(*row)) {
            let straight = (0..grid.columns).map(|column| grid.centre(column * grid.rows + row));
            let straight: Vec<Point> = straight.collect();
            assert!(
                own < 1.05 * cost_of(&straight),
                "{seed}: {own} {}",
                cost_of(&straight)
            );
        }
    }
}

#[test]
fn obstacles_are_avoided_and_may_leave_no_room() {
    let passage = Passage::new(&LANE, 3.0, 1);
    let danger = danger(&passage, |_| 0.0);
    let wall = |from_m: f64, to_m: f64| {
        move |at: Point| (at.x - 20.0).abs() < 2.0 && at.y > from_m && at.y < to_m
    };
    let around = path(&passage, &danger, &wall(10.0, 17.0)).unwrap();
    assert!(around.iter().any(|at| at.y > 17.0));
    assert!(around.iter().all(|at| !wall(10.0, 17.0)(*at)));
    assert!(path(&passage, &danger, &wall(10.0, 20.0)).is_none());
}

#[test]
fn the_sides_of_the_lane_leave_room_for_the_width() {
    for (width_m, lane) in [(10.0, LANE), (3.0, LANE), (9.0, LANE)] {
        let passage = Passage::new(&lane, width_m, 1);
        let path = path(&passage, &danger(&passage, |at| at.y), &|_| false).unwrap();
        for at in path {
            let side_m = (at.y - 10.0).min(20.0 - at.y);
            assert!(side_m > width_m / 2.0 - 1e-5, "{width_m}: {at:?}");
        }
    }
}

#[test]
fn the_grid_of_any_lane_is_bounded_and_lies_along_its_longer_side() {
    for (x, y, width_m) in [
        (200.0, 20.0, 3.0),
        (20.0, 200.0, 0.05),
        (1e5, 1e5, 0.1),
        (5.0, 0.5, 0.5),
    ] {
        let area = Rectangle::spanned(
            Point { x: 1.0, y: 2.0 },
            Point {
                x: 1.0 + x,
                y: 2.0 + y,
            },
        );
        let grid = PassageGrid::new(area, width_m);
        assert!(grid.cells() < 70_000, "{}", grid.cells());
        assert!((0..grid.cells()).all(|cell| area.contains(grid.centre(cell))));
        let ends = [grid.end(0, false), grid.end(0, true)];
        assert!((ends[0].to(ends[1]).length() - x.max(y)).abs() < 1e-6);
        assert!((0..grid.rows).any(|row| grid.is_inside(row)));
    }
}
