//! Items that sensors of a model never detect, and the kinds that sensors report.
//!
//! Shares may be off by 5.5 standard errors, which a correct simulator exceeds for one seed in 26 million. The seed
//! is fixed.

use crate::common::{id, scenario};
use brain::AgentId;
use sim::scenario::Scenario;
use sim::simulation::Simulation;
use std::collections::BTreeSet;
use std::sync::Arc;

const RUNS: u64 = 20;
const ITEMS: u32 = 400;

/// Each look misses a tenth of the items that can be detected: after this number, none is left by chance.
const LOOKS: u32 = 12;

const TEXT: &str = "
world.size_m = [20, 20]
items.clutter.count = 400
items.mine.count = 400
";

/// A kind of stationary robots, with an item detector for the whole world.
fn watcher(name: &str, x: f64, lines: &str) -> String {
    format!(
        "[robots.{name}]\nradius_m = 0\nlayer = \"air\"\nbrain.behaviours = []\n\
         start = {{ at_m = [[{x}, 10]], heading_deg = [0] }}\n\
         drive = {{ max_speed_m_s = 0, max_turn_rate_deg_s = 0 }}\n\
         [robots.{name}.sensors.eye]\nkind = \"items\"\nrange_m = 40\nneeds_line_of_sight = false\n\
         detection_probability = {{ clutter = 0.9, mine = 0.9 }}\n{lines}\n"
    )
}

/// The contacts of a robot in one step: the item, and the reported kind.
fn contacts(simulation: &mut Simulation, robot: AgentId) -> Vec<(usize, u16)> {
    let scenario = Arc::clone(simulation.scenario());
    let percept = simulation.percept(robot).unwrap().unwrap();
    let at = simulation.state().each_robot(&scenario);
    let at = at.into_iter().find(|each| each.id == robot).unwrap().at;
    let items: Vec<_> = simulation.state().each_item(&scenario).collect();
    let item = |range_m: f64, bearing_rad: f64| {
        let place = base::geometry::Point {
            x: at.x + range_m * libm::cos(bearing_rad),
            y: at.y + range_m * libm::sin(bearing_rad),
        };
        let distance_m = |number: &usize| items[*number].at.to(place).length();
        let nearest = (0..items.len())
            .min_by(|one, other| distance_m(one).total_cmp(&distance_m(other)))
            .unwrap();
        assert!(distance_m(&nearest) < 1e-6);
        nearest
    };
    let contacts = percept.contacts.iter();
    contacts
        .map(|contact| (item(contact.range_m, contact.bearing_rad), contact.kind))
        .collect()
}

/// The mines that each kind of robots never detects in a run, of the numbers of all mines.
fn never_detected(scenario: &Arc<Scenario>, run: u64, kinds: u8) -> Vec<BTreeSet<usize>> {
    let mut simulation = Simulation::new(Arc::clone(scenario), 1, run).unwrap();
    let mines = ITEMS as usize..2 * ITEMS as usize;
    let mut left = vec![mines.collect::<BTreeSet<usize>>(); usize::from(kinds)];
    for _ in 0..LOOKS {
        simulation.step();
        for kind in 0..kinds {
            for (item, _) in contacts(&mut simulation, id(kind, 0)) {
                left[usize::from(kind)].remove(&item);
            }
        }
    }
    left
}

fn assert_share(count: usize, of: usize, share: f64) {
    let (count, of) = (count as f64, of as f64);
    let error = (share * (1.0 - share) / of).sqrt();
    let sigmas = (count / of - share) / error;
    assert!(sigmas.abs() < 5.5, "{count} of {of}, expected {share}");
}

#[test]
fn the_share_of_items_that_is_never_detected_is_the_blind_share() {
    let blind = "blind_share = { mine = 0.2 }";
    let text = TEXT.to_owned() + &watcher("watcher", 5.0, blind);
    let scenario = scenario(&text);
    let mut never = 0;
    for run in 0..RUNS {
        never += never_detected(&scenario, run, 1)[0].len();
    }
    let all = usize::try_from(RUNS).unwrap() * ITEMS as usize;
    assert_share(never, all, 0.2);
}

#[test]
fn sensors_of_one_model_are_blind_to_the_same_items_and_others_independently() {
    let eye = |more: &str| format!("blind_share = {{ mine = 0.3 }}\n{more}");
    let text = TEXT.to_owned()
        + &watcher("a", 5.0, &eye("model = \"magnetometer\""))
        + &watcher("b", 9.0, &eye("model = \"magnetometer\""))
        + &watcher("c", 12.0, &eye(""))
        + &watcher(
            "d",
            15.0,
            "blind_share = { mine = 0.1 }\nmodel = \"magnetometer\"",
        );
    let scenario = scenario(&text);
    let (mut one, mut both) = (0, 0);
    for run in 0..RUNS {
        let left = never_detected(&scenario, run, 4);
        assert_eq!(left[0], left[1]);
        assert!(left[3].is_subset(&left[0]));
        one += left[0].len();
        both += left[0].intersection(&left[2]).count();
    }
    assert_share(both, one, 0.3);
}

#[test]
fn other_runs_have_other_blind_items() {
    let blind = "blind_share = { mine = 0.5 }";
    let text = TEXT.to_owned() + &watcher("watcher", 5.0, blind);
    let scenario = scenario(&text);
    let [first, second] = [0, 1].map(|run| never_detected(&scenario, run, 1).remove(0));
    assert_share(first.intersection(&second).count(), ITEMS as usize, 0.25);
}

#[test]
fn kinds_are_reported_with_the_probabilities_of_their_row_at_each_look() {
    let row = "confusion = { mine = { mine = 0.7, clutter = 0.3 } }";
    let text = TEXT.to_owned() + &watcher("watcher", 5.0, row);
    let mut simulation = Simulation::new(scenario(&text), 1, 0).unwrap();
    let (mut mines, mut as_clutter, mut changes, mut pairs) = (0, 0, 0, 0);
    let mut last = vec![None; 2 * ITEMS as usize];
    for _ in 0..LOOKS {
        simulation.step();
        for (item, reported) in contacts(&mut simulation, id(0, 0)) {
            if item < ITEMS as usize {
                assert_eq!(reported, 0, "clutter is reported as it is");
                continue;
            }
            mines += 1;
            as_clutter += usize::from(reported == 0);
            if let Some(before) = last[item].replace(reported) {
                pairs += 1;
                changes += usize::from(before != reported);
            }
        }
    }
    assert_share(as_clutter, mines, 0.3);
    // Independent looks differ with probability 2 x 0.7 x 0.3. Pairs of one item share looks, which doubles the
    // variance at most: of its looks, every other pair is independent.
    assert_share(changes / 2, pairs / 2, 0.42);
}

#[test]
fn a_share_of_the_mines_looks_like_clutter_to_all_sensors_of_a_model_at_each_look() {
    let alike = "lookalike_share = { mine = { clutter = 0.3 } }";
    let one_model = format!("{alike}\nmodel = \"magnetometer\"");
    let text = TEXT.to_owned()
        + &watcher("a", 5.0, &one_model)
        + &watcher("b", 9.0, &one_model)
        + &watcher("c", 12.0, alike);
    let mut simulation = Simulation::new(scenario(&text), 1, 0).unwrap();
    let mut reported = [0; 3].map(|_| vec![None; 2 * ITEMS as usize]);
    for _ in 0..LOOKS {
        simulation.step();
        for kind in 0..3 {
            let reported = &mut reported[usize::from(kind)];
            for (item, as_kind) in contacts(&mut simulation, id(kind, 0)) {
                assert!(reported[item].is_none_or(|before| before == as_kind));
                reported[item] = Some(as_kind);
            }
        }
    }
    let reported = &reported;
    let alike = |kind: usize| {
        let mines = ITEMS as usize..2 * ITEMS as usize;
        mines
            .filter(move |mine| reported[kind][*mine] == Some(0))
            .collect::<BTreeSet<usize>>()
    };
    let [one, same, other] = [0, 1, 2].map(alike);
    assert_eq!(one, same);
    assert_share(one.len(), ITEMS as usize, 0.3);
    assert_share(one.intersection(&other).count(), one.len(), 0.3);
}

#[test]
fn shares_of_zero_and_rows_of_the_true_kind_change_nothing() {
    let plain = TEXT.to_owned() + &watcher("watcher", 5.0, "noise_m = 0.1");
    let same = "noise_m = 0.1\nblind_share = { mine = 0 }\nlookalike_share = { mine = { clutter = 0 } }\nmodel = \"magnetometer\"\n\
                confusion = { mine = { mine = 1 }, clutter = { clutter = 1, mine = 0 } }";
    let same = TEXT.to_owned() + &watcher("watcher", 5.0, same);
    let percepts = |text: &str| {
        let mut simulation = Simulation::new(scenario(text), 1, 0).unwrap();
        (0..5).for_each(|_| simulation.step());
        simulation.percept(id(0, 0)).unwrap().unwrap()
    };
    assert_eq!(percepts(&plain), percepts(&same));
}
