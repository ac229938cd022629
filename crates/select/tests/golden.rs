//! The same problem gives the same decisions, bit for bit, on every machine and in every version.
//!
//! A golden value changes only in a commit that states the reason: it changes every study.

use base::random::{Entity, Purpose, stream};
use select::bounds::mean_bounds;
use select::{Bounds, Problem, Procedure, Race, Strict};

const TEAMS: usize = 120;
const UNIT: Bounds = Bounds { min: 0.0, max: 1.0 };

/// Merits in 0..=1 of a run: the sum of what all share and of what is the configuration's own.
fn merit(run: u64, configuration: usize) -> f64 {
    let configuration = u32::try_from(configuration).unwrap_or_default();
    let draw = |kind, index| {
        let mut stream = stream(1, run, Entity { kind, index }, Purpose::Start);
        f64::from(stream.next_u32()) / f64::from(u32::MAX)
    };
    let lead = f64::from(configuration % 40) / 100.0;
    (0.3 * draw(0, 0) + 0.3 * draw(1, configuration) + lead).min(1.0)
}

fn problem() -> Problem {
    Problem {
        bounds: vec![UNIT; TEAMS],
        delta: 0.02,
        confidence: 0.95,
    }
}

/// All decisions of a procedure, and bounds of the means of its merits, as one number (FNV-1a).
fn fingerprint(mut procedure: impl Procedure) -> u64 {
    let mut seen = vec![Vec::new(); TEAMS];
    while let Some(request) = procedure.next() {
        let mut merits = Vec::new();
        for &each in &request.configurations {
            let runs = request.first_run..request.first_run + request.runs as u64;
            let row: Vec<f64> = runs.map(|run| merit(run, each)).collect();
            seen[each].extend(&row);
            merits.extend(row);
        }
        procedure.record(&merits);
    }
    let eliminations = procedure.eliminations().into_iter();
    let mut numbers: Vec<u64> = eliminations
        .flat_map(|each| {
            [
                each.configuration as u64,
                each.by.map_or(u64::MAX, |by| by as u64),
                each.runs,
            ]
        })
        .collect();
    numbers.push(procedure.selected().map_or(u64::MAX, |each| each as u64));
    numbers.extend(procedure.runs());
    for values in &seen {
        let (low, high) = mean_bounds(values, UNIT, 0.01);
        numbers.extend([low.to_bits(), high.to_bits()]);
    }
    numbers
        .iter()
        .flat_map(|number| number.to_le_bytes())
        .fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
            (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
        })
}

#[test]
fn the_race_decides_the_same_bytes() {
    assert_eq!(fingerprint(Race::new(problem())), 0xa782_7010_504b_85bb);
}

#[test]
fn the_strict_procedure_decides_the_same_bytes() {
    assert_eq!(fingerprint(Strict::new(problem())), 0x1a5e_c8f2_b94c_40ae);
}
