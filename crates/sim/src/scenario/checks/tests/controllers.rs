//! Controllers, their carriers and their leases.

use super::{GOOD, error, errors_in};

/// The errors of the valid scenario with controllers of these keys.
fn errors_of(keys: &str) -> Vec<String> {
    let text = format!("{GOOD}\n[controllers.base]\ncount = 1\n{keys}\n");
    errors_in(&text)
}

fn error_of(keys: &str) -> String {
    let errors = errors_of(keys);
    assert_eq!(errors.len(), 1, "{errors:?}");
    errors.concat()
}

const RADIO: &str = "radio = { range_m = 9 }\n";

#[test]
fn a_controller_needs_a_radio() {
    assert_eq!(errors_of(RADIO), [""; 0]);
    assert!(error_of("").starts_with("controllers.base.radio is missing"));
}

#[test]
fn the_radio_of_a_controller_reaches_others() {
    let range = error_of("radio = { range_m = 0 }");
    assert!(
        range.starts_with("controllers.base.radio.range_m = 0: must be above 0"),
        "{range}"
    );
    let messages = error_of("radio = { range_m = 9, messages_per_step = 0 }");
    assert!(
        messages.contains("messages_per_step = 0: must be at least 1"),
        "{messages}"
    );
}

#[test]
fn errors_of_keys_meaning_and_places_are_reported_together() {
    let text = format!(
        "{GOOD}[controllers.base]\ncount = -1\nprise = 3\naboard = \"rovr\"\nradio = {{ range_m = 0 }}\n\
         [goals.spot]\ncount = 1\nonwer = \"base\"\nrequires = \"arm\"\n"
    );
    let places = text.replace("count = -1\nprise = 3\n", "count = 1\n");
    let places =
        places.replace("onwer", "owner") + "placement = { kind = \"fixed\", at_m = [[2, 2]] }\n";
    let starts = |text: &str| {
        let errors = errors_in(text);
        let paths = errors
            .iter()
            .map(|error| error.split(' ').next().unwrap_or_default().to_owned());
        paths.collect::<Vec<String>>()
    };
    assert_eq!(
        starts(&places),
        [
            "controllers.base.aboard",
            "controllers.base.radio.range_m",
            "goals.spot.requires",
            "goals.spot.placement.at_m[0]"
        ]
    );
    let ranges = text.replace("count = -1", "count = 2000");
    assert_eq!(
        starts(&ranges),
        [
            "controllers.base.count",
            "controllers.base.prise",
            "goals.spot.onwer",
            "controllers.base.aboard",
            "controllers.base.radio.range_m",
            "goals.spot.requires",
        ]
    );
}

#[test]
fn controllers_are_aboard_a_kind_of_robots_that_has_enough_of_them() {
    assert_eq!(errors_of(&format!("{RADIO}aboard = \"rover\"")), [""; 0]);
    let unknown = error_of(&format!("{RADIO}aboard = \"rovr\""));
    assert_eq!(
        unknown,
        "controllers.base.aboard = \"rovr\": must be one of \"bird\", \"rover\"; did you mean \"rover\"?"
    );
    let text =
        "[controllers.base]\ncount = 3\naboard = \"rover\"\nradio = { range_m = 9 }\n[terrain.mud]";
    assert!(
        error("[terrain.mud]", text).starts_with("controllers.base.count = 3: must be at most 2")
    );
    let both = format!("{RADIO}aboard = \"rover\"\nstart = {{ kind = \"uniform\" }}");
    assert!(error_of(&both).contains("must be omitted"));
}

#[test]
fn a_lease_outlasts_an_auction_and_a_round_trip() {
    let delayed = "radio = { range_m = 9, delay_s = 2 }\nservice_lease_s = 3";
    assert!(
        error_of(delayed).starts_with("controllers.base.service_lease_s = 3: must be at least 3.5")
    );
    let auction = format!("{RADIO}auction_s = 30");
    assert!(error_of(&auction).contains("an auction of 30 s"));
    let owner = format!("{RADIO}owner_lease_s = 0.1");
    assert!(error_of(&owner).starts_with("controllers.base.owner_lease_s = 0.1: must be at least"));
}

#[test]
fn an_ownership_lease_that_a_majority_grants_outlasts_three_round_trips() {
    let with = |count: u32, lease_s: f64, backup: &str| {
        let radio = "radio = { range_m = 9, delay_s = 1 }";
        let text = format!(
            "{GOOD}\n[controllers.base]\ncount = {count}\n{radio}\nowner_lease_s = {lease_s}\n{backup}\n"
        );
        errors_in(&text).concat()
    };
    let few = with(3, 5.0, "");
    assert!(
        few.starts_with("controllers.base.owner_lease_s = 5: must be at least 7."),
        "{few}"
    );
    assert!(few.contains("3 round trips"), "{few}");
    for (count, lease_s, backup) in [(3, 8.0, ""), (1, 5.0, ""), (3, 5.0, "backup = \"none\"")] {
        assert_eq!(with(count, lease_s, backup), "");
    }
    let unknown = with(3, 30.0, "backup = \"heir\"");
    assert!(
        unknown.contains("controllers.base.backup = \"heir\""),
        "{unknown}"
    );
}

#[test]
fn trade_needs_another_controller_and_a_gain_below_1() {
    let errors = errors_of(&format!(
        "{RADIO}owner_lease_s = 0.1\n[controllers.base.trade]\ngain = 1"
    ));
    let paths: Vec<&str> = errors
        .iter()
        .filter_map(|it| it.split(": must").next())
        .collect();
    let expected = [
        "controllers.base.trade.gain = 1",
        "controllers.base.trade = {...}",
        "controllers.base.owner_lease_s = 0.1",
    ];
    assert_eq!(paths, expected);
    for good in ["gain = 0.01", "confidence = 1", "gain = 0.99"] {
        let text = format!("{GOOD}\n[controllers.base]\ncount = 2\n{RADIO}trade = {{ {good} }}\n");
        assert_eq!(errors_in(&text), [""; 0], "{good}");
    }
    for bad in [
        "gain = 0",
        "gain = 1.0",
        "confidence = 1.1",
        "confidence = -1",
        "price = 3",
    ] {
        let text = format!("{GOOD}\n[controllers.base]\ncount = 2\n{RADIO}trade = {{ {bad} }}\n");
        assert_eq!(errors_in(&text).len(), 1, "{bad}");
    }
}

#[test]
fn the_error_of_a_default_lease_names_the_default() {
    let auction = error_of(&format!("{RADIO}auction_s = 30"));
    let start = "controllers.base.service_lease_s = 20 (default): must be at least 3";
    assert!(auction.starts_with(start), "{auction}");
}

#[test]
fn exact_clocks_are_no_reason_for_a_longer_lease() {
    let owner = "[controllers.base]\ncount = 1\nradio = { range_m = 9 }\nowner_lease_s = 0.1\n[terrain.mud]";
    for (max_drift, is_reason) in [("0", false), ("0.01", true)] {
        let clock = format!("[clock]\nmax_drift = {max_drift}\n");
        let text = GOOD
            .replace("[clock]\n", &clock)
            .replace("[terrain.mud]", owner);
        let errors = errors_in(&text).concat();
        assert!(
            errors.contains("owner_lease_s = 0.1: must be at least"),
            "{errors}"
        );
        assert_eq!(errors.contains("drift"), is_reason, "{errors}");
    }
}

#[test]
fn a_lease_outlasts_the_service_of_the_goals() {
    let of_lease = |lease_s: u32| {
        let errors = errors_of(&format!(
            "{RADIO}service_lease_s = {lease_s}\n[goals.spot]\ncount = 1\nservice_s = 25"
        ));
        errors
            .into_iter()
            .find(|error| error.starts_with("controllers.base.service_lease_s"))
    };
    let short = of_lease(24).unwrap();
    assert!(short.contains("= 24: must be at least 25.6"), "{short}");
    assert!(short.contains("the service of goals.spot, 25 s"), "{short}");
    assert_eq!(of_lease(26), None);
}

#[test]
fn controllers_have_other_names_than_robots_and_free_places() {
    let text = "[controllers.rover]\ncount = 1\nradio = { range_m = 9 }\n[terrain.mud]";
    assert!(error("[terrain.mud]", text).contains("a different name"));
    let start = format!("{RADIO}start = {{ kind = \"fixed\", at_m = [[2, 2]] }}");
    assert!(error_of(&start).starts_with("controllers.base.start.at_m[0]"));
    let few = format!("{RADIO}start = {{ kind = \"fixed\", at_m = [] }}");
    assert!(error_of(&few).contains("at least 1 places"));
}

#[test]
fn controllers_have_detectors_of_robots_only() {
    let sensor = |keys: &str| errors_of(&format!("{RADIO}sensors = {{ eye = {{ {keys} }} }}"));
    assert_eq!(
        sensor("kind = \"robots\", range_m = 9, rate_hz = 2"),
        [""; 0]
    );
    assert_eq!(
        sensor("kind = \"position\""),
        [
            "controllers.base.sensors.eye.kind = \"position\": must be \"robots\": controllers have no other sensors"
        ]
    );
    let odd =
        sensor("kind = \"robots\", range_m = 9, latency_s = 1, power_w = 2, rate_hz = 99").concat();
    for error in [
        "eye.latency_s = 1: must be 0",
        "eye.power_w = 2: must be 0",
        "eye.rate_hz = 99: must be at most 10",
    ] {
        assert!(odd.contains(error), "{odd}");
    }
    let aboard = error_of(&format!(
        "{RADIO}aboard = \"rover\"\nsensors = {{ eye = {{ kind = \"robots\", range_m = 9 }} }}"
    ));
    assert!(aboard.contains("does not know its position"), "{aboard}");
}
