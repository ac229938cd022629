//! Vehicles that pass a lane move, and mines destroy them.

use crate::judge::events::{EventKind, EventLog};
use crate::passage::VehicleStatus;
use crate::passage::convoy::{Convoy, Moving};
use crate::run::state::State;
use crate::scenario::Scenario;
use crate::sensors::sensor_frame::NoisePurpose;
use base::noise::{Noise, share};
use base::random::{Entity, kind_key};

/// The name of vehicles in random streams: no kind of robots can have it.
const STREAM: &str = "[passage]";

/// Moves the vehicles by a step, in their order; returns whether one of them has passed or was destroyed.
pub(super) fn drive(scenario: &Scenario, state: &mut State, events: &EventLog) -> bool {
    let (Some(passage), Some(mut convoy)) = (scenario.passage, state.convoy.take()) else {
        return false;
    };
    let step_m = passage.speed_m_s * scenario.step_s;
    let mut is_counted = false;
    for number in 0..convoy.vehicles.len() {
        let vehicle = convoy.vehicles[number];
        if vehicle.status == VehicleStatus::Driving {
            let next = moved(scenario, state, (&convoy, number), step_m, events);
            is_counted |= next.status != VehicleStatus::Driving;
            convoy.vehicles[number] = next;
        }
    }
    if !convoy.is_driving() {
        convoy.ended_at.get_or_insert(state.tick);
    }
    state.convoy = Some(convoy);
    is_counted
}

/// A vehicle after a step: mines ahead may destroy it.
fn moved(
    scenario: &Scenario,
    state: &mut State,
    (convoy, number): (&Convoy, usize),
    step_m: f64,
    events: &EventLog,
) -> Moving {
    let mut vehicle = convoy.vehicles[number];
    let from_m = vehicle.along_m;
    vehicle.along_m = (from_m + step_m).min(convoy.length_m());
    let index = u32::try_from(number).unwrap_or(u32::MAX);
    for (along_m, item) in convoy.ahead(scenario, &state.items, [from_m, vehicle.along_m]) {
        let effect = scenario
            .passage
            .and_then(|passage| passage.effect_of(scenario, state.items.kind(item)));
        let Some(effect) =
            effect.filter(|effect| draw(state, scenario, index, item) < effect.destroy_probability)
        else {
            continue;
        };
        (vehicle.along_m, vehicle.status) = (along_m, VehicleStatus::Lost);
        let named = (state.items.kind(item), state.items.thing(item).index);
        let kind = EventKind::VehicleLost {
            vehicle: index,
            item: named,
        };
        events.note(state.tick, kind);
        if effect.detonates {
            state.items.remove(item);
        }
        return vehicle;
    }
    if vehicle.along_m >= convoy.length_m() {
        vehicle.status = VehicleStatus::Passed;
        events.note(state.tick, EventKind::VehiclePassed { vehicle: index });
    }
    vehicle
}

/// Whether a mine destroys a vehicle: the same draw in each step, one for each vehicle and item.
fn draw(state: &State, scenario: &Scenario, index: u32, item: u32) -> f64 {
    let kind = kind_key(STREAM);
    let noise = Noise::of(state.seed, state.run, Entity { kind, index });
    let key = scenario.items[usize::from(state.items.kind(item))].key;
    let thing = state.items.thing(item).index;
    let words = noise.words(NoisePurpose::Hazard as u32, key.into(), thing);
    share(words[0])
}
