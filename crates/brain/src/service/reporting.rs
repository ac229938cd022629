//! What a robot reports to controllers.

use super::ability::{Ability, Moment};
use super::assignee::Assignee;
use crate::io::agent_id::AgentId;
use crate::io::contract::{ContractMessage, Fitness, Refusal, Report};
use crate::io::goal_id::GoalId;
use crate::io::lease::Claim;
use crate::io::reason::Reason;
use alloc::vec::Vec;
use base::geometry::Point;

impl Assignee {
    /// Reports the goals that have been served, or that it serves no longer, and now and then the robot's state.
    pub(super) fn report(&mut self, ability: &Ability, moment: &Moment) {
        let done: Vec<(AgentId, Claim)> = self.finished.due(self.now_s).collect();
        for (owner, claim) in done {
            self.send(owner, ContractMessage::Done(claim));
        }
        for report in self.returned.due(self.now_s) {
            self.send(AgentId::OPERATOR, report);
        }
        let Some(at) = moment.at.filter(|_| !self.is_out_of_service) else {
            return;
        };
        let receivers: Vec<AgentId> = self.schedule.due(self.now_s).collect();
        for to in receivers {
            self.send(to, ContractMessage::Report(self.state(ability, moment, at)));
            if let Some(fitness) = self.fitness(to, ability, at) {
                self.send(to, ContractMessage::Fitness(fitness));
            }
        }
    }

    #[expect(clippy::cast_possible_truncation, reason = "messages are short")]
    pub(super) fn state(&self, ability: &Ability, moment: &Moment, at: Point) -> Report {
        let goals = self.jobs.list.len();
        let free = ability.max_goals.saturating_sub(goals);
        Report {
            at_m: [at.x as f32, at.y as f32],
            speed_m_s: ability.speed_m_s as f32,
            battery: moment.charge.unwrap_or(1.0) as f32,
            goals: u16::try_from(goals).unwrap_or(u16::MAX),
            payload: u16::try_from(free).unwrap_or(u16::MAX),
        }
    }

    /// The progress towards the first goal of a controller.
    #[expect(clippy::cast_possible_truncation, reason = "messages are short")]
    pub(super) fn fitness(&self, owner: AgentId, ability: &Ability, at: Point) -> Option<Fitness> {
        let job = self.jobs.list.iter().find(|job| job.owner == owner)?;
        let away_m = at.to(job.task.at()).length();
        let remaining_s = ability.travel_s(away_m) + ability.work_s(&job.task) - job.served_s;
        Some(Fitness {
            goal: job.task.id,
            verdict: job.verdict,
            remaining_s: remaining_s as f32,
        })
    }

    pub(super) fn report_failure(&mut self, goal: GoalId, reason: Reason) {
        if let Some(lease) = self.holder.lease(goal) {
            let (to, number) = (lease.grantor, lease.number);
            self.send(
                to,
                ContractMessage::Stuck(Refusal {
                    goal,
                    number,
                    reason,
                }),
            );
        }
    }

    pub(super) fn refuse(&mut self, to: AgentId, goal: GoalId, number: u32, reason: Reason) {
        self.send(
            to,
            ContractMessage::Refuse(Refusal {
                goal,
                number,
                reason,
            }),
        );
    }
}
