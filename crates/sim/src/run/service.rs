//! Robots that a person takes out of service, or puts back into it.

use super::state::State;
use crate::scenario::Scenario;
use brain::{AgentId, ContractMessage};

impl State {
    /// Orders the robots out of service that the scenario names.
    pub(super) fn order_service(&mut self, scenario: &Scenario) {
        for robot in 0..self.robots() {
            if is_out(scenario, self.ids[robot]) {
                self.set_service(robot, false);
            }
        }
    }

    /// Orders robots that stay, each from its `old` number, out of service or back into it.
    pub(super) fn change_service(
        &mut self,
        (before, from): (&Self, &Scenario),
        to: &Scenario,
        old: &[Option<usize>],
    ) {
        for (robot, was) in old.iter().enumerate() {
            let is_out_now = is_out(to, self.ids[robot]);
            let was_out = was.map(|was| is_out(from, before.ids[was]));
            if was_out.is_some_and(|was_out| was_out != is_out_now) {
                self.set_service(robot, !is_out_now);
            }
        }
    }

    /// A person's order reaches a robot that has a radio.
    fn set_service(&mut self, robot: usize, is_in: bool) {
        self.order(robot, ContractMessage::Service(is_in));
    }
}

fn is_out(scenario: &Scenario, id: AgentId) -> bool {
    scenario.kind_of(id).out_of_service.contains(&id.index)
}
