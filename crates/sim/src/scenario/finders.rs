//! Which robots have to come near items and goals, and where they can move.

use super::checked::Checked;
use super::spec::ScenarioSpec;
use crate::bodies::{Layer, RobotSpec};
use crate::goals::GoalSpec;
use crate::sensors::items::ItemsSpec;
use crate::sensors::sensor_kind::AmongKinds;
use crate::world::obstacles::Solid;
use base::geometry::Rectangle;
use base::placement::Placement;
use base::reachability::{self, Reachability};

/// A kind of robots that detects an item, or serves a goal, at this distance.
pub(crate) struct Finder<'s> {
    pub(crate) robot: &'s RobotSpec,
    pub(crate) range_m: f64,
    /// The distance at which obstacles in between do not matter.
    pub(crate) through_m: f64,
}

/// The kinds of robots with a sensor for a kind of item: one that detects it, or is believed to.
pub(crate) fn finders<'s>(spec: &'s ScenarioSpec, item: &str) -> Vec<Finder<'s>> {
    let finder = |robot: &'s RobotSpec| {
        let mut range_m = None;
        let mut through_m = 0.0_f64;
        for sensor in robot.sensors.values() {
            let Some(items) = ItemsSpec::of(&sensor.measures) else {
                continue;
            };
            let believed = items.as_believed(spec.items.keys());
            let kinds = believed.detection_probability.as_ref();
            if kinds.is_none_or(|kinds| kinds.contains_key(item)) {
                let reach_m = items.sector.range_m;
                range_m = Some(reach_m.max(range_m.unwrap_or(0.0)));
                if !items.needs_line_of_sight {
                    through_m = through_m.max(reach_m);
                }
            }
        }
        Some(Finder {
            robot,
            range_m: range_m?,
            through_m,
        })
    };
    spec.robots.values().filter_map(finder).collect()
}

/// The kinds of robots that can serve a kind of goal.
pub(crate) fn servers<'s>(spec: &'s ScenarioSpec, kind: &GoalSpec) -> Vec<Finder<'s>> {
    let robots = spec.robots.values().filter(|robot| can_serve(robot, kind));
    let server = |robot| Finder {
        robot,
        range_m: kind.within_m,
        through_m: kind.within_m,
    };
    robots.map(server).collect()
}

/// Whether robots of a kind can be awarded such goals, and report that they served them.
pub(super) fn can_serve(robot: &RobotSpec, kind: &GoalSpec) -> bool {
    let mut required = kind.requires.iter();
    robot.radio.is_some() && required.all(|name| robot.capabilities.contains(name))
}

/// Where robots of a kind may move; a kind counts whatever its number of robots.
pub(crate) fn reach(checked: &Checked, robot: &RobotSpec) -> Reachability {
    let world = checked.scenario.world();
    let starts: Vec<Rectangle> = match &robot.start {
        Placement::Fixed { at_m, .. } => at_m
            .iter()
            .map(|place| Rectangle::spanned(*place, *place))
            .collect(),
        Placement::Uniform { within_m } | Placement::Clustered { within_m, .. } => {
            vec![within_m.unwrap_or(world)]
        }
    };
    around(checked, robot.radius_m, robot.layer, &starts)
}

/// Where a body of a layer may move from its `starts`.
pub(crate) fn around(
    checked: &Checked,
    radius_m: f64,
    layer: Layer,
    starts: &[Rectangle],
) -> Reachability {
    let solids = match layer {
        Layer::Ground => checked.scenario.solids(),
        Layer::Air => &[],
    };
    let solids = solids.iter().flat_map(parts);
    Reachability::new(checked.scenario.world(), radius_m, solids, starts)
}

fn parts(solid: &Solid) -> Vec<reachability::Solid> {
    match solid {
        Solid::Polygon(polygon) => polygon.edges().map(reachability::Solid::Wall).collect(),
        Solid::Disc(disc) => vec![reachability::Solid::Pillar(*disc)],
        Solid::Map(map) => map
            .outline()
            .iter()
            .copied()
            .map(reachability::Solid::Wall)
            .collect(),
    }
}
