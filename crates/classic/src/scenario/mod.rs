//! A scenario of the classic engine: what a study of the 2003 experiment is told in a TOML file.
//!
//! ```toml
//! engine = "classic"
//! summary = "One line for people."
//! contact = "touch"                       # see `contact`
//! merit = "equation-5.2"                  # or "appendix"
//!
//! [clock]
//! paints_per_s = 56
//! cap_s = 120
//!
//! [robots.wanderer]
//! count = 4                               # of a single run; a study varies it
//!
//! [study]
//! runs = 10000                            # of each configuration
//! vary = { "robots.wanderer.count" = "1..8" }
//!
//! [published]                             # may be left out: results to show beside ours
//! source = "Williams 2003"
//! choice = 3
//! cap_s = 120
//! times_s = { 1 = [120, 44], 2 = [120, 43] }
//! ```

mod clock;
mod merit;
mod published;
mod study;

pub use clock::{Clock, MAX_CAP_PAINTS};
pub use merit::Merit;
pub use published::Published;
pub use study::{Study, TEAM_SIZE_PATH};

use crate::contact::Contact;
use crate::start::MAX_ROBOTS;
use base::document::{Document, Section, Value};
use base::fault::Faults;

const MAX_CAP_S: f64 = 1e6;

/// Everything that does not change in a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Scenario {
    /// One line for people.
    pub summary: String,
    /// What counts as finding an item.
    pub contact: Contact,
    /// How runs are scored.
    pub merit: Merit,
    /// How paints are seconds, and when a search has failed.
    pub clock: Clock,
    /// Robots in a single run.
    pub robots: u32,
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
        document.read(scenario)
    }
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
    let engine = root.choice("engine", &[("classic", ())]);
    let summary = root.line("summary");
    let contact = root.choice("contact", &Contact::NAMES);
    let merits = Merit::ALL.map(|merit| (merit.name, merit));
    let merit = root.choice("merit", &merits);
    let clock = clock::clock(&root.section("clock"));
    let robots = robots(&root.section("robots"));
    let study = study::study(&root.section("study"), robots);
    let published = root
        .has("published")
        .then(|| published::published(&root.section("published")));
    engine?;
    Some(Scenario {
        summary: summary?,
        contact: contact?,
        merit: merit?,
        clock: clock?,
        robots: robots?,
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
runs = 100
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
        assert_eq!(scenario.contact, Contact::Touch);
        assert_eq!(scenario.merit, Merit::EQUATION);
        assert_eq!(scenario.study.team_sizes, [1, 2, 3, 8]);
        let times = scenario.published.unwrap().times_s;
        assert_eq!(times, [(2, vec![4.0, 5.5]), (10, vec![120.0, 120.0])]);
    }

    #[test]
    fn without_vary_the_scenarios_own_team_is_studied() {
        let text = GOOD.replace("vary =", "#");
        assert_eq!(
            Scenario::read("t.toml", &text, &[])
                .unwrap()
                .study
                .team_sizes,
            [4]
        );
    }

    #[test]
    fn every_fault_of_a_bad_scenario_is_told_at_once() {
        let text = GOOD
            .replace("\"touch\"", "\"tuoch\"")
            .replace("count = 4", "count = 0")
            .replace("runs = 100", "runs = -5")
            .replace("1..3, 8", "8..1")
            .replace("cap_s = 120", "cap_s = nan\ncap = 3");
        let faults = faults(&text);
        for expected in [
            "t.toml:4: contact = \"tuoch\": must be one of",
            "did you mean \"touch\"?",
            "t.toml:11: robots.wanderer.count = 0: must be a whole number from 1 to 250",
            "t.toml:13: study.runs = -5: must be a whole number from 2 to 1000000",
            "t.toml:14: study.vary.\"robots.wanderer.count\" = \"8..1\": must be a text of whole",
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
