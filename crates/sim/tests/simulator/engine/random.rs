//! Random small scenarios that cover every key of a scenario.

use crate::common::Random;

/// The document of a scenario, which may contain errors.
pub(crate) fn text(seed: u64) -> String {
    let random = &mut Random::new(seed);
    // Of its own, so that acts change nothing else in a scenario.
    let acts = &mut Random::new(!seed);
    let step_s = random.one_of(&[0.02, 0.1, 0.1, 0.25, 1.0]);
    let time_limit_s = f64::from(random.below(200)) * step_s * random.one_of(&[1.0, 0.99]);
    let [wide, high] = [random.between(4.0, 30.0), random.between(4.0, 30.0)];
    let mut text = format!(
        "[clock]\nstep_s = {step_s}\ntime_limit_s = {time_limit_s}\n[world]\nsize_m = [{wide}, {high}]\nobstacles = [{}]\n",
        list(random.below(4), || obstacle(random, wide, high))
    );
    for name in ["grass", "swamp"].iter().take(random.below(3) as usize) {
        let areas = list(1 + random.below(2), || polygon(random, wide, high));
        let [speed, energy] = [0, 1].map(|_| random.one_of(&[0.0, 0.3, 1.0, 4.0]));
        text +=
            &format!("[terrain.{name}]\nspeed = {speed}\nenergy = {energy}\nareas_m = [{areas}]\n");
    }
    let items: Vec<&str> = ["cow", "flag", "mine"][..random.below(4) as usize].to_vec();
    for name in &items {
        let (count, is_target) = (random.below(6), random.below(3) > 0);
        let placement = placement(random, wide, high);
        text += &format!(
            "[items.{name}]\ncount = {count}\ntarget = {is_target}\nplacement = {placement}\n"
        );
        text += &item_acts(acts);
    }
    for name in ["alpha", "beta", "gamma"]
        .iter()
        .take(1 + random.below(3) as usize)
    {
        text += &robot(random, name, &items, step_s, (wide, high));
        text += &tools(acts, name);
    }
    text
}

/// What completes an item, and its hazard.
fn item_acts(random: &mut Random) -> String {
    let completed_by = random.one_of(&["", "", "", "", "detected", "confirmed", "neutralised"]);
    let mut text = match completed_by {
        "" => String::new(),
        act => format!("completed_by = \"{act}\"\n"),
    };
    if random.below(2) == 0 {
        let radius_m = random.one_of(&[0.0, 0.3, 2.0, 1000.0]);
        let probability = random.one_of(&[0.0, 0.5, 1.0]);
        let detonates = random.below(2) == 0;
        text += &format!(
            "hazard = {{ radius_m = {radius_m}, destroy_probability = {probability}, detonates = {detonates} }}\n"
        );
    }
    text
}

/// Any of the tools; all for the robots that each scenario has, as items may need one to be completed.
fn tools(random: &mut Random, robot: &str) -> String {
    let mut text = String::new();
    for tool in ["mark", "confirm", "isolate", "neutralise"] {
        if random.below(2) == 0 && robot != "alpha" {
            continue;
        }
        text += &format!("[robots.{robot}.tools.{tool}]\n");
        text += &one_of(random, "range_m", &[0.0, 1.0, 5.0, 10_000.0]);
        if ["isolate", "neutralise"].contains(&tool) {
            text += &one_of(random, "reach_m", &[0.0, 0.5, 1000.0]);
            text += &one_of(random, "duration_s", &[0.0, 0.03, 2.0, 1e6]);
        }
        if tool == "neutralise" {
            text += &one_of(random, "success_probability", &[0.0, 0.5, 1.0]);
            text += &format!("charges = {}\n", 1 + random.below(3));
        }
    }
    text
}

fn list(count: u32, mut entry: impl FnMut() -> String) -> String {
    let entries: Vec<String> = (0..count).map(|_| entry()).collect();
    entries.join(", ")
}

fn polygon(random: &mut Random, wide: f64, high: f64) -> String {
    let [x, y] = [random.between(-1.0, wide), random.between(-1.0, high)];
    let [w, h] = [random.between(0.01, 5.0), random.between(0.01, 5.0)];
    let [right, top, third] = [x + w, y + h, y + h / 3.0];
    match random.below(2) {
        0 => format!("[[{x}, {y}], [{right}, {y}], [{right}, {top}], [{x}, {top}]]"),
        _ => format!("[[{x}, {y}], [{right}, {third}], [{x}, {top}]]"),
    }
}

fn obstacle(random: &mut Random, wide: f64, high: f64) -> String {
    if random.below(2) == 0 {
        return format!("{{ polygon_m = {} }}", polygon(random, wide, high));
    }
    let [x, y] = [random.between(0.0, wide), random.between(0.0, high)];
    let radius_m = random.between(0.01, 2.0);
    format!("{{ circle = {{ at_m = [{x}, {y}], radius_m = {radius_m} }} }}")
}

fn placement(random: &mut Random, wide: f64, high: f64) -> String {
    match random.below(4) {
        0 => "{ kind = \"clustered\", clusters = 2, spread_m = 1.5 }".to_owned(),
        1 => {
            let [x, y] = [wide, high].map(|side| random.between(0.0, side / 2.0));
            format!("{{ kind = \"uniform\", within_m = [[{x}, {y}], [{wide}, {high}]] }}")
        }
        _ => "{ kind = \"uniform\" }".to_owned(),
    }
}

fn robot(
    random: &mut Random,
    name: &str,
    items: &[&str],
    step_s: f64,
    (wide, high): (f64, f64),
) -> String {
    let model = match random.one_of(&["", "", "", "tracked", "ugv", "quadrotor"]) {
        "" => String::new(),
        model => format!("model = \"{model}\""),
    };
    let layer = random.one_of(&["ground", "ground", "air"]);
    let radius_m = random.one_of(&[0.0, 0.1, 0.3, 0.8]);
    let most = wide.min(high) / step_s;
    let speed = random.one_of(&[0.0, 1.0, 2.0, 20.0_f64, 100.0]).min(most);
    let back = random.one_of(&[0.0, 0.5, 3.0_f64]).min(most);
    let turn = random.one_of(&[0.0, 90.0, 720.0_f64]).min(179.0 / step_s);
    let acceleration = match random.one_of(&["", "0.5", "40"]) {
        "" => String::new(),
        limit => format!("max_acceleration_m_s2 = {limit}, "),
    };
    let mut text = format!(
        "[robots.{name}]\n{model}\ncount = {}\nlayer = \"{layer}\"\nradius_m = {radius_m}\nprice = 2.5\n\
         payload_kg = 3\nstart = {}\n\
         drive = {{ max_speed_m_s = {speed}, max_reverse_speed_m_s = {back}, {acceleration}max_turn_rate_deg_s = {turn} }}\n",
        random.below(6),
        placement(random, wide, high),
    );
    let stop_duration_s = random.one_of(&[0.0, 0.3, 2.0]);
    let breaks = random.one_of(&["", ", max_collisions = 1", ", max_collisions = 5"]);
    text += &format!("collision = {{ stop_duration_s = {stop_duration_s}{breaks} }}\n");
    if random.below(2) == 0 {
        let capacity = match random.one_of(&["", "0.5", "50", "1e5"]) {
            "" => String::new(),
            capacity => format!("capacity_j = {capacity}, "),
        };
        text += &format!("battery = {{ {capacity}idle_w = 5, move_w = 3, move_j_per_m = 20 }}\n");
    }
    if random.below(2) == 0 {
        let [loss, delay_s] = [random.one_of(&[0.0, 0.4]), random.one_of(&[0.0, 0.1, 0.7])];
        let needs = random.below(2) == 0;
        text += &format!(
            "radio = {{ range_m = 8, loss_probability = {loss}, delay_s = {delay_s}, power_w = 1, messages_per_step = {}, \
             needs_line_of_sight = {needs} }}\n",
            random.below(4)
        );
    }
    let rate = if random.below(2) == 0 {
        String::new()
    } else {
        format!("rate_hz = {}, ", 0.3 / step_s)
    };
    let behaviours = random.one_of(&[
        "",
        "behaviours = []",
        "behaviours = [{ kind = \"cruise\" }]",
        "behaviours = [{ kind = \"cruise\" }, { kind = \"random_bounce\" }]",
    ]);
    let limited = random.below(2) == 0;
    let comma = if behaviours.is_empty() { "" } else { ", " };
    text += &format!(
        "brain = {{ {rate}limit_speed_to_stopping_distance = {limited}{comma}{behaviours} }}\n"
    );
    for number in 0..random.below(5) {
        let head = format!("[robots.{name}.sensors.s{number}]\n");
        text += &sensor(random, &head, items, step_s);
    }
    text
}

/// A line with one of some values for a key.
fn one_of(random: &mut Random, key: &str, values: &[f64]) -> String {
    format!("{key} = {}\n", random.one_of(values))
}

fn sensor(random: &mut Random, head: &str, items: &[&str], step_s: f64) -> String {
    let mut text = head.to_owned();
    text += &one_of(random, "latency_s", &[0.0, 0.0, 0.03, 0.5]);
    text += &one_of(random, "dropout_probability", &[0.0, 0.3, 1.0]);
    text += "power_w = 0.5\n";
    if random.below(2) == 0 {
        text += &one_of(
            random,
            "rate_hz",
            &[0.11, 0.5, 1.0].map(|rate| rate / step_s),
        );
    }
    let kind = random.one_of(&["range", "items", "robots", "position", "heading"]);
    text += &format!("kind = \"{kind}\"\n");
    match kind {
        "position" => return text + &one_of(random, "noise_m", &[0.0, 3.0]),
        "heading" => return text + &one_of(random, "noise_deg", &[0.0, 3.0]),
        _ => {}
    }
    text += &one_of(random, "range_m", &[0.5, 3.0, 50.0]);
    text += &one_of(random, "fov_deg", &[0.0, 60.0, 270.0, 360.0]);
    text += &one_of(random, "facing_deg", &[0.0, -180.0, 77.0]);
    text += &one_of(random, "noise_m", &[0.0, 0.2]);
    if kind == "range" {
        text += &format!("rays = {}\n", 1 + random.below(30));
        text += &one_of(random, "relative_noise", &[0.0, 0.1]);
        text += &one_of(random, "miss_probability", &[0.0, 0.1, 1.0]);
        return text + &one_of(random, "spurious_return_probability", &[0.0, 0.1, 1.0]);
    }
    text += &format!("needs_line_of_sight = {}\n", random.below(2) == 0);
    let table = "[[0, 1], [2, 0.2]]";
    let curve = "{ peak = 0.9, half_range_m = 1 }";
    let detection = |random: &mut Random| random.one_of(&["0.5", "1", table, curve]);
    if kind == "robots" {
        text += &format!("detection_probability = {}\n", detection(random));
    } else if let Some(item) = items.last() {
        let rate = random.one_of(&[0.0, 0.02, 1.0]);
        text += &format!("false_alarm_rate_per_m2_s = {{ {item} = {rate} }}\n");
        if random.below(2) == 0 {
            let each = |item: &&str| format!("{item} = {}", detection(random));
            let all: Vec<String> = items.iter().map(each).collect();
            text += &format!("detection_probability = {{ {} }}\n", all.join(", "));
        }
    }
    text
}
