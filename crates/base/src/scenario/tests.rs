use super::*;
use crate::engine::{BlockOptions, Bounds, Column, ColumnKind, NamedMerit, Runner};
use crate::error::InputError;
use condition::ConditionColumns;
use std::ops::Range;

const EXAMPLE: &str = r#"
engine = "shop"
summary = "A test."
merit = "equation-5.2"
[robots.rover]
count = 2
[study]
delta = 0.05
vary = { "robots.rover.count" = "1..3" }
"#;

/// An engine of robots that wait; everything of a robot but its count may be left out.
struct Shop;

struct Waiting;

impl Runner for Waiting {
    fn columns(&self) -> Vec<Column> {
        let column = |name: &str| Column {
            name: name.to_owned().into(),
            kind: ColumnKind::Real,
            bounds: Bounds::up_to(1.0),
        };
        ["time_s", "failed", "robots"].map(column).into()
    }

    fn run_block(&self, _: u64, runs: Range<u64>, _: BlockOptions) -> Vec<Vec<f64>> {
        vec![runs.map(|_| 0.0).collect(); 3]
    }
}

fn robot(section: &Section) -> Option<u32> {
    section.only(&["count", "loud", "mode", "speed"]);
    let count = section.integer("count", 1..=9);
    if section.has("speed") {
        section.number("speed", 0.0..=2.0)?;
    }
    if section.has("loud") && !matches!(section.value("loud"), Some(Value::Bool(_))) {
        section.error("loud", "true or false");
    }
    if section.has("mode") {
        section.choice("mode", &[("sweep", ()), ("spiral", ())])?;
    }
    count.and_then(|count| u32::try_from(count).ok())
}

impl Engine for Shop {
    fn name(&self) -> &'static str {
        "shop"
    }

    fn keys(&self) -> &'static [&'static str] {
        &["robots"]
    }

    fn read(&self, document: &Document) -> Result<Configuration, InputErrors> {
        let robots = document.read(|root| {
            let robots = root.section("robots");
            let kinds = robots.keys();
            kinds
                .map(|kind| Some((kind.to_owned(), robot(&robots.section(kind))?)))
                .collect::<Option<Vec<_>>>()
        })?;
        Ok(Configuration {
            runner: Box::new(Waiting),
            robots,
            time_limit_s: 1.0,
            facts: Vec::new(),
        })
    }

    fn merit_terms(&self, _: &Document) -> Vec<MeritTerm> {
        vec![
            MeritTerm::new("time", "time_s"),
            MeritTerm::new("robots", "robots"),
        ]
    }

    fn condition_columns(&self, _: &Document) -> ConditionColumns {
        ConditionColumns {
            names: ["time_s", "failed", "robots"].map(str::to_owned).into(),
            times: Vec::new(),
            unseen: Vec::new(),
        }
    }

    fn merits(&self) -> &'static [NamedMerit] {
        &[NamedMerit::EQUATION_5_2]
    }

    fn factors(&self) -> Option<&'static [&'static str]> {
        None
    }

    fn names(&self, document: &Document, path: &[&str]) -> Option<Vec<String>> {
        match &document.get(path)?.value {
            Value::Table(robots) if path == ["robots"] => Some(robots.keys().cloned().collect()),
            _ => None,
        }
    }

    fn max_robots(&self) -> u32 {
        9
    }
}

const ENGINES: [&dyn Engine; 1] = [&Shop];

fn read(text: &str) -> Result<Scenario, InputErrors> {
    Scenario::read(&ENGINES, Document::parse("t.toml", text)?)
}

fn errors_with(vary: &str) -> Vec<String> {
    let text = EXAMPLE.replace("\"robots.rover.count\" = \"1..3\"", vary);
    let reported: Vec<InputError> = read(&text).err().map(|errors| errors.0).unwrap_or_default();
    reported.iter().map(ToString::to_string).collect()
}

#[test]
fn the_common_keys_and_the_engines_part_are_read_together() {
    let scenario = read(EXAMPLE).ok().unwrap();
    assert_eq!(scenario.engine, "shop");
    assert_eq!(scenario.configuration.robots, [("rover".to_owned(), 2)]);
    let factor = &scenario.study.factors[0];
    assert_eq!(factor.path, "robots.rover.count");
    assert_eq!(
        factor.values,
        Values::Listed([1, 2, 3].map(Value::Integer).into())
    );
    // A named merit omits terms that the engine does not have.
    let names: Vec<&str> = scenario
        .merit
        .terms
        .iter()
        .map(|each| &*each.name)
        .collect();
    assert_eq!(names, ["time", "robots"]);
}

#[test]
fn errors_of_both_parts_are_reported_at_once() {
    let text = EXAMPLE
        .replace("count = 2", "count = 0\ncuont = 3")
        .replace("\"equation-5.2\"", "{ tiem = 1 }")
        .replace("delta = 0.05", "delta = -1")
        .replace("[study]", "[stduy]\n[study]");
    let errors = read(&text).err().unwrap().to_string();
    for part in [
        "stduy is not a known key: expected one of engine, summary, robots, merit, require, study, \
         published; did you mean study?",
        "robots.rover.cuont is not a known key",
        "robots.rover.count = 0: must be a whole number from 1 to 9",
        "merit.tiem is not a known key: expected one of time, robots; did you mean time?",
        "study.delta = -1: must be a number above 0",
    ] {
        assert!(errors.contains(part), "{part}\nnot in\n{errors}");
    }
}

#[test]
fn an_unknown_engine_is_reported_with_the_known_ones() {
    let errors = read(&EXAMPLE.replace("\"shop\"", "\"shpo\""))
        .err()
        .unwrap();
    assert_eq!(
        errors.to_string(),
        "t.toml:2: engine = \"shpo\": must be one of \"shop\"; did you mean \"shop\"?"
    );
}

#[test]
fn a_confidence_in_percent_is_reported_with_its_share() {
    for (given, end) in [
        ("95", "; did you mean 0.95?"),
        ("99.9", "; did you mean 0.999?"),
        ("9500", ""),
        ("50", ""),
        ("1", ""),
        ("\"95\"", ""),
    ] {
        let text = EXAMPLE.replace("delta = 0.05", &format!("confidence = {given}"));
        assert_eq!(
            read(&text).err().unwrap().to_string(),
            format!(
                "t.toml:8: study.confidence = {given}: must be a number above 0.5 and below 1, such \
                 as 0.95{end}"
            )
        );
    }
}

#[test]
fn any_path_that_the_engine_can_read_is_varied() {
    for vary in [
        r#""robots.rover.speed" = "0.5,2""#,
        r#""robots.rover.loud" = "false,true""#,
        r#""robots.rover.mode" = "spiral,sweep""#,
    ] {
        assert_eq!(errors_with(vary), [""; 0], "{vary}");
    }
}

#[test]
fn values_that_the_engine_rejects_are_errors() {
    assert_eq!(
        errors_with(r#""robots.rover.count" = "8..10""#),
        ["t.toml:9: robots.rover.count = 10: must be a whole number from 1 to 9"]
    );
    assert_eq!(
        errors_with(r#""robots.rover.mode" = "siral,sweep""#),
        [
            "t.toml:9: robots.rover.mode = \"siral\": must be one of \"sweep\", \"spiral\"; did you \
             mean \"spiral\"?"
        ]
    );
}

#[test]
fn an_unknown_path_is_reported_once_with_the_nearest() {
    assert_eq!(
        errors_with(r#""robots.rover.cuont" = "1..8""#),
        [
            "t.toml:9: robots.rover.cuont is not a known key: expected one of count, loud, \
             mode, speed; did you mean count?",
            "t.toml:9: 7 more values of robots.rover.cuont are not allowed either",
        ]
    );
    assert_eq!(
        errors_with(r#""robot.rover.count" = "1..8""#),
        [
            "t.toml:9: study.vary.\"robot.rover.count\" = \"1..8\": must be a path that begins with \
             one of robots; did you mean robots.rover.count?"
        ]
    );
    assert_eq!(errors_with(r#""study.delta" = "1..8""#).len(), 1);
}

#[test]
fn a_misspelt_kind_is_an_error_and_is_not_created() {
    assert_eq!(
        errors_with(r#""robots.rovr.count" = "1""#),
        [
            "t.toml:9: robots.rovr.count = \"1\": must be in an existing entry of robots: rover; \
             did you mean robots.rover.count?"
        ]
    );
}

#[test]
fn an_unknown_kind_is_reported_once_with_the_nearest() {
    for (vary, kind) in [("rovr.speed", "rovr"), ("rovr.cuont", "rovr")] {
        let reported = errors_with(&format!("\"robots.{vary}\" = \"0..2\""));
        assert_eq!(reported.len(), 1, "{reported:?}");
        let meant = vary.replace(kind, "rover");
        let expected = format!("entry of robots: rover; did you mean robots.{meant}?");
        assert!(reported[0].ends_with(&expected), "{reported:?}");
    }
    let reported = errors_with(r#""robots.zeppelin.speed" = "1""#);
    assert!(
        reported[0].ends_with("entry of robots: rover"),
        "{reported:?}"
    );
}

fn errors_with_set(sets: &[(&str, Value)]) -> String {
    let mut document = Document::parse("t.toml", EXAMPLE).unwrap();
    for (path, value) in sets {
        let keys: Vec<&str> = path.split('.').collect();
        document.set(&keys, value.clone(), "--set");
    }
    let read = Scenario::read(&ENGINES, document);
    read.err()
        .map_or_else(String::new, |errors| errors.to_string())
}

#[test]
fn a_value_of_a_kind_that_is_not_there_tells_the_kinds_and_what_a_new_one_needs() {
    assert_eq!(
        errors_with_set(&[("robots.rovr.speed", Value::Integer(1))]),
        "--set: robots.rovr.speed = 1: must be in an existing entry of robots: rover; a new entry also \
         needs count; did you mean robots.rover.speed?"
    );
}

#[test]
fn a_whole_new_kind_can_be_set() {
    let [count, speed] = ["robots.scout.count", "robots.scout.speed"];
    assert_eq!(errors_with_set(&[(count, Value::Integer(1))]), "");
    let wrong = [(count, Value::Integer(1)), (speed, Value::Integer(7))];
    assert_eq!(
        errors_with_set(&wrong),
        "--set: robots.scout.speed = 7: must be a number from 0 to 2"
    );
}

#[test]
fn too_many_values_are_reported_with_their_number() {
    assert_eq!(
        errors_with(r#""robots.rover.count" = "1..100000""#),
        [
            "t.toml:9: study.vary.\"robots.rover.count\" = \"1..100000\": must be at most 10000 \
             values; it has 100000"
        ]
    );
}

#[test]
fn a_configuration_takes_values_at_the_paths_of_factors_only() {
    let configuration = |path: &str, value| {
        let document = Document::parse("t.toml", EXAMPLE)?;
        read_configuration(&ENGINES, document, &[(path.to_owned(), value)])
    };
    let read = configuration("robots.rover.count", Value::Integer(5));
    assert_eq!(read.ok().unwrap().robots, [("rover".to_owned(), 5)]);
    let errors = configuration("summary", Value::Integer(5)).err().unwrap();
    assert_eq!(
        errors.to_string(),
        "study.vary: summary = 5: must be a path that begins with one of robots"
    );
}
