//! Bounds on the observations that are kept for a brain that rarely steps.

use crate::common::{id, message, send, start, step_with};

/// A robot with a slow brain that detects three items and a robot in every step.
const SLOW: &str = r#"
clock.time_limit_s = 1000
items.flag.placement.at_m = [[4, 5], [5, 6], [5, 4]]
[robots.listener]
start.at_m = [[5, 5]]
drive = { max_speed_m_s = 0, max_turn_rate_deg_s = 0 }
brain.rate_hz = 0.01
radio.range_m = 9
sensors = { eye = { kind = "items", range_m = 3 }, mates = { kind = "robots", range_m = 9 } }
[robots.other]
start.at_m = [[8, 5]]
drive = { max_speed_m_s = 0, max_turn_rate_deg_s = 0 }
radio.range_m = 9
"#;

#[test]
fn a_brain_that_rarely_steps_receives_the_newest_thousand_of_each_kind() {
    let mut simulation = start(SLOW);
    for _ in 0..1000 {
        step_with(&mut simulation, [(id(1, 0), send(&[message(1.0); 4]))]);
    }
    let percept = simulation.percept(id(0, 0)).unwrap().unwrap();
    let ages = [
        percept.contacts.iter().map(|each| each.age_s).collect(),
        percept.inbox.iter().map(|each| each.age_s).collect(),
        percept.neighbours.iter().map(|each| each.age_s).collect(),
    ];
    let [contacts, inbox, neighbours]: [Vec<f64>; 3] = ages;
    // Three flags per step; those of the current step are added to the ones that were kept.
    assert_eq!((contacts.len(), inbox.len()), (1000 + 3, 1000));
    assert_eq!(neighbours.len(), 1000);
    for (ages, a_step) in [(contacts, 3.0), (inbox, 4.0), (neighbours, 1.0)] {
        let oldest_s = ages.iter().copied().fold(0.0, f64::max);
        assert!((oldest_s - 100.0 / a_step).abs() < 0.3, "{oldest_s}");
    }
}
