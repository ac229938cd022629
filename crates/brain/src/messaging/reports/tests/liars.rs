//! Single tricks of liars.

use super::*;

#[test]
fn a_liar_cannot_keep_honest_reports_out_of_a_track() {
    let mut items = Items::new(64, None);
    for observer in 10..30 {
        receive(
            &mut items,
            ME,
            &Report {
                from: robot(7),
                ..report(observer, 1.0)
            },
        );
    }
    let by_liar = confidence(&items, ME);
    receive(&mut items, ME, &report(1, 0.5));
    assert!(confidence(&items, ME) > by_liar);
}

#[test]
fn a_liar_cannot_move_a_reported_item_far() {
    let mut items = Items::new(64, None);
    receive(&mut items, ME, &report(1, 0.9));
    for number in 0..100 {
        let provenance = Provenance {
            track_id: number,
            ..report(7, 1.0).provenance
        };
        let at = items.tracks[0].at.plus(Point { x: 0.2, y: 0.0 });
        receive(
            &mut items,
            ME,
            &Report {
                at,
                provenance,
                ..report(7, 1.0)
            },
        );
    }
    assert!(
        items.tracks[0].at.to(POSITION).length() < 0.2,
        "{:?}",
        items.tracks[0].at
    );
}

#[test]
fn a_liar_cannot_gather_the_reports_of_others_by_naming_them_first() {
    let mut items = Items::new(64, None);
    let lie = POSITION.plus(Point { x: -15.0, y: 9.0 });
    let named = |observer| Report {
        from: robot(7),
        at: lie,
        ..report(observer, 1.0)
    };
    let lies = [7, 1, 2, 3].map(named);
    for each in &lies {
        receive(&mut items, ME, each);
    }
    let alone = confidence(&items, ME);
    for observer in 1..4 {
        receive(&mut items, ME, &report(observer, 1.0));
        // Also relayed.
        let relayed = Report {
            from: robot(5),
            ..report(observer, 1.0)
        };
        receive(&mut items, ME, &relayed);
    }
    assert!((confidence(&items, ME) - alone).abs() < 1e-12);
    assert!(items.tracks[0].at.to(lie).length() < 1e-9);
    assert!(items.tracks[1].at.to(POSITION).length() < 1e-9);
}

#[test]
fn an_item_earns_trust_once_however_often_it_is_reported() {
    let mut items = Items::new(64, None);
    let mut trust = Trust::new(&TrustSpec::default());
    (0..10).for_each(|_| hit(&mut items, ME));
    let mut after = [0.0; 2];
    for number in 0..100 {
        let repeated = Report {
            from: robot(7),
            ..report(100 + number, 0.9)
        };
        receive(&mut items, ME, &repeated);
        hit(&mut items, ME);
        items.learn(ME, &mut trust);
        after[usize::from(number > 0)] = trust.of(robot(7));
    }
    assert!(after[0] > TrustSpec::default().initial);
    assert!((after[1] - after[0]).abs() < 1e-9, "{after:?}");
}

#[test]
fn a_miss_of_a_robot_with_a_poor_position_is_not_support() {
    let mut items = Items::new(64, None);
    let lie = report(7, 1.0);
    receive(&mut items, ME, &lie);
    let alone = confidence(&items, ME);
    let (observer, mut of_observer) = (robot(1), Items::new(64, None));
    with_initial_trust(observer, |reception| {
        of_observer.receive(reception, &lie, 4.0, &[PER_M2]);
    });
    // The item is at the edge of its field of view.
    observe(&mut of_observer, observer, Point { x: -2.0, y: 0.0 }, &[]);
    let own = sent(&mut of_observer);
    let own = own.iter().find(|sent| sent.provenance.observer == observer);
    let missed = own.expect("it reports its miss");
    let prior = TAU * 0.01 * PER_M2;
    assert!(missed.confidence > prior, "{}", missed.confidence);
    receive(&mut items, ME, missed);
    assert!(confidence(&items, ME) <= alone);
}

/// The confidence in an item at a trust in all robots after the reports of liars, and after each of some denials.
fn denied(trust: f64, liars: u32, denials: &[f64]) -> Vec<f64> {
    let spec = TrustSpec {
        initial: trust,
        adaptive: false,
    };
    let trust = &Trust::new(&spec);
    let reception = Reception { own: ME, trust };
    let mut items = Items::new(64, None);
    for liar in 1..=liars {
        items.receive(&reception, &report(liar, 1.0), 0.01, &[PER_M2]);
    }
    let mut found = vec![items.tracks[0].confidence(&reception, None)];
    for (observer, denial) in (10..).zip(denials) {
        items.receive(&reception, &report(observer, *denial), 0.01, &[PER_M2]);
        found.push(items.tracks[0].confidence(&reception, None));
    }
    found
}

#[test]
fn robots_that_see_nothing_lower_the_belief_in_what_liars_report() {
    for denial in [1e-6, 1e-5, 1e-4] {
        let found = denied(0.5, 2, &[denial; 2]);
        assert!((found[0] - 0.75).abs() < 3e-3, "{found:?}");
        assert!(found[1] < found[0] && found[2] < found[1], "{found:?}");
    }
}

/// A report by any robot of the observations of any robot.
fn any_report(confidence: impl Strategy<Value = f64>) -> impl Strategy<Value = Report> {
    let share = proptest::option::of(0.01_f32..=1.0);
    (1_u32..8, 1_u32..8, confidence, 0_u16..2, share).prop_map(
        |(from, observer, confidence, kind, kind_share)| Report {
            from: robot(from),
            kind,
            kind_share,
            ..report(observer, confidence)
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn a_denial_never_raises_belief(
        initial in 0.01_f64..0.99,
        before in proptest::collection::vec(any_report(0.0..=1.0), 0..12),
        denials in proptest::collection::vec(any_report(0.0..=MAX_PRIOR), 1..4),
        has_kinds in any::<bool>(),
    ) {
        let trust = &Trust::new(&TrustSpec { initial, adaptive: false });
        let reception = Reception { own: ME, trust };
        let mut items = if has_kinds { kinds::receiver() } else { Items::new(64, None) };
        let model = items.kinds.clone();
        let mut last = 1.0;
        for (number, each) in (0..).zip(before.iter().chain(&denials)) {
            let provenance = Provenance { track_id: number, ..each.provenance };
            let kind = if has_kinds { each.kind } else { 0 };
            items.receive(&reception, &Report { kind, provenance, ..*each }, 0.01, &[PER_M2, PER_M2]);
            let believed = items.tracks[0].confidence(&reception, model.as_deref());
            prop_assert!(each.confidence > MAX_PRIOR || number == 0 || believed <= last + 1e-12, "{believed} {last}");
            last = believed;
        }
    }
}

#[test]
fn a_denial_that_own_observations_refute_costs_trust_and_one_that_they_confirm_earns_none() {
    let mut trust = Trust::new(&TrustSpec::default());
    let mut items = Items::new(64, None);
    receive(&mut items, ME, &report(7, 0.9));
    receive(&mut items, ME, &report(8, 1e-4));
    (0..10).for_each(|_| hit(&mut items, ME));
    items.learn(ME, &mut trust);
    assert!(trust.of(robot(7)) > TrustSpec::default().initial);
    assert!(trust.of(robot(8)) < TrustSpec::default().initial);

    let mut trust = Trust::new(&TrustSpec::default());
    let mut items = Items::new(64, None);
    receive(&mut items, ME, &report(7, 0.9));
    receive(&mut items, ME, &report(8, 1e-4));
    (0..30).for_each(|_| miss(&mut items, ME));
    items.learn(ME, &mut trust);
    assert!(trust.of(robot(7)) < TrustSpec::default().initial);
    assert!((trust.of(robot(8)) - TrustSpec::default().initial).abs() < 1e-6);
}

/// Six reports fill all slots; two of them name another kind than the most probable one.
#[test]
fn a_denial_does_not_take_the_slot_of_support_that_contradicts_the_kind() {
    let spec = TrustSpec {
        initial: 0.978,
        adaptive: false,
    };
    let trust = &Trust::new(&spec);
    let reception = Reception { own: ME, trust };
    let mut items = kinds::receiver();
    let model = items.kinds.clone();
    let support = [
        (0.12, 0, Some(0.95)),
        (0.12, 1, Some(0.95)),
        (0.6, 1, None),
        (0.11, 0, None),
        (0.6, 1, None),
        (0.6, 0, None),
    ];
    for (number, (confidence, kind, kind_share)) in (1..).zip(support) {
        let named = Report {
            kind,
            kind_share,
            ..report(number, confidence)
        };
        items.receive(&reception, &named, 4.0, &[PER_M2, PER_M2]);
    }
    let before = items.tracks[0].confidence(&reception, model.as_deref());
    items.receive(&reception, &report(7, 1e-6), 4.0, &[PER_M2, PER_M2]);
    let after = items.tracks[0].confidence(&reception, model.as_deref());
    assert!(
        items.tracks.len() == 1 && after <= before,
        "{before} {after}"
    );
}

#[test]
fn reports_that_deny_and_those_that_are_too_old_do_not_move_an_item() {
    let mut items = Items::new(64, None);
    receive(&mut items, ME, &report(1, 0.9));
    let of = |items: &Items| (items.tracks[0].at, items.tracks[0].variance_m2);
    let before = of(&items);
    let beside = POSITION.plus(Point { x: 0.1, y: 0.0 });
    for (number, confidence, freshness) in [(2, 0.05, 1.0), (3, 0.9, 0.0), (4, 0.9, 1e-9)] {
        let other = Report {
            at: beside,
            freshness,
            ..report(number, confidence)
        };
        receive(&mut items, ME, &other);
    }
    assert!((of(&items).1 - before.1).abs() < 1e-9 && of(&items).0.to(before.0).length() < 1e-6);
    receive(
        &mut items,
        ME,
        &Report {
            at: beside,
            ..report(5, 0.9)
        },
    );
    assert!(of(&items).1 < before.1);
}
