//! The goals that follow from beliefs, and the decision.

use super::simulated::{clearance, picture};
use crate::clearance::plan::{Circumstances, MAX_INTERROGATIONS, Plan, Subject};
use crate::clearance::{Charge, Clearance, Decision, LanePicture, Skill};
use brain::{AgentId, Coverage, GoalId, Mark, MarkVerdict, Statement};

const OAV: AgentId = AgentId::robot(0, 0);
const UGV: AgentId = AgentId::robot(1, 0);

/// OAVs with capability 1 survey with two nats, UGVs with capability 2 search with one.
fn able() -> Clearance {
    let skill = |capability| Skill {
        capability,
        service_s: 2.0,
    };
    let mut clearance = clearance([4.0, 4.0], [0.05, 0.02]);
    clearance.searches = vec![skill(1), skill(2)];
    clearance.interrogate = Some(skill(2));
    clearance.neutralise = Some(Charge {
        skill: skill(2),
        success_probability: 0.9,
        reach_m: 1.0,
    });
    for (robot, (capability, nats)) in clearance.robots.iter_mut().zip([(1, 2.0), (2, 1.0)]) {
        (robot.capabilities, robot.search_nats) = (vec![capability], nats);
    }
    clearance
}

fn planned(picture: &LanePicture, kinds: &[u8], interrogations: u32) -> Plan {
    let interrogations = |_| interrogations;
    Plan::new(
        picture,
        &Circumstances {
            kinds,
            interrogations: &interrogations,
            is_impossible: &|_| false,
            is_vain: &|_| false,
            is_own: &|_| true,
            others_gain: 0.0,
        },
    )
}

fn subjects(picture: &LanePicture, interrogations: u32) -> Vec<Subject> {
    let plan = planned(picture, &[0, 1], interrogations);
    plan.proposals.iter().map(|wanted| wanted.subject).collect()
}

fn searched(picture: &mut LanePicture, robot: AgentId, nats: f64) {
    for first in (0..50).step_by(16) {
        let missed = [Coverage::steps(nats); 16];
        let marks = 0;
        picture.take_coverage(
            robot,
            &Coverage {
                first,
                marks,
                missed,
                driven: [0; 16],
            },
        );
    }
}

fn marked(picture: &mut LanePicture, log_ratio: f32) {
    let mark = Mark {
        id: GoalId {
            issuer: OAV.into(),
            number: 0,
        },
        at_m: [12.0, 1.0],
        deviation_mm: 500,
        log_ratios: [log_ratio, log_ratio - 2.0, 0.0, 0.0],
        missed_since: 0,
        further: 0,
    };
    picture.take_mark(OAV, &mark);
}

fn stated(picture: &mut LanePicture, verdict: MarkVerdict) {
    picture.take_statement(&Statement {
        mark: GoalId {
            issuer: UGV.into(),
            number: 0,
        },
        at_m: [12.0, 1.0],
        verdict,
    });
}

#[test]
fn each_tile_is_searched_in_each_way_first_by_the_better_sensor() {
    let wanted = planned(&picture(&able()), &[0, 1], 0).proposals;
    assert_eq!(wanted.len(), 4, "two tiles of 10 m, two ways");
    let value = |tile, search| {
        let mut wanted = wanted.iter();
        let subject = Subject::Tile { tile, search };
        wanted.find(|one| one.subject == subject).unwrap().value
    };
    // Two mines in a tile: those that the OAV can detect, and does with two nats.
    assert!((value(0, 0) - 2.0 * 0.95 * (1.0 - (-2.0_f64).exp())).abs() < 1e-6);
    assert!(value(1, 0) > value(1, 1));
}

#[test]
fn a_tile_that_has_been_searched_is_left_to_the_other_sensor() {
    let mut picture = picture(&able());
    searched(&mut picture, OAV, 15.0);
    let ways = subjects(&picture, 0)
        .into_iter()
        .map(|subject| match subject {
            Subject::Tile { search, .. } => search,
            _ => panic!("there is no mark"),
        });
    assert_eq!(ways.collect::<Vec<u8>>(), [1, 1]);
}

#[test]
fn a_mark_is_interrogated_and_neutralised_when_it_is_confirmed() {
    let mut picture = picture(&able());
    marked(&mut picture, 6.0);
    let (suspect, mine) = (Subject::Suspect { place: 0 }, Subject::Mine { place: 0 });
    let is_proposed = |picture: &LanePicture, subject| subjects(picture, 0).contains(&subject);
    assert!(is_proposed(&picture, suspect) && !is_proposed(&picture, mine));
    stated(&mut picture, MarkVerdict::Rejected);
    assert!(is_proposed(&picture, suspect), "a mine is still probable");
    assert!(!subjects(&picture, MAX_INTERROGATIONS).contains(&suspect));
    stated(&mut picture, MarkVerdict::Confirmed);
    assert!(!is_proposed(&picture, suspect) && is_proposed(&picture, mine));
    let wanted = planned(&picture, &[1], 0).proposals;
    let wanted = wanted.iter().find(|wanted| wanted.subject == mine).unwrap();
    assert!((wanted.radius_m - 1.5).abs() < 1e-6, "three deviations");
    stated(&mut picture, MarkVerdict::Neutralised);
    assert!(!is_proposed(&picture, suspect) && !is_proposed(&picture, mine));
}

#[test]
fn a_mark_that_the_ground_sensor_misses_is_not_interrogated() {
    let mut picture = picture(&able());
    marked(&mut picture, 4.0);
    let suspect = Subject::Suspect { place: 0 };
    assert!(subjects(&picture, 0).contains(&suspect));
    searched(&mut picture, UGV, 10.0);
    assert!(!subjects(&picture, 0).contains(&suspect));
}

/// A mark below `interrogate_above` is worth a visit only if it keeps the lane from being declared clear, and looks do
/// not settle its kind.
#[test]
fn a_mark_that_may_be_a_lookalike_is_neutralised_when_the_rest_of_the_lane_is_searched() {
    let mut known = able();
    known.robots[0].lookalike_share = vec![vec![0.98, 0.02], vec![0.0, 1.0]];
    (known.interrogate_above, known.declare_below) = (0.06, 0.01);
    let mut plain = known.clone();
    plain.robots[0].lookalike_share.clear();
    let (suspect, mine) = (Subject::Suspect { place: 0 }, Subject::Mine { place: 0 });
    // All looks of the OAV report clutter.
    let picture_of = |clearance: &Clearance, nats: f64| {
        let mut picture = picture(clearance);
        let id = GoalId {
            issuer: OAV.into(),
            number: 0,
        };
        picture.take_mark(
            OAV,
            &Mark {
                id,
                at_m: [12.0, 1.0],
                deviation_mm: 300,
                log_ratios: [-20.0, 12.0, 0.0, 0.0],
                missed_since: 0,
                further: 0,
            },
        );
        searched(&mut picture, OAV, nats);
        searched(&mut picture, UGV, nats);
        picture
    };
    let clear = picture_of(&known, 15.0);
    let probability = clear.marks().next().unwrap().mine;
    assert!((0.001..0.06).contains(&probability), "{probability}");
    assert!(subjects(&clear, 0).contains(&suspect));
    assert!(subjects(&clear, MAX_INTERROGATIONS).contains(&mine));
    for other in [picture_of(&known, 0.0), picture_of(&plain, 15.0)] {
        let subjects = subjects(&other, 0);
        assert!(!subjects.contains(&suspect) && !subjects.contains(&mine));
    }
}

#[test]
fn a_lane_is_declared_clear_when_the_stated_risk_is_low_enough() {
    let mut picture = picture(&able());
    let mut decision = Decision::default();
    let plan = planned(&picture, &[0, 1], 0);
    decision.decide(&picture, &plan, 1.0);
    assert_eq!(decision.statement, None);
    searched(&mut picture, OAV, 15.0);
    searched(&mut picture, UGV, 15.0);
    let plan = planned(&picture, &[0, 1], 0);
    decision.decide(&picture, &plan, 2.0);
    let statement = decision.statement.unwrap();
    assert!(statement.is_clear && (statement.risk - picture.clearance().floor()).abs() < 1e-4);
    marked(&mut picture, 6.0);
    decision.decide(&picture, &plan, 3.0);
    assert_eq!(decision.statement, Some(statement), "it is stated once");
}

#[test]
fn a_lane_is_not_declared_clear_while_marks_are_missing() {
    let mut picture = picture(&able());
    searched(&mut picture, OAV, 15.0);
    searched(&mut picture, UGV, 15.0);
    picture.take_coverage(
        OAV,
        &Coverage {
            first: 0,
            marks: 1,
            missed: [255; 16],
            driven: [0; 16],
        },
    );
    let mut decision = Decision::default();
    decision.decide(&picture, &planned(&picture, &[0, 1], 0), 1.0);
    assert_eq!(decision.statement, None);
}

/// Without UGVs, the lane is given up once the OAVs cannot lower the risk any more.
#[test]
fn a_lane_is_given_up_after_a_time_in_which_no_robot_can_lower_the_risk() {
    let given_up = |nats, kinds: &[u8]| {
        let mut picture = picture(&able());
        searched(&mut picture, OAV, nats);
        let plan = planned(&picture, kinds, 0);
        let mut decision = Decision::default();
        decision.decide(&picture, &plan, 0.0);
        decision.decide(&picture, &plan, 59.0);
        assert_eq!(decision.statement, None);
        decision.decide(&picture, &plan, 60.0);
        decision.statement
    };
    assert_eq!(given_up(1.0, &[0]), None);
    assert_eq!(given_up(15.0, &[0, 1]), None);
    let statement = given_up(15.0, &[0]).unwrap();
    assert!(!statement.is_clear && statement.risk > 0.1);
    assert!(given_up(0.0, &[]).is_some(), "no robot is in range");
}
