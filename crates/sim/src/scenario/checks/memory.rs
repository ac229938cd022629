//! Checks that a run fits into memory.

use super::ground::rectangle;
use crate::bodies::RobotSpec;
use crate::controllers::ControllerSpec;
use crate::radio::RadioSpec;
use crate::scenario::spec::ScenarioSpec;
use crate::sensors::SensorSpec;
use crate::sensors::memory::{
    CONTACT_BYTES, MAX_PENDING, MEASUREMENT_BYTES, MESSAGE_BYTES, NEIGHBOUR_BYTES,
    OBSERVATION_BYTES, SENT_BYTES,
};
use crate::sensors::sensor_kind::Vicinity;
use base::document::Place;
use base::error::InputError;
use base::geometry::Rectangle;
use base::placement::Placement;
use brain::behaviours::BehaviourSpec;

/// Approximate limit in bytes per run: as many runs as there are processor cores are computed at
/// once.
const MAX_BYTES: f64 = 4e9;

/// Approximate bytes of a robot's state, its brain and its share of the indices.
const ROBOT_BYTES: f64 = 2_000.0;

/// Approximate bytes of a robot's beliefs besides its maps, and of one cell of those.
const BELIEFS_BYTES: f64 = 30_000.0;
const CELL_BYTES: f64 = 20.0;

/// Approximate bytes of one tracked item; the beliefs above include this number of them.
const TRACK_BYTES: f64 = 600.0;
const TRACKS: f64 = 64.0;

/// One measured number.
const VALUE_BYTES: f64 = 8.0;

/// One setpoint in the delay of a drive.
const SETPOINT_BYTES: f64 = 16.0;

/// Bytes of a list besides its values, and its minimum capacity.
const LIST_BYTES: f64 = 16.0;
const MIN_VALUES: f64 = 4.0;

/// Approximate bytes of a controller, and of one goal that it may own.
const CONTROLLER_BYTES: f64 = 10_000.0;
const OWNED_BYTES: f64 = 500.0;

/// Approximate bytes of a goal.
const GOAL_BYTES: f64 = 400.0;

/// Approximate bytes of an item.
const ITEM_BYTES: f64 = 64.0;

pub(super) fn errors(spec: &ScenarioSpec, at: &Place) -> Vec<InputError> {
    let items = spec.items.iter().map(|(name, kind)| {
        let bytes = f64::from(kind.max_number()) * ITEM_BYTES;
        (bytes, at.key("items").key(name))
    });
    let robots = spec.robots.iter().map(|(name, robot)| {
        let bytes = f64::from(robot.count) * bytes_of(robot, spec);
        (bytes, at.key("robots").key(name))
    });
    let goals = spec.goals.iter().map(|(name, kind)| {
        let bytes = f64::from(kind.count) * GOAL_BYTES;
        (bytes, at.key("goals").key(name))
    });
    let controllers = spec.controllers.iter().map(|(name, kind)| {
        let bytes = f64::from(kind.count) * bytes_of_controller(kind, spec);
        (bytes, at.key("controllers").key(name))
    });
    let all = items.chain(robots).chain(goals).chain(controllers);
    let all: Vec<(f64, Place)> = all.collect();
    let total: f64 = all.iter().map(|(bytes, _)| bytes).sum();
    let largest = all.iter().max_by(|one, other| one.0.total_cmp(&other.0));
    let largest = largest.filter(|_| total > MAX_BYTES);
    let error = largest.map(|(bytes, at)| {
        at.key("count").error(format!(
            "fewer, or with fewer rays, contacts and messages: a run may take {} GB of memory, and this one \
             takes about {:.1} GB, {:.1} GB for these",
            MAX_BYTES / 1e9,
            total / 1e9,
            bytes / 1e9
        ))
    });
    error.into_iter().collect()
}

/// With everything that its sensors and its radio have in transit, in the mean over random events,
/// with everything at its given place and each robot sending at its maximum.
fn bytes_of(robot: &RobotSpec, spec: &ScenarioSpec) -> f64 {
    let sensors = robot.sensors.values();
    let sensors: f64 = sensors
        .map(|sensor| bytes_of_sensor(sensor, robot.brain.rate_hz, spec))
        .sum();
    let radio = robot.radio.as_ref();
    let rate_hz = robot.brain.rate_hz;
    let radio = radio.map_or(0.0, |radio| bytes_of_radio(radio, rate_hz, spec));
    let delayed = robot.drive.delay_s / spec.clock.step_s * SETPOINT_BYTES;
    ROBOT_BYTES + sensors + radio + delayed + bytes_of_beliefs(robot)
}

fn bytes_of_controller(kind: &ControllerSpec, spec: &ScenarioSpec) -> f64 {
    let goals: u32 = spec.goals.values().map(|kind| kind.count).sum();
    let owned = f64::from(goals.min(kind.max_goals));
    let sensors = kind.sensors.values();
    let sensors: f64 = sensors
        .map(|sensor| bytes_of_sensor(sensor, None, spec))
        .sum();
    CONTROLLER_BYTES + owned * OWNED_BYTES + sensors + bytes_of_radio(&kind.radio, None, spec)
}

/// Approximate bytes of its beliefs.
fn bytes_of_beliefs(robot: &RobotSpec) -> f64 {
    let brain = &robot.brain;
    let mut behaviours = brain.behaviours.iter();
    if brain.beliefs.is_none() && !behaviours.any(BehaviourSpec::needs_beliefs) {
        return 0.0;
    }
    let beliefs = brain.beliefs.clone().unwrap_or_default();
    let more_tracks = (f64::from(beliefs.max_tracks) - TRACKS).max(0.0);
    BELIEFS_BYTES + f64::from(beliefs.cells) * CELL_BYTES + more_tracks * TRACK_BYTES
}

/// Bytes of its messages in transit to all receivers, and of those that it has received.
fn bytes_of_radio(radio: &RadioSpec, rate_hz: Option<f64>, spec: &ScenarioSpec) -> f64 {
    let step_s = spec.clock.step_s;
    let a_step = f64::from(radio.messages_per_step);
    let controllers: u32 = spec.controllers.values().map(|kind| kind.count).sum();
    let robots = robots_within(radio.range_m, spec, |robot| robot.radio.is_some());
    let receivers = robots + f64::from(controllers);
    let delay = (radio.delay_s / step_s).max(1.0);
    let waiting = (a_step * period_s(rate_hz, step_s) / step_s).min(most() + a_step);
    a_step * delay * receivers * size(SENT_BYTES) + waiting * size(MESSAGE_BYTES)
}

/// Bytes of measurements that are in transit, or wait for a brain that steps at a rate.
fn bytes_of_sensor(sensor: &SensorSpec, rate_hz: Option<f64>, spec: &ScenarioSpec) -> f64 {
    let step_s = spec.clock.step_s;
    let counts = MeasurementCounts {
        late: sensor.latency_s / period_s(sensor.rate_hz, step_s),
        per_brain_step: period_s(rate_hz, step_s) / period_s(sensor.rate_hz, step_s),
        is_immediate: sensor.latency_s == 0.0 && rate_hz.is_none(),
    };
    let amounts = sensor
        .measures
        .amounts(period_s(sensor.rate_hz, step_s), &Around(spec));
    if !sensor.measures.facts().detects {
        return counts.bytes_kept(amounts.values, sensor);
    }
    counts.waiting(amounts.contacts) * size(CONTACT_BYTES)
        + counts.waiting(amounts.observations) * size(OBSERVATION_BYTES)
        + counts.waiting(amounts.neighbours) * size(NEIGHBOUR_BYTES)
}

/// What is to be expected anywhere in a scenario.
struct Around<'s>(&'s ScenarioSpec);

impl Vicinity for Around<'_> {
    fn items_within(&self, area_m2: f64) -> impl Iterator<Item = (&str, f64)> {
        self.0.items.iter().map(move |(name, kind)| {
            let items = things_within(area_m2, kind.count, &kind.placement, self.0);
            (name.as_str(), items)
        })
    }

    fn robots_within(&self, range_m: f64) -> f64 {
        robots_within(range_m, self.0, |_| true)
    }
}

/// How many measurements of a sensor exist at a time.
struct MeasurementCounts {
    /// In transit to the robot.
    late: f64,
    /// From one step of the brain to the next.
    per_brain_step: f64,
    /// Whether the brain gets each in the step in which it is taken.
    is_immediate: bool,
}

impl MeasurementCounts {
    /// Of a sensor of which the newest measurement replaces the others.
    fn bytes_kept(&self, values: f64, sensor: &SensorSpec) -> f64 {
        let never_waits = sensor.latency_s == 0.0 && sensor.dropout_probability == 0.0;
        if never_waits && sensor.rate_hz.is_none() {
            return values * VALUE_BYTES;
        }
        let list_bytes = LIST_BYTES + values.max(MIN_VALUES) * VALUE_BYTES;
        (self.late + 2.0) * (size(MEASUREMENT_BYTES) + list_bytes)
    }

    /// What waits if each measurement yields this number of entries that all count.
    fn waiting(&self, per_measurement: f64) -> f64 {
        if self.is_immediate {
            return 0.0;
        }
        let late = per_measurement * self.late;
        // Entries that are too old are dropped once there are twice as many as the limit.
        late + (per_measurement * self.per_brain_step.max(1.0)).min(late + most() + per_measurement)
    }
}

/// Mean number of robots in range where they start; at most as many as have room beside each other.
fn robots_within(range_m: f64, spec: &ScenarioSpec, counts: impl Fn(&RobotSpec) -> bool) -> f64 {
    let view_m2 = std::f64::consts::PI * range_m * range_m;
    let robots = spec.robots.values().filter(|robot| counts(robot));
    let within = robots.map(|robot| {
        let side = (range_m + robot.radius_m) / robot.radius_m;
        // Points have room anywhere.
        let room = if side.is_finite() {
            side * side
        } else {
            f64::MAX
        };
        things_within(view_m2, robot.count, &robot.start, spec).min(room)
    });
    within.sum()
}

/// The mean number of these things in such an area, but all that lie at given places and all of a
/// cluster.
fn things_within(view_m2: f64, count: u32, placement: &Placement, spec: &ScenarioSpec) -> f64 {
    let count = f64::from(count);
    let anywhere = |within_m: &Option<Rectangle>| {
        let within = within_m.unwrap_or_else(|| rectangle(&spec.world));
        count * (view_m2 / within.area_m2()).min(1.0)
    };
    match placement {
        Placement::Fixed { .. } => count,
        Placement::Uniform { within_m } => anywhere(within_m),
        Placement::Clustered {
            clusters, within_m, ..
        } => (count / f64::from(*clusters) + anywhere(within_m)).min(count),
    }
}

/// Period of a schedule, or one step.
fn period_s(rate_hz: Option<f64>, step_s: f64) -> f64 {
    rate_hz.map_or(step_s, |rate_hz| (1.0 / rate_hz).max(step_s))
}

fn most() -> f64 {
    size(MAX_PENDING)
}

#[expect(clippy::cast_precision_loss, reason = "some thousands at most")]
fn size(bytes: usize) -> f64 {
    bytes as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::document::Document;

    /// Approximate megabytes of a run with this number of robots, besides the robots themselves.
    fn megabytes(step_s: f64, count: u32, robot: &str) -> f64 {
        let text = format!(
            "[clock]\nstep_s = {step_s}\ntime_limit_s = 60\n[world]\nsize_m = [100, 100]\n\
             [items.mine]\ncount = 100\n[robots.rover]\ncount = {count}\nradius_m = 0.5\n\
             drive = {{ max_speed_m_s = 1, max_turn_rate_deg_s = 90 }}\n{robot}"
        );
        let document = Document::parse("t", &text).unwrap();
        let spec: ScenarioSpec = document.typed(ScenarioSpec::schema()).unwrap();
        let robot = &spec.robots["rover"];
        f64::from(robot.count) * (bytes_of(robot, &spec) - ROBOT_BYTES) / 1e6
    }

    fn assert_about(expected: f64, given: f64) {
        assert!(
            (given / expected - 1.0).abs() < 0.02,
            "{given} for {expected}"
        );
    }

    #[test]
    fn a_stored_measurement_counts_with_its_list() {
        let sonar =
            "sensors = { a = { kind = \"range\", rays = 1, range_m = 1, latency_s = 3600 } }";
        // 3,600,000 measurements of 40 bytes, each with a list of four numbers of 16 bytes more.
        assert_about(3.0 * 3.6 * (40.0 + 16.0 + 32.0), megabytes(0.001, 3, sonar));
    }

    #[test]
    fn contacts_count_by_their_number_per_measurement() {
        let eye = |more: &str| {
            let eye = "kind = \"items\", range_m = 10, latency_s = 100";
            megabytes(0.1, 10, &format!("sensors = {{ a = {{ {eye}, {more} }} }}"))
        };
        let counts = 10.0 * 1001.0 / 1e6;
        let (contact, glance) = (size(CONTACT_BYTES), size(OBSERVATION_BYTES));
        let area_m2 = std::f64::consts::PI * 100.0;
        assert_about(
            counts * (contact * area_m2 / 100.0 + glance),
            eye("detection_probability = { mine = 1 }"),
        );
        let alarms = "detection_probability = {}, false_alarm_rate_per_m2_s = { mine = 1 }";
        assert_about(counts * (contact * area_m2 / 10.0 + glance), eye(alarms));
    }

    #[test]
    fn robots_count_that_start_in_range_as_far_as_they_have_room() {
        let mates = |range_m: f64, side_m: f64| {
            let mates = format!("kind = \"robots\", range_m = {range_m}, latency_s = 100");
            let start = format!("kind = \"uniform\", within_m = [[0, 0], [{side_m}, {side_m}]]");
            let robot = format!("start = {{ {start} }}\nsensors = {{ a = {{ {mates} }} }}");
            megabytes(0.1, 1000, &robot)
        };
        let look = 1000.0 * 1001.0 * size(NEIGHBOUR_BYTES) / 1e6;
        assert_about(look * 1000.0 * 0.0314, mates(10.0, 100.0));
        assert_about(look * 1000.0, mates(100.0, 10.0));
        assert_about(look * 9.0, mates(1.0, 10.0));
    }

    #[test]
    fn what_waits_for_a_slow_brain_counts_until_it_is_forgotten() {
        let mates = "sensors = { a = { kind = \"robots\", range_m = 200 } }";
        assert!(megabytes(0.1, 10, mates).abs() < 1e-12);
        let slow = |rate_hz: f64| {
            megabytes(
                0.1,
                10,
                &format!("brain = {{ rate_hz = {rate_hz} }}\n{mates}"),
            )
        };
        let neighbour = 10.0 * size(NEIGHBOUR_BYTES) / 1e6;
        assert_about(neighbour * 10.0 * 10.0, slow(1.0));
        assert_about(neighbour * (2000.0 + 10.0), slow(0.0001));
    }

    #[test]
    fn a_message_counts_once_for_each_receiver() {
        let radio = "radio = { range_m = 200, messages_per_step = 10, delay_s = 60 }";
        let sent = size(SENT_BYTES) / 1e6;
        let expected = 200.0 * 200.0 * 10.0 * 600.0 * sent;
        assert_about(expected, megabytes(0.1, 200, radio));
        assert!(expected > 15_000.0);
    }
}
