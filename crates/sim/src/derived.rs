//! Quantities that follow from the values of a scenario, for people who check it.

use crate::bodies::RobotSpec;
use crate::controllers::lane::in_truth;
use crate::scenario::{Checked, ScenarioSpec};
use crate::sensors::SensorSpec;
use crate::sensors::detection::Detection;
use crate::sensors::items::ItemsSpec;
use crate::sensors::pass::{Pass, Path};
use crate::sensors::sensor_kind::AmongKinds;
use crate::warnings::lane_reach::{lane_reach, percent, reach_of};
use economy::Clearance;

/// What a pass of each item detector detects, for each kind of item that it detects: (sensor and kind, text).
pub(crate) fn derived(checked: &Checked) -> Vec<(String, String)> {
    let spec = &checked.spec;
    let mut derived = Vec::new();
    for (owner, robot) in &spec.robots {
        for (name, sensor) in &robot.sensors {
            if let Some(items) = ItemsSpec::of(&sensor.measures) {
                let of = |kind: &String| {
                    let text = with_belief(spec, (robot, sensor), items, kind)?;
                    Some((format!("robots.{owner}.sensors.{name}, {kind}"), text))
                };
                derived.extend(spec.items.keys().filter_map(of));
            }
        }
    }
    derived.extend(floor(checked));
    derived
}

/// The lowest risk that clearing a lane can reach.
fn floor(checked: &Checked) -> Option<(String, String)> {
    let mut kinds = checked.spec.controllers.iter();
    let (name, _) = kinds.find(|(_, kind)| kind.clearance.is_some())?;
    let clearance = checked.scenario.clearance()?;
    let expected: f64 = clearance.hazards().map(|(_, expected)| expected).sum();
    let floor_of = |clearance: &Clearance| {
        let reach = reach_of(clearance, checked).map_or(0.0, |reach| reach.floor);
        reach.max(clearance.floor())
    };
    let floor = floor_of(clearance);
    let truth = in_truth(clearance, &checked.spec);
    let truth = truth.map(|truth| floor_of(&truth));
    let truth = truth.filter(|truth| percent(*truth) != percent(floor));
    let believed = truth.map_or(String::new(), |_| {
        format!(
            "; controllers believe that it never falls below {}",
            percent(floor)
        )
    });
    let floor = truth.unwrap_or(floor);
    let reach = lane_reach(checked);
    let unseen = reach.map_or(0.0, |reach| reach.unseen);
    let unseen = (unseen > 0.0).then(|| {
        format!(
            "{} of the lane is out of reach of every robot; ",
            percent(unseen)
        )
    });
    let text = format!(
        "{expected} expected mines; {}the risk never falls below {}, however often all sensors look{believed}",
        unseen.unwrap_or_default(),
        percent(floor)
    );
    Some((format!("controllers.{name}.clearance"), text))
}

/// What the sensor detects, and what it is believed to detect if that differs.
fn with_belief(
    spec: &ScenarioSpec,
    robot: (&RobotSpec, &SensorSpec),
    items: &ItemsSpec,
    kind: &str,
) -> Option<String> {
    let truth = for_kind(spec, robot, items, kind);
    let believed = for_kind(spec, robot, &items.as_believed(spec.items.keys()), kind);
    if truth == believed {
        return truth;
    }
    let [truth, believed] =
        [truth, believed].map(|text| text.unwrap_or_else(|| "detects none".to_owned()));
    Some(format!("{truth}. Believed: {believed}"))
}

/// `None` if the sensor never detects that kind, or there is nothing to state.
fn for_kind(
    spec: &ScenarioSpec,
    (robot, sensor): (&RobotSpec, &SensorSpec),
    items: &ItemsSpec,
    kind: &str,
) -> Option<String> {
    let always = Detection::Constant(1.0);
    let detection = match &items.detection_probability {
        None => &always,
        Some(kinds) => kinds.get(kind)?,
    };
    let blind = items.blind_share.get(kind).copied().unwrap_or(0.0);
    let path = Path::new(robot, sensor, spec.clock.step_s);
    let is_moving = path.speed_m_s > 0.0 && items.sector.range_m > 0.0;
    let pass = is_moving.then(|| of_pass(&Pass::new(items, detection, path), path, blind));
    let ceiling =
        (blind > 0.0).then(|| format!("at most {} however often it passes", percent(1.0 - blind)));
    let alike = items.lookalike_share.get(kind).into_iter().flatten();
    let alike = alike.filter(|(_, share)| **share > 0.0);
    let alike = alike.map(|(other, share)| {
        let share = percent(*share);
        format!("{share} look like {other} however often it passes")
    });
    let parts = pass.into_iter().chain(ceiling).chain(alike);
    let parts: Vec<String> = parts.collect();
    (!parts.is_empty()).then(|| parts.join("; "))
}

fn of_pass(pass: &Pass, path: Path, blind: f64) -> String {
    let [on_path, in_swath] =
        [pass.on_path, pass.in_swath].map(|share| percent((1.0 - blind) * share));
    format!(
        "a pass at {} m/s, with a measurement every {} m, detects {on_path} on its path and {in_swath} in its swath of \
         {:.3} m",
        path.speed_m_s,
        rounded(path.speed_m_s * path.period_s),
        pass.swath_m
    )
}

/// A distance with three significant digits at most.
fn rounded(length_m: f64) -> f64 {
    let text = format!("{length_m:.2e}");
    text.parse().unwrap_or(length_m)
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::document::Document;

    fn lines(drive: &str, eye: &str) -> Vec<(String, String)> {
        let text = format!(
            "clock = {{ step_s = 0.1, time_limit_s = 9 }}\nworld = {{ size_m = [40, 40] }}\n\
             [items.clutter]\ncount = 1\ntarget = false\n[items.mine]\ncount = 1\n\
             [robots.rover]\ncount = 1\nradius_m = 0.2\n\
             drive = {{ max_speed_m_s = {drive}, max_turn_rate_deg_s = 90 }}\n\
             [robots.rover.sensors.eye]\nkind = \"items\"\n{eye}\n"
        );
        let document = Document::parse("t", &text).unwrap();
        let read = ScenarioSpec::read(&document);
        derived(&read.unwrap_or_else(|errors| panic!("{errors}")))
    }

    const MINE: &str = "robots.rover.sensors.eye, mine";

    #[test]
    fn a_pass_is_stated_for_each_kind_that_a_sensor_detects() {
        // 20 looks, each of which misses 90%; the mean over the swath is lower.
        let eye = "range_m = 1\ndetection_probability = { mine = 0.1 }";
        let text = "a pass at 1 m/s, with a measurement every 0.1 m, detects 87.8% on its path and 78.3% in its swath of \
                    2.000 m";
        assert_eq!(lines("1", eye), [(MINE.to_owned(), text.to_owned())]);
        assert_eq!(lines("1", "range_m = 1").len(), 2);
    }

    #[test]
    fn a_blind_share_lowers_a_pass_and_limits_all_passes() {
        let eye =
            "range_m = 1\ndetection_probability = { mine = 0.1 }\nblind_share = { mine = 0.25 }";
        let text = "a pass at 1 m/s, with a measurement every 0.1 m, detects 65.9% on its path and 58.7% in its swath of \
                    2.000 m; at most 75.0% however often it passes";
        assert_eq!(lines("1", eye)[0].1, text);
    }

    #[test]
    fn what_a_sensor_is_believed_to_detect_is_stated_beside_the_truth() {
        let eye = "range_m = 1\ndetection_probability = { mine = 0.1 }\nblind_share = { mine = 0.25 }\n\
                   believed = { detection_probability = { clutter = 0.1 }, blind_share = { mine = 0.1 } }";
        let texts: Vec<String> = lines("1", eye).into_iter().map(|(_, text)| text).collect();
        assert!(
            texts[0].starts_with("detects none. Believed: a pass at 1 m/s"),
            "{texts:?}"
        );
        let [truth, believed] = [0, 1].map(|part| texts[1].split(". Believed: ").nth(part));
        assert!(
            truth
                .unwrap()
                .ends_with("at most 75.0% however often it passes")
        );
        assert!(
            believed
                .unwrap()
                .ends_with("at most 90.0% however often it passes")
        );
    }

    #[test]
    fn the_share_that_looks_like_another_kind_is_stated() {
        let eye = "range_m = 1\nlookalike_share = { mine = { clutter = 0.2 } }";
        let text = &lines("1", eye)[1].1;
        assert!(
            text.ends_with("; 20.0% look like clutter however often it passes"),
            "{text}"
        );
    }

    #[test]
    fn a_robot_that_does_not_drive_passes_nothing() {
        let eye = "range_m = 1\ndetection_probability = { mine = 0.1 }";
        assert!(lines("0", eye).is_empty());
        let blind = format!("{eye}\nblind_share = {{ mine = 0.05 }}");
        assert_eq!(
            lines("0", &blind)[0].1,
            "at most 95.0% however often it passes"
        );
    }

    #[test]
    fn only_what_is_certain_is_0_or_100_percent() {
        let shares = [0.0, 1e-9, 0.123, 0.9999, 1.0].map(percent);
        assert_eq!(
            shares,
            [
                "0.0%",
                "less than 0.1%",
                "12.3%",
                "more than 99.9%",
                "100.0%"
            ]
        );
    }
}
