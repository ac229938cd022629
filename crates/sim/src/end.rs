//! When a run is complete.

use crate::scenario::features::Features;
use base::scenario::condition::{
    Condition, ConditionColumns, ConditionError, Operator, Quantity, parse,
};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// When a run is complete and over; without this table, when all targets are complete and all goals are served.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct EndSpec {
    /// The condition with which a run is complete: a count that changes during the run, compared with
    /// a number by `>=`, `>`, `<=`, `<`, `==` or `!=`, such as `"found_mine >= 3"`. The counts are
    /// `found` and `missed` (of all targets), `found_KIND` and `missed_KIND` (of a kind of items),
    /// `false_alarms`, `collisions` and `robots_stopped`, with goals `served`, and where robots act on items `left`,
    /// `marked`, `confirmed`, `neutralised` and `robots_lost`, and where controllers clear a lane `declared`, which is
    /// 1 once they have declared it clear. A run that is not complete when the time
    /// limit is reached, or when no robot can move, has failed.
    #[schemars(length(min = 1))]
    pub when: String,
}

/// What is counted during a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Count {
    /// Targets found.
    Found,
    /// Targets not found.
    Missed,
    FalseAlarms,
    Collisions,
    RobotsStopped,
    /// Goals served.
    Served,
    /// Targets not found, and goals not served.
    Open,
    /// Targets not complete.
    Left,
    /// Targets not complete, and goals not served.
    LeftOrOpen,
    /// Targets marked.
    Marked,
    /// Targets confirmed.
    Confirmed,
    /// Targets destroyed by a charge.
    Neutralised,
    /// Robots destroyed by items.
    RobotsLost,
    /// Whether controllers have declared a lane clear: 0 or 1.
    Declared,
    /// Items found of the kind of this number.
    FoundOf(usize),
    /// Items not found of the kind of this number.
    MissedOf(usize),
}

/// The condition with which a run is complete.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct EndCondition {
    pub(crate) count: Count,
    pub(crate) comparison: Condition,
}

impl Count {
    /// All counts, named as the outcome columns of scenarios with these kinds of items and these optional parts.
    fn all<'k>(kinds: impl Iterator<Item = &'k str>, has: Features) -> Vec<(String, Self)> {
        let of_one_kind = kinds.enumerate().flat_map(|(number, kind)| {
            [
                (format!("found_{kind}"), Self::FoundOf(number)),
                (format!("missed_{kind}"), Self::MissedOf(number)),
            ]
        });
        let of_all = [
            ("found", Self::Found),
            ("missed", Self::Missed),
            ("false_alarms", Self::FalseAlarms),
            ("collisions", Self::Collisions),
            ("robots_stopped", Self::RobotsStopped),
        ];
        let of_all = of_all.map(|(name, count)| (name.to_owned(), count));
        let of_goals = has.goals.then(|| ("served".to_owned(), Self::Served));
        let of_acts = [
            ("left", Self::Left),
            ("marked", Self::Marked),
            ("confirmed", Self::Confirmed),
            ("neutralised", Self::Neutralised),
            ("robots_lost", Self::RobotsLost),
        ];
        let of_acts = of_acts.map(|(name, count)| (name.to_owned(), count));
        let of_acts = of_acts.into_iter().filter(|_| has.acts);
        let of_clearance = [("declared", Self::Declared)].into_iter();
        let of_clearance = of_clearance.filter(|_| has.clearance);
        let of_clearance = of_clearance.map(|(name, count)| (name.to_owned(), count));
        let of_all = of_all.into_iter().chain(of_goals).chain(of_acts);
        let of_all = of_all.chain(of_clearance);
        of_all.chain(of_one_kind).collect()
    }
}

impl EndCondition {
    /// That all targets are found.
    pub(crate) fn all_found() -> Self {
        Self {
            count: Count::Missed,
            comparison: Condition {
                quantity: Quantity::Column("missed".to_owned()),
                place: 1,
                operator: Operator::Equal,
                number: 0.0,
            },
        }
    }

    /// That all targets are complete; `is_plain` if finding them completes all of them.
    pub(crate) fn all_complete(is_plain: bool) -> Self {
        let left = Self {
            count: Count::Left,
            ..Self::all_found()
        };
        if is_plain { Self::all_found() } else { left }
    }

    /// That all targets are complete and all goals are served; `is_plain` if finding the targets completes them.
    pub(crate) fn all_served(is_plain: bool) -> Self {
        let count = if is_plain {
            Count::Open
        } else {
            Count::LeftOrOpen
        };
        Self {
            count,
            ..Self::all_found()
        }
    }

    /// That controllers have declared a lane clear.
    pub(crate) fn declared() -> Self {
        Self {
            count: Count::Declared,
            comparison: Condition {
                quantity: Quantity::Column("declared".to_owned()),
                place: 0,
                operator: Operator::AtLeast,
                number: 1.0,
            },
        }
    }

    /// Parses a condition on the counts of scenarios with these kinds of items and these optional parts.
    pub(crate) fn parse<'k>(
        text: &str,
        kinds: impl Iterator<Item = &'k str>,
        has: Features,
    ) -> Result<Self, ConditionError> {
        let (names, counts): (Vec<String>, Vec<Count>) = Count::all(kinds, has).into_iter().unzip();
        let columns = ConditionColumns {
            names,
            ..ConditionColumns::default()
        };
        let comparison = parse(text, &columns)?;
        Ok(Self {
            count: counts[comparison.place],
            comparison,
        })
    }

    /// Whether it is that nothing is left to find or to serve.
    pub(crate) fn is_default(&self) -> bool {
        let is_of_no_text = matches!(self.count, Count::Open | Count::LeftOrOpen);
        *self == Self::all_found() || *self == Self::all_complete(false) || is_of_no_text
    }

    /// Whether it can hold for a count from 0 to `max`.
    pub(crate) fn can_hold(&self, max: f64) -> bool {
        let number = self.comparison.number.floor().clamp(0.0, max);
        let mut counts = [0.0, number, max].into_iter();
        counts.any(|count| self.comparison.holds_for(count))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn condition(text: &str) -> EndCondition {
        let has = Features {
            goals: true,
            acts: true,
            clearance: true,
            passage: true,
        };
        EndCondition::parse(text, ["cow", "mine"].into_iter(), has).unwrap()
    }

    #[test]
    fn a_condition_refers_to_a_count() {
        for (text, count) in [
            ("found >= 1", Count::Found),
            ("missed == 0", Count::Missed),
            ("found_mine >= 1", Count::FoundOf(1)),
            ("missed_cow < 2", Count::MissedOf(0)),
            ("robots_stopped > 0", Count::RobotsStopped),
            ("served >= 60", Count::Served),
        ] {
            assert_eq!(condition(text).count, count, "{text}");
        }
        assert_eq!(condition("missed == 0"), EndCondition::all_found());
    }

    #[test]
    fn a_condition_can_hold_if_it_does_for_a_possible_count() {
        for (text, max, expected) in [
            ("found >= 12", 12.0, true),
            ("found >= 12.5", 12.0, false),
            ("found > 12", 12.0, false),
            ("found == 7", 12.0, true),
            ("found == 7.5", 12.0, false),
            ("found == 13", 12.0, false),
            ("found == -1", 12.0, false),
            ("found < 0", 12.0, false),
            ("found <= 0", 12.0, true),
            ("found != 0", 12.0, true),
            ("found != 0", 0.0, false),
            ("false_alarms >= 1e9", f64::INFINITY, true),
            ("false_alarms == 3", f64::INFINITY, true),
        ] {
            assert_eq!(condition(text).can_hold(max), expected, "{text}");
        }
    }
}
