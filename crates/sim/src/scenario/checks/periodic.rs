//! Checks that a periodic world is large enough for what robots detect and touch.

use crate::scenario::checked::Checked;
use base::document::Place;
use base::error::InputError;

/// Of all images of a thing only the nearest is ever in range. A radio may reach farther: only the
/// nearest image receives.
pub(super) fn errors(checked: &Checked, at: &Place) -> Vec<InputError> {
    let (spec, scenario) = (&checked.spec, &checked.scenario);
    let Some(torus) = scenario.torus else {
        return Vec::new();
    };
    let half_size_m = torus.size_m.x.min(torus.size_m.y) / 2.0;
    let max_m = half_size_m - scenario.skin_m - scenario.max_radius_m();
    let mut errors = Vec::new();
    let min_m = 2.0 * (scenario.contact_m + scenario.skin_m);
    if 2.0 * half_size_m < min_m {
        let allowed =
            format!("at least {min_m:.3} each way for these robots, because the world is periodic");
        errors.push(at.key("world").key("size_m").error(allowed));
    }
    for (name, robot) in &spec.robots {
        let at = at.key("robots").key(name);
        let sensors = robot.sensors.iter().filter_map(|(name, sensor)| {
            let at = at.key("sensors").key(name).key("range_m");
            Some((sensor.measures.range_m()?, at))
        });
        let too_far = sensors.filter(|(range_m, _)| *range_m > max_m);
        errors.extend(too_far.map(|(_, at)| at.error(allowed(max_m))));
    }
    errors
}

fn allowed(max_m: f64) -> String {
    if max_m > 0.0 {
        format!("at most {max_m:.3}, somewhat less than half of a periodic world")
    } else {
        "none: the world is periodic and too small".to_owned()
    }
}
