//! Scenarios of the classic engine, in TOML.
//!
//! ```toml
//! engine = "classic"
//! contact = "touch"                       # see `contact`
//!
//! [clock]
//! paints_per_s = 56
//! time_limit_s = 120
//!
//! [robots.wanderer]
//! count = 4                               # in a single run; a study varies it
//! ```
//!
//! The keys that all engines share are in [`base::scenario`]. **What can be varied** is
//! `robots.wanderer.count`, `clock.paints_per_s`, `clock.time_limit_s` and `contact`. **The terms of a
//! figure of merit**:
//!
//! | term | meaning |
//! |---|---|
//! | `time` | seconds until the last find, at most `time_limit_s` |
//! | `robots` | team size |
//! | `failed` | 1 if it took longer than `time_limit_s`, else 0 |
//! | `found` | items found within the time limit, 0 to 4 |
//! | `collisions` | robot-decisions spent on a shared cell, until completion or the time limit |
//! | `paints` | paints until the last find; infinite if there is none, so it needs a `max` |

mod schema;

pub use schema::schema;

use crate::clock::{Clock, MAX_TIME_LIMIT_PAINTS, PAINTS_PER_S};
use crate::contact::Contact;
use crate::runner::{Configuration, columns};
use crate::search::Task;
use crate::start::MAX_ROBOTS;
use base::document::{Document, Section};
use base::engine::{Engine, MAX_TIME_LIMIT_S, MeritTerm, NamedMerit};
use base::error::InputErrors;
use base::scenario::condition::ConditionColumns;

/// The worksheet in the thesis's appendix, which does not divide the time by ten.
const APPENDIX: NamedMerit = NamedMerit {
    name: "appendix",
    weights: &[("time", -0.3), ("robots", -0.2), ("failed", -5.0)],
};

/// The classic engine.
#[derive(Debug, Clone, Copy)]
pub struct Classic;

impl Engine for Classic {
    fn name(&self) -> &'static str {
        "classic"
    }

    fn keys(&self) -> &'static [&'static str] {
        &["contact", "clock", "robots"]
    }

    fn read(&self, document: &Document) -> Result<base::engine::Configuration, InputErrors> {
        let read = Configuration::read(document)?;
        Ok(base::engine::Configuration {
            robots: vec![("wanderer".to_owned(), read.robots)],
            time_limit_s: read.clock.time_limit_s,
            facts: facts(&read),
            runner: Box::new(read),
        })
    }

    fn merit_terms(&self, _: &Document) -> Vec<MeritTerm> {
        columns().merit_terms()
    }

    fn condition_columns(&self, _: &Document) -> ConditionColumns {
        ConditionColumns {
            names: columns().names(),
            times: Vec::new(),
            unseen: Vec::new(),
        }
    }

    fn merits(&self) -> &'static [NamedMerit] {
        &[NamedMerit::EQUATION_5_2, APPENDIX]
    }

    fn factors(&self) -> Option<&'static [&'static str]> {
        Some(&[
            "robots.wanderer.count",
            "clock.paints_per_s",
            "clock.time_limit_s",
            "contact",
        ])
    }

    fn names(&self, _: &Document, _: &[&str]) -> Option<Vec<String>> {
        None
    }

    fn max_robots(&self) -> u32 {
        MAX_ROBOTS
    }
}

impl Configuration {
    /// Reads the configuration from a scenario document.
    ///
    /// # Errors
    /// Everything that is wrong with the engine's own keys.
    pub fn read(document: &Document) -> Result<Self, InputErrors> {
        document.read(configuration)
    }
}

fn configuration(root: &Section) -> Option<Configuration> {
    let contact = root.choice("contact", &Contact::NAMES);
    let clock = clock(&root.section("clock"));
    let robots = robots(&root.section("robots"));
    let clock = clock?;
    Some(Configuration {
        robots: robots?,
        task: Task {
            contact: contact?,
            time_limit_paints: clock.time_limit_paints,
        },
        clock,
    })
}

fn clock(section: &Section) -> Option<Clock> {
    section.only(&["paints_per_s", "time_limit_s"]);
    let paints_per_s = section.number("paints_per_s", PAINTS_PER_S);
    let time_limit_s = section.number("time_limit_s", 0.0..=MAX_TIME_LIMIT_S);
    let paints_per_s = paints_per_s?;
    let clock = Clock::new(paints_per_s, time_limit_s?);
    if clock.is_none() {
        let allowed =
            format!("at most {MAX_TIME_LIMIT_PAINTS} paints at {paints_per_s} paints per second");
        section.error("time_limit_s", &allowed);
    }
    clock
}

fn robots(section: &Section) -> Option<u32> {
    section.only(&["wanderer"]);
    let wanderer = section.section("wanderer");
    wanderer.only(&["count"]);
    let count = wanderer.integer("count", 1..=MAX_ROBOTS.into())?;
    u32::try_from(count).ok()
}

fn facts(read: &Configuration) -> Vec<(String, String)> {
    let Clock {
        paints_per_s,
        time_limit_s,
        ..
    } = read.clock;
    let names = Contact::NAMES.iter();
    let contact = names.filter(|(_, each)| *each == read.task.contact);
    let contact = contact.map(|(name, _)| ("contact".to_owned(), (*name).to_owned()));
    let clock = format!("{paints_per_s} paints per second, time limit {time_limit_s} s");
    contact.chain([("clock".to_owned(), clock)]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::document::{Override, Value};
    use base::engine::Runner;
    use base::scenario::{Design, Factor, Scenario, Values};

    const GOOD: &str = r#"
engine = "classic"
summary = "A test."
contact = "touch"
merit = "equation-5.2"
[clock]
paints_per_s = 56
time_limit_s = 120
[robots.wanderer]
count = 4
[study]
delta = 0.05
vary = { "robots.wanderer.count" = "1..3, 8" }
[published]
source = "Someone"
choice = 3
time_limit_s = 120
times_s = { 10 = [120, 120], 2 = [4, 5.5] }
"#;

    fn read(text: &str, changes: &[Override]) -> Result<Scenario, InputErrors> {
        let document = Document::parse("t.toml", text).unwrap();
        Scenario::read(&[&Classic], document.with(changes))
    }

    fn good(text: &str) -> Scenario {
        read(text, &[]).ok().unwrap()
    }

    fn errors(text: &str) -> String {
        read(text, &[]).err().unwrap().to_string()
    }

    #[test]
    fn a_good_scenario_is_read() {
        let scenario = good(GOOD);
        let facts = [
            ("contact", "touch"),
            ("clock", "56 paints per second, time limit 120 s"),
        ];
        let facts = facts.map(|(name, text)| (name.to_owned(), text.to_owned()));
        assert_eq!(scenario.configuration.facts, facts);
        assert_eq!(scenario.configuration.robots, [("wanderer".to_owned(), 4)]);
        assert_eq!(scenario.merit.name, Some("equation-5.2"));
        let factor = Factor {
            path: "robots.wanderer.count".to_owned(),
            values: Values::Listed([1, 2, 3, 8].map(Value::Integer).into()),
        };
        assert_eq!(scenario.study.factors, [factor]);
        assert_eq!(scenario.study.design, Design::Factorial);
        assert_eq!(
            (scenario.study.delta, scenario.study.confidence),
            (Some(0.05), 0.95)
        );
        let times = scenario.published.unwrap().times_s;
        assert_eq!(times, [(2, vec![4.0, 5.5]), (10, vec![120.0, 120.0])]);
    }

    #[test]
    fn a_configuration_is_the_scenario_with_other_values_at_the_factors_paths() {
        let change = |path: &str, value| Override {
            path: path.split('.').map(str::to_owned).collect(),
            value,
            origin: "--vary".to_owned(),
        };
        let changes = [
            change("robots.wanderer.count", Value::Integer(9)),
            change("clock.paints_per_s", Value::Float(41.5)),
            change("clock.time_limit_s", Value::Integer(10)),
            change("contact", Value::Text("ahead".to_owned())),
        ];
        let document = Document::parse("t.toml", GOOD).unwrap().with(&changes);
        let read = document.read(configuration).unwrap();
        assert_eq!(read.robots, 9);
        assert_eq!(
            (read.task.contact, read.task.time_limit_paints),
            (Contact::Ahead, 415)
        );
    }

    #[test]
    fn nothing_need_be_varied() {
        let text = GOOD.replace("vary =", "#");
        let study = good(&text).study;
        assert_eq!(study.factors, []);
    }

    #[test]
    fn each_value_is_checked_and_the_first_bad_ones_are_reported() {
        let text = GOOD.replace(
            r#""robots.wanderer.count" = "1..3, 8""#,
            r#""robots.wanderer.count" = "0..3, 249..260", "contact" = "touch,aheda,3",
               "clock.time_limit_s" = "-1.0..5.0", "clock.paints_per_s" = "500""#,
        );
        let text = text.replace(
            "time_limit_s = 120
[robots",
            "time_limit_s = 9000
[robots",
        );
        let text = text.replace("vary = {", "design = \"lhs:20\"\nvary = {");
        assert_eq!(
            errors(&text).lines().collect::<Vec<_>>(),
            [
                "t.toml:14: robots.wanderer.count = 0: must be a whole number from 1 to 250",
                "t.toml:14: robots.wanderer.count = 251: must be a whole number from 1 to 250",
                "t.toml:14: robots.wanderer.count = 252: must be a whole number from 1 to 250",
                "t.toml:14: 8 more values of robots.wanderer.count are not allowed either",
                "t.toml:15: clock.paints_per_s = 500: must be a value with which clock.time_limit_s is at most \
                 1000000 paints at 500 paints per second",
                "t.toml:15: clock.time_limit_s = -1.0: must be a number from 0 to 1000000",
                "t.toml:14: contact = \"aheda\": must be one of \"neighbour\", \"diagonal\", \
                 \"within-2\", \"within-3\", \"touch\", \"ahead\"; did you mean \"ahead\"?",
                "t.toml:14: contact = 3: must be one of \"neighbour\", \"diagonal\", \
                 \"within-2\", \"within-3\", \"touch\", \"ahead\"",
            ]
        );
    }

    #[test]
    fn values_are_checked_beside_other_errors_but_not_within_what_is_no_table() {
        let vary = r#"vary = { "clock.time_limit_s" = "-1", "#;
        let text = GOOD.replace("vary = {", vary);
        let reported = errors(&text.replace(
            "time_limit_s = 120\n[robots",
            "time_limit_s = 120\ncap = 3\n[robots",
        ));
        assert!(reported.contains("clock.cap is not a known key: expected one of paints_per_s"));
        assert!(reported.contains("clock.time_limit_s = -1: must be a number from 0"));
        let no_table = "[clock]\npaints_per_s = 56\ntime_limit_s = 120\n";
        let reported = errors(&format!("clock = 3\n{}", text.replace(no_table, "")));
        assert_eq!(reported, "t.toml:1: clock = 3: must be a table");
    }

    #[test]
    fn a_studys_bad_keys_are_reported_at_once() {
        let more = "delta = 0\nconfidence = 1\ndesign = \"sobol:200\"\nvary = ";
        let errors = errors(&GOOD.replace("delta = 0.05\nvary = ", more));
        for expected in [
            "t.toml:12: study.delta = 0: must be a number above 0",
            "t.toml:13: study.confidence = 1: must be a number above 0.5 and below 1",
            "t.toml:14: study.design = \"sobol:200\": must be \"factorial\", or \"lhs:200\" or",
        ] {
            assert!(errors.contains(expected), "{expected}\nnot in\n{errors}");
        }
        assert_eq!(errors.lines().count(), 3);
    }

    #[test]
    fn a_range_of_any_numbers_needs_a_design_that_takes_points_from_it() {
        let range = r#"vary = { "clock.paints_per_s" = "41.0..57.0", "#;
        let text = GOOD.replace("vary = {", range);
        assert!(
            errors(&text).contains("= \"41.0..57.0\": must be a list of values with the design")
        );
        let filling = text.replace("vary =", "design = \"sobol:256\"\nvary =");
        let study = good(&filling).study;
        assert_eq!(study.factors[1].values, Values::Between(41.0, 57.0));
    }

    #[test]
    fn every_error_of_a_bad_scenario_is_reported_at_once() {
        let text = GOOD
            .replace("\"touch\"", "\"tuoch\"")
            .replace("count = 4", "count = 0")
            .replace("delta = 0.05", "delta = -5")
            .replace("1..3, 8", "8..1")
            .replace("time_limit_s = 120", "time_limit_s = nan\ncap = 3");
        let errors = errors(&text);
        for expected in [
            "t.toml:4: contact = \"tuoch\": must be one of",
            "did you mean \"touch\"?",
            "t.toml:11: robots.wanderer.count = 0: must be a whole number from 1 to 250",
            "t.toml:13: study.delta = -5: must be a number above 0",
            "t.toml:14: study.vary.\"robots.wanderer.count\" = \"8..1\": must be a string of values",
            "t.toml:8: clock.time_limit_s = NaN: must be a number",
            "t.toml:9: clock.cap is not a known key: expected one of paints_per_s, time_limit_s",
        ] {
            assert!(errors.contains(expected), "{expected}\nnot in\n{errors}");
        }
    }

    #[test]
    fn a_time_limit_too_long_to_compute_is_an_error() {
        let text = GOOD.replace("time_limit_s = 120", "time_limit_s = 100000");
        assert!(
            errors(&text)
                .contains("clock.time_limit_s = 100000: must be at most 1000000 paints at 56")
        );
    }

    #[test]
    fn an_override_replaces_the_files_value() {
        let change = Override {
            path: vec!["contact".to_owned()],
            value: Value::Text("nose".to_owned()),
            origin: "--contact".to_owned(),
        };
        let errors = read(GOOD, &[change]).err().unwrap();
        assert!(
            errors
                .to_string()
                .starts_with("--contact: contact = \"nose\": must be one of")
        );
    }

    #[test]
    fn the_terms_that_need_a_max_are_the_columns_without_bound() {
        let document = Document::parse("t.toml", GOOD).unwrap();
        let columns = document.read(configuration).unwrap().columns();
        for term in Classic.merit_terms(&document) {
            let column = columns.iter().find(|each| each.name == term.column);
            let is_bounded = column.unwrap().bounds.max.is_some();
            assert_eq!(is_bounded, term.usual_max.is_none());
        }
    }
}
