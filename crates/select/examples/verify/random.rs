//! Random numbers by their position: any macro-replication can be run alone.

use base::random::Stream;

/// The position of a run's random numbers.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Place {
    pub(crate) seed: u64,
    pub(crate) replication: u32,
    pub(crate) run: u64,
}

/// A stream has 2^8 blocks of four numbers, and a run 2^24 streams: the last is shared by all.
const CONFIGURATION_SHIFT: u32 = 8;
const NOT_OF_A_CONFIGURATION: u128 = (1 << 24) - 1;

impl Place {
    /// Numbers of this configuration alone in this run.
    pub(crate) fn own(self, configuration: usize) -> Random {
        self.random(configuration as u128)
    }

    /// Numbers that all configurations share in this run.
    pub(crate) fn shared(self) -> Random {
        self.random(NOT_OF_A_CONFIGURATION)
    }

    /// The counter: replication (32 bits), run (64), configuration (24), block (8).
    fn random(self, configuration: u128) -> Random {
        let replication = u128::from(self.replication) << 96;
        let run = u128::from(self.run) << 32;
        let counter = replication | run | (configuration << CONFIGURATION_SHIFT);
        let [s0, s1, s2, s3, s4, s5, s6, s7] = self.seed.to_le_bytes();
        let key = [
            u32::from_le_bytes([s0, s1, s2, s3]),
            u32::from_le_bytes([s4, s5, s6, s7]),
        ];
        Random(Stream::new(key, counter))
    }
}

/// A stream of random numbers.
pub(crate) struct Random(Stream);

impl Random {
    /// Uniform between 0 and 1, neither included.
    pub(crate) fn uniform(&mut self) -> f64 {
        (f64::from(self.0.next_u32()) + 0.5) / 4_294_967_296.0
    }

    /// Exponential with mean 1.
    pub(crate) fn exponential(&mut self) -> f64 {
        -libm::log(self.uniform())
    }

    /// Standard normal (Box and Muller).
    pub(crate) fn normal(&mut self) -> f64 {
        let radius = (2.0 * self.exponential()).sqrt();
        radius * libm::cos(std::f64::consts::TAU * self.uniform())
    }

    /// Mean of four uniforms: bounded by 0 and 1, of mean 1/2, nearly normal.
    pub(crate) fn bates(&mut self) -> f64 {
        (0..4).map(|_| self.uniform()).sum::<f64>() / 4.0
    }

    /// A whole number from 1 to `max`.
    pub(crate) fn one_to(&mut self, max: u32) -> usize {
        1 + self.0.bounded(max) as usize
    }
}
