//! Problems whose answer is known.

use crate::random::Place;

/// Configurations in the order of their costs, 1, 2, ..., unless given otherwise.
#[derive(Debug, Clone)]
pub(crate) struct Known {
    pub(crate) name: &'static str,
    /// The probability that a run of each meets the requirement.
    pub(crate) met: Vec<f64>,
    pub(crate) costs: Vec<f64>,
    pub(crate) probability: f64,
    pub(crate) tolerance: f64,
    pub(crate) sampling: Sampling,
}

/// How the runs of configurations depend on each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Sampling {
    Independent,
    /// All configurations use the same random numbers.
    Common,
    /// A run meets the requirement if each of three dependent conditions holds.
    ThreeConditions,
}

impl Known {
    fn new(name: &'static str, met: Vec<f64>, probability: f64, tolerance: f64) -> Self {
        let costs = (1_u32..).take(met.len()).map(f64::from).collect();
        Self {
            name,
            met,
            costs,
            probability,
            tolerance,
            sampling: Sampling::Independent,
        }
    }

    /// Whether a run of a configuration meets the requirement.
    pub(crate) fn sample(&self, place: Place, configuration: usize) -> bool {
        let met = self.met[configuration];
        match self.sampling {
            Sampling::Independent => place.own(configuration).uniform() < met,
            Sampling::Common => place.shared().uniform() < met,
            Sampling::ThreeConditions => {
                // Each fails in a third of the missed runs, and often together with the first.
                let mut random = place.own(configuration);
                let missed = random.uniform() >= met;
                let which = random.one_to(3);
                (1..=3).all(|condition| !(missed && (condition == which || condition == 1)))
            }
        }
    }

    /// Whether the cheapest that meets the requirement is not among those that are shown not to.
    pub(crate) fn is_below_right(&self, below: &[usize]) -> bool {
        let meets = |each: &usize| self.met[*each] >= self.probability;
        (0..self.met.len())
            .find(meets)
            .is_none_or(|cheapest| !below.contains(&cheapest))
    }

    /// Whether a study that selects this keeps the promise at a tolerance.
    pub(crate) fn is_kept(&self, selected: Option<usize>, tolerance: f64) -> bool {
        // What lies at a limit itself was rounded.
        let rounding = 1e-12;
        let spare = self.probability + tolerance - rounding;
        let max = selected.map_or(f64::INFINITY, |each| self.costs[each]);
        let misses_cheaper = self
            .met
            .iter()
            .zip(&self.costs)
            .any(|(met, cost)| *cost < max && *met >= spare);
        let is_met = selected.is_none_or(|each| self.met[each] >= self.probability - rounding);
        is_met && !misses_cheaper
    }
}

/// All problems.
pub(crate) fn all() -> Vec<Known> {
    let mut problems = independent();
    let common = |name, problem: usize| Known {
        name,
        sampling: Sampling::Common,
        ..problems[problem].clone()
    };
    let three = |name, problem: usize| Known {
        name,
        sampling: Sampling::ThreeConditions,
        ..problems[problem].clone()
    };
    let more = [
        common("8 just below p0, common random numbers", 4),
        common("16 of .1 to .95, common random numbers", 3),
        three("7 at p0, one above, three conditions", 1),
        Known {
            name: "8 at p0 + tolerance, equal costs",
            costs: vec![1.0; 8],
            ..problems[5].clone()
        },
        Known {
            name: "more robots are worse, in any order",
            costs: vec![4.0, 1.0, 7.0, 2.0, 3.0, 6.0, 5.0],
            ..problems[11].clone()
        },
    ];
    problems.extend(more);
    problems
}

/// Problems with independent runs.
fn independent() -> Vec<Known> {
    let below = |limit: f64| limit - 1e-6;
    let ramp = |count: u32, high: f64, factor: f64| -> Vec<f64> {
        (1..=count)
            .map(|size| 1.0 - high * libm::pow(factor, f64::from(size)))
            .collect()
    };
    vec![
        Known::new(
            "16 teams, failures fall by .62",
            ramp(16, 0.9, 0.62),
            0.95,
            0.02,
        ),
        Known::new(
            "7 teams at p0, the last at p0 + tolerance",
            [vec![0.95; 7], vec![0.97]].concat(),
            0.95,
            0.02,
        ),
        Known::new(
            "6 teams of .99 to .9999",
            ramp(6, 0.01 / 0.398, 0.398),
            0.999,
            0.0005,
        ),
        Known::new(
            "16 teams of .1 to .95",
            (0..16)
                .map(|each| 0.1 + 0.85 * f64::from(each) / 15.0)
                .collect(),
            0.5,
            0.05,
        ),
        Known::new("8 teams just below p0", vec![below(0.95); 8], 0.95, 0.02),
        Known::new("8 teams at p0 + tolerance", vec![0.97; 8], 0.95, 0.02),
        Known::new("8 teams inside", vec![0.96; 8], 0.95, 0.02),
        Known::new("1 team just below p0", vec![below(0.9)], 0.9, 0.05),
        Known::new("1 team at p0 + tolerance", vec![0.95], 0.9, 0.05),
        Known::new("all meet it", vec![0.99; 12], 0.9, 0.05),
        Known::new(
            "none meets it",
            vec![0.6, 0.7, 0.8, 0.85, 0.88, 0.8, 0.7],
            0.9,
            0.05,
        ),
        Known::new(
            "more robots are worse",
            vec![0.2, 0.93, 0.97, 0.95, 0.8, 0.99, 0.5],
            0.95,
            0.02,
        ),
        Known::new(
            "4 teams at .999",
            vec![below(0.999), 0.9985, 0.9995, 0.9999],
            0.999,
            0.0005,
        ),
        Known::new("1000 teams", ramp(1000, 0.9, 0.995), 0.95, 0.02),
        Known::new("1000 teams just below p0", vec![below(0.8); 1000], 0.8, 0.1),
        Known::new(
            "a requirement of 1 in 10",
            vec![below(0.1), 0.05, 0.15, 0.3],
            0.1,
            0.05,
        ),
    ]
}
