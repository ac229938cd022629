//! What a study does.

use crate::start::MAX_ROBOTS;
use base::document::Section;
use std::collections::BTreeSet;

/// The only factor that a study of this engine varies.
pub const TEAM_SIZE_PATH: &str = "robots.wanderer.count";

const MAX_RUNS: i64 = 1_000_000;

/// What a study does.
#[derive(Debug, Clone, PartialEq)]
pub struct Study {
    /// Runs of each configuration.
    pub runs: u64,
    /// Team sizes to compare, ascending.
    pub team_sizes: Vec<u32>,
}

pub(super) fn study(section: &Section, robots: Option<u32>) -> Option<Study> {
    section.only(&["runs", "vary"]);
    let runs = section.integer("runs", 2..=MAX_RUNS);
    let vary = section.section("vary");
    vary.only(&[TEAM_SIZE_PATH]);
    let team_sizes = if vary.has(TEAM_SIZE_PATH) {
        let allowed = format!(
            "a text of whole numbers from 1 to {MAX_ROBOTS}, such as \"1..8\" (both ends \
             included) or \"1,2,4\""
        );
        vary.parsed(TEAM_SIZE_PATH, &allowed, values)
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
