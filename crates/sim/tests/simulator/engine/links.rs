//! Radio links for display.

use super::determinism::{assert_no_effect, crowd};
use crate::common::{id, message, robots, send, start, step_with};
use brain::AgentId;
use sim::simulation::{Link, Simulation};
use std::collections::{BTreeMap, BTreeSet};

/// Kinds of robots with their radios in a field of 40 m with a wall at 30 m.
fn field(world: &str, kinds: &[(&str, &str)]) -> Simulation {
    let kinds = kinds.iter().zip(["alpha", "beta", "gamma"]);
    let kinds = kinds.map(|((places, more), name)| {
        format!("[robots.{name}]\nstart.at_m = {places}\nbrain.behaviours = []\n{more}\n")
    });
    start(&format!(
        "[clock]\ntime_limit_s = 100\n[world]\nsize_m = [40, 20]\n{world}\n\
         obstacles = [{{ polygon_m = [[30, 9], [30.1, 9], [30.1, 11], [30, 11]] }}]\n{}",
        kinds.collect::<String>()
    ))
}

/// All links: sender, receiver, and whether the link is mutual.
fn links(simulation: &mut Simulation) -> Vec<(u32, u32, bool)> {
    let links = simulation.links(None, 100).unwrap();
    links
        .iter()
        .map(|link| (link.from, link.to, link.is_mutual))
        .collect()
}

#[test]
fn a_wall_breaks_a_link_that_needs_line_of_sight() {
    for (needs, expected) in [(false, vec![(0, 1, true)]), (true, vec![])] {
        let radio = format!("radio = {{ range_m = 9, needs_line_of_sight = {needs} }}");
        let mut across = field("", &[("[[28, 10], [32, 10]]", &radio)]);
        assert_eq!(links(&mut across), expected);
        let mut beside = field("", &[("[[28, 12], [32, 12]]", &radio)]);
        assert_eq!(links(&mut beside), [(0, 1, true)]);
    }
}

#[test]
fn flying_robots_are_linked_over_a_wall() {
    let radio = "layer = \"air\"\nradio = { range_m = 9, needs_line_of_sight = true }";
    let rover = "radio = { range_m = 9, needs_line_of_sight = true }";
    let mut simulation = field(
        "",
        &[("[[28, 10], [32, 10]]", radio), ("[[28, 11]]", rover)],
    );
    assert_eq!(links(&mut simulation), [(0, 1, true), (0, 2, true)]);
}

#[test]
fn links_cross_the_border_of_a_periodic_world() {
    let kinds = [("[[1, 1], [39, 19]]", "radio = { range_m = 3 }")];
    assert_eq!(links(&mut field("", &kinds)), []);
    assert_eq!(links(&mut field("periodic = true", &kinds)), [(0, 1, true)]);
}

#[test]
fn a_longer_range_gives_a_one_way_link() {
    let kinds = [
        ("[[10, 10]]", "radio = { range_m = 2 }"),
        ("[[13, 10], [11, 10]]", "radio = { range_m = 5 }"),
        ("[[10, 11]]", ""),
    ];
    let expected = [(1, 0, false), (0, 2, true), (1, 2, true)];
    assert_eq!(links(&mut field("", &kinds)), expected);
}

#[test]
fn a_broken_robot_an_empty_one_and_one_without_radio_have_no_links() {
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
fn a_robot_that_breaks_loses_its_links() {
    let radio = "radio = { range_m = 5 }\ncollision = { max_collisions = 1 }";
    let mut simulation = field("", &[("[[29.7, 10], [28, 10]]", radio)]);
    assert_eq!(links(&mut simulation), [(0, 1, true)]);
    for _ in 0..3 {
        step_with(&mut simulation, [(id(0, 0), crate::common::go(1.0, 0.0))]);
    }
    assert_eq!(links(&mut simulation), []);
}

#[test]
fn links_of_one_robot_are_its_part_of_all_links_and_are_bounded() {
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
fn a_link_exists_exactly_where_a_message_arrives() {
    // Without loss, messages arrive in the next step.
    let text = crowd(60, 25.0)
        .replace("loss_probability = 0.2", "")
        .replace("delay_s = 0.2", "");
    let mut simulation = start(&text);
    let ids: Vec<AgentId> = robots(&simulation).iter().map(|robot| robot.id).collect();
    for (number, from) in (0..).zip(&ids) {
        let links = simulation.links(Some(*from), 1000).unwrap();
        let receives = |link: &Link| match (link.from == number, link.is_mutual) {
            (true, _) => Some(link.to),
            (false, true) => Some(link.from),
            (false, false) => None,
        };
        let linked: BTreeSet<u32> = links.iter().filter_map(receives).collect();
        let quiet = ids.iter().map(|id| (*id, send(&[])));
        let mut commands: BTreeMap<AgentId, _> = quiet.collect();
        commands.insert(*from, send(&[message(1.0)]));
        step_with(&mut simulation, commands);
        let received = (0..).zip(&ids).filter(|(_, id)| {
            let percept = simulation.percept(**id).unwrap();
            percept.is_some_and(|percept| !percept.inbox.is_empty())
        });
        let received: BTreeSet<u32> = received.map(|(number, _)| number).collect();
        assert_eq!(linked, received, "{number}");
    }
}

#[test]
fn computing_links_has_no_effect_on_the_run() {
    assert_no_effect(|simulation, step| {
        assert!(!simulation.links(None, 4000).unwrap().is_empty() || step > 50);
    });
}
