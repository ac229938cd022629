//! How soon goals have an owner again, and are offered again, after an agent is lost.

use crate::controller::{CALLS_PER_STEP, CANDIDACY_S, MAX_MESSAGES, REPEAT_S, RETRY_S, TURN_S};
use crate::settings::Settings;
use brain::wait_s;

impl Settings {
    /// The time within which each open goal that a working agent knows has an owner or is reported as
    /// lost, and each robot in the owner's range without an award has been offered the goals for
    /// which it can bid. It holds without lost messages, with the agents connected and no further
    /// failure, for a number of goals and steps and delays of these durations in seconds.
    ///
    /// ```text
    ///   owner lease      until no vote for a lost owner is left, and that reports the goal as lost; an agent
    ///                    that restarts grants nothing for that long
    /// + candidacies      of several controllers: until a majority votes for one, or it reports that none does
    /// + service lease    until it can be awarded: a robot may still serve it
    /// + call period      until each goal has been called again
    /// + goals x step / calls per step
    /// + 4 (step + delay) until the messages have arrived
    /// ```
    ///
    /// Each lease is as long as its grantor waits on a drifting clock. Goals that no robot could serve
    /// are reported; they are offered again when a robot comes into range, and after at most 320 s.
    #[must_use]
    pub fn recovery_s(&self, goals: u32, step_s: f64, delay_s: f64) -> f64 {
        let leases_s = self.owner_lease_s.max(self.service_lease_s) + self.service_lease_s;
        #[expect(clippy::cast_precision_loss, reason = "a few calls")]
        let calls_s = f64::from(goals) * step_s / CALLS_PER_STEP as f64;
        let drifted = 1.0 + 2.0 * self.max_drift;
        let waits_s = self.candidacies_s(goals, step_s) + REPEAT_S + calls_s;
        let by_clock_s = wait_s(leases_s, self.max_drift) + waits_s * drifted;
        by_clock_s * drifted + 4.0 * (step_s + delay_s)
    }

    /// The longest time from the end of the last vote for an owner until the next one owns the goal, or has reported that
    /// no controller does: each has its turn, one gives up, and another is a candidate, whose requests take a step for each few. Nothing for a
    /// single controller.
    #[expect(clippy::cast_precision_loss, reason = "a few messages")]
    fn candidacies_s(&self, goals: u32, step_s: f64) -> f64 {
        if self.votes_needed() == 0 {
            return 0.0;
        }
        let requests = f64::from(goals * self.count) / MAX_MESSAGES as f64;
        f64::from(self.count) * TURN_S + 2.0 * CANDIDACY_S + RETRY_S + requests * step_s
    }
}
