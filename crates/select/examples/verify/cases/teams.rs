use super::Case;
use crate::random::Place;
use select::Bounds;

/// Teams of 1 to 40 robots with a figure of merit like the thesis's: time, robots and failures all
/// cost. Mixes of robots that are slower by steps make the problem larger.
pub(crate) struct Teams {
    teams: Vec<Team>,
    /// Whether all teams have the same random numbers in a run.
    common: bool,
}

/// One team, and the parameters of its loss.
struct Team {
    robots: f64,
    /// The minimum time of a run, in seconds.
    min_s: f64,
    /// Mean of the time added to it.
    scale_s: f64,
    /// How often a run fails for another reason than time.
    lost: f64,
}

const LIMIT_S: f64 = 120.0;
const COST_OF_A_SECOND: f64 = 0.03;
const COST_OF_A_ROBOT: f64 = 0.2;
const COST_OF_A_FAILURE: f64 = 5.0;

impl Teams {
    /// 40 teams.
    pub(crate) fn sizes(common: bool) -> Self {
        Self::mixes(1, common)
    }

    /// 40 teams of each of some mixes.
    pub(crate) fn mixes(mixes: u32, common: bool) -> Self {
        let team = |mix| move |robots| Team::new(f64::from(robots), f64::from(mix));
        let teams = (0..mixes).flat_map(|mix| (1..=40).map(team(mix))).collect();
        Self { teams, common }
    }
}

impl Team {
    fn new(robots: f64, mix: f64) -> Self {
        Self {
            robots,
            min_s: 10.0 + 0.4 * mix + 60.0 / robots.sqrt(),
            scale_s: 260.0 * (1.0 + 0.03 * mix) / robots,
            lost: libm::pow(0.25, robots.min(6.0)),
        }
    }

    fn loss(&self, time_s: f64, failed: f64) -> f64 {
        COST_OF_A_SECOND * time_s + COST_OF_A_ROBOT * self.robots + COST_OF_A_FAILURE * failed
    }

    /// A failed run takes the time limit.
    fn mean_loss(&self) -> f64 {
        let late = libm::exp(-(LIMIT_S - self.min_s) / self.scale_s);
        let time = self.min_s + self.scale_s * (1.0 - late);
        let failed = self.lost + (1.0 - self.lost) * late;
        self.loss(self.lost * LIMIT_S + (1.0 - self.lost) * time, failed)
    }
}

impl Case for Teams {
    fn means(&self) -> Vec<f64> {
        self.teams.iter().map(|team| -team.mean_loss()).collect()
    }

    fn bounds(&self) -> Vec<Bounds> {
        let bounds = |team: &Team| Bounds {
            min: -team.loss(LIMIT_S, 1.0),
            max: -team.loss(0.0, 0.0),
        };
        self.teams.iter().map(bounds).collect()
    }

    fn delta(&self) -> f64 {
        0.05
    }

    fn sample(&self, place: Place, configuration: usize) -> f64 {
        let team = &self.teams[configuration];
        let mut random = if self.common {
            place.shared()
        } else {
            place.own(configuration)
        };
        let time = team.min_s + team.scale_s * random.exponential();
        if random.uniform() < team.lost || time > LIMIT_S {
            -team.loss(LIMIT_S, 1.0)
        } else {
            -team.loss(time, 0.0)
        }
    }
}
