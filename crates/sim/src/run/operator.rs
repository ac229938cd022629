//! The operator: the person that issues goals to controllers and receives their reports.
//!
//! What the operator sends is not sent by radio: it reaches agents in the next step. What agents report to it counts among
//! the messages of their radios, and arrives at once.

use super::state::State;
use crate::radio::channel::Outgoing;
use crate::scenario::Scenario;
use crate::schedule::steps_of;
use brain::{About, AgentId, ContractMessage, Message, Reason, ReceivedMessage, Refusal};

/// A goal that all controllers refuse is issued again after this time, in seconds: one may have room by then.
const RETRY_S: f64 = 10.0;

impl State {
    /// Answers what controllers report in a step: each report is acknowledged, and a goal that one of them refuses is
    /// issued to the next.
    pub(crate) fn answer_reports<'m>(
        &mut self,
        scenario: &Scenario,
        sent: impl Iterator<Item = &'m Outgoing>,
    ) {
        if self.tally.goals.is_none() {
            return;
        }
        let reports = sent.filter(|sent| sent.message.to == AgentId::OPERATOR.into());
        for Outgoing { from, message, .. } in reports {
            let About::Contract(report) = message.about else {
                continue;
            };
            match report {
                ContractMessage::Stuck(report) => self.acknowledge(*from as usize, &report),
                ContractMessage::Refuse(refusal) => {
                    self.acknowledge(*from as usize, &refusal);
                    self.take_refusal(scenario, *from as usize, &refusal);
                }
                _ => {}
            }
        }
    }

    fn acknowledge(&mut self, agent: usize, report: &Refusal) {
        self.order(agent, ContractMessage::Acknowledge(report.goal));
    }

    /// Sends an order to an agent with a radio: the number of a robot, or after those of all robots, of a controller.
    pub(super) fn order(&mut self, agent: usize, message: ContractMessage) {
        let (robots, now) = (self.robots(), self.tick);
        let participant = if agent < robots {
            self.agents[agent].inputs.participant.as_deref_mut()
        } else {
            Some(&mut self.controllers[agent - robots].participant)
        };
        if let Some(participant) = participant {
            participant.receive_order(order_to(participant.id, message), now);
        }
    }

    /// A controller to which a goal was issued does not own it.
    fn take_refusal(&mut self, scenario: &Scenario, agent: usize, refusal: &Refusal) {
        let Some(controller) = agent.checked_sub(self.robots()) else {
            return;
        };
        let (Some(number), Some(tally)) = (self.goals.number(refusal.goal), &mut self.tally.goals)
        else {
            return;
        };
        let record = &mut tally.records[number];
        let id = self.controllers[controller].participant.id;
        if record.issued_to != Some(id) || record.served.is_some() {
            return;
        }
        (record.issued_to, record.unserved) = (None, Some(refusal.reason));
        if refusal.reason == Reason::Invalid {
            return;
        }
        let is_last = self
            .goals
            .refuse(number)
            .is_multiple_of(self.controllers.len());
        let wait = if is_last {
            steps_of(RETRY_S, scenario.step_s)
        } else {
            1
        };
        self.goals.issue_again(number, self.tick + wait);
    }
}

/// An order as an agent receives it.
pub(super) fn order_to(agent: AgentId, message: ContractMessage) -> ReceivedMessage {
    ReceivedMessage {
        from: AgentId::OPERATOR,
        age_s: 0.0,
        message: Message::to(agent, message),
    }
}
