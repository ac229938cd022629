//! A hash of the state of a run.

use super::participant::Participant;
use super::state::State;
use base::hash::Hash;
use base::hashed::Hashed;
use brain::Motion;

impl State {
    /// A hash of the poses, speeds, setpoints and counts of the robots, of which items were found, of
    /// the beliefs of the robots, of the goals and the memory of the controllers, and of the messages that have not
    /// reached their agents. What a run does not have adds nothing.
    ///
    /// It covers neither the memory of brains without beliefs, nor readings that have not reached a
    /// brain: [`Simulation::hash_decisions`](crate::simulation::Simulation::hash_decisions) covers
    /// what follows from them.
    #[must_use]
    pub fn hash(&self) -> u64 {
        let mut hash = Hash::new();
        hash.add(self.tick);
        (0..self.robots()).for_each(|robot| self.hash_body(robot, &mut hash));
        self.tally.add_to(&mut hash, &self.items);
        self.hash_beliefs(&mut hash);
        self.channel.hash_messages(&mut hash);
        self.hash_inboxes(&mut hash);
        self.hash_controllers(&mut hash);
        if let Some(convoy) = &self.convoy {
            convoy.as_ref().add_to(&mut hash);
        }
        hash.value()
    }

    /// A hash of all decisions since it was switched on, at a value that was given then: of the
    /// percept and the command of each step of each brain. `None` while it is off.
    #[must_use]
    pub fn decision_hash(&self) -> Option<u64> {
        self.decisions
    }

    fn hash_body(&self, robot: usize, hash: &mut Hash) {
        let (centre, body_state) = (self.discs[robot].centre, &self.body_states[robot]);
        let Motion {
            speed_m_s,
            turn_rate_rad_s,
        } = self.agents[robot].setpoint;
        [centre.x, centre.y].add_to(hash);
        [
            self.orientations[robot].heading_rad,
            body_state.speed_m_s,
            body_state.energy_j,
            body_state.distance_m,
            speed_m_s,
            turn_rate_rad_s,
        ]
        .add_to(hash);
        let is_external = u64::from(body_state.is_external());
        let status = is_external << 7 | body_state.status as u64;
        hash.add(u64::from(body_state.collisions) << 8 | status);
        if let Some(queue) = &self.agents[robot].queue {
            body_state.turn_rate_rad_s.add_to(hash);
            queue.add_to(hash);
        }
        if let Some(external) = self.body_states[robot].external() {
            external.add_to(hash);
        }
        if let Some(acting) = &self.agents[robot].inputs.acting {
            acting.add_to(hash);
        }
    }

    fn hash_beliefs(&self, hash: &mut Hash) {
        for (robot, agent) in self.agents.iter().enumerate() {
            if agent.brain.has_beliefs() {
                robot.add_to(hash);
                agent.brain.hash_beliefs(hash);
            }
        }
    }

    /// The messages that participants have received, and that wait for their agents.
    fn hash_inboxes(&self, hash: &mut Hash) {
        for (number, participant) in self.participants() {
            let inbox = &participant.inbox.entries;
            if !inbox.is_empty() {
                number.add_to(hash);
                inbox.add_to(hash);
            }
        }
    }

    fn hash_controllers(&self, hash: &mut Hash) {
        if !self.controllers.is_empty() {
            self.goals.add_issues_to(hash);
        }
        for agent in &self.controllers {
            (agent.participant.id, agent.participant.has_failed).add_to(hash);
            agent.controller.add_to(hash);
            if let Some(is_clear) = agent.stated {
                hash.add(is_clear.into());
            }
        }
    }

    /// The participants in communication, with their numbers.
    fn participants(&self) -> impl Iterator<Item = (usize, &Participant)> {
        let aboard = self.agents.iter();
        let aboard = aboard.map(|agent| agent.inputs.participant.as_deref());
        let controllers = self.controllers.iter();
        let controllers = controllers.map(|agent| Some(&agent.participant));
        let all = aboard.chain(controllers).enumerate();
        all.filter_map(|(number, participant)| Some((number, participant?)))
    }
}
