//! Marks of several robots, fused.

use super::simulated::{clearance, picture};
use crate::clearance::LanePicture;
use brain::{AgentId, Coverage, GoalId, Mark, MarkVerdict, Statement};

const OAV: AgentId = AgentId::robot(0, 0);
const UGV: AgentId = AgentId::robot(1, 0);

fn mark(robot: AgentId, x_m: f32, deviation_m: f32, log_ratio: f32) -> Mark {
    Mark {
        id: GoalId {
            issuer: robot.into(),
            number: 0,
        },
        at_m: [x_m, 1.0],
        deviation_mm: Mark::millimetres(deviation_m.into()),
        log_ratios: [log_ratio, log_ratio - 1.0, 0.0, 0.0],
        missed_since: 0,
        further: 0,
    }
}

fn looked(picture: &mut LanePicture, robot: AgentId, nats: f64) {
    for first in (0..50).step_by(16) {
        let missed = [Coverage::steps(nats); 16];
        picture.take_coverage(
            robot,
            &Coverage {
                first,
                marks: 0,
                missed,
                driven: [0; 16],
            },
        );
    }
}

fn lane() -> LanePicture {
    picture(&clearance([4.0, 4.0], [0.2, 0.01]))
}

#[test]
fn marks_within_four_joint_deviations_are_one_place_at_their_weighted_mean() {
    let mut picture = lane();
    picture.take_mark(OAV, &mark(OAV, 10.0, 0.4, 3.0));
    picture.take_mark(UGV, &mark(UGV, 11.0, 0.2, 3.0));
    let places: Vec<_> = picture.marks().collect();
    assert_eq!(places.len(), 1);
    assert!((places[0].at.x - 10.8).abs() < 1e-6);
    assert!((places[0].deviation_m - (0.032_f64).sqrt()).abs() < 1e-6);
    picture.take_mark(UGV, &mark(UGV, 12.0, 0.2, 3.0));
    assert_eq!(picture.marks().count(), 2, "it has moved away");
}

#[test]
fn two_marks_of_one_robot_are_two_places() {
    let mut picture = lane();
    picture.take_mark(OAV, &mark(OAV, 10.0, 0.4, 3.0));
    let mut second = mark(OAV, 10.1, 0.4, 3.0);
    second.id.number = 1;
    picture.take_mark(OAV, &second);
    assert_eq!(picture.marks().count(), 2);
    picture.take_mark(UGV, &second);
    assert_eq!(picture.marks().count(), 2, "the mark names another robot");
}

#[test]
fn a_second_robot_that_agrees_makes_a_mark_probable() {
    let mut picture = lane();
    picture.take_mark(OAV, &mark(OAV, 10.0, 0.4, 3.0));
    let one = picture.marks().next().unwrap().mine;
    picture.take_mark(UGV, &mark(UGV, 10.1, 0.4, 3.0));
    let both = picture.marks().next().unwrap().mine;
    assert!(both > 3.0 * one, "{one} {both}");
}

#[test]
fn a_mark_that_another_model_misses_is_explained_by_its_blindness_or_by_nothing_there() {
    let mine = |looks: f64, robot| {
        let mut picture = lane();
        picture.take_mark(OAV, &mark(OAV, 10.0, 0.4, 6.0));
        looked(&mut picture, robot, looks);
        picture.marks().next().unwrap().mine
    };
    assert!(mine(5.0, UGV) < 0.2 * mine(0.0, UGV));
    // More looks change nothing once the model is probably blind to it.
    assert!((mine(14.0, UGV) / mine(12.0, UGV) - 1.0).abs() < 0.01);
    // The looks of the robot itself are already in its mark.
    assert_eq!(mine(5.0, OAV), mine(0.0, OAV));
}

/// Another robot of the model of the false alarm does not detect the mine, to which that model is blind: a mark of the
/// model is no evidence that it can detect it.
#[test]
fn a_false_alarm_beside_a_mine_does_not_turn_the_looks_of_that_model_into_evidence_against_it() {
    let other = AgentId { index: 1, ..OAV };
    let mine = |has_false_alarm: bool| {
        let mut picture = lane();
        picture.take_mark(UGV, &mark(UGV, 10.0, 0.1, 15.0));
        if has_false_alarm {
            picture.take_mark(OAV, &mark(OAV, 11.0, 0.4, 2.0));
        }
        looked(&mut picture, other, 12.0);
        assert_eq!(picture.marks().count(), 1);
        picture.marks().next().unwrap().mine
    };
    let (alone, beside) = (mine(false), mine(true));
    assert!(alone > 0.5 && beside > 0.9 * alone, "{alone} {beside}");
}

#[test]
fn looks_of_a_robot_count_only_with_all_of_its_marks() {
    let mut picture = lane();
    let before = picture.risk().unmarked;
    let coverage = Coverage {
        first: 0,
        marks: 1,
        missed: [32; 16],
        driven: [0; 16],
    };
    picture.take_coverage(OAV, &coverage);
    assert_eq!(
        (picture.missing_marks(), picture.risk().unmarked),
        (1, before)
    );
    picture.take_mark(OAV, &mark(OAV, 10.0, 0.4, 3.0));
    picture.take_coverage(OAV, &coverage);
    assert!(picture.missing_marks() == 0 && picture.risk().unmarked < before);
}

#[test]
fn only_a_place_that_has_been_neutralised_holds_no_mine() {
    let mut picture = lane();
    let mark = mark(OAV, 10.0, 0.4, 9.0);
    picture.take_mark(OAV, &mark);
    let mine = |picture: &LanePicture| picture.marks().next().unwrap().mine;
    let state = |picture: &mut LanePicture, verdict| {
        picture.take_statement(&Statement {
            mark: mark.id,
            at_m: mark.at_m,
            verdict,
        });
    };
    let before = mine(&picture);
    for verdict in [
        MarkVerdict::Confirmed,
        MarkVerdict::Rejected,
        MarkVerdict::Isolated,
    ] {
        state(&mut picture, verdict);
        assert_eq!(mine(&picture), before);
    }
    state(&mut picture, MarkVerdict::Neutralised);
    state(&mut picture, MarkVerdict::Confirmed);
    assert_eq!(mine(&picture), 0.0);
}

fn numbered(number: u32, mark: Mark) -> Mark {
    let id = GoalId { number, ..mark.id };
    Mark { id, ..mark }
}

fn destroy(picture: &mut LanePicture, mark: &Mark) {
    picture.take_statement(&Statement {
        mark: mark.id,
        at_m: mark.at_m,
        verdict: MarkVerdict::Neutralised,
    });
}

/// A charge destroys one item, of which the marks can be several places: the other marks are mostly of the same item.
#[test]
fn what_is_marked_beside_a_destroyed_mine_is_improbable_and_looks_since_then_end_it() {
    let mut picture = lane();
    let first = mark(OAV, 10.0, 0.1, 9.0);
    let beside = numbered(1, mark(OAV, 10.2, 0.1, 9.0));
    let away = numbered(2, mark(OAV, 14.0, 0.1, 9.0));
    for mark in [first, beside, away] {
        picture.take_mark(OAV, &mark);
    }
    let mines = |picture: &LanePicture| picture.marks().map(|mark| mark.mine).collect::<Vec<_>>();
    let before = mines(&picture);
    destroy(&mut picture, &first);
    let after = mines(&picture);
    assert_eq!(after[0], 0.0);
    // Another mine is rare, but a robot has two marks of one item only in one of ten cases.
    assert!(after[1] < 0.3 * before[1] && after[1] > 0.01, "{after:?}");
    assert_eq!(after[2], before[2]);
    picture.take_mark(
        OAV,
        &Mark {
            missed_since: 96,
            further: 0,
            ..beside
        },
    );
    assert!(mines(&picture)[1] < 0.01 * after[1]);
}

/// Looks before the charge were at the item that it has destroyed.
#[test]
fn only_looks_after_a_charge_count_for_the_mines_beside_the_destroyed_one() {
    let searched = |ugv_nats: f64| {
        let mut picture = lane();
        looked(&mut picture, OAV, 8.0);
        looked(&mut picture, UGV, ugv_nats);
        picture
    };
    let mut picture = searched(8.0);
    let several = Mark {
        further: 100,
        ..mark(UGV, 10.0, 0.2, 9.0)
    };
    picture.take_mark(UGV, &several);
    picture.take_statement(&Statement {
        mark: several.id,
        at_m: several.at_m,
        verdict: MarkVerdict::Neutralised,
    });
    let beside = picture.risk().expected() - searched(8.0).risk().expected();
    assert!((beside - 1.0).abs() < 1e-6, "{beside}");
    looked(&mut picture, UGV, 12.0);
    let beside = picture.risk().expected() - searched(12.0).risk().expected();
    // The model that has shown the mine is not blind to it.
    let missed = (-4.0_f64).exp();
    assert!((beside - missed).abs() < 1e-6, "{beside} {missed}");
}

#[test]
fn a_mark_after_a_charge_is_of_another_item_than_the_marks_before_it() {
    let mut picture = lane();
    let first = mark(UGV, 10.0, 0.1, 9.0);
    picture.take_mark(UGV, &first);
    picture.take_mark(OAV, &mark(OAV, 10.5, 0.4, 6.0));
    destroy(&mut picture, &first);
    picture.take_mark(UGV, &numbered(1, mark(UGV, 10.3, 0.1, 9.0)));
    let mines: Vec<f64> = picture.marks().map(|mark| mark.mine).collect();
    assert!(
        mines.len() == 2 && mines[0] == 0.0 && mines[1] > 0.5,
        "{mines:?}"
    );
}

#[test]
fn many_marks_of_one_robot_at_one_spot_are_three_places() {
    let mut picture = lane();
    for (number, x_m) in (0..12).zip([10.0, 10.05, 10.1].into_iter().cycle()) {
        picture.take_mark(UGV, &numbered(number, mark(UGV, x_m, 0.1, 9.0)));
    }
    assert_eq!((picture.marks().count(), picture.missing_marks()), (3, 0));
}

/// The believed density of mines is the sum of both parts.
#[test]
fn mines_near_a_mark_belong_to_it_and_mines_far_from_all_marks_to_none() {
    let mut picture = lane();
    assert_eq!(
        picture.share_of_marks(picture.clearance().lane.centre(7)),
        0.0
    );
    picture.take_mark(OAV, &mark(OAV, 10.0, 0.2, 9.0));
    let share = |x: f64| picture.share_of_marks(base::geometry::Point { x, y: 1.0 });
    assert!(
        share(10.0) > 0.99 && share(12.0) < 1e-6,
        "{} {}",
        share(10.0),
        share(12.0)
    );
}

/// Controllers receive statements about goals of other controllers.
#[test]
fn a_statement_about_an_unknown_goal_is_about_the_nearest_place() {
    let mut picture = lane();
    for (number, x_m) in [(0, 10.0), (1, 12.0)] {
        let mut mark = mark(OAV, x_m, 0.1, 9.0);
        mark.id.number = number;
        picture.take_mark(OAV, &mark);
    }
    let mut state = |x_m| {
        picture.take_statement(&Statement {
            mark: GoalId {
                issuer: AgentId::OPERATOR.into(),
                number: 7,
            },
            at_m: [x_m, 1.0],
            verdict: MarkVerdict::Confirmed,
        });
        let verdicts = picture.marks().map(|mark| mark.verdict.is_some());
        verdicts.collect::<Vec<bool>>()
    };
    assert_eq!(state(14.0), [false, false]);
    assert_eq!(state(11.2), [false, true]);
}

#[test]
fn a_mark_just_beyond_the_border_counts_and_one_far_beyond_does_not() {
    let marked = |x_m| {
        let mut picture = lane();
        picture.take_mark(OAV, &mark(OAV, x_m, 0.2, 9.0));
        picture.risk().marked
    };
    assert!(marked(4.6) > 0.5 && marked(4.6) == marked(5.4));
    assert_eq!(marked(4.3), 0.0);
}
