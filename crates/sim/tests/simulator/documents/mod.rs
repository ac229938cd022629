//! Random documents from the schema of scenarios, valid and mutated, and mutated valid scenarios:
//! each is accepted, or rejected with complete errors.

mod generation;

use base::document::{Document, Node, Value};
use base::error::InputErrors;
use generation::{Random, generate, mutate};
use proptest::prelude::*;
use sim::scenario::ScenarioSpec;

/// Small, so that a mutation is likely to have an effect.
const VALID: &str = r#"
clock = { time_limit_s = 60 }
world = { size_m = [20, 10], obstacles = [
    { polygon_m = [[0, 0], [4, 0], [4, 4], [0, 4]] },
    { circle = { at_m = [15, 5], radius_m = 1 } },
    { map = "room.yaml" },
] }
terrain = { mud = { speed = 0.5, areas_m = [[[10, 0], [20, 0], [20, 10]]] } }
[items]
mine = { count = 2, placement = { kind = "fixed", at_m = [[5, 5], [19, 9]] } }
scrap = { count = 3, target = false, placement = { kind = "clustered", clusters = 2, spread_m = 1 } }
[robots.rover]
count = 2
radius_m = 0.5
start = { kind = "fixed", at_m = [[6, 6], [7, 6]], heading_deg = [0, 90] }
drive = { max_speed_m_s = 1, max_turn_rate_deg_s = 90 }
battery = { capacity_j = 1000 }
radio = { range_m = 10, delay_s = 0.3 }
capabilities = ["arm"]
brain = { behaviours = [{ kind = "cruise" }, { kind = "serve" }, { kind = "avoid", near_m = 0.2 }] }
[robots.rover.sensors]
eye = { kind = "items", range_m = 3, detection_probability = { mine = [[0, 1], [3, 0.5]], scrap = 0.1 } }
sonar = { kind = "range", rays = 8, range_m = 2 }
gps = { kind = "position" }
compass = { kind = "heading" }
[controllers.base]
count = 1
aboard = "rover"
radio = { range_m = 10 }
[goals.spot]
count = 2
requires = "arm"
placement = { kind = "fixed", at_m = [[6, 7], [7, 7]] }
[models.best]
model = "quadrotor"
price = 3
[robots.bird]
model = "best"
count = 1
start = { kind = "uniform", within_m = [[10, 1], [19, 9]] }
"#;

fn open(file: &str) -> Result<Vec<u8>, String> {
    match file {
        "room.yaml" => Ok(
            "image: room.pgm\nresolution: 0.5\norigin: [9, 8, 0.5]\nnegate: 0\n\
                           occupied_thresh: 0.65\nfree_thresh: 0.196\n"
                .into(),
        ),
        "room.pgm" => Ok("P2 3 2 255  0 205 254  0 254 254".into()),
        _ => Err("there is no such file".to_owned()),
    }
}

fn document(root: &Value) -> Document {
    let mut document = Document::parse("t", "").unwrap();
    document.set(&[], root.clone(), "t");
    document
}

/// Whether every error has its origin and what is allowed, and no type disagrees with its schema.
fn are_complete(errors: &InputErrors) -> bool {
    let is_complete = |error: &base::error::InputError| {
        error.origin.is_some() && !error.allowed.starts_with("readable")
    };
    !errors.0.is_empty() && errors.0.iter().all(is_complete)
}

#[test]
fn the_valid_scenario_is_accepted() {
    let document = Document::parse("t", VALID).unwrap();
    let read = ScenarioSpec::read_with(&document, open);
    assert!(read.is_ok(), "{}", read.unwrap_err());
}

#[test]
fn mutation_leaves_some_scenarios_valid_and_makes_others_invalid() {
    let valid = Document::parse("t", VALID).unwrap();
    let is_valid = |seed: u64| {
        let mut root = valid.get(&[]).unwrap().value.clone();
        mutate(&mut root, &mut Random(seed));
        ScenarioSpec::read_with(&document(&root), open).is_ok()
    };
    let valid = (0..200).filter(|seed| is_valid(*seed)).count();
    assert!((20..180).contains(&valid), "{valid}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn documents_that_match_the_schema_are_accepted(seed: u64) {
        let schema = ScenarioSpec::schema();
        let root = generate(schema, schema.json(), &mut Random(seed));
        let read = document(&root).typed::<ScenarioSpec>(schema);
        prop_assert!(read.is_ok(), "{}\n{root:?}", read.unwrap_err());
    }

    #[test]
    fn mutated_documents_are_accepted_or_rejected_with_complete_errors(seed: u64) {
        let schema = ScenarioSpec::schema();
        let mut random = Random(seed);
        let mut root = generate(schema, schema.json(), &mut random);
        for _ in 0..=random.below(3) {
            mutate(&mut root, &mut random);
        }
        if let Err(errors) = document(&root).typed::<ScenarioSpec>(schema) {
            prop_assert!(are_complete(&errors), "{errors}\n{root:?}");
        }
    }

    #[test]
    fn mutated_scenarios_are_accepted_or_rejected_with_complete_errors(seed: u64) {
        let valid = Document::parse("t", VALID).unwrap();
        let Node { value: mut root, .. } = valid.get(&[]).unwrap().clone();
        let mut random = Random(seed);
        for _ in 0..=random.below(3) {
            mutate(&mut root, &mut random);
        }
        if let Err(errors) = ScenarioSpec::read_with(&document(&root), open) {
            prop_assert!(are_complete(&errors), "{errors}\n{root:?}");
        }
    }
}
