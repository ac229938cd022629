//! Liveness: goals of lost agents have an owner or are reported, and are offered, within
//! [`Settings::recovery_s`].

use crate::network::Weather;
use crate::team::{STEP_S, Station, Team, goal_id};
use brain::GoalId;
use economy::{Controller, Settings};
use proptest::prelude::*;

const GOALS: u32 = 16;
const MAX_DELAY_S: f64 = 0.3;

/// What is lost, and returns.
#[derive(Debug, Clone, Copy)]
enum Loss {
    Controller(usize),
    /// A controller that restarts after a time.
    Restarted(usize, f64),
    /// A controller whose radio fails for a time.
    CutOff(usize, f64),
}

fn loss() -> impl Strategy<Value = Loss> {
    let which = 0..3_usize;
    let time_s = 1.0..60.0_f64;
    prop_oneof![
        which.clone().prop_map(Loss::Controller),
        (which.clone(), time_s.clone()).prop_map(|(which, time_s)| Loss::Restarted(which, time_s)),
        (which, time_s).prop_map(|(which, time_s)| Loss::CutOff(which, time_s)),
    ]
}

fn settings(service_lease_s: f64, owner_lease_s: f64) -> Settings {
    Settings {
        service_lease_s,
        owner_lease_s,
        max_drift: 0.01,
        ..Settings::default()
    }
}

/// Lets a team work for a time, loses an agent, and returns the time from which all work again.
fn disturbed(team: &mut Team, start_s: f64, loss: Loss) -> f64 {
    // This robot is not there before: it has no award.
    team.crash_robot(0);
    team.run(start_s);
    match loss {
        Loss::Controller(index) => team.crash_station(index),
        Loss::Restarted(index, time_s) => {
            team.crash_station(index);
            team.run(time_s);
            team.restart_station(index);
        }
        Loss::CutOff(index, time_s) => {
            team.stations[index].is_cut_off = true;
            team.run(time_s);
            team.stations[index].is_cut_off = false;
        }
    }
    team.restart_robot(0);
    team.now_s
}

fn has_lost(station: &Station, goal: GoalId) -> bool {
    let controller = station.controller.as_ref();
    controller.is_some_and(|controller| controller.lost().any(|task| task.id == goal))
}

/// The goals that a working agent knew when the last disturbance was over.
fn known(team: &Team) -> Vec<GoalId> {
    let working = || team.stations.iter().filter_map(|it| it.controller.as_ref());
    let is_known = |goal: &GoalId| working().any(|controller| controller.knows(*goal));
    (0..GOALS).map(goal_id).filter(is_known).collect()
}

/// Goals that a working agent knew, and those of them that recovered in time, with lost messages.
fn recovered(
    seed: u64,
    leases: (f64, f64),
    (start_s, event): (f64, Loss),
    loss: f64,
) -> [usize; 2] {
    let settings = settings(leases.0, leases.1);
    let weather = Weather {
        max_delay_s: MAX_DELAY_S,
        loss,
        ..Weather::default()
    };
    let mut team = Team::new([3, 3], &settings, weather, seed);
    // Too far to be served: all stay open.
    team.issue_random(GOALS, 1e6);
    let since_s = disturbed(&mut team, start_s, event);
    let known = known(&team);
    team.run(settings.recovery_s(GOALS, STEP_S, MAX_DELAY_S));
    let recovered = known
        .iter()
        .filter(|goal| has_recovered(&team, **goal, since_s));
    [known.len(), recovered.count()]
}

/// Whether a goal has one owner or is reported, and has been called if it waits for a robot.
fn has_recovered(team: &Team, goal: GoalId, since_s: f64) -> bool {
    let stations = team.stations.iter();
    let owners = stations.filter(|it| Team::owns(it, goal, team.now_s));
    let owners: Vec<&Station> = owners.collect();
    let [owner] = owners[..] else {
        return team.stations.iter().any(|station| has_lost(station, goal));
    };
    let mut goals = owner.controller.iter().flat_map(Controller::goals);
    let open = goals.find(|owned| owned.task.id == goal);
    let waits = open.is_some_and(|owned| owned.assignee.is_none() && owned.unserved.is_none());
    let mut calls = team.calls.iter();
    !waits || calls.any(|(at_s, id)| *at_s > since_s && *id == goal)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, max_shrink_iters: 20, ..ProptestConfig::default() })]

    #[test]
    fn goals_of_lost_controllers_are_owned_or_reported_and_offered_in_time(
        seed in any::<u64>(),
        leases in (4.0..15.0_f64, 4.0..15.0_f64),
        start_s in 15.0..40.0_f64,
        loss in loss(),
    ) {
        let [known, recovered] = recovered(seed, leases, (start_s, loss), 0.0);
        prop_assert!(known > 0);
        prop_assert_eq!(known, recovered);
    }
}

#[test]
fn with_a_tenth_of_the_messages_lost_at_least_99_percent_recover_in_time() {
    let losses = [
        Loss::Controller(0),
        Loss::Controller(2),
        Loss::Restarted(1, 20.0),
        Loss::CutOff(2, 30.0),
        Loss::CutOff(0, 10.0),
    ];
    let mut all = [0, 0];
    for seed in 0..20 {
        for loss in losses {
            let [known, recovered] = recovered(seed, (8.0, 12.0), (30.0, loss), 0.1);
            all = [all[0] + known, all[1] + recovered];
        }
    }
    let [known, recovered] = all;
    assert!(
        known > 1000 && 100 * recovered >= 99 * known,
        "{recovered} of {known}"
    );
}
