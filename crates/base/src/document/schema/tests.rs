use super::*;
use crate::document::Document;
use schemars::JsonSchema;
use serde::Deserialize;
use std::collections::BTreeMap;

#[derive(Debug, PartialEq, Deserialize, JsonSchema)]
struct Job {
    /// When it ends, in seconds; later is failed.
    #[schemars(range(min = 0.0, max = 100.0))]
    time_limit_s: f64,
    #[serde(default)]
    kind: Kind,
    #[serde(default)]
    shapes: Vec<Shape>,
    #[serde(default)]
    sensors: BTreeMap<String, Sensor>,
    #[schemars(range(min = 1))]
    workers: Option<u32>,
    pair: Option<(u8, String)>,
    chance: Option<Chance>,
}

#[derive(Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
enum Kind {
    #[default]
    Ground,
    /// Up there.
    Air,
}

#[derive(Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(untagged)]
enum Shape {
    Polygon {
        #[schemars(length(min = 3))]
        polygon_m: Vec<[f64; 2]>,
    },
    Circle {
        circle: Circle,
    },
}

#[derive(Debug, PartialEq, Deserialize, JsonSchema)]
struct Circle {
    #[schemars(range(min = 0.0))]
    radius_m: f64,
}

#[derive(Debug, PartialEq, Deserialize, JsonSchema)]
struct Sensor {
    #[serde(default)]
    on: bool,
    #[serde(flatten)]
    measures: Measures,
}

#[derive(Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "snake_case")]
enum Measures {
    Range(Range),
    Heading {},
}

#[derive(Debug, PartialEq, Deserialize, JsonSchema)]
struct Range {
    #[schemars(range(max = 9))]
    rays: u32,
}

#[derive(Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(untagged)]
enum Chance {
    Constant(#[schemars(range(min = 0.0, max = 1.0))] f64),
    Steps(Vec<[f64; 2]>),
    Curve { peak: f64, half_range_m: f64 },
}

fn read(text: &str) -> Result<Job, Vec<String>> {
    let document = Document::parse("t", text).unwrap();
    let job = document.typed(&Schema::of::<Job>());
    job.map_err(|errors| errors.0.iter().map(ToString::to_string).collect())
}

/// The errors of a job that has this besides what it must have.
fn errors(more: &str) -> Vec<String> {
    read(&format!("time_limit_s = 1\n{more}")).unwrap_err()
}

#[test]
fn a_good_document_is_read_whole() {
    let text = r#"
        time_limit_s = 7
        kind = "air"
        shapes = [{ circle = { radius_m = 1 } }, { polygon_m = [[0, 0], [1, 0], [0, 1.5]] }]
        workers = 4
        pair = [1, "a"]
        chance = { peak = 0.5, half_range_m = 2 }
        [sensors.front]
        kind = "range"
        rays = 3
        on = true
        [sensors.north]
        kind = "heading"
    "#;
    let corners = vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.5]];
    let sensor = |on, measures| Sensor { on, measures };
    let job = Job {
        time_limit_s: 7.0,
        kind: Kind::Air,
        shapes: vec![
            Shape::Circle {
                circle: Circle { radius_m: 1.0 },
            },
            Shape::Polygon { polygon_m: corners },
        ],
        sensors: BTreeMap::from([
            (
                "front".to_owned(),
                sensor(true, Measures::Range(Range { rays: 3 })),
            ),
            ("north".to_owned(), sensor(false, Measures::Heading {})),
        ]),
        workers: Some(4),
        pair: Some((1, "a".to_owned())),
        chance: Some(Chance::Curve {
            peak: 0.5,
            half_range_m: 2.0,
        }),
    };
    assert_eq!(read(text), Ok(job));
}

#[test]
fn errors_name_a_range_with_its_unit_and_nan_is_never_in_range() {
    for bad in ["nan", "inf", "-1", "100.5", "\"1\"", "true", "[1]"] {
        let given = if bad == "nan" { "NaN" } else { bad };
        let expected =
            format!("t:1: time_limit_s = {given}: must be a number from 0 to 100 (seconds)");
        assert_eq!(
            read(&format!("time_limit_s = {bad}")).unwrap_err(),
            [expected]
        );
    }
    let given = "shapes = [{ circle = { radius_m = inf } }]";
    let expected = "t:2: shapes[0].circle.radius_m = inf: must be a number of at least 0 (metres)";
    assert_eq!(errors(given), [expected]);
}

#[test]
fn a_whole_number_is_one_that_the_type_can_hold() {
    for bad in ["0", "1.0", "4294967296", "99999999999999999999"] {
        let reported = errors(&format!("workers = {bad}"));
        assert!(
            reported[0].ends_with("must be a whole number from 1 to 4294967295"),
            "{reported:?}"
        );
    }
    assert!(read("time_limit_s = 1\nworkers = 4294967295").is_ok());
}

#[test]
fn a_missing_key_is_reported_at_its_table() {
    assert_eq!(
        read("shapes = [{ circle = {} }]").unwrap_err(),
        [
            "t:1: shapes[0].circle.radius_m is missing: expected a number of at least 0 (metres)",
            "t: time_limit_s is missing: expected a number from 0 to 100 (seconds)",
        ]
    );
}

#[test]
fn a_name_is_one_of_the_known_and_a_slip_is_recognised() {
    assert_eq!(
        errors("kind = \"iar\"\nkidn = 3"),
        [
            "t:3: kidn is not a known key: expected one of time_limit_s, kind, shapes, sensors, \
             workers, pair, chance; did you mean kind?",
            "t:2: kind = \"iar\": must be one of \"ground\", \"air\"; did you mean \"air\"?",
        ]
    );
}

#[test]
fn of_tagged_forms_the_one_that_its_tag_names_is_meant() {
    let reported = errors(
        "[sensors.a]\nkind = \"range\"\nrays = 10\nfov = 3\n[sensors.b]\nkind = \"heding\"\n\
         [sensors.c]\nrays = 1\n[sensors]\nd = 3",
    );
    assert_eq!(
        reported,
        [
            "t:5: sensors.a.fov is not a known key: expected one of kind, rays, on",
            "t:4: sensors.a.rays = 10: must be a whole number from 0 to 9",
            "t:7: sensors.b.kind = \"heding\": must be one of \"range\", \"heading\"; did you mean \
             \"heading\"?",
            "t:8: sensors.c.kind is missing: expected one of \"range\", \"heading\"",
            "t:11: sensors.d = 3: must be a table with kind = \"range\" or \"heading\"",
        ]
    );
}

#[test]
fn of_untagged_forms_the_one_whose_keys_are_there_is_meant() {
    let reported = errors(
        "shapes = [\n{ polygn_m = [] },\n{ circle = 3 },\n{ square = 1 },\n\
         { polygon_m = [[0, 0], [1]] },\n{ circle = { radius_m = 1 }, polygon_m = 2 }]",
    );
    assert_eq!(
        reported,
        [
            "t:3: shapes[0].polygn_m is not a known key: expected one of polygon_m; did you \
             mean polygon_m?",
            "t:3: shapes[0].polygon_m is missing: expected a list of at least 3 lists of 2 numbers (metres)",
            "t:4: shapes[1].circle = 3: must be a table with radius_m",
            "t:5: shapes[2] = {...}: must be a table with polygon_m or a table with circle",
            "t:6: shapes[3].polygon_m = [[0, 0], [1]]: must be a list of at least 3 lists of 2 \
             numbers (metres)",
            "t:6: shapes[3].polygon_m[1] = [1]: must be a list of 2 numbers",
            "t:7: shapes[4].polygon_m is not a known key: expected one of circle",
        ]
    );
}

#[test]
fn of_forms_of_other_types_the_one_of_its_type_is_meant() {
    let reported = |given: &str| errors(&format!("chance = {given}")).join("\n");
    let all =
        "a number from 0 to 1, a list of lists of 2 numbers or a table with peak and half_range_m";
    assert_eq!(
        reported("2"),
        "t:2: chance = 2: must be a number from 0 to 1"
    );
    assert_eq!(
        reported("[3]"),
        "t:2: chance[0] = 3: must be a list of 2 numbers"
    );
    assert_eq!(
        reported("{ peak = 1 }"),
        "t:2: chance.half_range_m is missing: expected a number (metres)"
    );
    assert_eq!(
        reported("{ x = 1 }"),
        format!("t:2: chance = {{...}}: must be {all}")
    );
    assert_eq!(
        reported("\"x\""),
        format!("t:2: chance = \"x\": must be {all}")
    );
}

#[test]
fn only_tables_without_keys_of_their_own_have_names_of_a_persons_choice() {
    let has_names = |path: &[&str]| Schema::of::<Job>().has_names_at(path);
    assert!(has_names(&["sensors"]));
    for path in [
        &[][..],
        &["kind"],
        &["sensors", "eye"],
        &["nothing", "here"],
    ] {
        assert!(!has_names(path), "{path:?}");
    }
}

#[test]
fn each_place_of_a_pair_has_its_own_type() {
    let reported = |given: &str| errors(&format!("pair = {given}")).join("\n");
    assert_eq!(reported("[1, 2]"), "t:2: pair[1] = 2: must be a string");
    assert_eq!(
        reported("[300, \"a\"]"),
        "t:2: pair[0] = 300: must be a whole number from 0 to 255"
    );
    assert_eq!(
        reported("[1]"),
        "t:2: pair = [1]: must be a list of 2 values"
    );
}

#[test]
fn a_long_value_is_abbreviated_in_errors() {
    let long = format!("kind = \"{}\"", "x".repeat(1000));
    let reported = errors(&long).concat();
    assert!(
        reported.len() < 180
            && reported.contains("xxx...xxx")
            && reported.contains("xxx\": must be"),
        "{reported}"
    );
}

#[test]
fn a_type_that_disagrees_with_its_schema_is_reported_with_its_path() {
    #[derive(Debug, Deserialize, JsonSchema)]
    struct Odd {
        #[expect(dead_code, reason = "it is never read")]
        lists: Vec<Inner>,
    }
    #[derive(Debug, Deserialize, JsonSchema)]
    struct Inner {
        #[schemars(with = "String")]
        #[expect(dead_code, reason = "it is never read")]
        number: u8,
    }
    let document = Document::parse("t", "lists = [\n{ number = \"1\" }]").unwrap();
    let reported = document.typed::<Odd>(&Schema::of::<Odd>()).unwrap_err();
    let reported = reported.to_string();
    assert!(
        reported.starts_with("t:2: lists[0].number = \"1\": must be readable: invalid"),
        "{reported}"
    );
}

#[test]
fn a_name_may_be_one_of_a_table_of_the_document() {
    let schema = schemars::json_schema!({
        "type": "object",
        "properties": {
            "tool": { "anyOf": [{ "enum": ["saw", "drill"] }, { "type": "string" }], "x-names": "tools" },
            "tools": { "type": "object", "additionalProperties": { "type": "number" } },
        },
    });
    let schema = Schema::closed(schema);
    let errors = |text: &str| {
        let document = Document::parse("t", text).unwrap();
        let errors = schema.errors(&document).into_iter();
        errors.map(|error| error.to_string()).collect::<Vec<_>>()
    };
    let none: [&str; 0] = [];
    for tool in ["saw", "lathe"] {
        assert_eq!(errors(&format!("tool = {tool:?}\ntools.lathe = 3")), none);
    }
    assert_eq!(
        errors("tool = \"lahte\"\ntools.lathe = 3"),
        [
            "t:1: tool = \"lahte\": must be one of \"saw\", \"drill\", \"lathe\"; did you mean \"lathe\"?"
        ]
    );
    assert!(errors("tool = 3\ntools = 4")[0].ends_with("must be one of \"saw\", \"drill\""));
    let part = &schema.json()["properties"]["tool"];
    assert_eq!(
        schema.expected(part),
        "one of \"saw\", \"drill\", or a name in `tools`"
    );
}
