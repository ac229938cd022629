use super::*;
use crate::sensors::range::tests::{instruction_sets, with_set};
use base::random::{Entity, Purpose, stream, unit};
use brain::behaviours::flock::Sums;
use proptest::prelude::*;
use pulp::Arch;

const SIDE_M: f64 = 40.0;

/// By kind: squares of the range and of the separation distance.
const LIMITS: [[f64; 2]; 3] = [[25.0, 1.0], [9.0, 16.0], [-1.0, -1.0]];

/// Robots of three kinds anywhere on a square.
fn team(robots: u32, seed: u64, side_m: f64) -> (Torus, Vec<AgentId>, Vec<Disc>, Vec<Orientation>) {
    let mut random = stream(seed, 0, Entity { kind: 0, index: 0 }, Purpose::Start);
    let mut up_to = |most: f64| most * unit(&mut random);
    let each = (0..robots).map(|index| {
        let kind = [0, 1, 2][index as usize % 3];
        let centre = Point {
            x: up_to(side_m),
            y: up_to(side_m),
        };
        let disc = Disc {
            centre,
            radius_m: 0.0,
        };
        (
            AgentId::robot(kind, index),
            disc,
            Orientation::new(up_to(6.0)),
        )
    });
    let (mut ids, mut discs, mut orientations) = (Vec::new(), Vec::new(), Vec::new());
    for (id, disc, course) in each {
        ids.push(id);
        discs.push(disc);
        orientations.push(course);
    }
    let corner = Point {
        x: side_m,
        y: side_m,
    };
    (Torus { size_m: corner }, ids, discs, orientations)
}

/// The sums of each robot, by its number.
fn sums(robots: u32, seed: u64, side_m: f64) -> Vec<Sums> {
    let (torus, ids, discs, orientations) = team(robots, seed, side_m);
    let mut flock = Flock::new(torus, 5.0);
    flock.fill(&ids, &discs, &orientations, false);
    let mut sorted = vec![Sums::default(); ids.len()];
    // In chunks, as threads process them.
    for (piece, sums) in sorted.chunks_mut(7).enumerate() {
        flock.sums(7 * piece, |kind| LIMITS[usize::from(kind)], sums);
    }
    let places = flock.places.iter();
    places.map(|place| sorted[*place as usize]).collect()
}

/// The same, from all pairs.
fn plain_sums(robots: u32, seed: u64, side_m: f64) -> Vec<Sums> {
    let (torus, ids, discs, orientations) = team(robots, seed, side_m);
    let of = |robot: usize| {
        let [reach, near] = LIMITS[usize::from(ids[robot].kind)];
        let at = discs[robot].centre;
        let mut sums = Sums::default();
        for other in (0..discs.len()).filter(|other| *other != robot) {
            let way = at.to(torus.image(at, discs[other].centre));
            if way.length_squared() <= reach {
                sums.count += 1.0;
                sums.way = sums.way.plus(way);
                sums.course = sums.course.plus(orientations[other].front);
            }
            if way.length_squared() < near.min(reach) {
                sums.way_to_near = sums.way_to_near.plus(way);
            }
        }
        sums
    };
    (0..discs.len()).map(of).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn sums_are_those_of_all_pairs(robots in 1_u32..400, seed: u64, side_m in 10.1..300.0_f64) {
        let (found, expected) = (sums(robots, seed, side_m), plain_sums(robots, seed, side_m));
        for (robot, (found, expected)) in found.iter().zip(&expected).enumerate() {
            if robot % 3 == 2 {
                // The sums of a robot that does not flock are unused.
                continue;
            }
            let off_m = [
                found.way.to(expected.way).length(),
                found.course.to(expected.course).length(),
                found.way_to_near.to(expected.way_to_near).length(),
            ];
            prop_assert_eq!(found.count, expected.count);
            prop_assert!(off_m.iter().all(|off_m| *off_m < 1e-10), "{:?} {:?}", found, expected);
        }
    }
}

#[test]
fn a_strips_cells_are_numbered_row_by_row() {
    let cells = [2 * STRIP + 3, 5];
    let all: Vec<[usize; 2]> = (0..cells[0] * cells[1])
        .map(|number| place(number, cells))
        .collect();
    for (number, [column, row]) in all.iter().enumerate() {
        assert_eq!(cell(*column, *row, cells), number);
        assert!(*column < cells[0] && *row < cells[1]);
    }
}

#[test]
fn sums_have_the_same_bits_in_every_instruction_set() {
    let bits = |arch| {
        let all = with_set(arch, || sums(900, 1, SIDE_M));
        let numbers = all.into_iter().flat_map(|sums| {
            let [way, course, near] = [sums.way, sums.course, sums.way_to_near];
            [sums.count, way.x, way.y, course.x, course.y, near.x, near.y]
        });
        numbers.map(f64::to_bits).collect::<Vec<u64>>()
    };
    let plain = bits(Arch::Scalar);
    for arch in instruction_sets() {
        assert_eq!(bits(arch), plain, "{arch:?}");
    }
}
