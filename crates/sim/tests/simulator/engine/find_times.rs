//! Columns with the times of finds.

use super::judge::{line, mines};
use crate::common::scenario;
use base::document::{Document, Value};
use base::engine::{BlockOptions, Engine, Runner};
use base::scenario::condition::parse;
use base::scenario::read_configuration;
use sim::runner::{Metric, Runs};
use sim::simulation::Simulation;

/// Where the mines lie.
const PLACES: &str = "[[6, 5], [4, 5], [1, 5], [9, 9]]";

/// Four mines on the line of the rover, one of which it cannot detect, and one piece of clutter.
fn field() -> String {
    let items = mines(PLACES, 4)
        + "[items.scrap]\ncount = 1\ntarget = false\n\
           placement = { kind = \"fixed\", at_m = [[5, 5]] }\n";
    line(8.0, &items, "")
}

/// The same with mines at random places.
fn anywhere() -> String {
    let fixed = format!("kind = \"fixed\", at_m = {PLACES}");
    field().replace(&fixed, "kind = \"uniform\"")
}

fn names(runner: &dyn Runner) -> Vec<String> {
    let columns = runner.columns().into_iter();
    columns.map(|column| column.name.into_owned()).collect()
}

/// The values of run 0 by column.
fn values(text: &str) -> Vec<(String, f64)> {
    let runs = Runs(scenario(text));
    let values = runs.run_block(1, 0..1, BlockOptions::ALONE);
    let values = values.iter().map(|column| column[0]);
    names(&runs).into_iter().zip(values).collect()
}

fn find_times(values: &[(String, f64)]) -> Vec<(&str, f64)> {
    let times = values
        .iter()
        .skip_while(|(name, _)| name != "found_mine_1_s");
    times
        .map(|(name, time_s)| (name.as_str(), *time_s))
        .collect()
}

#[test]
fn the_kth_find_time_is_the_time_of_the_kth_find() {
    let values = values(&field());
    let expected = [
        ("found_mine_1_s", 0.0),
        ("found_mine_2_s", 2.0),
        ("found_mine_3_s", 4.0),
        ("found_mine_4_s", f64::INFINITY),
        ("found_scrap_1_s", 3.0),
    ];
    assert_eq!(find_times(&values), expected);
    let mut simulation = Simulation::new(scenario(&field()), 1, 0).unwrap();
    simulation.finish();
    let items = simulation.state().each_item(simulation.scenario());
    let mines = items.filter(|item| item.kind == 0);
    let mut found_s: Vec<f64> = mines.filter_map(|item| item.found_s).collect();
    found_s.sort_by(f64::total_cmp);
    assert_eq!(found_s, [0.0, 2.0, 4.0]);
}

#[test]
fn a_run_that_has_not_found_everything_is_not_quarantined() {
    let values = values(&field());
    assert!(values.iter().all(|(_, value)| !value.is_nan()));
    let runs = Runs(scenario(&field()));
    let outcome = Simulation::new(scenario(&field()), 1, 0).unwrap().finish();
    assert!(outcome.is_finite());
    let expected: Vec<f64> = values.iter().map(|(_, value)| *value).collect();
    assert_eq!(runs.values(&outcome), Some(expected));
}

#[test]
fn times_of_finds_come_after_all_other_columns_at_most_64_per_kind() {
    let many = anywhere().replace("count = 4", "count = 70");
    let names = names(&Runs(scenario(&many)));
    let counts = ["found_mine", "missed_mine", "found_scrap", "missed_scrap"];
    assert_eq!(names[11..15], counts);
    assert_eq!(names.len(), 15 + 64 + 1);
    assert_eq!(names[15], "found_mine_1_s");
    assert_eq!(names[78..], ["found_mine_64_s", "found_scrap_1_s"]);
}

#[test]
fn configurations_with_different_counts_have_the_same_columns() {
    let study = "engine = \"metric\"\n[study]\nvary = { \"items.mine.count\" = \"0..3,6\" }\n";
    let text = study.to_owned() + &anywhere();
    let mut document = Document::parse("t.toml", &text).unwrap();
    let of = |document: &Document, count: i64| {
        let values = [("items.mine.count".to_owned(), Value::Integer(count))];
        let read = read_configuration(&[&Metric], document.clone(), &values);
        names(&*read.ok().unwrap().runner)
    };
    let all = names(&*Metric.read(&document).unwrap().runner);
    assert_eq!(all[15..].len(), 6 + 1, "{all:?}");
    for count in [0, 1, 3, 6] {
        assert_eq!(of(&document, count), all, "{count}");
    }
    document.set(&["items", "mine", "count"], Value::Integer(9), "--set");
    assert_eq!(
        of(&document, 1).len(),
        all.len() + 3,
        "its own count is larger"
    );
}

#[test]
fn conditions_refer_to_the_columns_of_runs() {
    let document = Document::parse("t.toml", &field()).unwrap();
    let columns = Metric.condition_columns(&document);
    assert_eq!(columns.names, names(&Runs(scenario(&field()))));
    let values = values(&field());
    for (kind, number) in [("mine", 1), ("mine", 3), ("mine", 4), ("scrap", 1)] {
        let text = format!("time_until(found_{kind} >= {number}) <= 3");
        let condition = parse(&text, &columns).unwrap();
        assert_eq!(
            values[condition.place].0,
            format!("found_{kind}_{number}_s")
        );
    }
    assert!(parse("time_until(found_mine >= 5) <= 3", &columns).is_err());
    // Errors elsewhere do not hide the columns.
    let broken = field().replace("time_limit_s = 8", "time_limit_s = -8");
    let document = Document::parse("t.toml", &broken).unwrap();
    assert_eq!(Metric.condition_columns(&document), columns);
}

#[test]
fn a_kind_without_items_has_no_times() {
    let none = field().replace("count = 1\ntarget = false", "count = 0\ntarget = false");
    let none = none.replace("at_m = [[5, 5]]", "at_m = []");
    let document = Document::parse("t.toml", &none).unwrap();
    let columns = Metric.condition_columns(&document);
    assert_eq!(columns.names, names(&Runs(scenario(&none))));
    let counts: Vec<&str> = columns
        .times
        .iter()
        .map(|each| each.count.as_str())
        .collect();
    assert_eq!(counts, ["found_mine"]);
}

/// Whether a requirement of one condition is refused because of the end of runs, for four mines and one scrap.
fn is_unseen(end: &str, condition: &str) -> bool {
    is_unseen_in(&field(), end, condition)
}

fn is_unseen_in(field: &str, end: &str, condition: &str) -> bool {
    let text = format!("{field}\n[end]\nwhen = \"{end}\"\n");
    let document = Document::parse("t.toml", &text).unwrap();
    let columns = Metric.condition_columns(&document);
    let parsed = parse(condition, &columns).unwrap();
    let mut unseen = columns.unseen.iter();
    unseen.any(|unseen| unseen.place == parsed.place && parsed.needs_beyond(unseen.seen))
}

#[test]
fn a_run_that_ends_at_a_find_shows_nothing_of_later_ones() {
    let beyond = [
        "found_mine >= 3",
        "found_mine > 2",
        "found_mine == 3",
        "missed_mine <= 1",
        "missed_mine == 0",
        "found_mine_3_s <= 20",
        "time_until(found_mine >= 4) <= 20",
        "found >= 4",
    ];
    let within = [
        "found_mine >= 2",
        "found_mine <= 2",
        "missed_mine <= 2",
        "found_mine_2_s <= 20",
        "time_until(found_mine >= 1) <= 20",
        "found >= 3",
        "missed_scrap <= 0",
        "time_s <= 20",
    ];
    for end in [
        "found_mine >= 2",
        "found_mine > 1",
        "missed_mine <= 2",
        "missed_mine < 3",
    ] {
        for condition in beyond {
            assert!(is_unseen(end, condition), "{end}: {condition}");
        }
        for condition in within {
            assert!(!is_unseen(end, condition), "{end}: {condition}");
        }
    }
    assert!(is_unseen("found >= 3", "found >= 4") && is_unseen("found >= 3", "found_mine >= 4"));
    assert!(!is_unseen("found >= 3", "found_mine >= 3"));
    assert!(!is_unseen("collisions >= 1", "found_mine >= 4"));
}

/// The field, where robots can do more to mines than detect them.
fn field_with_acts() -> String {
    let acts = "[items.mine]\ncompleted_by = \"confirmed\"\nhazard = { radius_m = 0.1 }";
    field().replace("[items.mine]", acts)
}

#[test]
fn a_run_that_ends_at_an_act_or_a_lost_robot_shows_nothing_of_later_ones() {
    for count in ["marked", "confirmed", "neutralised", "robots_lost"] {
        for (end, number) in [(">= 2", 2), ("> 1", 2), ("== 2", 2)] {
            let end = format!("{count} {end}");
            let unseen = |condition: &str| is_unseen_in(&field_with_acts(), &end, condition);
            let [same, more] = [0, 1].map(|more| format!("{count} >= {}", number + more));
            assert!(unseen(&more) && !unseen(&same), "{end}");
            assert!(
                !unseen(&format!("{count} <= 1")) && !unseen("found_mine >= 4"),
                "{end}"
            );
        }
        let end = format!("{count} <= 3");
        assert!(
            !is_unseen_in(&field_with_acts(), &end, &format!("{count} >= 3")),
            "{end}"
        );
    }
}

/// Four mines are targets, and the scrap is not.
#[test]
fn a_run_that_ends_at_a_number_of_targets_that_are_left_shows_nothing_of_fewer() {
    for end in ["left <= 2", "left < 3", "left == 2"] {
        let unseen = |condition: &str| is_unseen_in(&field_with_acts(), end, condition);
        for condition in ["left <= 1", "left == 0", "left < 2", "neutralised >= 3"] {
            assert!(unseen(condition), "{end}: {condition}");
        }
        for condition in [
            "left <= 2",
            "left >= 3",
            "neutralised >= 2",
            "marked >= 4",
            "found_mine >= 4",
        ] {
            assert!(!unseen(condition), "{end}: {condition}");
        }
    }
    let drawn = field_with_acts().replace("[items.mine]", "[items.mine]\nnumber = \"poisson\"");
    let varied = format!(
        "{}[study]\nvary = {{ \"items.scrap.target\" = \"false,true\" }}\n",
        field_with_acts()
    );
    for field in [drawn, varied] {
        assert!(!is_unseen_in(&field, "left <= 2", "left <= 1"));
    }
}

#[test]
fn a_run_that_ends_at_a_served_goal_shows_nothing_of_later_ones() {
    let field = format!("{}\n[goals.spot]\ncount = 6\n", field());
    for end in ["served >= 3", "served > 2", "served == 3"] {
        for condition in ["served >= 4", "served > 3", "served == 6"] {
            assert!(is_unseen_in(&field, end, condition), "{end}: {condition}");
        }
        for condition in ["served >= 3", "time_s <= 20", "found_mine >= 4"] {
            assert!(!is_unseen_in(&field, end, condition), "{end}: {condition}");
        }
    }
}
