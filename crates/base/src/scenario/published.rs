//! Results of others, to show beside ours.

use crate::document::Section;
use crate::engine::MAX_CAP_S;

/// Results of others, to show beside ours.
#[derive(Debug, Clone, PartialEq)]
pub struct Published {
    /// Where they stand.
    pub source: String,
    /// The team size that they recommend.
    pub choice: u32,
    /// Where they stopped; a time of this much is a failed run.
    pub time_limit_s: f64,
    /// Team size and the times of its runs.
    pub times_s: Vec<(u32, Vec<f64>)>,
}

pub(super) fn published(section: &Section, max_robots: u32) -> Option<Published> {
    section.only(&["source", "choice", "time_limit_s", "times_s"]);
    let source = section.line("source");
    let choice = section.integer("choice", 1..=max_robots.into());
    let time_limit_s = section.number("time_limit_s", 0.0..=MAX_CAP_S);
    let max_s = time_limit_s.unwrap_or(MAX_CAP_S);
    let times_s = times_s(&section.section("times_s"), max_s, max_robots);
    Some(Published {
        source: source?,
        choice: u32::try_from(choice?).ok()?,
        time_limit_s: time_limit_s?,
        times_s: times_s?,
    })
}

fn times_s(teams: &Section, max_s: f64, max_robots: u32) -> Option<Vec<(u32, Vec<f64>)>> {
    let times_of = |key: &str| {
        let robots = key
            .parse()
            .ok()
            .filter(|robots| (1..=max_robots).contains(robots));
        // "01" is a team size to a parser, but would be a second one of 1.
        let Some(robots) = robots.filter(|robots: &u32| robots.to_string() == key) else {
            teams.error(key, &format!("under a team size from 1 to {max_robots}"));
            return None;
        };
        let times_s = teams.numbers(key, 0.0..=max_s)?;
        if times_s.len() < 2 {
            teams.error(key, "two times or more: one has no interval");
            return None;
        }
        Some((robots, times_s))
    };
    let times: Vec<_> = teams.keys().map(times_of).collect();
    let mut times_s: Vec<(u32, Vec<f64>)> = times.into_iter().collect::<Option<_>>()?;
    times_s.sort_by_key(|(robots, _)| *robots);
    Some(times_s)
}
