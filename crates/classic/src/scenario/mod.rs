//! A scenario of the classic engine: what a study of the 2003 experiment is told in a TOML file.
//!
//! ```toml
//! engine = "classic"
//! summary = "One line for people."
//! contact = "touch"                       # see `contact`
//! merit = "equation-5.2"                  # or "appendix", or weights of your own: see below
//!
//! [clock]
//! paints_per_s = 56
//! cap_s = 120
//!
//! [robots.wanderer]
//! count = 4                               # of a single run; a study varies it
//!
//! [study]
//! vary = { "robots.wanderer.count" = "1..8" }
//! design = "factorial"                    # or "lhs:200" or "sobol:256": points that fill the space
//! delta = 0.05                            # may be left out: a difference of merit worth knowing
//! confidence = 0.95                       # above 0.5, below 1; how often the answer is right
//!
//! [published]                             # may be left out: results to show beside ours
//! source = "Williams 2003"
//! choice = 3
//! cap_s = 120
//! times_s = { 1 = [120, 44], 2 = [120, 43] }
//! ```
//!
//! **What can be varied** is `robots.wanderer.count`, `clock.paints_per_s`, `clock.cap_s` and
//! `contact`; each with a text of its values:
//!
//! | text | values |
//! |---|---|
//! | `1..40` | whole numbers, both ends included |
//! | `1,2,4` or `1..4,8` or `0.5,1.0` | these |
//! | `touch,ahead` | these names |
//! | `41.0..57.0` | any number of the range: for `lhs:` and `sobol:` only |
//!
//! **A figure of merit of your own** is a table of weights on what a run gives; higher is better:
//!
//! ```toml
//! merit = { time = -0.03, robots = -0.2, failed = -5, paints = { weight = -0.01, max = 100 } }
//! ```
//!
//! | term | of a run |
//! |---|---|
//! | `time` | seconds until the last find, at most `cap_s` |
//! | `robots` | team size |
//! | `failed` | 1 if it took longer than `cap_s`, else 0 |
//! | `found` | items found until the cap, 0 to 4 |
//! | `collisions` | robot-decisions spent on a shared cell, until completion or the cap |
//! | `paints` | paints until the last find; infinite if it never comes, so it needs a `max` |
//!
//! A value above `max` counts as `max`. On the command line it is `--merit time=-0.03,robots=-0.2`.

mod clock;
mod merit;
mod published;
mod study;
mod vary;

pub use clock::{Clock, MAX_CAP_PAINTS};
pub use merit::{Merit, TERMS, Term};
pub use published::Published;
pub use study::{Design, Study};
pub use vary::{Factor, Values};

use crate::contact::Contact;
use crate::runner::Configuration;
use crate::search::Task;
use crate::start::MAX_ROBOTS;
use base::document::{Document, Section, Value};
use base::fault::Faults;

const MAX_CAP_S: f64 = 1e6;

/// Everything that does not change in a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Scenario {
    /// One line for people.
    pub summary: String,
    /// How runs are scored.
    pub merit: Merit,
    /// A single run; a study varies it.
    pub configuration: Configuration,
    /// What a study does.
    pub study: Study,
    /// Results of others.
    pub published: Option<Published>,
}

/// A value put over what a file says, and how faults should name where it comes from.
#[derive(Debug, Clone, PartialEq)]
pub struct Override {
    /// Keys from the root.
    pub path: Vec<String>,
    /// The new value.
    pub value: Value,
    /// For example `--contact`.
    pub origin: String,
}

impl Scenario {
    /// Reads a scenario; `file` is how faults name it.
    ///
    /// # Errors
    /// Everything that is wrong with it.
    pub fn read(file: &str, text: &str, overrides: &[Override]) -> Result<Self, Faults> {
        let mut document = document(file, text, overrides)?;
        merit::make_table(&mut document);
        let (read, mut faults) = document.read_all(scenario);
        faults.extend(vary::faults_of_values(&document, &faults));
        Faults::or(faults, read)
    }
}

impl Configuration {
    /// Reads what a run depends on, and nothing else, of a scenario; as [`Scenario::read`] does.
    ///
    /// # Errors
    /// Everything that is wrong with that part.
    pub fn read(file: &str, text: &str, overrides: &[Override]) -> Result<Self, Faults> {
        document(file, text, overrides)?.read(configuration)
    }
}

fn document(file: &str, text: &str, overrides: &[Override]) -> Result<Document, Faults> {
    let mut document = Document::parse(file, text)?;
    for Override {
        path,
        value,
        origin,
    } in overrides
    {
        let path: Vec<&str> = path.iter().map(String::as_str).collect();
        document.set(&path, value.clone(), origin);
    }
    Ok(document)
}

fn configuration(root: &Section) -> Option<Configuration> {
    let engine = root.choice("engine", &[("classic", ())]);
    let contact = root.choice("contact", &Contact::NAMES);
    let clock = clock::clock(&root.section("clock"));
    let robots = robots(&root.section("robots"));
    engine?;
    let clock = clock?;
    Some(Configuration {
        robots: robots?,
        task: Task {
            contact: contact?,
            cap_paints: clock.cap_paints,
        },
        clock,
    })
}

fn scenario(root: &Section) -> Option<Scenario> {
    root.only(&[
        "engine",
        "summary",
        "contact",
        "merit",
        "clock",
        "robots",
        "study",
        "published",
    ]);
    let configuration = configuration(root);
    let summary = root.line("summary");
    let merit = merit::merit(root);
    let study = study::study(&root.section("study"));
    let published = root
        .has("published")
        .then(|| published::published(&root.section("published")));
    Some(Scenario {
        summary: summary?,
        merit: merit?,
        configuration: configuration?,
        study: study?,
        published: match published {
            Some(read) => Some(read?),
            None => None,
        },
    })
}

fn robots(section: &Section) -> Option<u32> {
    section.only(&["wanderer"]);
    let wanderer = section.section("wanderer");
    wanderer.only(&["count"]);
    let count = wanderer.integer("count", 1..=MAX_ROBOTS.into())?;
    u32::try_from(count).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    const GOOD: &str = r#"
engine = "classic"
summary = "A test."
contact = "touch"
merit = "equation-5.2"
[clock]
paints_per_s = 56
cap_s = 120
[robots.wanderer]
count = 4
[study]
delta = 0.05
vary = { "robots.wanderer.count" = "1..3, 8" }
[published]
source = "Someone"
choice = 3
cap_s = 120
times_s = { 10 = [120, 120], 2 = [4, 5.5] }
"#;

    fn faults(text: &str) -> String {
        Scenario::read("t.toml", text, &[]).unwrap_err().to_string()
    }

    #[test]
    fn a_good_scenario_is_read() {
        let scenario = Scenario::read("t.toml", GOOD, &[]).unwrap();
        assert_eq!(scenario.configuration.task.contact, Contact::Touch);
        assert_eq!(scenario.merit.name, Some(Merit::EQUATION));
        let factor = Factor {
            path: "robots.wanderer.count",
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
            change("clock.cap_s", Value::Integer(10)),
            change("contact", Value::Text("ahead".to_owned())),
        ];
        let read = Configuration::read("t.toml", GOOD, &changes).unwrap();
        assert_eq!(read.robots, 9);
        assert_eq!(
            (read.task.contact, read.task.cap_paints),
            (Contact::Ahead, 415)
        );
        let whole = Scenario::read("t.toml", GOOD, &changes).unwrap();
        assert_eq!(whole.configuration, read);
    }

    #[test]
    fn nothing_need_be_varied() {
        let text = GOOD.replace("vary =", "#");
        let study = Scenario::read("t.toml", &text, &[]).unwrap().study;
        assert_eq!(study.factors, []);
    }

    #[test]
    fn each_value_is_checked_and_the_first_bad_ones_are_told() {
        let text = GOOD.replace(
            r#""robots.wanderer.count" = "1..3, 8""#,
            r#""robots.wanderer.count" = "0..3, 249..260", "contact" = "touch,aheda,3",
               "clock.cap_s" = "-1.0..5.0", "clock.paints_per_s" = "500""#,
        );
        let text = text.replace(
            "cap_s = 120
[robots",
            "cap_s = 9000
[robots",
        );
        let text = text.replace("vary = {", "design = \"lhs:20\"\nvary = {");
        assert_eq!(
            faults(&text).lines().collect::<Vec<_>>(),
            [
                "t.toml:14: robots.wanderer.count = 0: must be a whole number from 1 to 250",
                "t.toml:14: robots.wanderer.count = 251: must be a whole number from 1 to 250",
                "t.toml:14: robots.wanderer.count = 252: must be a whole number from 1 to 250",
                "t.toml:14: 8 more values of robots.wanderer.count are not allowed either",
                "t.toml:15: clock.paints_per_s = 500: must be one with which clock.cap_s is at most \
                 1000000 paints at 500 paints per second",
                "t.toml:15: clock.cap_s = -1.0: must be a number from 0 to 1000000",
                "t.toml:14: contact = \"aheda\": must be one of \"neighbour\", \"diagonal\", \
                 \"within-2\", \"within-3\", \"touch\", \"ahead\"; did you mean \"ahead\"?",
                "t.toml:14: contact = 3: must be one of \"neighbour\", \"diagonal\", \
                 \"within-2\", \"within-3\", \"touch\", \"ahead\"",
            ]
        );
    }

    #[test]
    fn values_are_checked_beside_other_faults_but_not_within_what_is_no_table() {
        let vary = r#"vary = { "clock.cap_s" = "-1", "#;
        let text = GOOD.replace("vary = {", vary);
        let told = faults(&text.replace("cap_s = 120\n[robots", "cap_s = 120\ncap = 3\n[robots"));
        assert!(told.contains("clock.cap = 3: must be one of the known keys"));
        assert!(told.contains("clock.cap_s = -1: must be a number from 0"));
        let no_table = "[clock]\npaints_per_s = 56\ncap_s = 120\n";
        let told = faults(&format!("clock = 3\n{}", text.replace(no_table, "")));
        assert_eq!(told, "t.toml:1: clock = 3: must be a table");
    }

    #[test]
    fn a_studys_bad_keys_are_told_at_once() {
        let more = "delta = 0\nconfidence = 1\ndesign = \"sobol:200\"\nvary = ";
        let faults = faults(&GOOD.replace("delta = 0.05\nvary = ", more));
        for expected in [
            "t.toml:12: study.delta = 0: must be a number above 0",
            "t.toml:13: study.confidence = 1: must be a number above 0.5 and below 1",
            "t.toml:14: study.design = \"sobol:200\": must be \"factorial\", \"lhs:200\" or",
        ] {
            assert!(faults.contains(expected), "{expected}\nnot in\n{faults}");
        }
        assert_eq!(faults.lines().count(), 3);
    }

    #[test]
    fn a_range_of_any_numbers_needs_a_design_that_takes_points_from_it() {
        let range = r#"vary = { "clock.paints_per_s" = "41.0..57.0", "#;
        let text = GOOD.replace("vary = {", range);
        assert!(
            faults(&text).contains("= \"41.0..57.0\": must be a list of values where the design")
        );
        let filling = text.replace("vary =", "design = \"sobol:256\"\nvary =");
        let study = Scenario::read("t.toml", &filling, &[]).unwrap().study;
        assert_eq!(study.factors[1].values, Values::Between(41.0, 57.0));
    }

    #[test]
    fn every_fault_of_a_bad_scenario_is_told_at_once() {
        let text = GOOD
            .replace("\"touch\"", "\"tuoch\"")
            .replace("count = 4", "count = 0")
            .replace("delta = 0.05", "delta = -5")
            .replace("1..3, 8", "8..1")
            .replace("cap_s = 120", "cap_s = nan\ncap = 3");
        let faults = faults(&text);
        for expected in [
            "t.toml:4: contact = \"tuoch\": must be one of",
            "did you mean \"touch\"?",
            "t.toml:11: robots.wanderer.count = 0: must be a whole number from 1 to 250",
            "t.toml:13: study.delta = -5: must be a number above 0",
            "t.toml:14: study.vary.\"robots.wanderer.count\" = \"8..1\": must be a text of values",
            "t.toml:8: clock.cap_s = NaN: must be a number",
            "t.toml:9: clock.cap = 3: must be one of the known keys here: paints_per_s, cap_s",
        ] {
            assert!(faults.contains(expected), "{expected}\nnot in\n{faults}");
        }
    }

    #[test]
    fn a_cap_too_long_to_compute_is_told() {
        let text = GOOD.replace("cap_s = 120", "cap_s = 100000");
        assert!(
            faults(&text).contains("clock.cap_s = 100000: must be at most 1000000 paints at 56")
        );
    }

    #[test]
    fn an_override_replaces_the_files_value() {
        let change = Override {
            path: vec!["contact".to_owned()],
            value: Value::Text("nose".to_owned()),
            origin: "--contact".to_owned(),
        };
        let faults = Scenario::read("t.toml", GOOD, &[change]).unwrap_err();
        assert!(
            faults
                .to_string()
                .starts_with("--contact: contact = \"nose\": must be one of")
        );
    }
}
