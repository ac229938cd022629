//! Configurations that cannot be run are neither requested nor selected by the procedure for
//! requirements.

use select::{Exclude, Procedure, Requirement, RequirementProblem};

fn procedure() -> Requirement {
    Requirement::new(RequirementProblem {
        costs: vec![1.0, 2.0, 3.0],
        probability: 0.9,
        tolerance: 0.05,
        finer: None,
        confidence: 0.95,
    })
}

#[test]
fn an_impossible_configuration_is_left_out_when_its_first_runs_show_it() {
    let mut procedure = procedure();
    while let Some(request) = procedure.next() {
        if request.configurations == [0] {
            procedure.exclude(&[0]);
        } else {
            procedure.record(&vec![1.0; request.runs]);
        }
    }
    assert_eq!(procedure.selected(), Some(1));
    assert_eq!(procedure.runs()[0], 0);
    assert!(procedure.eliminations().is_empty());
}

#[test]
fn if_none_can_be_run_none_is_selected() {
    let mut procedure = procedure();
    procedure.exclude(&[0, 1, 2]);
    assert_eq!((procedure.next(), procedure.selected()), (None, None));
}
