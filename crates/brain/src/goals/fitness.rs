//! Whether a goal is being reached.

use crate::wish::Aim;
use base::geometry::Point;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// It comes nearer if the way left has become shorter by this since the best so far, in metres.
const NEARER_M: f64 = 0.1;

/// Who has not come nearer for so long recedes; and for so long, cannot get there; in seconds.
const RECEDING_S: f64 = 4.0;
const IMPOSSIBLE_S: f64 = 30.0;

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
    /// Where it went in the last step: what it did not go for may wait.
    pub(crate) going: Option<Point>,
}

/// How a goal has been approached so far.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Fitness {
    best_m: f64,
    since_s: f64,
}

impl Default for Fitness {
    fn default() -> Self {
        Self {
            best_m: f64::INFINITY,
            since_s: 0.0,
        }
    }
}

impl Fitness {
    /// The verdict on a goal that is `way_m` away:
    ///
    /// ```text
    /// complete      way <= within
    /// impossible    no way known, or battery time < way / speed, or not nearer for 30 s
    /// receding      not nearer for 4 s
    /// approaching   else
    /// ```
    pub(crate) fn judge(&mut self, way_m: f64, aim: &Aim, step: &Step) -> Verdict {
        if way_m < self.best_m - NEARER_M {
            (self.best_m, self.since_s) = (way_m, 0.0);
        } else if step.going == Some(aim.to) {
            self.since_s += step.period_s;
        }
        let needed_s = super::time_s(way_m, aim);
        let is_closed = step.closed == Some(aim.to);
        if way_m <= aim.within_m {
            Verdict::Complete
        } else if is_closed || needed_s > step.battery_s || self.since_s > IMPOSSIBLE_S {
            Verdict::Impossible
        } else if self.since_s > RECEDING_S {
            Verdict::Receding
        } else {
            Verdict::Approaching
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const AIM: Aim = Aim {
        to: Point { x: 9.0, y: 0.0 },
        within_m: 0.5,
        speed_m_s: 1.0,
        value: 1.0,
    };

    const STEP: Step = Step {
        at: Point { x: 0.0, y: 0.0 },
        period_s: 1.0,
        closed: None,
        battery_s: 20.0,
        going: Some(AIM.to),
    };

    #[test]
    fn who_comes_nearer_approaches_and_is_there_in_the_end() {
        let mut fitness = Fitness::default();
        for way_m in [9.0, 8.0, 7.0, 3.0] {
            assert_eq!(fitness.judge(way_m, &AIM, &STEP), Verdict::Approaching);
        }
        assert_eq!(fitness.judge(0.4, &AIM, &STEP), Verdict::Complete);
    }

    #[test]
    fn who_does_not_come_nearer_recedes_and_gives_up_in_the_end() {
        let mut fitness = Fitness::default();
        let verdicts: Vec<Verdict> = (0..40).map(|_| fitness.judge(5.0, &AIM, &STEP)).collect();
        assert_eq!(verdicts[4], Verdict::Approaching);
        assert_eq!(verdicts[6], Verdict::Receding);
        assert_eq!(verdicts[35], Verdict::Impossible);
    }

    #[test]
    fn what_the_battery_does_not_reach_or_nothing_leads_to_is_impossible() {
        let empty = Step {
            battery_s: 3.0,
            ..STEP
        };
        assert_eq!(
            Fitness::default().judge(5.0, &AIM, &empty),
            Verdict::Impossible
        );
        let closed = Step {
            closed: Some(AIM.to),
            ..STEP
        };
        assert_eq!(
            Fitness::default().judge(5.0, &AIM, &closed),
            Verdict::Impossible
        );
    }
}
