//! What waits for a brain that hardly ever steps.

use crate::common::{id, message, say, start, told};

/// A slow mind beside three items and a robot, which it sees in each step.
const SLOW: &str = "
[clock]
step_s = 0.1
time_limit_s = 1000
[world]
size_m = [20, 10]
[items.flag]
count = 3
placement = { kind = \"fixed\", at_m = [[4, 5], [5, 6], [5, 4]] }
[robots.mind]
count = 1
radius_m = 0.2
start = { kind = \"fixed\", at_m = [[5, 5]] }
drive = { max_speed_m_s = 0, max_turn_rate_deg_s = 0 }
brain = { rate_hz = 0.01 }
radio = { range_m = 9 }
[robots.mind.sensors.eye]
kind = \"items\"
range_m = 3
[robots.mind.sensors.mates]
kind = \"robots\"
range_m = 9
[robots.other]
count = 1
radius_m = 0.2
start = { kind = \"fixed\", at_m = [[8, 5]] }
drive = { max_speed_m_s = 0, max_turn_rate_deg_s = 0 }
radio = { range_m = 9 }
";

#[test]
fn a_brain_that_hardly_steps_is_told_of_the_newest_thousand_of_a_kind() {
    let mut simulation = start(SLOW);
    for _ in 0..1000 {
        told(&mut simulation, [(id(1, 0), say(&[message(1.0); 4]))]);
    }
    let percept = simulation.percept(id(0, 0)).unwrap().unwrap();
    let ages = [
        percept.contacts.iter().map(|each| each.age_s).collect(),
        percept.inbox.iter().map(|each| each.age_s).collect(),
        percept.neighbours.iter().map(|each| each.age_s).collect(),
    ];
    let [contacts, inbox, neighbours]: [Vec<f64>; 3] = ages;
    // Three flags in each step, of which those of this step come beside what has waited.
    assert_eq!((contacts.len(), inbox.len()), (1000 + 3, 1000));
    assert_eq!(neighbours.len(), 1000);
    for (ages, a_step) in [(contacts, 3.0), (inbox, 4.0), (neighbours, 1.0)] {
        let oldest_s = ages.iter().copied().fold(0.0, f64::max);
        assert!((oldest_s - 100.0 / a_step).abs() < 0.3, "{oldest_s}");
    }
}
