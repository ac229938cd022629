//! Who hears whom, as it is told to people who watch.

use crate::common::{id, message, robots, say, start, told};
use crate::determinism::{commands, crowd};
use brain::RobotId;
use sim::simulation::{Link, Simulation};
use std::collections::{BTreeMap, BTreeSet};

/// Robots at places of a field of 40 m with a wall at 30 m, each kind with its radio.
fn field(world: &str, kinds: &[(&str, &str)]) -> Simulation {
    let kinds = kinds.iter().zip(["alpha", "beta", "gamma"]);
    let kinds = kinds.map(|((places, more), name)| {
        let count = places.matches('[').count() - 1;
        format!(
            "[robots.{name}]\ncount = {count}\nradius_m = 0.2\n\
             start = {{ kind = \"fixed\", at_m = {places} }}\nbrain = {{ behaviours = [] }}\n\
             drive = {{ max_speed_m_s = 1, max_turn_rate_deg_s = 90 }}\n{more}\n"
        )
    });
    start(&format!(
        "[clock]\ntime_limit_s = 100\n[world]\nsize_m = [40, 20]\n{world}\n\
         obstacles = [{{ polygon_m = [[30, 9], [30.1, 9], [30.1, 11], [30, 11]] }}]\n{}",
        kinds.collect::<String>()
    ))
}

/// All links: who is heard, who hears, and whether both do.
fn links(simulation: &mut Simulation) -> Vec<(u32, u32, bool)> {
    let links = simulation.links(None, 100).unwrap();
    links
        .iter()
        .map(|link| (link.from, link.to, link.is_mutual))
        .collect()
}

#[test]
fn a_wall_breaks_a_link_of_radios_that_need_to_see() {
    for (needs, expected) in [(false, vec![(0, 1, true)]), (true, vec![])] {
        let radio = format!("radio = {{ range_m = 9, needs_line_of_sight = {needs} }}");
        let mut across = field("", &[("[[28, 10], [32, 10]]", &radio)]);
        assert_eq!(links(&mut across), expected);
        let mut beside = field("", &[("[[28, 12], [32, 12]]", &radio)]);
        assert_eq!(links(&mut beside), [(0, 1, true)]);
    }
}

#[test]
fn two_that_fly_hear_each_other_over_a_wall() {
    let radio = "layer = \"air\"\nradio = { range_m = 9, needs_line_of_sight = true }";
    let rover = "radio = { range_m = 9, needs_line_of_sight = true }";
    let mut simulation = field(
        "",
        &[("[[28, 10], [32, 10]]", radio), ("[[28, 11]]", rover)],
    );
    assert_eq!(links(&mut simulation), [(0, 1, true), (0, 2, true)]);
}

#[test]
fn a_link_goes_across_the_border_of_a_world_that_wraps() {
    let kinds = [("[[1, 1], [39, 19]]", "radio = { range_m = 3 }")];
    assert_eq!(links(&mut field("", &kinds)), []);
    assert_eq!(links(&mut field("periodic = true", &kinds)), [(0, 1, true)]);
}

#[test]
fn who_reaches_farther_is_heard_and_does_not_hear() {
    let kinds = [
        ("[[10, 10]]", "radio = { range_m = 2 }"),
        ("[[13, 10], [11, 10]]", "radio = { range_m = 5 }"),
        ("[[10, 11]]", ""),
    ];
    let expected = [(1, 0, false), (0, 2, true), (1, 2, true)];
    assert_eq!(links(&mut field("", &kinds)), expected);
}

#[test]
fn who_is_broken_or_empty_or_mute_has_no_links() {
    let pair = |more: &str| {
        field(
            "",
            &[
                ("[[10, 10], [12, 10]]", "radio = { range_m = 5 }"),
                ("[[11, 11]]", more),
            ],
        )
    };
    let healthy = "radio = { range_m = 5 }";
    let empty = "radio = { range_m = 5 }\nbattery = { capacity_j = 1, idle_w = 100 }";
    let mute = "radio = { range_m = 5, messages_per_step = 0 }";
    for (more, count) in [(healthy, 3), (empty, 1), (mute, 1)] {
        let mut simulation = pair(more);
        simulation.step();
        assert_eq!(links(&mut simulation).len(), count, "{more}");
    }
    let deaf = "radio = { range_m = 5, loss_probability = 1 }";
    assert_eq!(
        links(&mut pair(deaf)),
        [(0, 1, true), (0, 2, false), (1, 2, false)]
    );
}

#[test]
fn who_breaks_hears_nothing_any_more() {
    let radio = "radio = { range_m = 5 }\ncollision = { max_collisions = 1 }";
    let mut simulation = field("", &[("[[29.7, 10], [28, 10]]", radio)]);
    assert_eq!(links(&mut simulation), [(0, 1, true)]);
    for _ in 0..3 {
        told(&mut simulation, [(id(0, 0), crate::common::go(1.0, 0.0))]);
    }
    assert_eq!(links(&mut simulation), []);
}

#[test]
fn links_of_one_are_those_of_all_that_are_its_own_and_most_bounds_them() {
    let mut simulation = start(&crowd(200, 30.0));
    let all = simulation.links(None, usize::MAX).unwrap();
    assert!(all.len() > 300 && all.iter().any(|link| !link.is_mutual));
    assert_eq!(simulation.links(None, 100).unwrap(), all[..100]);
    for (number, robot) in (0..).zip(robots(&simulation)).step_by(20) {
        let own = |link: &&Link| link.from == number || link.to == number;
        let own: Vec<Link> = all.iter().filter(own).copied().collect();
        let mut given = simulation.links(Some(robot.id), usize::MAX).unwrap();
        given.sort_by_key(|link| (link.from.min(link.to), link.from.max(link.to)));
        assert_eq!(given, own);
    }
    assert!(simulation.links(Some(id(7, 0)), 10).is_err());
}

#[test]
fn a_link_is_there_where_a_message_comes_and_nowhere_else() {
    // Without loss, and the next step hears.
    let text = crowd(60, 25.0)
        .replace("loss_probability = 0.2", "")
        .replace("delay_s = 0.2", "");
    let mut simulation = start(&text);
    let ids: Vec<RobotId> = robots(&simulation).iter().map(|robot| robot.id).collect();
    for (number, from) in (0..).zip(&ids) {
        let links = simulation.links(Some(*from), 1000).unwrap();
        let hears = |link: &Link| match (link.from == number, link.is_mutual) {
            (true, _) => Some(link.to),
            (false, true) => Some(link.from),
            (false, false) => None,
        };
        let linked: BTreeSet<u32> = links.iter().filter_map(hears).collect();
        let quiet = ids.iter().map(|id| (*id, say(&[])));
        let mut commands: BTreeMap<RobotId, _> = quiet.collect();
        commands.insert(*from, say(&[message(1.0)]));
        told(&mut simulation, commands);
        let heard = (0..).zip(&ids).filter(|(_, id)| {
            let percept = simulation.percept(**id).unwrap();
            percept.is_some_and(|percept| !percept.inbox.is_empty())
        });
        let heard: BTreeSet<u32> = heard.map(|(number, _)| number).collect();
        assert_eq!(linked, heard, "{number}");
    }
}

#[test]
fn to_ask_who_hears_whom_changes_nothing() {
    let text = crowd(120, 40.0);
    let (mut asked, mut free) = (start(&text), start(&text));
    for step in 0..100 {
        for simulation in [&mut asked, &mut free] {
            let commands = commands(simulation, step);
            simulation.step_with(BTreeMap::new(), commands).unwrap();
        }
        assert!(!asked.links(None, 4000).unwrap().is_empty() || step > 50);
        assert_eq!(asked.state().hash(), free.state().hash());
    }
    assert_eq!(asked.outcome(), free.outcome());
}
