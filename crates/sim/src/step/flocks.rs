//! Robots that only flock, computed all at once.
//!
//! For such a kind a percept would only be summed up. So the sums are computed from the poses of
//! all robots ([`Flock`]), and the flocking rule of their brains is evaluated with these. Which
//! kinds these are depends on the scenario alone, never on the machine or the number of threads: a
//! run is the same bytes everywhere.

use super::flock_sums::Flock;
use super::view::View;
use crate::bodies::kind::Flocking;
use crate::bodies::path::Orientation;
use crate::run::agent::{Agent, is_on};
use crate::scenario::Scenario;
use crate::sensors::sensor_frame::NoisePurpose;
use base::noise::Noise;
use brain::behaviours::flock::Sums;
use brain::{Motion, RandomWords};
use rayon::prelude::*;

/// Robots per batch, where each one's data would otherwise be waited for.
pub(super) const AT_ONCE: usize = 64;

/// Robots per task of a thread: they need little time each, and all tasks wait for the last one.
pub(super) const PER_TASK: usize = 4 * AT_ONCE;

/// Squared ranges below any distance: no robot is in range of one that does not flock.
const NO_RANGE: [f64; 2] = [-1.0; 2];

/// The turn rates of all robots that only flock.
#[derive(Debug, Clone)]
pub(crate) struct Flocks {
    /// `None` without such robots.
    flock: Option<Flock>,
    /// In rad/s, in the order of the sorted list.
    turn_rates: Vec<f64>,
}

impl Flocks {
    pub(crate) fn new(scenario: &Scenario) -> Self {
        let kinds = scenario.kinds.iter();
        let reaches = kinds.filter_map(|kind| Some(kind.flocking.as_ref()?.reach_m));
        let reach_m = reaches.reduce(f64::max);
        let flock = scenario.torus.zip(reach_m);
        Self {
            flock: flock.map(|(torus, reach_m)| Flock::new(torus, reach_m)),
            turn_rates: Vec::new(),
        }
    }

    /// Computes the turn rate of every such robot.
    pub(crate) fn compute(&mut self, view: &View, is_shared: bool) {
        let Some(flock) = &mut self.flock else {
            return;
        };
        flock.fill(view.ids, view.discs, view.orientations, is_shared);
        self.turn_rates.resize(view.discs.len(), 0.0);
        let flock = &*flock;
        let compute = |(task, turn_rates): (usize, &mut [f64])| {
            let firsts = (task * PER_TASK..).step_by(AT_ONCE);
            for (first, turn_rates) in firsts.zip(turn_rates.chunks_mut(AT_ONCE)) {
                compute_some(view, flock, first, turn_rates);
            }
        };
        if is_shared {
            let tasks = self.turn_rates.par_chunks_mut(PER_TASK);
            tasks.enumerate().for_each(compute);
        } else {
            let tasks = self.turn_rates.chunks_mut(PER_TASK);
            tasks.enumerate().for_each(compute);
        }
    }

    /// The motion setpoint of a robot whose only behaviour is flocking.
    #[inline]
    pub(crate) fn motion(&self, view: &View, robot: usize, agent: &Agent) -> Option<Motion> {
        let flocking = view.kind(robot).flocking.as_ref()?;
        let mut turn_rate = [0.0];
        self.turn_rates_from(robot, &mut turn_rate);
        let noise = (view.noises[robot], view.tick);
        Some(flocking.setpoint(agent, turn_rate[0], &view.orientations[robot], noise))
    }

    /// The turn rates of robots, from the `first` on.
    #[inline]
    pub(super) fn turn_rates_from(&self, first: usize, turn_rates: &mut [f64]) {
        if let Some(flock) = &self.flock {
            let places = &flock.places[first..];
            for (turn_rate, place) in turn_rates.iter_mut().zip(places) {
                *turn_rate = self.turn_rates[*place as usize];
            }
        }
    }
}

/// Computes a batch from the place `first` on.
fn compute_some(view: &View, flock: &Flock, first: usize, turn_rates: &mut [f64]) {
    let mut sums = [Sums::default(); AT_ONCE];
    let kinds = &view.scenario.kinds;
    let flocking = |kind: u8| kinds[usize::from(kind)].flocking.as_ref();
    let limits = |kind| flocking(kind).map_or(NO_RANGE, Flocking::squares);
    let sums = &mut sums[..turn_rates.len()];
    flock.sums(first, limits, sums);
    for ((place, sums), turn_rate) in (first..).zip(sums).zip(turn_rates) {
        if let Some(flocking) = flocking(flock.kinds[place]) {
            let random_words =
                || random_words(view.noises[flock.robots[place] as usize], view.tick);
            *turn_rate = flocking.turn_rate_rad_s(flock.course(place), sums, random_words);
        }
    }
}

/// The random words of a brain that steps in each step.
fn random_words(noise: Noise, tick: u64) -> RandomWords {
    RandomWords::new(noise.words(NoisePurpose::RandomWords as u32, tick, 0))
}

impl Flocking {
    /// The motion setpoint of a robot, given its turn rate if its sensor is on.
    #[inline]
    pub(super) fn setpoint(
        &self,
        agent: &Agent,
        turn_rate_rad_s: f64,
        course: &Orientation,
        (noise, tick): (Noise, u64),
    ) -> Motion {
        if is_on(agent.sensors_off, 0) {
            return self.motion(turn_rate_rad_s);
        }
        let random_words = || random_words(noise, tick);
        self.motion(self.turn_rate_rad_s(course.front, &Sums::default(), random_words))
    }
}
