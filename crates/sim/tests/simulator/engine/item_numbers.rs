//! Kinds of items whose number is drawn in each run.

use crate::common::{read, scenario};
use base::document::Document;
use base::engine::{BlockOptions, Engine, Runner};
use sim::run::State;
use sim::runner::{Metric, Runs};

/// Rovers, and `count` mines on average.
fn field(count: u32, more: &str) -> String {
    format!(
        r#"
clock = {{ time_limit_s = 20 }}
world = {{ size_m = [20, 20] }}
[items]
mine = {{ count = {count}, number = "poisson" }}
scrap = {{ count = 3, target = false }}
[robots.rover]
count = 2
radius_m = 0.3
drive = {{ max_speed_m_s = 1, max_turn_rate_deg_s = 90 }}
brain = {{ behaviours = [{{ kind = "cruise", speed_m_s = 1 }}, {{ kind = "avoid" }}] }}
[robots.rover.sensors]
eye = {{ kind = "items", range_m = 3 }}
sonar = {{ kind = "range", rays = 8, range_m = 3 }}
{more}
"#
    )
}

/// The values of a column in the first runs.
fn column(runs: &Runs, name: &str, number: u64) -> Vec<f64> {
    let values = runs.run_block(5, 0..number, BlockOptions::ALONE);
    let columns = runs.columns();
    let place = columns.iter().position(|column| column.name == name);
    values[place.unwrap()].clone()
}

#[test]
fn found_and_missed_of_each_run_add_up_to_the_number_that_it_drew_and_are_bounded() {
    let runs = Runs(scenario(&field(4, "")));
    let [found, missed] = ["found_mine", "missed_mine"].map(|name| column(&runs, name, 60));
    let numbers: Vec<f64> = found
        .iter()
        .zip(missed)
        .map(|(one, two)| one + two)
        .collect();
    for (run, number) in (0..).zip(&numbers) {
        let state = State::new(&runs.0, 5, run).unwrap();
        let mines = state.each_item(&runs.0).filter(|item| item.kind == 0);
        assert_eq!(mines.count() as f64, *number, "run {run}");
    }
    let different: std::collections::BTreeSet<u64> =
        numbers.iter().map(|number| *number as u64).collect();
    assert!(different.len() > 4, "{numbers:?}");
    let columns = runs.columns().into_iter();
    let bound = columns.filter(|column| ["found", "missed_mine"].contains(&&*column.name));
    assert!(
        bound
            .into_iter()
            .all(|column| column.bounds.max == Some(28.0))
    );
}

#[test]
fn configurations_with_more_expected_items_have_those_of_configurations_with_fewer() {
    let (few, many) = (scenario(&field(3, "")), scenario(&field(9, "")));
    for run in 0..30 {
        let places = |scenario| {
            let state = State::new(scenario, 5, run).unwrap();
            let mines = state.each_item(scenario).filter(|item| item.kind == 0);
            mines.map(|item| item.at).collect::<Vec<_>>()
        };
        let (few, many) = (places(&few), places(&many));
        assert_eq!(few, many[..few.len()], "run {run}");
    }
}

#[test]
fn a_run_that_draws_no_target_is_complete_when_it_begins() {
    let runs = Runs(scenario(&field(1, "")));
    let [missed, found] = ["missed", "found"].map(|name| column(&runs, name, 40));
    let [time_s, failed] = ["time_s", "failed"].map(|name| column(&runs, name, 40));
    let none: Vec<usize> = (0..40)
        .filter(|run| missed[*run] + found[*run] == 0.0)
        .collect();
    assert!(none.len() > 5 && none.len() < 30, "{none:?}");
    assert!(
        none.iter()
            .all(|run| (time_s[*run], failed[*run]) == (0.0, 0.0))
    );
    // The same condition may hold at the start if runs draw their numbers.
    let late = Runs(scenario(&field(1, "[end]\nwhen = \"missed_mine == 0\"")));
    assert_eq!(column(&late, "time_s", 40), time_s);
}

#[test]
fn a_drawn_number_has_a_mean_of_at_most_500_and_fixed_places_for_its_maximum() {
    let errors = read(&field(501, "")).unwrap_err().to_string();
    let expected = "a whole number from 0 to 500 with number = \"poisson\"";
    assert!(
        errors.contains("items.mine.count") && errors.contains(expected),
        "{errors}"
    );
    let text = field(4, "").replace(
        "number = \"poisson\" }",
        "number = \"poisson\", placement = { kind = \"fixed\", at_m = [[1, 1], [2, 2], [3, 3], [4, 4]] } }",
    );
    let errors = read(&text).unwrap_err().to_string();
    assert!(errors.contains("28"), "{errors}");
    let errors = read(&field(4, "").replace("poisson", "poison")).unwrap_err();
    assert!(errors.to_string().contains("items.mine.number"), "{errors}");
}

#[test]
fn columns_of_documents_with_drawn_numbers_are_those_of_their_runs() {
    let text = field(4, "");
    let document = Document::parse("t.toml", &text).unwrap();
    let runs = Runs(scenario(&text));
    let columns = runs.columns().into_iter();
    let names: Vec<String> = columns.map(|column| column.name.into_owned()).collect();
    assert_eq!(Metric.condition_columns(&document).names, names);
    assert!(names.contains(&"found_mine_28_s".to_owned()));
}
