//! How runs are scored.

/// Weights of a figure of merit; higher is better, so all are at most 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Merit {
    /// How the scenario names it.
    pub name: &'static str,
    /// For each second of a run, capped.
    pub time_s: f64,
    /// For each robot.
    pub robots: f64,
    /// For a failed run.
    pub failed: f64,
}

impl Merit {
    /// Equation 5.2 of the thesis: -(0.3 T/10 + 0.2 n + 0.5 failures in ten).
    pub const EQUATION: Self = Self {
        name: "equation-5.2",
        time_s: -0.03,
        robots: -0.2,
        failed: -5.0,
    };

    /// The sheet in the thesis's appendix, which forgets to divide the time by ten.
    pub const APPENDIX: Self = Self {
        name: "appendix",
        time_s: -0.3,
        ..Self::EQUATION
    };

    /// Every figure of merit that a scenario can name.
    pub const ALL: [Self; 2] = [Self::EQUATION, Self::APPENDIX];
}
