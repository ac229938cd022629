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
//! times_s = { 1 = [120, 44], 2 = [120, 43] }
//! ```

use crate::contact::Contact;
use crate::start::MAX_ROBOTS;
use base::document::{Document, Section, Value};
use base::fault::Faults;
use std::collections::BTreeSet;

/// The only factor that a study of this engine varies.
pub const TEAM_SIZE: &str = "robots.wanderer.count";

/// Paints that a run may be counted for: some minutes of computing for a run that never ends.
const MAX_CAP_PAINTS: f64 = 1e6;

const MAX_RUNS: i64 = 1_000_000;

/// Everything that does not change in a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Scenario {
    /// One line for people.
    pub summary: String,
    /// What counts as finding an item.
    pub contact: Contact,
    /// How runs are scored.
    pub merit: Merit,
    /// Turns paints into seconds.
    pub paints_per_s: f64,
    /// A run that takes longer has failed, and counts as this long.
    pub cap_s: f64,
    /// Robots in a single run.
    pub robots: u32,
    /// What a study does.
    pub study: Study,
    /// Results of others.
    pub published: Option<Published>,
}

/// What a study does.
#[derive(Debug, Clone, PartialEq)]
pub struct Study {
    /// Runs of each configuration.
    pub runs: u64,
    /// Team sizes to compare, ascending.
    pub team_sizes: Vec<u32>,
}

/// Weights of a figure of merit; higher is better, so all are at most 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Merit {
    /// How the scenario names it.
    pub name: &'static str,
    /// For each second of a run, capped.
    pub time_s: f64,
    /// For each robot.
    pub robots: f64,
    /// For a failed run.
    pub failed: f64,
}

impl Merit {
    /// Equation 5.2 of the thesis: -(0.3 T/10 + 0.2 n + 0.5 failures in ten).
    pub const EQUATION: Self = Self {
        name: "equation-5.2",
        time_s: -0.03,
        robots: -0.2,
        failed: -5.0,
    };

    /// The sheet in the thesis's appendix, which forgets to divide the time by ten.
    pub const APPENDIX: Self = Self {
        name: "appendix",
        time_s: -0.3,
        ..Self::EQUATION
    };
}

/// Results of others, to show beside ours.
#[derive(Debug, Clone, PartialEq)]
pub struct Published {
    /// Where they stand.
    pub source: String,
    /// The team size that they recommend.
    pub choice: u32,
    /// Team size and the times of its runs; a time at the cap is a failed run.
    pub times_s: Vec<(u32, Vec<f64>)>,
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
    let summary = root.text("summary");
    let contact = root.choice("contact", &Contact::NAMES);
    let merits = [Merit::EQUATION, Merit::APPENDIX].map(|merit| (merit.name, merit));
    let merit = root.choice("merit", &merits);
    let clock = clock(&root.section("clock"));
    let robots = robots(&root.section("robots"));
    let study = study(&root.section("study"), robots);
    let cap_s = clock.map(|(_, cap_s)| cap_s);
    let published = root
        .has("published")
        .then(|| published(&root.section("published"), cap_s));
    engine?;
    let (paints_per_s, cap_s) = clock?;
    Some(Scenario {
        summary: summary?.to_owned(),
        contact: contact?,
        merit: merit?,
        paints_per_s,
        cap_s,
        robots: robots?,
        study: study?,
        published: match published {
            Some(read) => Some(read?),
            None => None,
        },
    })
}

fn clock(section: &Section) -> Option<(f64, f64)> {
    section.only(&["paints_per_s", "cap_s"]);
    let paints_per_s = section.number("paints_per_s", 0.1..=1000.0);
    let cap_s = section.number("cap_s", 0.0..=1e6);
    let (paints_per_s, cap_s) = (paints_per_s?, cap_s?);
    if paints_per_s * cap_s > MAX_CAP_PAINTS {
        let allowed = format!(
            "at most {MAX_CAP_PAINTS} paints: {} s",
            MAX_CAP_PAINTS / paints_per_s
        );
        section.fault("cap_s", &allowed);
        return None;
    }
    Some((paints_per_s, cap_s))
}

fn robots(section: &Section) -> Option<u32> {
    section.only(&["wanderer"]);
    let wanderer = section.section("wanderer");
    wanderer.only(&["count"]);
    let count = wanderer.integer("count", 1..=MAX_ROBOTS.into())?;
    u32::try_from(count).ok()
}

fn study(section: &Section, robots: Option<u32>) -> Option<Study> {
    section.only(&["runs", "vary"]);
    let runs = section.integer("runs", 2..=MAX_RUNS);
    let vary = section.section("vary");
    vary.only(&[TEAM_SIZE]);
    let team_sizes = if vary.has(TEAM_SIZE) {
        let sizes = vary.text(TEAM_SIZE).map(values);
        if sizes == Some(None) {
            let allowed = format!(
                "whole numbers from 1 to {MAX_ROBOTS}, such as \"1..8\" (both ends included) or \"1,2,4\""
            );
            vary.fault(TEAM_SIZE, &allowed);
        }
        sizes.flatten()
    } else {
        robots.map(|count| vec![count])
    };
    Some(Study {
        runs: u64::try_from(runs?).ok()?,
        team_sizes: team_sizes?,
    })
}

/// The numbers of `1..8` (both ends included), `1,2,4` or a mixture, ascending; `None` if any is
/// none or out of range.
fn values(text: &str) -> Option<Vec<u32>> {
    let number = |text: &str| {
        let number = text.trim().parse().ok()?;
        (1..=MAX_ROBOTS).contains(&number).then_some(number)
    };
    let mut values = BTreeSet::new();
    for part in text.split(',') {
        let (low, high) = part.split_once("..").unwrap_or((part, part));
        let range = number(low)?..=number(high)?;
        if range.is_empty() {
            return None;
        }
        values.extend(range);
    }
    Some(values.into_iter().collect())
}

fn published(section: &Section, cap_s: Option<f64>) -> Option<Published> {
    section.only(&["source", "choice", "times_s"]);
    let source = section.text("source");
    let choice = section.integer("choice", 1..=MAX_ROBOTS.into());
    let teams = section.section("times_s");
    let max_s = cap_s.unwrap_or(f64::MAX);
    let times_of = |key: &str| {
        let Some(&[robots]) = values(key).as_deref() else {
            teams.fault(key, &format!("under a team size from 1 to {MAX_ROBOTS}"));
            return None;
        };
        Some((robots, teams.numbers(key, 0.0..=max_s)?))
    };
    let times: Vec<_> = teams.keys().map(times_of).collect();
    let mut times_s: Vec<(u32, Vec<f64>)> = times.into_iter().collect::<Option<_>>()?;
    times_s.sort_by_key(|(robots, _)| *robots);
    Some(Published {
        source: source?.to_owned(),
        choice: u32::try_from(choice?).ok()?,
        times_s,
    })
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
times_s = { 10 = [120], 2 = [4, 5.5] }
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
        assert_eq!(times, [(2, vec![4.0, 5.5]), (10, vec![120.0])]);
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
            "t.toml:14: study.vary.\"robots.wanderer.count\" = \"8..1\": must be whole numbers",
            "t.toml:8: clock.cap_s = NaN: must be a number",
            "t.toml:9: clock.cap = 3: must be one of the known keys here: paints_per_s, cap_s",
        ] {
            assert!(faults.contains(expected), "{expected}\nnot in\n{faults}");
        }
    }

    #[test]
    fn a_cap_too_long_to_compute_is_told() {
        let text = GOOD.replace("cap_s = 120", "cap_s = 100000");
        assert!(faults(&text).contains("clock.cap_s = 100000: must be at most 1000000 paints"));
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
