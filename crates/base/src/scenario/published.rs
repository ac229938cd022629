//! Published results, shown beside those of a study.

use crate::document::Section;
use crate::engine::MAX_TIME_LIMIT_S;

/// Published results, shown beside those of a study.
#[derive(Debug, Clone, PartialEq)]
pub struct Published {
    /// Source of the results.
    pub source: String,
    /// The team size that the source recommends.
    pub choice: u32,
    /// Time limit of the published runs, in seconds; a run with this time failed.
    pub time_limit_s: f64,
    /// Times of the runs, in seconds, by team size.
    pub times_s: Vec<(u32, Vec<f64>)>,
}

pub(super) fn published(section: &Section, max_robots: u32) -> Option<Published> {
    section.only(&["source", "choice", "time_limit_s", "times_s"]);
    let source = section.line("source");
    let choice = section.integer("choice", 1..=max_robots.into());
    let time_limit_s = section.number("time_limit_s", 0.0..=MAX_TIME_LIMIT_S);
    let max_s = time_limit_s.unwrap_or(MAX_TIME_LIMIT_S);
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
        // "01" parses as a team size too, but would be a second entry for 1.
        let Some(robots) = robots.filter(|robots: &u32| robots.to_string() == key) else {
            teams.error(
                key,
                &format!("listed under a team size from 1 to {max_robots}"),
            );
            return None;
        };
        let times_s = teams.numbers(key, 0.0..=max_s)?;
        if times_s.len() < 2 {
            teams.error(key, "a list of at least two times: an interval needs them");
            return None;
        }
        Some((robots, times_s))
    };
    let times: Vec<_> = teams.keys().map(times_of).collect();
    let mut times_s: Vec<(u32, Vec<f64>)> = times.into_iter().collect::<Option<_>>()?;
    times_s.sort_by_key(|(robots, _)| *robots);
    Some(times_s)
}
