use super::*;

/// A step, and the robots that broadcast in it, in order.
type Senders = (u32, Vec<AgentId>);

/// The robots that broadcast in each step of a duration in seconds; all are stationary and have a
/// destination.
fn senders(own: &[AgentId], period_s: f64, for_s: f64) -> Vec<Senders> {
    let mut sent = vec![BroadcastState::new(period_s); own.len()];
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "few"
    )]
    let steps = libm::round(for_s / period_s) as u32;
    let in_step = |step| {
        let each = own.iter().zip(&mut sent);
        let sending = each.filter_map(|(id, sent)| sent.is_due(*id, period_s).then_some(*id));
        (step, sending.collect())
    };
    (1..=steps).map(in_step).collect()
}

fn robots(kind: u8, count: u32) -> Vec<AgentId> {
    (0..count)
        .map(|index| AgentId::robot(kind, index))
        .collect()
}

#[test]
fn each_robot_broadcasts_once_per_second_for_any_period() {
    for (period_s, apart) in [(0.1, 10..=10), (0.05, 20..=20), (0.3, 3..=4), (1.0, 1..=1)] {
        let mates = robots(0, 3);
        let steps = senders(&mates, period_s, 60.0);
        for mate in &mates {
            let own = steps.iter().filter(|(_, all)| all.contains(mate));
            let own: Vec<u32> = own.map(|(step, _)| *step).collect();
            assert!((59..=61).contains(&own.len()), "{period_s}: {own:?}");
            assert!(
                own.windows(2).all(|two| apart.contains(&(two[1] - two[0]))),
                "{own:?}"
            );
        }
    }
}

/// Each robot broadcasts its pose and its destination; four messages are received per step.
#[test]
fn a_receiver_of_four_messages_per_step_receives_all_robots_equally_often() {
    let mates = robots(0, 16);
    let steps = senders(&mates, 0.1, 60.0);
    let received = |mate: &AgentId| {
        let receives = |all: &[AgentId]| all.iter().take(2).any(|one| one == mate);
        steps.iter().filter(|(_, all)| receives(all)).count()
    };
    let counts: Vec<usize> = mates.iter().map(received).collect();
    assert!(
        counts.iter().all(|count| (59..=60).contains(count)),
        "{counts:?}"
    );
}

#[test]
fn robots_of_several_kinds_have_different_phases() {
    let mates = [robots(0, 5), robots(1, 5), robots(2, 5)].concat();
    let max = senders(&mates, 0.1, 60.0)
        .into_iter()
        .map(|(_, all)| all.len())
        .max();
    assert!(max <= Some(3), "{max:?}");
}
