//! Radio: range, delay, loss, capacity and line of sight.

use crate::common::{id, message, send, start, step_with};
use brain::{About, AgentId, Message, ReceivedMessage};
use sim::simulation::Simulation;

/// Robots on a line through the middle of a field of 40 m with a wall at 30 m.
fn line(radio: &str, waypoints_m: &[f64], more: &str) -> String {
    let places: Vec<[f64; 2]> = waypoints_m.iter().map(|x| [*x, 10.0]).collect();
    format!(
        "clock.time_limit_s = 100000\nworld.size_m = [40, 20]\n\
         world.obstacles = [{{ polygon_m = [[30, 9], [30.1, 9], [30.1, 11], [30, 11]] }}]\n\
         [robots.rover]\nstart.at_m = {places:?}\nbrain.behaviours = []\nradio = {{ {radio} }}\n{more}"
    )
}

fn number(received: &ReceivedMessage) -> f64 {
    match received.message.about {
        About::Item { at, .. } => at.x,
        _ => f64::NAN,
    }
}

fn inbox(simulation: &mut Simulation, id: AgentId) -> Vec<ReceivedMessage> {
    let percept = simulation.percept(id).unwrap();
    percept.map_or(Vec::new(), |percept| percept.inbox)
}

/// The robots of the first kind, out of a number, with a message in their inbox.
fn receivers(simulation: &mut Simulation, robots: u32) -> Vec<u32> {
    (0..robots)
        .filter(|index| !inbox(simulation, id(0, *index)).is_empty())
        .collect()
}

#[test]
fn robots_in_range_receive_a_message_once_in_the_next_step() {
    let places = [10.0, 12.0, 15.0, 15.41, 5.0, 4.59];
    let mut simulation = start(&line("range_m = 5", &places, ""));
    step_with(&mut simulation, [(id(0, 0), send(&[message(7.0)]))]);
    assert_eq!(receivers(&mut simulation, 6), [1, 2, 4]);
    let received = inbox(&mut simulation, id(0, 1));
    assert_eq!(received.len(), 1);
    assert_eq!(
        (received[0].from, received[0].age_s, received[0].message),
        (id(0, 0), 0.1, message(7.0))
    );
    simulation.step();
    assert_eq!(receivers(&mut simulation, 6), [0; 0]);
}

#[test]
fn a_message_arrives_after_the_configured_delay() {
    for (delay_s, steps) in [
        (0.0, 1),
        (0.05, 1),
        (0.1, 1),
        (0.11, 2),
        (0.3, 3),
        (2.0, 20),
    ] {
        let text = line(
            &format!("range_m = 5, delay_s = {delay_s}"),
            &[9.0, 10.0],
            "",
        );
        let mut simulation = start(&text);
        // One message per step is sent, so one per step arrives.
        for step in 0..30_u32 {
            let received = inbox(&mut simulation, id(0, 1));
            let expected = step.checked_sub(steps).map(f64::from);
            assert_eq!(
                received.iter().map(number).collect::<Vec<_>>(),
                Vec::from_iter(expected)
            );
            let age_s = f64::from(steps) * 0.1;
            assert!(
                received
                    .iter()
                    .all(|received| (received.age_s - age_s).abs() < 1e-12)
            );
            step_with(
                &mut simulation,
                [(id(0, 0), send(&[message(f64::from(step))]))],
            );
        }
    }
}

#[test]
fn messages_are_lost_independently_with_the_configured_probability() {
    let mut simulation = start(&line(
        "range_m = 9, loss_probability = 0.3",
        &[9.0, 10.0, 11.0],
        "",
    ));
    let (count, mut received, mut both) = (20_000, [0.0; 2], 0.0);
    for _ in 0..count {
        step_with(&mut simulation, [(id(0, 0), send(&[message(0.0)]))]);
        let now = receivers(&mut simulation, 3);
        received[0] += f64::from(u8::from(now.contains(&1)));
        received[1] += f64::from(u8::from(now.contains(&2)));
        both += f64::from(u8::from(now.len() == 2));
    }
    // Five standard errors: a correct program fails less than once in a million runs.
    let assert_share = |hits: f64, share: f64| {
        let error = (share * (1.0 - share) / f64::from(count)).sqrt();
        assert!(
            (hits / f64::from(count) - share).abs() < 5.0 * error,
            "{hits}"
        );
    };
    received
        .into_iter()
        .for_each(|received| assert_share(received, 0.7));
    assert_share(both, 0.49);
}

#[test]
fn two_messages_of_a_step_are_lost_independently() {
    let mut simulation = start(&line(
        "range_m = 9, loss_probability = 0.5",
        &[9.0, 10.0],
        "",
    ));
    let mut counts = [0.0_f64; 3];
    for _ in 0..10_000 {
        step_with(
            &mut simulation,
            [(id(0, 0), send(&[message(0.0), message(1.0)]))],
        );
        counts[inbox(&mut simulation, id(0, 1)).len()] += 1.0;
    }
    // As above.
    let error = (0.25_f64 * 0.75 * 10_000.0).sqrt();
    assert!((counts[0] - 2500.0).abs() < 5.0 * error && (counts[2] - 2500.0).abs() < 5.0 * error);
}

#[test]
fn the_messages_sent_and_received_per_step_are_bounded() {
    let text = line("range_m = 9, messages_per_step = 3", &[9.0, 10.0, 11.0], "");
    let mut simulation = start(&text);
    let many: Vec<Message> = (0..5).map(|place| message(f64::from(place))).collect();
    step_with(&mut simulation, [(id(0, 0), send(&many))]);
    let numbers = |simulation: &mut Simulation, index| -> Vec<f64> {
        inbox(simulation, id(0, index)).iter().map(number).collect()
    };
    assert_eq!(numbers(&mut simulation, 1), [0.0, 1.0, 2.0]);
    // The third robot receives three messages of two senders, which receive each other's: the first
    // of each, and the second of one of them.
    let more: Vec<Message> = (10..12).map(|place| message(f64::from(place))).collect();
    step_with(
        &mut simulation,
        [(id(0, 0), send(&more)), (id(0, 1), send(&many))],
    );
    let received = numbers(&mut simulation, 2);
    let expected = [[10.0, 11.0, 0.0], [10.0, 0.0, 1.0]];
    assert!(expected.iter().any(|each| received == each), "{received:?}");
    assert_eq!(numbers(&mut simulation, 0), [0.0, 1.0, 2.0]);
    assert_eq!(numbers(&mut simulation, 1), [10.0, 11.0]);
    let mute = line("range_m = 9, messages_per_step = 0", &[9.0, 10.0], "");
    let mut simulation = start(&mute);
    step_with(&mut simulation, [(id(0, 0), send(&many))]);
    assert_eq!(receivers(&mut simulation, 2), [0; 0]);
}

#[test]
fn of_too_many_messages_each_sender_loses_the_same_share() {
    let places = [9.0, 9.5, 10.0, 10.5, 11.0];
    let mut simulation = start(&line("range_m = 9, messages_per_step = 1", &places, ""));
    let mut counts = [0.0_f64; 5];
    for _ in 0..10_000 {
        let sent = (0..5_u32).map(|index| (id(0, index), send(&[message(f64::from(index))])));
        step_with(&mut simulation, sent);
        for received in inbox(&mut simulation, id(0, 0)) {
            counts[received.from.index as usize] += 1.0;
        }
    }
    // Five standard deviations: the probability of an error is below 1e-5.
    let error = (0.25_f64 * 0.75 * 10_000.0).sqrt();
    let counts = &counts[1..];
    assert!(
        counts
            .iter()
            .all(|count| (count - 2500.0).abs() < 5.0 * error),
        "{counts:?}"
    );
}

#[test]
fn messages_to_the_receiver_alone_are_received_first() {
    let places = [9.0, 9.5, 10.0, 10.5, 11.0];
    let mut simulation = start(&line("range_m = 9, messages_per_step = 1", &places, ""));
    for step in 0..100 {
        let sent = (0..5_u32).map(|index| {
            let message = message(f64::from(index));
            let to = if index == step % 4 + 1 {
                id(0, 0).into()
            } else {
                message.to
            };
            (id(0, index), send(&[Message { to, ..message }]))
        });
        step_with(&mut simulation, sent);
        let received = inbox(&mut simulation, id(0, 0));
        let senders: Vec<u32> = received.iter().map(|each| each.from.index).collect();
        assert_eq!(senders, [step % 4 + 1]);
    }
}

#[test]
fn obstacles_block_a_radio_that_needs_line_of_sight() {
    for (needs, expected) in [("false", vec![1, 2]), ("true", vec![1])] {
        let radio = format!("range_m = 9, needs_line_of_sight = {needs}");
        let mut simulation = start(&line(&radio, &[28.0, 29.0, 32.0], ""));
        step_with(&mut simulation, [(id(0, 0), send(&[message(0.0)]))]);
        assert_eq!(receivers(&mut simulation, 3), expected);
    }
}

#[test]
fn a_slow_brain_receives_each_message_since_its_last_step_once() {
    let slow = "[robots.slow]\nbrain = { rate_hz = 1, behaviours = [] }\n\
                start.at_m = [[9, 10]]\nradio.range_m = 5\n";
    let mut simulation = start(&line("range_m = 5", &[10.0], slow));
    let mut received = Vec::new();
    for step in 0..41_u32 {
        if let Some(percept) = simulation.percept(id(1, 0)).unwrap() {
            assert_eq!(step % 10, 0);
            for each in &percept.inbox {
                received.push(number(each));
                assert!((each.age_s - (f64::from(step) - number(each)) * 0.1).abs() < 1e-9);
            }
        }
        step_with(
            &mut simulation,
            [(id(0, 0), send(&[message(f64::from(step))]))],
        );
    }
    assert_eq!(received, (0..40).map(f64::from).collect::<Vec<_>>());
}

#[test]
fn a_robot_without_radio_neither_sends_nor_receives() {
    let mute = "[robots.zero]\nstart.at_m = [[9, 10]]\n";
    let mut simulation = start(&line("range_m = 5", &[10.0, 11.0], mute));
    let all = [id(0, 0), id(1, 0)].map(|id| (id, send(&[message(0.0)])));
    step_with(&mut simulation, all);
    assert_eq!(receivers(&mut simulation, 2), [1]);
    assert!(inbox(&mut simulation, id(1, 0)).is_empty());
}

#[test]
fn a_stopped_robot_neither_sends_nor_receives() {
    // The battery of the first is empty after the second step.
    let weak = "[robots.alpha]\nbattery = { capacity_j = 2, idle_w = 10 }\nstart.at_m = [[9, 10]]\n\
                radio = { range_m = 5, delay_s = 0.2 }\nbrain.behaviours = []\n";
    let mut simulation = start(&line("range_m = 5", &[10.0], weak));
    let both = [id(0, 0), id(1, 0)].map(|id| (id, send(&[message(0.0)])));
    let mut received = Vec::new();
    for _ in 0..6 {
        step_with(&mut simulation, both.clone());
        received.push([id(0, 0), id(1, 0)].map(|id| inbox(&mut simulation, id).len()));
    }
    // Its messages of the first two steps are in transit and arrive; it gets no further percepts.
    assert_eq!(received, [[1, 0], [0, 1], [0, 1], [0, 0], [0, 0], [0, 0]]);
}
