use super::*;

fn problem(costs: &[f64]) -> RequirementProblem {
    RequirementProblem {
        costs: costs.to_vec(),
        probability: 0.9,
        tolerance: 0.05,
        finer: None,
        confidence: 0.95,
    }
}

#[expect(clippy::cast_precision_loss, reason = "few")]
fn count(runs: u64, share: f64) -> f64 {
    (runs as f64 * share).floor()
}

/// Runs a procedure in which the share of runs that meet the requirement is exactly the given one.
fn ended(problem: RequirementProblem, shares: &[f64]) -> Requirement {
    let mut procedure = Requirement::new(problem);
    record_until(&mut procedure, shares, |_| false);
    procedure
}

fn record_until(
    procedure: &mut Requirement,
    shares: &[f64],
    is_enough: impl Fn(&Requirement) -> bool,
) {
    while let Some(request) = procedure.next().filter(|_| !is_enough(procedure)) {
        let share = shares[request.configurations[0]];
        let runs = request.first_run..request.first_run + request.runs as u64;
        let met = runs.map(|run| count(run + 1, share) - count(run, share));
        procedure.record(&met.collect::<Vec<f64>>());
    }
}

#[test]
fn the_cheapest_that_meets_it_is_selected_whatever_the_order() {
    let shares = [1.0, 0.2, 0.99, 0.5];
    assert_eq!(
        ended(problem(&[4.0, 1.0, 3.0, 2.0]), &shares).selected(),
        Some(2)
    );
    assert_eq!(
        ended(problem(&[1.0, 2.0, 3.0, 4.0]), &shares).selected(),
        Some(0)
    );
}

#[test]
fn nothing_is_selected_if_none_meets_it() {
    let procedure = ended(problem(&[1.0, 2.0]), &[0.5, 0.8]);
    assert_eq!(procedure.selected(), None);
    assert_eq!(procedure.eliminations().len(), 2);
    assert!(procedure.survivors().is_empty() && procedure.certified().is_empty());
}

#[test]
fn those_that_are_dearer_than_a_certified_one_are_not_run() {
    let procedure = ended(problem(&[1.0, 2.0, 3.0, 3.0]), &[0.3, 1.0, 1.0, 1.0]);
    assert_eq!(procedure.selected(), Some(1));
    assert_eq!(procedure.runs()[2..], [0, 0]);
    assert_eq!(procedure.survivors(), [1]);
}

fn finer(costs: &[f64]) -> RequirementProblem {
    RequirementProblem {
        finer: Some(0.0125),
        ..problem(costs)
    }
}

#[test]
fn a_cheaper_one_within_the_tolerance_is_selected_at_a_finer_one() {
    let shares = [0.8, 0.91, 0.999];
    let costs = [1.0, 2.0, 3.0];
    assert_eq!(ended(problem(&costs), &shares).selected(), Some(2));
    let procedure = ended(finer(&costs), &shares);
    assert_eq!(procedure.selected(), Some(1));
    assert_eq!(procedure.certified(), [1, 2]);
}

#[test]
fn a_cheaper_one_below_the_requirement_is_refuted_at_the_finer_tolerance_too() {
    let procedure = ended(finer(&[1.0, 2.0]), &[0.89, 0.999]);
    assert_eq!(
        (procedure.selected(), procedure.survivors()),
        (Some(1), vec![1])
    );
    assert!(procedure.runs()[0] > 3 * ended(problem(&[1.0, 2.0]), &[0.89, 0.999]).runs()[0]);
}

#[test]
fn the_first_question_is_settled_as_without_a_finer_one() {
    let shares = [0.91, 0.999];
    let alone = ended(problem(&[1.0, 2.0]), &shares);
    let mut procedure = Requirement::new(finer(&[1.0, 2.0]));
    record_until(&mut procedure, &shares, Procedure::is_settled);
    assert_eq!(procedure.runs(), alone.runs());
    assert_eq!(procedure.selected(), alone.selected());
    assert!(procedure.next().is_some());
}

#[test]
fn the_runs_that_decide_are_predicted_for_a_known_share() {
    for share in [0.6, 0.88, 0.905, 0.908, 0.93, 0.99] {
        let shares = [share, 0.999];
        let open = ended(problem(&[1.0, 2.0]), &shares);
        let decided = ended(finer(&[1.0, 2.0]), &shares).runs()[0];
        let predicted = finer(&[1.0, 2.0]).runs_to_decide(share, open.runs()[0]);
        let near = predicted * 8 / 10..predicted * 13 / 10;
        assert!(near.contains(&decided), "{share}: {decided} {predicted}");
    }
}

#[test]
fn of_equal_costs_one_is_enough() {
    let procedure = ended(problem(&[1.0, 1.0]), &[1.0, 1.0]);
    assert_eq!((procedure.certified(), procedure.runs()[1]), (vec![0], 0));
    assert_eq!(procedure.next(), None);
}

#[test]
fn a_hard_configuration_does_not_keep_a_dearer_one_from_being_certified() {
    let mut procedure = Requirement::new(problem(&[1.0, 2.0]));
    let mut runs = 0;
    while procedure.selected().is_none() {
        let request = procedure.next().expect("the first is never decided");
        runs += request.runs;
        assert!(runs < 5000);
        // Exactly between the limits, so that neither test gets far.
        let is_first = request.configurations == [0];
        let is_met = |run: u64| !is_first || !run.is_multiple_of(13);
        let runs = request.first_run..request.first_run + request.runs as u64;
        let met: Vec<f64> = runs.map(|run| f64::from(u8::from(is_met(run)))).collect();
        procedure.record(&met);
    }
    assert_eq!(procedure.selected(), Some(1));
    assert_eq!(procedure.survivors(), [0, 1]);
}
