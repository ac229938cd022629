//! Radio links between robots, for display only: no brain uses them.

use super::{NoRobot, Simulation};
use crate::step::view::View;
use brain::RobotId;

/// Two robots of which at least one receives the other's messages, unless they are lost by chance.
///
/// Robots are numbered in the order of [`State::each_robot`](super::State::each_robot).
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
    /// The current links, at most `most`: of one robot, or of all; ordered by the numbers of the
    /// robots, the lower one first. The run does not change.
    ///
    /// # Errors
    /// If there is no such robot.
    pub fn links(&mut self, of: Option<RobotId>, most: usize) -> Result<Vec<Link>, NoRobot> {
        let of = of.map(|id| self.number(id)).transpose()?;
        let radios = self.scenario().kinds.iter().filter_map(|kind| kind.radio);
        let Some(reach_m) = radios.map(|radio| radio.range_m).reduce(f64::max) else {
            return Ok(Vec::new());
        };
        let (view, _) = self.view();
        let links = |robot: usize| {
            let about = view.neighbours.about(view.discs[robot].centre, reach_m);
            let is_included = |other: &u32| {
                let other = *other as usize;
                other > robot || (of.is_some() && other != robot)
            };
            let mut others: Vec<u32> = about.filter(is_included).collect();
            // Lists of near robots have no particular order.
            others.sort_unstable();
            let view = &view;
            let links = others.into_iter();
            links.filter_map(move |other| view.link(robot, other as usize))
        };
        let robots = of.map_or(0..view.ids.len(), |robot| robot..robot + 1);
        Ok(robots.flat_map(links).take(most).collect())
    }
}

impl View<'_> {
    fn link(&self, robot: usize, other: usize) -> Option<Link> {
        let (low, high) = (robot.min(other), robot.max(other));
        let [forth, back] = [[low, high], [high, low]].map(|[from, to]| self.is_received(from, to));
        let [from, to] = if forth { [low, high] } else { [high, low] };
        #[expect(
            clippy::cast_possible_truncation,
            reason = "robots have 32-bit numbers"
        )]
        let link = Link {
            from: from as u32,
            to: to as u32,
            is_mutual: forth && back,
        };
        (forth || back).then_some(link)
    }

    /// Whether messages of a robot reach another, if it sends any.
    fn is_received(&self, from: usize, to: usize) -> bool {
        let radio = self.kind(from).radio.as_ref();
        let radio = radio.filter(|radio| self.is_on_air(from) && radio.loss_probability < 1.0);
        radio.is_some_and(|radio| self.is_on_air(to) && self.reaches(from, to, radio))
    }

    /// Whether its radio is on, and sends and receives anything.
    fn is_on_air(&self, robot: usize) -> bool {
        let radio = self.kind(robot).radio;
        self.is_listening(robot) && radio.is_some_and(|radio| radio.messages_per_step > 0)
    }
}
