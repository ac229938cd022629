//! Acts on items: what robots do with their tools, after all have moved.
//!
//! One robot after the other, in their order: an item that one has destroyed is gone for the next.

use crate::bodies::body_state::{BodyState, Status};
use crate::bodies::tools::Tool;
use crate::judge::act_tally::Done;
use crate::judge::events::EventLog;
use crate::run::acting::{Acting, Work};
use crate::run::state::State;
use crate::scenario::Scenario;
use crate::sensors::sensor_frame::NoisePurpose;
use crate::world::items::MARK_TOLERANCE_M;
use base::geometry::Point;
use base::noise::share;
use brain::{Act, ActKind};

/// A robot that is slower is stationary.
const STANDS_M_S: f64 = 1e-6;

/// Lets all robots with tools act; returns whether the judge counted anything.
pub(super) fn carry_out(scenario: &Scenario, state: &mut State, events: &EventLog) -> bool {
    let mut is_counted = false;
    if state.tally.acts.is_none() {
        return false;
    }
    for robot in 0..state.robots() {
        let Some(mut acting) = state.agents[robot].inputs.acting.take() else {
            continue;
        };
        is_counted |= state.act(scenario, robot, &mut acting, events);
        state.agents[robot].inputs.acting = Some(acting);
    }
    is_counted
}

/// Whether a robot can act in the simulated world.
fn is_able(body_state: &BodyState) -> bool {
    body_state.status == Status::Active && !body_state.is_external()
}

impl State {
    fn act(
        &mut self,
        scenario: &Scenario,
        robot: usize,
        acting: &mut Acting,
        events: &EventLog,
    ) -> bool {
        let body_state = &self.body_states[robot];
        if !is_able(body_state) {
            acting.command(&[]);
        }
        let stands = body_state.speed_m_s.abs() < STANDS_M_S;
        let begun = acting.work.take();
        let mut is_counted = false;
        for act in std::mem::take(&mut acting.acts) {
            let Some(tool) = self.usable(scenario, robot, acting, act) else {
                acting.report(act, false);
                continue;
            };
            if tool.duration_steps > 0 {
                // One at a time: the first.
                if acting.work.is_none() && stands {
                    acting.work = Some(continued(begun, act, &tool, self.tick));
                }
                let work = acting.work.filter(|work| work.act == act);
                let ends_at = work.map(|work| work.since + tool.duration_steps);
                if ends_at.is_none_or(|ends_at| self.tick + 1 < ends_at) {
                    acting.acts.push(act);
                    continue;
                }
                acting.work = None;
            }
            is_counted |= self.complete(scenario, robot, (acting, act, &tool), events);
        }
        is_counted
    }

    /// The tool for an act, if the robot has it and the place is in range.
    fn usable(&self, scenario: &Scenario, robot: usize, acting: &Acting, act: Act) -> Option<Tool> {
        let kind = scenario.kind_of(self.ids[robot]);
        let tool = kind.tools.iter().find(|tool| tool.known.act == act.kind)?;
        let centre = self.discs[robot].centre;
        let distance_m = centre.to(scenario.image(centre, act.at)).length();
        let is_charge = act.kind == ActKind::Neutralise;
        // Of an item, the distance is examined when the charge goes off.
        let reach_m = if is_charge { tool.known.reach_m } else { 0.0 };
        let has_charge = !is_charge || acting.charges != Some(0);
        (distance_m <= tool.known.range_m + reach_m && has_charge).then_some(*tool)
    }

    /// Completes an act: changes the world, and reports it to the robot and to the judge.
    fn complete(
        &mut self,
        scenario: &Scenario,
        robot: usize,
        (acting, act, tool): (&mut Acting, Act, &Tool),
        events: &EventLog,
    ) -> bool {
        let at = scenario.home(act.at);
        let (items, is_success) = match act.kind {
            ActKind::Mark | ActKind::Confirm | ActKind::Reject => (
                self.items
                    .nearest(at, MARK_TOLERANCE_M)
                    .into_iter()
                    .collect(),
                true,
            ),
            ActKind::Isolate => (self.items.within(at, tool.known.reach_m), true),
            ActKind::Neutralise => self.attempt(scenario, robot, at, tool),
            // No robot has a tool for these.
            ActKind::DeclareClear | ActKind::GiveUp => (Vec::new(), false),
        };
        if let Some(charges) = acting
            .charges
            .as_mut()
            .filter(|_| act.kind == ActKind::Neutralise)
        {
            *charges -= 1;
        }
        if act.kind == ActKind::Neutralise && is_success {
            for item in &items {
                self.items.remove(*item);
            }
        }
        acting.report(act, is_success);
        let done = Done {
            act: Act { at, ..act },
            by: self.ids[robot],
            items,
            is_success,
        };
        self.tally
            .acted(&done, (scenario, self.tick, &self.items), events)
    }

    /// The item that a charge at a place hits, and whether it destroys it.
    fn attempt(
        &self,
        scenario: &Scenario,
        robot: usize,
        at: Point,
        tool: &Tool,
    ) -> (Vec<u32>, bool) {
        let item = self.items.nearest(at, tool.known.reach_m);
        let centre = self.discs[robot].centre;
        let distance_m = |item: u32| {
            let place = scenario.image(centre, self.items.place(item));
            centre.to(place).length()
        };
        let item = item.filter(|item| distance_m(*item) <= tool.known.range_m);
        let words = self.noises[robot].words(NoisePurpose::Act as u32, self.tick, 0);
        let is_success = item.is_some() && share(words[0]) < tool.success_probability;
        (item.into_iter().collect(), is_success)
    }
}

/// The work on an act: that which has begun, or that which begins in this step. An act at another place within the
/// reach of the tool is the same: beliefs move.
fn continued(begun: Option<Work>, act: Act, tool: &Tool, tick: u64) -> Work {
    let is_same = |work: &Work| {
        let moved_m = work.act.at.to(act.at).length();
        work.act.kind == act.kind && moved_m <= tool.known.reach_m
    };
    let since = begun.filter(is_same).map_or(tick, |work| work.since);
    Work { act, since }
}
