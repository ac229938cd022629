//! Checks of controllers: what carries them, and their leases.

use crate::controllers::ControllerSpec;
use crate::goals::GoalSpec;
use crate::radio::RadioSpec;
use crate::scenario::spec::ScenarioSpec;
use crate::sensors::KINDS;
use base::document::Place;
use base::error::{InputError, Problem};

/// Steps in which messages wait for their receivers, on the way to a controller and back.
const STEPS: f64 = 4.0;

pub(super) fn errors(spec: &ScenarioSpec, at: &Place) -> Vec<InputError> {
    let kinds = spec.controllers.iter();
    kinds
        .flat_map(|(name, kind)| {
            let at = at.key("controllers").key(name);
            let mut errors = of_carriers(kind, spec, &at);
            errors.extend(of_sensors(kind, &at));
            errors.extend(of_radio(&kind.radio, &at.key("radio")));
            errors.extend(of_trade(kind, &at));
            errors.extend(of_leases(kind, spec, &at));
            errors.extend(of_services(name, spec, &at));
            errors
        })
        .collect()
}

/// A kind of robots that does not exist, or has too few robots.
fn of_carriers(kind: &ControllerSpec, spec: &ScenarioSpec, at: &Place) -> Vec<InputError> {
    let Some(aboard) = &kind.aboard else {
        return Vec::new();
    };
    let mut errors = Vec::new();
    if kind.start.is_some() {
        let allowed = "omitted: controllers aboard robots are where these are";
        errors.push(at.key("start").error(allowed));
    }
    match spec.robots.get(aboard) {
        None => errors.push(unknown(aboard, spec.robots.keys(), &at.key("aboard"))),
        Some(robots) if robots.count < kind.count => {
            let allowed = format!(
                "at most {}, the number of robots that carry these controllers, one each",
                robots.count
            );
            errors.push(at.key("count").error(allowed));
        }
        Some(_) => {}
    }
    errors
}

/// Sensors that controllers do not have, or that have no effect on them.
fn of_sensors(kind: &ControllerSpec, at: &Place) -> Vec<InputError> {
    let mut errors = Vec::new();
    if kind.aboard.is_some() && !kind.sensors.is_empty() {
        let allowed = "omitted: a controller aboard a robot does not know its position, nor those of what it detects";
        errors.push(at.key("sensors").error(allowed));
    }
    for (name, sensor) in &kind.sensors {
        let at = at.key("sensors").key(name);
        if !sensor.measures.facts().is_for_controllers {
            let kinds = KINDS.iter().filter(|kind| kind.is_for_controllers);
            let kinds: Vec<String> = kinds.map(|kind| format!("{:?}", kind.name)).collect();
            let allowed = format!("{}: controllers have no other sensors", kinds.join(" or "));
            errors.push(at.key("kind").error(allowed));
        }
        if sensor.latency_s > 0.0 {
            let allowed = "0: sensors of controllers have no delay";
            errors.push(at.key("latency_s").error(allowed));
        }
        if sensor.power_w > 0.0 {
            let allowed = "0: controllers have no battery";
            errors.push(at.key("power_w").error(allowed));
        }
    }
    errors
}

/// A radio over which a controller reaches no other agent: messages are all that it has.
fn of_radio(radio: &RadioSpec, at: &Place) -> Vec<InputError> {
    let mut errors = Vec::new();
    if radio.range_m == 0.0 {
        let allowed = "above 0: a controller acts only through messages";
        errors.push(at.key("range_m").error(allowed));
    }
    if radio.messages_per_step == 0 {
        let allowed = "at least 1: a controller acts only through messages";
        errors.push(at.key("messages_per_step").error(allowed));
    }
    errors
}

/// Trade with no other controller of the kind.
fn of_trade(kind: &ControllerSpec, at: &Place) -> Option<InputError> {
    (kind.trade.is_some() && kind.count == 1).then(|| {
        let allowed = "omitted for a single controller: it trades with others of its kind";
        at.key("trade").error(allowed)
    })
}

/// A name that is none of these.
pub(super) fn unknown<'n>(
    name: &str,
    names: impl Iterator<Item = &'n String> + Clone,
    at: &Place,
) -> InputError {
    let names = names.map(String::as_str);
    if names.clone().next().is_none() {
        return at.error("omitted: there are none");
    }
    let listed = InputError::not_one_of(String::new(), None, name, names);
    InputError {
        suggestion: listed.suggestion,
        ..at.error(listed.allowed)
    }
}

/// Leases that end before they can be renewed. The clock of the holder may be fast, and that of an auction slow.
fn of_leases(kind: &ControllerSpec, spec: &ScenarioSpec, at: &Place) -> Vec<InputError> {
    let drift = spec.clock.max_drift;
    let [robots_s, controllers_s] = round_trips_s(kind, spec);
    let min_service_s = kind.settings(spec).min_service_lease_s(robots_s);
    let clocks = on_clocks(drift);
    let (auction_s, trips) = (kind.auction_s, trips(kind));
    let service = format!(
        "an auction of {auction_s} s and a round trip of {robots_s:.3} s over the radio{clocks}"
    );
    let trips_s = format!("of {controllers_s:.3} s over the radio{clocks}");
    let owner = match trips {
        1 => format!("a round trip {trips_s}"),
        _ => format!("{trips} round trips {trips_s}, so that it is renewed in time"),
    };
    let min_owner_s = (1.0 + drift) * f64::from(trips) * controllers_s;
    let leases = [
        (
            "service_lease_s",
            kind.service_lease_s,
            min_service_s,
            service,
        ),
        ("owner_lease_s", kind.owner_lease_s, min_owner_s, owner),
    ];
    let short = leases
        .into_iter()
        .filter(|(_, lease_s, min_s, _)| lease_s < min_s);
    let errors = short.map(|(key, lease_s, min_s, what)| {
        let allowed = format!("at least {min_s:.3}: it must outlast {what}");
        of_lease(lease_s, allowed, &at.key(key))
    });
    errors.collect()
}

/// Round trips that an ownership lease outlasts: a vote is renewed when two thirds of it are left, and twice later.
fn trips(kind: &ControllerSpec) -> u32 {
    if kind.has_voters() { 3 } else { 1 }
}

/// Why a lease is longer than by exact clocks, in words; empty if clocks do not drift.
fn on_clocks(max_drift: f64) -> String {
    if max_drift > 0.0 {
        format!(", on clocks that drift by at most {max_drift}")
    } else {
        String::new()
    }
}

/// The error of a lease, which may be the default.
pub(super) fn of_lease(lease_s: f64, allowed: String, at: &Place) -> InputError {
    let mut error = at.error(allowed);
    if error.problem == Problem::Missing {
        error.problem = Problem::NotAllowed(format!("{lease_s} (default)"));
    }
    error
}

/// A lease that ends before a goal is served: a robot begins no service that it may not end.
fn of_services(name: &str, spec: &ScenarioSpec, at: &Place) -> Option<InputError> {
    let kind = &spec.controllers[name];
    let is_owner = |goal: &GoalSpec| match &goal.owner {
        Some(owner) => owner == name,
        None => spec
            .controllers
            .keys()
            .next()
            .is_some_and(|first| first == name),
    };
    let goals = spec.goals.iter().filter(|(_, goal)| is_owner(goal));
    let longest = goals.max_by(|(_, one), (_, other)| one.service_s.total_cmp(&other.service_s));
    let (goals, goal) = longest.filter(|(_, goal)| goal.service_s > 0.0)?;
    let [trip_s, _] = round_trips_s(kind, spec);
    let min_lease_s = (1.0 + spec.clock.max_drift) * (goal.service_s + trip_s);
    let allowed = format!(
        "at least {min_lease_s:.3}: it must outlast the service of goals.{goals}, {} s, and a round trip of \
         {trip_s:.3} s over the radio",
        goal.service_s
    );
    (kind.service_lease_s < min_lease_s)
        .then(|| of_lease(kind.service_lease_s, allowed, &at.key("service_lease_s")))
}

/// The longest time until a message of a robot is answered, and until one of another controller is.
pub(super) fn round_trips_s(kind: &ControllerSpec, spec: &ScenarioSpec) -> [f64; 2] {
    let step_s = spec.clock.step_s;
    let controllers = spec.controllers.values();
    let controllers_s = controllers
        .map(|other| other.radio.trip_s(step_s))
        .fold(step_s, f64::max);
    let others_s = controllers_s + kind.radio.trip_s(step_s);
    [kind.answer_s(spec), others_s].map(|trip_s| trip_s + STEPS * step_s)
}
