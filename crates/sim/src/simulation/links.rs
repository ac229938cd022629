//! Radio links between robots and controllers, for display only: no agent uses them.

use super::{NoRobot, Simulation};
use crate::step::communicate::Participants;
use brain::AgentId;

/// Two robots or controllers of which at least one receives the other's messages, unless they are lost by chance.
///
/// Robots are numbered in the order of [`State::each_robot`](super::State::each_robot), and controllers after them in the
/// order of [`State::each_controller`](super::State::each_controller).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Link {
    /// The sender; the lower number if the link is mutual.
    pub from: u32,
    /// The receiver.
    pub to: u32,
    /// Whether each receives the other.
    pub is_mutual: bool,
}

impl Simulation {
    /// The current links, at most `most`: of one robot, or of all robots and controllers; ordered by the numbers, the
    /// lower one first. The run does not change.
    ///
    /// # Errors
    /// If there is no such robot.
    pub fn links(&mut self, of: Option<AgentId>, most: usize) -> Result<Vec<Link>, NoRobot> {
        of.map(|id| self.number(id)).transpose()?;
        let radios = self.scenario().kinds.iter().filter_map(|kind| kind.radio);
        let controllers = self.scenario().controllers.iter().map(|kind| kind.radio);
        let ranges_m = radios.chain(controllers).map(|radio| radio.range_m);
        let Some(reach_m) = ranges_m.reduce(f64::max) else {
            return Ok(Vec::new());
        };
        let (view, agents) = self.view();
        let participants = Participants::new(&view, agents);
        #[expect(
            clippy::cast_possible_truncation,
            reason = "participants have 32-bit numbers"
        )]
        let [robots, all] =
            [view.ids.len(), view.ids.len() + view.controllers.len()].map(|count| count as u32);
        let links = |robot: u32| {
            let near = view.discs.get(robot as usize);
            let near = near.map(|disc| view.neighbours.about(disc.centre, reach_m));
            let about = near.into_iter().flatten().chain(robots..all);
            let is_included = |other: &u32| *other > robot || (of.is_some() && *other != robot);
            let mut others: Vec<u32> = about.filter(is_included).collect();
            // Lists of near robots have no particular order.
            others.sort_unstable();
            let links = others.into_iter();
            links.filter_map(move |other| link(&participants, robot, other))
        };
        let included = (0..all).filter(|number| {
            let id = view.ids.get(*number as usize);
            of.is_none_or(|of| id == Some(&of))
        });
        Ok(included.flat_map(links).take(most).collect())
    }
}

fn link(participants: &Participants, robot: u32, other: u32) -> Option<Link> {
    let (low, high) = (robot.min(other), robot.max(other));
    let [forth, back] =
        [[low, high], [high, low]].map(|[from, to]| is_received(participants, from, to));
    let [from, to] = if forth { [low, high] } else { [high, low] };
    let link = Link {
        from,
        to,
        is_mutual: forth && back,
    };
    (forth || back).then_some(link)
}

/// Whether messages of a participant reach another, if it sends any.
fn is_received(participants: &Participants, from: u32, to: u32) -> bool {
    let on_air = |number| {
        let participant = participants.get(number);
        participant.filter(|each| participants.is_on_air(each))
    };
    let sender = on_air(from).filter(|sender| sender.radio.loss_probability < 1.0);
    let both = sender.zip(on_air(to));
    both.is_some_and(|(sender, receiver)| participants.reaches(sender, receiver))
}
