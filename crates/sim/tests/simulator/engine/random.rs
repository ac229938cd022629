//! Random small scenarios that cover every key of a scenario.

use crate::common::Random;

/// The document of a scenario, which may contain errors.
pub(crate) fn text(seed: u64) -> String {
    let random = &mut Random::new(seed);
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
    }
    for name in ["alpha", "beta", "gamma"]
        .iter()
        .take(1 + random.below(3) as usize)
    {
        text += &robot(random, name, &items, step_s, (wide, high));
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
    match random.below(2) {
        0 => format!(
            "[[{x}, {y}], [{}, {y}], [{}, {}], [{x}, {}]]",
            x + w,
            x + w,
            y + h,
            y + h
        ),
        _ => format!(
            "[[{x}, {y}], [{}, {}], [{x}, {}]]",
            x + w,
            y + h / 3.0,
            y + h
        ),
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
            let [x, y] = [
                random.between(0.0, wide / 2.0),
                random.between(0.0, high / 2.0),
            ];
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
    let like = random.one_of(&[
        "",
        "",
        "",
        "model = \"tracked\"",
        "model = \"ugv\"",
        "model = \"quadrotor\"",
    ]);
    let layer = random.one_of(&["ground", "ground", "air"]);
    let radius_m = random.one_of(&[0.0, 0.1, 0.3, 0.8]);
    let most = wide.min(high) / step_s;
    let speed = random.one_of(&[0.0, 1.0, 2.0, 20.0_f64, 100.0]).min(most);
    let back = random.one_of(&[0.0, 0.5, 3.0_f64]).min(most);
    let turn = random.one_of(&[0.0, 90.0, 720.0_f64]).min(179.0 / step_s);
    let acceleration = random.one_of(&[
        "",
        "max_acceleration_m_s2 = 0.5, ",
        "max_acceleration_m_s2 = 40, ",
    ]);
    let mut text = format!(
        "[robots.{name}]\n{like}\ncount = {}\nlayer = \"{layer}\"\nradius_m = {radius_m}\nprice = 2.5\n\
         payload_kg = 3\nstart = {}\n\
         drive = {{ max_speed_m_s = {speed}, max_reverse_speed_m_s = {back}, {acceleration}max_turn_rate_deg_s = {turn} }}\n",
        random.below(6),
        placement(random, wide, high),
    );
    let stop_duration_s = random.one_of(&[0.0, 0.3, 2.0]);
    let breaks = random.one_of(&["", ", max_collisions = 1", ", max_collisions = 5"]);
    text += &format!("collision = {{ stop_duration_s = {stop_duration_s}{breaks} }}\n");
    if random.below(2) == 0 {
        let capacity = random.one_of(&[
            "",
            "capacity_j = 0.5, ",
            "capacity_j = 50, ",
            "capacity_j = 1e5, ",
        ]);
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
        text += &sensor(
            random,
            &format!("[robots.{name}.sensors.s{number}]\n"),
            items,
            step_s,
        );
    }
    text
}

fn sensor(random: &mut Random, head: &str, items: &[&str], step_s: f64) -> String {
    let mut text = head.to_owned();
    let line = |text: &mut String, key: &str, value: f64| *text += &format!("{key} = {value}\n");
    line(
        &mut text,
        "latency_s",
        random.one_of(&[0.0, 0.0, 0.03, 0.5]),
    );
    line(
        &mut text,
        "dropout_probability",
        random.one_of(&[0.0, 0.3, 1.0]),
    );
    line(&mut text, "power_w", 0.5);
    if random.below(2) == 0 {
        line(
            &mut text,
            "rate_hz",
            random.one_of(&[0.11, 0.5, 1.0]) / step_s,
        );
    }
    let kind = random.one_of(&["range", "items", "robots", "position", "heading"]);
    text += &format!("kind = \"{kind}\"\n");
    if matches!(kind, "position" | "heading") {
        let key = if kind == "position" {
            "noise_m"
        } else {
            "noise_deg"
        };
        line(&mut text, key, random.one_of(&[0.0, 3.0]));
        return text;
    }
    line(&mut text, "range_m", random.one_of(&[0.5, 3.0, 50.0]));
    line(
        &mut text,
        "fov_deg",
        random.one_of(&[0.0, 60.0, 270.0, 360.0]),
    );
    line(&mut text, "facing_deg", random.one_of(&[0.0, -180.0, 77.0]));
    line(&mut text, "noise_m", random.one_of(&[0.0, 0.2]));
    if kind == "range" {
        text += &format!("rays = {}\n", 1 + random.below(30));
        line(&mut text, "relative_noise", random.one_of(&[0.0, 0.1]));
        line(
            &mut text,
            "miss_probability",
            random.one_of(&[0.0, 0.1, 1.0]),
        );
        line(
            &mut text,
            "spurious_return_probability",
            random.one_of(&[0.0, 0.1, 1.0]),
        );
        return text;
    }
    text += &format!("needs_line_of_sight = {}\n", random.below(2) == 0);
    let detection = |random: &mut Random| {
        random.one_of(&[
            "0.5",
            "1",
            "[[0, 1], [2, 0.2]]",
            "{ peak = 0.9, half_range_m = 1 }",
        ])
    };
    if kind == "robots" {
        text += &format!("detection_probability = {}\n", detection(random));
    } else if let Some(item) = items.last() {
        text += &format!(
            "false_alarm_rate_per_m2_s = {{ {item} = {} }}\n",
            random.one_of(&[0.0, 0.02, 1.0])
        );
        if random.below(2) == 0 {
            let all: Vec<String> = items
                .iter()
                .map(|item| format!("{item} = {}", detection(random)))
                .collect();
            text += &format!("detection_probability = {{ {} }}\n", all.join(", "));
        }
    }
    text
}
