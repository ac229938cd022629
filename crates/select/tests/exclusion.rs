//! Configurations that cannot be run are neither requested nor selected.

use select::{Bounds, EqualAllocation, Exclude, Problem, Race, Strict};

const TEAMS: usize = 5;

/// The merit of every run of each configuration.
const MERITS: [f64; TEAMS] = [0.9, 0.1, 0.2, 0.8, 0.4];

/// The impossible ones: they would have the best means.
const IMPOSSIBLE: [usize; 2] = [0, 3];

fn problem() -> Problem {
    Problem {
        bounds: vec![Bounds { min: 0.0, max: 1.0 }; TEAMS],
        delta: 0.1,
        confidence: 0.95,
    }
}

/// Runs a procedure to its end, and returns the selected configuration.
fn selected(mut procedure: impl Exclude) -> usize {
    procedure.exclude(&IMPOSSIBLE);
    while let Some(request) = procedure.next() {
        let is_possible = |each: &usize| !IMPOSSIBLE.contains(each);
        assert!(request.configurations.iter().all(is_possible));
        let row = |each: &usize| vec![MERITS[*each]; request.runs];
        let merits: Vec<f64> = request.configurations.iter().flat_map(row).collect();
        procedure.record(&merits);
    }
    let selected = procedure.selected().unwrap_or(usize::MAX);
    assert!(procedure.survivors().contains(&selected));
    for each in IMPOSSIBLE {
        assert_eq!(procedure.runs()[each], 0);
        assert!(!procedure.survivors().contains(&each));
        let mut eliminations = procedure.eliminations().into_iter();
        assert!(eliminations.all(|elimination| elimination.configuration != each));
    }
    selected
}

#[test]
fn every_procedure_selects_the_best_of_those_that_can_be_run() {
    assert_eq!(selected(Race::new(problem())), 4);
    assert_eq!(selected(Strict::new(problem())), 4);
    assert_eq!(selected(EqualAllocation::new(TEAMS, 30)), 4);
}

#[test]
fn a_single_configuration_that_can_be_run_is_run_and_selected() {
    let others = [0, 1, 3, 4];
    let mut race = Race::new(problem());
    let mut strict = Strict::new(problem());
    let mut equal = EqualAllocation::new(TEAMS, 10);
    let procedures: [&mut dyn Exclude; 3] = [&mut race, &mut strict, &mut equal];
    for procedure in procedures {
        procedure.exclude(&others);
        let request = procedure.next().expect("its first runs");
        assert_eq!((request.configurations, request.runs), (vec![2], 10));
        procedure.record(&[0.5; 10]);
        assert_eq!(procedure.next(), None);
        assert_eq!(procedure.selected(), Some(2));
    }
}
