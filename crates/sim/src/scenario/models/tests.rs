use crate::bodies::RobotSpec;
use crate::scenario::ScenarioSpec;
use base::document::{Document, Value};
use base::error::InputErrors;

const REST: &str = "[clock]\ntime_limit_s = 9\n[world]\nsize_m = [9, 9]\n";

fn document(text: &str) -> Document {
    Document::parse("t", &format!("{REST}{text}")).unwrap()
}

fn robots(text: &str) -> Vec<RobotSpec> {
    let checked = ScenarioSpec::read(&document(text)).unwrap_or_else(|errors| panic!("{errors}"));
    checked.spec.robots.into_values().collect()
}

fn lines(errors: &InputErrors) -> Vec<String> {
    errors.0.iter().map(ToString::to_string).collect()
}

fn errors(text: &str) -> Vec<String> {
    lines(&ScenarioSpec::read(&document(text)).unwrap_err())
}

/// The errors with values set by options.
fn errors_with(text: &str, values: &[(&str, Value)]) -> Vec<String> {
    let mut document = document(text);
    for (path, value) in values {
        let keys: Vec<&str> = path.split('.').collect();
        document.set(&keys, value.clone(), &format!("--set {path}"));
    }
    ScenarioSpec::read(&document).map_or_else(|errors| lines(&errors), |_| Vec::new())
}

/// A model, and two kinds that are based on it.
const CART: &str = r#"[models.cart]
radius_m = 0.4
price = 9000
drive = { max_speed_m_s = 1.5, max_turn_rate_deg_s = 90 }
sensors.sonar = { kind = "range", rays = 8, range_m = 3 }
brain = { behaviours = [{ kind = "cruise" }] }
[robots.a]
model = "cart"
count = 2
[robots.b]
model = "cart"
count = 3
price = 8000
drive = { max_speed_m_s = 1 }
"#;

#[test]
fn a_kind_with_a_model_equals_a_kind_with_its_values() {
    let written = CART.split("[robots.a]").next().unwrap();
    let whole = written.replace("[models.cart]", "[robots.a]\ncount = 2");
    let mut expected = robots(&whole).remove(0);
    let found = robots(CART);
    expected.model = found[0].model.clone();
    assert_eq!(found[0], expected);
}

#[test]
fn the_values_of_a_kind_hold_over_those_of_its_model() {
    let [a, b] = &robots(CART)[..] else {
        panic!("two kinds")
    };
    assert_eq!([a.price, b.price], [9000.0, 8000.0]);
    assert_eq!([a.drive.max_speed_m_s, b.drive.max_speed_m_s], [1.5, 1.0]);
    assert_eq!(a.drive.max_turn_rate_deg_s, b.drive.max_turn_rate_deg_s);
    assert_eq!(a.sensors, b.sensors);
}

#[test]
fn a_model_can_be_based_on_another_and_that_on_a_bundled_one() {
    let text = "[models.fast]\nmodel = \"slow\"\nprice = 5\nsensors.camera = { range_m = 4 }\n\
                [models.slow]\nmodel = \"ugv\"\nprice = 4\ndrive = { max_speed_m_s = 1 }\n\
                [robots.r]\nmodel = \"fast\"\ncount = 1\n[robots.u]\nmodel = \"ugv\"\ncount = 1\n";
    let [r, u] = &robots(text)[..] else {
        panic!("two kinds")
    };
    assert_eq!((r.price, r.drive.max_speed_m_s), (5.0, 1.0));
    assert_eq!(r.drive.max_turn_rate_deg_s, u.drive.max_turn_rate_deg_s);
    assert_eq!(r.sensors.len(), u.sensors.len());
    assert_ne!(r.sensors["camera"], u.sensors["camera"]);
}

#[test]
fn a_sensor_of_another_kind_replaces_that_of_the_base_completely() {
    let text = "[models.m]\nmodel = \"ugv\"\nsensors.camera = { kind = \"range\", rays = 3, range_m = 2 }\n\
                [robots.r]\nmodel = \"m\"\ncount = 1\nsensors.camera = { kind = \"items\", range_m = 2 }\n";
    let written = robots(text)[0].sensors["camera"].clone();
    let alone = "[robots.r]\ncount = 1\nradius_m = 0.2\ndrive = { max_speed_m_s = 1 }\n\
                 sensors.camera = { kind = \"items\", range_m = 2 }\n";
    assert_eq!(written, robots(alone)[0].sensors["camera"]);
}

#[test]
fn an_error_in_a_model_is_reported_once_at_its_path() {
    let text = CART
        .replace("radius_m = 0.4", "raduis_m = 0.4\nradius_m = -1")
        .replace("[{ kind = \"cruise\" }]", "[{ kind = \"cruse\" }]");
    let errors = errors(&text);
    assert_eq!(errors.len(), 3, "{errors:?}");
    assert!(
        errors[0].starts_with("t:11: models.cart.brain.behaviours[0].kind = \"cruse\""),
        "{errors:?}"
    );
    assert!(
        errors[1].starts_with("t:7: models.cart.radius_m = -1: must be"),
        "{errors:?}"
    );
    assert!(
        errors[2].starts_with("t:6: models.cart.raduis_m is not a known key"),
        "{errors:?}"
    );
    assert!(!errors[2].contains("count"), "{errors:?}");
}

#[test]
fn an_error_of_what_values_mean_together_is_at_the_model_too() {
    let text = CART.replace("rays = 8", "rays = 8, rate_hz = 11");
    assert_eq!(
        errors(&text),
        ["t:9: models.cart.sensors.sonar.rate_hz = 11: must be at most 10, once per step of 0.1 s"]
    );
}

#[test]
fn the_keys_that_a_model_lacks_are_missing_where_it_is_used() {
    let text = CART
        .replace("max_speed_m_s = 1.5, ", "")
        .replace("kind = \"range\", ", "")
        .replace("radius_m = 0.4\n", "");
    assert_eq!(
        errors(&text),
        [
            "t:7: models.cart.drive.max_speed_m_s is missing: expected a number from 0 to 100 (m/s)",
            "t:8: models.cart.sensors.sonar.kind is missing: expected one of \"range\", \"items\", \"robots\", \
             \"position\", \"heading\"",
            "t:10: robots.a.radius_m is missing: expected a number from 0 to 100 (metres)",
            "t:13: robots.b.radius_m is missing: expected a number from 0 to 100 (metres)",
        ]
    );
    let unused = text.split("[robots.a]").next().unwrap();
    robots(&format!("{unused}[robots.u]\nmodel = \"ugv\"\ncount = 1\n"));
}

#[test]
fn a_model_that_no_kind_uses_is_checked() {
    let text = "[models.m]\nprice = -1\ncount = 3\n[robots.u]\nmodel = \"ugv\"\ncount = 1\n";
    let errors = errors(text);
    assert!(
        errors[0].starts_with("t:7: models.m.count is not a known key"),
        "{errors:?}"
    );
    assert!(
        errors[1].starts_with("t:6: models.m.price = -1"),
        "{errors:?}"
    );
}

#[test]
fn an_unknown_name_is_reported_with_the_nearest() {
    let names = "must be one of \"tracked\", \"ugv\", \"quadrotor\", \"cart\"";
    assert_eq!(
        errors(&CART.replacen("model = \"cart\"", "model = \"crat\"", 1)),
        [format!(
            "t:12: robots.a.model = \"crat\": {names}; did you mean \"cart\"?"
        )]
    );
    assert_eq!(
        errors(&CART.replace("price = 9000", "model = \"ugw\"")),
        [format!(
            "t:7: models.cart.model = \"ugw\": {names}; did you mean \"ugv\"?"
        )]
    );
}

#[test]
fn a_model_is_not_based_on_itself_and_has_a_name_of_its_own() {
    let text = "[models.a]\nmodel = \"b\"\n[models.b]\nmodel = \"a\"\n[models.c]\nmodel = \"a\"\n\
                [models.ugv]\n[robots.r]\nmodel = \"c\"\ncount = 1\n";
    assert_eq!(
        errors(text),
        [
            "t:6: models.a.model = \"b\": must be a model that is not based on this one: a -> b -> a",
            "t:8: models.b.model = \"a\": must be a model that is not based on this one: b -> a -> b",
            "t:11: models.ugv = {...}: must be under another name: this is the name of a bundled model",
        ]
    );
}

#[test]
fn models_are_limited_in_number_and_size() {
    let kind = "[robots.r]\nmodel = \"ugv\"\ncount = 1\n";
    let many: Vec<String> = (0..256)
        .map(|number| format!("[models.m{number}]"))
        .collect();
    let large = format!(
        "[models.m]\nbrain.behaviours = [{}]\n",
        "{ kind = \"cruise\" }, ".repeat(10_001)
    );
    for models in [many.join("\n") + "\n", large] {
        assert_eq!(
            errors(&format!("{models}{kind}"))
                .iter()
                .filter(|error| error.contains("at most 255 models of 10000 values together"))
                .count(),
            1
        );
    }
}

#[test]
fn an_option_sets_values_of_existing_models_only() {
    let set = |path: &str, value| errors_with(CART, &[(path, value)]);
    let none: [&str; 0] = [];
    assert_eq!(set("models.cart.price", Value::Integer(3)), none);
    assert_eq!(
        set("models.cart.drive.max_speed_m_s", Value::Float(0.5)),
        none
    );
    assert_eq!(
        set("models.crat.price", Value::Integer(3)),
        [
            "--set models.crat.price: models.crat.price = 3: must be in an existing entry of models: cart; did you \
             mean models.cart.price?"
        ]
    );
    let used = [
        ("models.new.model", Value::Text("cart".to_owned())),
        ("models.new.price", Value::Integer(3)),
        ("robots.a.model", Value::Text("new".to_owned())),
    ];
    assert_eq!(errors_with(CART, &used), none);
}
