mod kinds;
mod liars;

use super::*;
use crate::perception::beliefs::TrustSpec;
use crate::perception::beliefs::items::tests::{
    ME, PER_M2, POSITION, contact, hit, miss, observe, random,
};
use base::random::unit;
use core::f64::consts::TAU;
use proptest::prelude::*;

fn sent(items: &mut Items) -> Vec<Report> {
    let mut outbox = Vec::new();
    with_initial_trust(ME, |reception| items.report(reception, &mut outbox, 100));
    let report = |message: Message| match message.about {
        About::Item {
            kind,
            at,
            provenance,
            kind_share,
        } => Some(Report {
            kind,
            at,
            provenance,
            confidence: message.confidence,
            kind_share,
            freshness: 1.0,
            from: provenance.observer,
        }),
        _ => None,
    };
    outbox.into_iter().filter_map(report).collect()
}

#[test]
fn a_report_counts_less_with_its_age() {
    let believed = |age_s: f64| {
        let mut items = Items::new(64, None);
        let freshness = freshness(age_s);
        receive(
            &mut items,
            ME,
            &Report {
                freshness,
                ..report(7, 1.0)
            },
        );
        confidence(&items, ME)
    };
    let prior = TAU * 0.01 * PER_M2;
    let expected = [(0.0, 0.9), (600.0, 0.45), (1200.0, 0.225), (1e9, 0.0)];
    for (age_s, trusted) in expected {
        let expected = trusted + (1.0 - trusted) * prior;
        assert!((believed(age_s) - expected).abs() < 1e-3, "{age_s}");
    }
}

/// The trust after nine refuted reports of a robot.
fn distrust_of(sender: AgentId) -> Trust {
    let mut trust = Trust::new(&TrustSpec::default());
    (0..9).for_each(|_| trust.learn(sender, false));
    trust
}

/// Calls a function with the initial trust in all robots.
fn with_initial_trust<T>(own: AgentId, then: impl FnOnce(&Reception) -> T) -> T {
    let trust = &Trust::new(&TrustSpec::default());
    then(&Reception { own, trust })
}

fn receive(items: &mut Items, own: AgentId, report: &Report) {
    with_initial_trust(own, |reception| {
        items.receive(reception, report, 0.01, &[PER_M2]);
    });
}

fn robot(index: u32) -> AgentId {
    AgentId::robot(0, index)
}

fn report(observer: u32, confidence: f64) -> Report {
    Report {
        kind: 0,
        at: POSITION,
        provenance: Provenance {
            observer: robot(observer),
            track_id: 1,
            observations: 1,
        },
        confidence,
        kind_share: None,
        freshness: 1.0,
        from: robot(observer),
    }
}

fn confidence(items: &Items, own: AgentId) -> f64 {
    with_initial_trust(own, |reception| items.tracks[0].confidence(reception, None))
}

#[test]
fn a_report_is_weighted_by_the_trust_in_its_sender() {
    let mut items = Items::new(64, None);
    receive(&mut items, ME, &report(1, 0.8));
    let before = TAU * 0.01 * PER_M2;
    assert!((confidence(&items, ME) - (0.9 * 0.8 + 0.1 * before)).abs() < 1e-9);
}

#[test]
fn a_relayed_report_is_weighted_by_the_trust_in_sender_and_observer() {
    let mut items = Items::new(64, None);
    let relayed = Report {
        from: robot(2),
        ..report(1, 0.8)
    };
    receive(&mut items, ME, &relayed);
    let before = TAU * 0.01 * PER_M2;
    assert!((confidence(&items, ME) - (0.81 * 0.8 + 0.19 * before)).abs() < 1e-9);
    receive(&mut items, ME, &report(1, 0.8));
    assert!((confidence(&items, ME) - (0.9 * 0.8 + 0.1 * before)).abs() < 1e-9);
}

#[test]
fn a_sender_is_believed_no_more_than_it_is_trusted_whichever_observers_it_names() {
    let mut items = Items::new(64, None);
    for observer in 1..6 {
        let from = robot(7);
        receive(
            &mut items,
            ME,
            &Report {
                from,
                ..report(observer, 0.99)
            },
        );
    }
    assert!(items.tracks[0].count == 5 && confidence(&items, ME) < 0.901);
}

#[test]
fn a_report_of_the_observer_itself_precedes_relayed_ones() {
    let mut items = Items::new(64, None);
    let more = |from: u32| Report {
        from: robot(from),
        provenance: Provenance {
            observations: 9,
            ..report(1, 0.5).provenance
        },
        ..report(1, 1e-3)
    };
    let trust = distrust_of(robot(7));
    let reception = Reception {
        own: ME,
        trust: &trust,
    };
    let mut confidence_after = |report: &Report| {
        items.receive(&reception, report, 0.01, &[PER_M2]);
        items.tracks[0].confidence(&reception, None)
    };
    let first = confidence_after(&report(1, 0.9));
    assert!(
        (confidence_after(&more(7)) - first).abs() < 1e-12,
        "a distrusted sender is ignored"
    );
    assert!(
        confidence_after(&more(2)) < 0.1,
        "a trusted sender with more observations replaces the report"
    );
    assert!(
        (confidence_after(&report(1, 0.9)) - first).abs() < 1e-12,
        "the observer itself takes precedence"
    );
}

#[test]
fn reports_of_distrusted_robots_are_not_relayed() {
    let mut items = Items::new(64, None);
    let trust = distrust_of(robot(7));
    let reception = Reception {
        own: ME,
        trust: &trust,
    };
    for (track_id, from, observer) in [(1, 7, 1), (2, 7, 7), (3, 2, 2)] {
        let provenance = Provenance {
            track_id,
            ..report(observer, 0.9).provenance
        };
        let relayed = Report {
            from: robot(from),
            provenance,
            ..report(observer, 0.9)
        };
        items.receive(&reception, &relayed, 0.01, &[PER_M2]);
    }
    let mut outbox = Vec::new();
    items.report(&reception, &mut outbox, 100);
    let is_of_2 = |message: &Message| matches!(message.about, About::Item { provenance, .. } if provenance.observer == robot(2));
    assert!(
        outbox.len() == 1 && outbox.iter().all(is_of_2),
        "{outbox:?}"
    );
}

#[test]
fn contradicting_reports_give_a_confidence_between_both() {
    let mut items = Items::new(64, None);
    receive(&mut items, ME, &report(1, 0.9));
    let alone = confidence(&items, ME);
    receive(&mut items, ME, &report(2, 1e-4));
    let both = confidence(&items, ME);
    assert!(both < alone && both > 0.01, "{alone} {both}");
    receive(&mut items, ME, &report(3, 0.9));
    assert!(confidence(&items, ME) > both);
}

#[test]
fn relayed_own_observations_change_nothing() {
    let (mut mine, mut theirs) = (Items::new(64, None), Items::new(64, None));
    hit(&mut mine, ME);
    for report in sent(&mut mine) {
        receive(&mut theirs, robot(1), &report);
    }
    let before = mine.clone().tracks;
    for report in sent(&mut theirs) {
        receive(&mut mine, ME, &report);
    }
    assert_eq!(mine.tracks, before);
}

#[test]
fn the_sources_of_an_item_are_bounded_and_own_observations_are_kept() {
    let mut items = Items::new(64, None);
    hit(&mut items, ME);
    let reports: Vec<Report> = (1..20)
        .map(|observer| report(observer, 0.3 + 0.03 * f64::from(observer)))
        .collect();
    for _ in 0..10 {
        for report in &reports {
            receive(&mut items, ME, report);
        }
    }
    assert!(items.tracks.len() == 1 && items.tracks[0].is_observed_by(ME));
    sent(&mut items);
    for _ in 0..10 {
        for report in &reports {
            receive(&mut items, ME, report);
        }
        assert!(sent(&mut items).is_empty());
    }
}

#[test]
fn all_items_are_repeated_for_robots_that_come_into_range_later() {
    let (mut items, mut later) = (Items::new(64, None), Items::new(64, None));
    for number in 0..20 {
        let at = Point {
            x: f64::from(number),
            y: 0.0,
        };
        observe(&mut items, ME, at, &[contact(at, at)]);
        sent(&mut items);
    }
    for _ in 0..20 {
        assert!(sent(&mut items).is_empty());
        items.repeat_next();
        for report in sent(&mut items) {
            receive(&mut later, robot(1), &report);
        }
    }
    assert_eq!(later.tracks.len(), 20);
}

#[test]
fn memory_is_bounded_for_a_thousand_contacts() {
    let (mut items, mut random) = (Items::new(64, None), random(1));
    for number in 0..1000 {
        let at = Point {
            x: 200.0 * unit(&mut random),
            y: 200.0 * unit(&mut random),
        };
        observe(
            &mut items,
            ME,
            at,
            &[contact(at, at), contact(at, at.plus(POSITION))],
        );
        receive(
            &mut items,
            ME,
            &Report {
                at,
                ..report(number, 0.4)
            },
        );
    }
    assert_eq!(items.tracks.len(), 64);
    let mut outbox = Vec::new();
    with_initial_trust(ME, |reception| items.report(reception, &mut outbox, 2));
    assert_eq!(outbox.len(), 2);
}

/// Three robots observe an item and relay reports: in each step one of them observes, sends, or
/// receives any message that was ever sent. Returns their items, and each robot's last report of
/// its own observations.
fn gossip(seed: u64, steps: u32) -> (Vec<Items>, Vec<Report>) {
    let mut random = random(seed);
    let mut team = vec![Items::new(64, None); 3];
    let mut sent_reports: Vec<Report> = Vec::new();
    for (items, observer) in team.iter_mut().zip(0..) {
        hit(items, robot(observer));
    }
    for _ in 0..steps {
        let observer = random.bounded(3);
        let items = &mut team[observer as usize];
        match random.bounded(6) {
            0 => hit(items, robot(observer)),
            1 => miss(items, robot(observer)),
            2 => {
                let from = robot(observer);
                let reports = sent(items).into_iter();
                sent_reports.extend(reports.map(|report| Report { from, ..report }));
            }
            _ if sent_reports.is_empty() => {}
            _ => {
                let any = random.bounded(u32::try_from(sent_reports.len()).unwrap()) as usize;
                receive(items, robot(observer), &sent_reports[any]);
            }
        }
    }
    let last = |observer: u32| {
        let is_own =
            |report: &&Report| [report.provenance.observer, report.from] == [robot(observer); 2];
        let own = sent_reports.iter().filter(is_own);
        own.max_by_key(|report| report.provenance.observations)
            .copied()
    };
    (team, (0..3).filter_map(last).collect())
}

proptest! {
    #[test]
    fn observations_count_once_however_often_and_by_whichever_route_they_are_reported(
        seed: u64, steps in 1_u32..300,
    ) {
        let (mut team, last) = gossip(seed, steps);
        for (items, own) in team.iter_mut().zip((0..).map(robot)) {
            for report in &last {
                receive(items, own, report);
            }
            prop_assert_eq!(items.tracks.len(), 1);
            let track = &items.tracks[0];
            let observations = &track.sources[track.slot_by(own)];
            let reports = last.iter().filter(|report| report.provenance.observer != own);
            let reported = reports.map(|report| {
                let prior = track.sources[track.slot_by(report.provenance.observer)].prior;
                let prior_probability = probability(prior);
                let given = report.confidence.clamp(1e-6, 1.0 - 1e-6);
                let confidence = if given <= MAX_PRIOR {
                    given.min(prior_probability)
                } else {
                    given
                };
                log_odds(0.9 * confidence + 0.1 * prior_probability) - prior
            });
            // Support raises the belief up to a bound; denials lower it from there.
            let (support, denial): (Vec<f64>, Vec<f64>) = reported.partition(|each| *each > 0.0);
            let supporters = i32::try_from(support.len()).unwrap();
            let sure = 1.0 - (1.0 - probability(track.prior)) * 0.1_f64.powi(supporters);
            let raised = (track.prior + support.iter().sum::<f64>()).min(log_odds(sure));
            let reported = raised + denial.iter().sum::<f64>();
            let expected = probability(reported + observations.log_ratio);
            prop_assert!((confidence(items, own) - expected).abs() < 1e-6, "{}", expected);
        }
    }
}

/// What an adversary does in one step.
#[derive(Debug, Clone, Copy)]
struct Act {
    liar: usize,
    /// The honest robot that it sends to, and one whose messages arrive afterwards.
    to: usize,
    from: usize,
    report: Report,
}

/// Any report at the place of the lie, of any robot's observations.
fn act() -> impl Strategy<Value = Act> {
    let robots = (0_usize..3, 0_usize..HEARERS, 0_usize..HEARERS);
    let provenance = (0_u32..30, 0_u32..6, 0_u32..9, any::<bool>());
    let content = (0.0_f64..=1.0, -0.4_f64..0.4, -0.4_f64..0.4);
    (robots, provenance, content).prop_map(
        |((liar, to, from), (observer, track_id, more, is_sure), (confidence, x, y))| Act {
            liar,
            to,
            from,
            report: Report {
                kind: 0,
                at: POSITION.plus(Point { x, y }),
                provenance: Provenance {
                    observer: robot(observer),
                    track_id,
                    observations: if more == 8 { u32::MAX } else { more },
                },
                confidence: if is_sure { 1.0 } else { confidence },
                kind_share: None,
                freshness: 1.0,
                from: ME,
            },
        },
    )
}

/// Number of honest robots; the first is the one whose beliefs are limited.
const HEARERS: usize = 6;

/// Ids of the liars.
const LIARS: u32 = 20;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    /// No honest robot observes anything: all reports come from liars, directly or relayed.
    #[test]
    fn liars_are_believed_within_the_bound_whatever_they_send_and_whoever_relays_it(
        trusts in [0.0_f64..1.0, 0.0_f64..1.0, 0.0_f64..1.0],
        liars in 1_usize..4,
        acts in proptest::collection::vec(act(), 1..200),
    ) {
        let mut team: Vec<Items> = vec![Items::new(64, None); HEARERS];
        let trust = liar_trust(&trusts);
        let hear = |items: &mut Items, own: usize, report: &Report| {
            let own = robot(u32::try_from(own).unwrap());
            items.receive(&Reception { own, trust: &trust }, report, 0.01, &[PER_M2]);
        };
        for Act { liar, to, from, report } in acts {
            let liar = robot(LIARS + u32::try_from(liar % liars).unwrap());
            hear(&mut team[to], to, &Report { from: liar, ..report });
            let sender = robot(u32::try_from(from).unwrap());
            let mut outbox = Vec::new();
            let reception = Reception { own: sender, trust: &trust };
            team[from].report(&reception, &mut outbox, 2);
            team[from].repeat_next();
            for message in outbox {
                for (own, items) in team.iter_mut().enumerate().filter(|(own, _)| *own != from) {
                    hear(items, own, &received_from(sender, message));
                }
            }
            let reception = Reception { own: ME, trust: &trust };
            for track in &team[0].tracks {
                let bound = (0..liars).fold(1.0 - probability(track.prior), |left, liar| {
                    left * (1.0 - trust.of(robot(LIARS + u32::try_from(liar).unwrap())))
                });
                let belief = track.confidence(&reception, None);
                prop_assert!(belief <= 1.0 - bound + 1e-9, "{} above {}", belief, 1.0 - bound);
            }
        }
    }
}

/// Trust near the given values in the three liars, and .9 in all other robots.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "few"
)]
fn liar_trust(wanted: &[f64; 3]) -> Trust {
    let mut trust = Trust::new(&TrustSpec::default());
    for (wanted, liar) in wanted.iter().zip(LIARS..) {
        let refuted = (3.6 / wanted.max(0.05) - 4.0).max(0.0) as u32;
        (0..refuted).for_each(|_| trust.learn(robot(liar), false));
    }
    trust
}

fn received_from(from: AgentId, message: Message) -> Report {
    match message.about {
        About::Item {
            kind,
            at,
            provenance,
            kind_share,
        } => Report {
            kind,
            at,
            provenance,
            confidence: message.confidence,
            kind_share,
            freshness: 1.0,
            from,
        },
        about => panic!("no item: {about:?}"),
    }
}

#[test]
fn three_liars_are_believed_at_most_a_half_three_quarters_and_seven_eighths() {
    let spec = TrustSpec {
        initial: 0.5,
        adaptive: true,
    };
    let trust = Trust::new(&spec);
    let (reception, mut items) = (
        Reception {
            own: ME,
            trust: &trust,
        },
        Items::new(64, None),
    );
    let mut beliefs = Vec::new();
    for liar in 1..4 {
        items.receive(&reception, &report(liar, 1.0), 0.01, &[PER_M2]);
        beliefs.push(items.tracks[0].confidence(&reception, None));
    }
    let prior = probability(items.tracks[0].prior);
    for (belief, left) in beliefs.iter().zip([0.5, 0.25, 0.125]) {
        assert!(
            (belief - (1.0 - (1.0 - prior) * left)).abs() < 1e-3,
            "{beliefs:?}"
        );
    }
}

#[test]
fn a_relayed_report_is_not_relayed_again() {
    let mut items = Items::new(64, None);
    let relayed = Report {
        from: robot(2),
        ..report(1, 0.9)
    };
    receive(&mut items, ME, &relayed);
    assert!(sent(&mut items).is_empty());
    receive(&mut items, ME, &report(1, 0.9));
    assert_eq!(sent(&mut items).len(), 1);
}

#[test]
fn of_reports_that_share_a_robot_only_the_strongest_counts() {
    let alone = |reports: &[Report]| {
        let mut items = Items::new(64, None);
        for each in reports {
            receive(&mut items, ME, each);
        }
        confidence(&items, ME)
    };
    let strong = report(1, 0.9);
    for weaker in [
        Report {
            from: robot(1),
            ..report(3, 0.5)
        },
        Report {
            from: robot(3),
            provenance: Provenance {
                track_id: 2,
                ..strong.provenance
            },
            ..report(1, 0.5)
        },
    ] {
        let both = alone(&[strong, weaker]);
        assert!((both - alone(&[strong])).abs() < 1e-12);
        // The prior of a report depends on those before it.
        assert!(alone(&[weaker, strong]) <= both);
    }
    assert!(alone(&[strong, report(3, 0.5)]) > alone(&[strong]));
}

impl Track {
    fn slot_by(&self, own: AgentId) -> usize {
        let mut sources = self.sources[..self.count].iter();
        sources
            .position(|source| source.provenance.observer == own)
            .unwrap()
    }
}
