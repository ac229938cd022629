//! Whether a goal is being reached.

use crate::goals::proposal::Destination;
use base::geometry::Point;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// It comes nearer if the way left has become shorter by this since the best so far, in metres.
const NEARER_M: f64 = 0.1;

/// Who has not come nearer for so long recedes; and for so long, cannot get there; in seconds.
const RECEDING_S: f64 = 4.0;
const IMPOSSIBLE_S: f64 = 30.0;

/// What is impossible is not tried again for so long, in seconds: others have their turn meanwhile.
const RESTS_S: f64 = 10.0;

/// What is being made of a goal.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// It is there.
    Complete,
    /// There is no way as far as it knows, the battery does not last, or it has tried for too long.
    Impossible,
    /// It comes nearer.
    Approaching,
    /// It has not come nearer for some time.
    Receding,
}

/// What is known of a step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Step {
    pub(crate) at: Point,
    pub(crate) period_s: f64,
    /// A place to which there is no way as far as is known.
    pub(crate) closed: Option<Point>,
    /// So long the battery lasts.
    pub(crate) battery_s: f64,
    /// Where it went in the last step, and the way left to there: what it did not go for may wait.
    pub(crate) going: Option<(Point, f64)>,
}

impl Step {
    /// The way left to a place: as it knows it where it is going, straight to others.
    fn left_m(&self, to: Point) -> f64 {
        let known = self.going.filter(|(going, _)| *going == to);
        known.map_or_else(|| self.at.to(to).length(), |(_, left_m)| left_m)
    }
}

/// How a goal has been approached so far.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Fitness {
    /// The way left when it was shortest, and in the last step.
    pub(crate) best_m: f64,
    pub(crate) last_m: f64,
    /// It has not come nearer for so long.
    pub(crate) since_s: f64,
    /// It still is impossible for so long.
    pub(crate) rests_s: f64,
}

impl Default for Fitness {
    fn default() -> Self {
        Self {
            best_m: f64::INFINITY,
            last_m: f64::INFINITY,
            since_s: 0.0,
            rests_s: 0.0,
        }
    }
}

impl Fitness {
    /// Whether it is known to be impossible for now.
    pub(crate) fn rests(&self) -> bool {
        self.rests_s > 0.0
    }

    /// Lets it be impossible for some time.
    pub(crate) fn rest(&mut self) {
        self.rests_s = RESTS_S;
    }

    /// The verdict on a goal:
    ///
    /// ```text
    /// complete      distance <= within
    /// impossible    no way known, or battery time < way / speed, or not nearer for 30 s, and 10 s from then
    /// receding      not nearer for 4 s
    /// approaching   else
    /// ```
    pub(crate) fn judge(&mut self, aim: &Destination, step: &Step) -> Verdict {
        if self.rests() {
            self.rests_s -= step.period_s;
            if !self.rests() {
                *self = Self::default();
            }
        }
        let left_m = step.left_m(aim.to);
        self.note(left_m, aim, step);
        let is_far = super::time_s(left_m, aim) > step.battery_s;
        let is_closed = step.closed == Some(aim.to);
        if step.at.to(aim.to).length() <= aim.within_m {
            Verdict::Complete
        } else if self.rests() || is_closed || is_far || self.since_s > IMPOSSIBLE_S {
            Verdict::Impossible
        } else if self.since_s > RECEDING_S {
            Verdict::Receding
        } else {
            Verdict::Approaching
        }
    }

    /// Notes the way left.
    fn note(&mut self, left_m: f64, aim: &Destination, step: &Step) {
        // Nobody goes so far in a step: the way that it knew is closed, or a shorter one was found.
        let most_m = aim.speed_m_s * step.period_s + NEARER_M;
        let is_another_way = (left_m - self.last_m).abs() > most_m;
        self.last_m = left_m;
        if is_another_way {
            self.best_m = left_m;
        } else if left_m < self.best_m - NEARER_M {
            (self.best_m, self.since_s) = (left_m, 0.0);
        } else if step.going.is_some_and(|(to, _)| to == aim.to) {
            self.since_s += step.period_s;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const AIM: Destination = Destination {
        to: Point { x: 9.0, y: 0.0 },
        within_m: 0.5,
        speed_m_s: 1.0,
        value: 1.0,
    };

    /// So far before the aim, with so much way left.
    fn step(away_m: f64, left_m: f64) -> Step {
        Step {
            at: Point {
                x: AIM.to.x - away_m,
                y: 0.0,
            },
            period_s: 1.0,
            closed: None,
            battery_s: 20.0,
            going: Some((AIM.to, left_m)),
        }
    }

    #[test]
    fn who_comes_nearer_approaches_and_is_there_in_the_end() {
        let mut fitness = Fitness::default();
        for way_m in [9.0, 8.0, 7.0, 3.0] {
            let verdict = fitness.judge(&AIM, &step(way_m, way_m));
            assert_eq!(verdict, Verdict::Approaching);
        }
        assert_eq!(fitness.judge(&AIM, &step(0.4, 0.4)), Verdict::Complete);
    }

    #[test]
    fn who_does_not_come_nearer_recedes_and_gives_up_in_the_end() {
        let mut fitness = Fitness::default();
        let verdicts: Vec<Verdict> = (0..40)
            .map(|_| fitness.judge(&AIM, &step(5.0, 5.0)))
            .collect();
        assert_eq!(verdicts[4], Verdict::Approaching);
        assert_eq!(verdicts[6], Verdict::Receding);
        assert_eq!(verdicts[35], Verdict::Impossible);
    }

    #[test]
    fn who_goes_a_long_way_round_approaches_though_the_aim_is_no_nearer() {
        let mut fitness = Fitness::default();
        for left_m in (0..40).map(|step| 60.0 - f64::from(step)) {
            let step = Step {
                battery_s: 100.0,
                ..step(5.0, left_m)
            };
            assert_eq!(fitness.judge(&AIM, &step), Verdict::Approaching);
        }
    }

    #[test]
    fn who_finds_that_the_way_is_longer_approaches_as_soon_as_he_gets_on_there() {
        let mut fitness = Fitness::default();
        fitness.judge(&AIM, &step(5.0, 5.0));
        for left_m in [18.0, 17.0, 16.0, 15.0, 14.0, 13.0, 12.0] {
            let verdict = fitness.judge(&AIM, &step(5.0, left_m));
            assert_eq!(verdict, Verdict::Approaching);
        }
    }

    #[test]
    fn what_the_battery_does_not_reach_or_nothing_leads_to_is_impossible() {
        let empty = Step {
            battery_s: 3.0,
            ..step(5.0, 5.0)
        };
        let closed = Step {
            closed: Some(AIM.to),
            ..step(5.0, 5.0)
        };
        for step in [empty, closed] {
            let verdict = Fitness::default().judge(&AIM, &step);
            assert_eq!(verdict, Verdict::Impossible);
        }
    }
}
