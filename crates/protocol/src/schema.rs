//! The JSON Schemas of the types.

use crate::lists::{Checked, Deleted, LibraryList, ScenarioEntry};
use crate::page::PageMessage;
use crate::server::ServerMessage;
use crate::study_answer::{Study, StudyList};
use crate::study_form::{Factors, StudyRequest};
use crate::warden::{Drive, WardenState};
use brain::{AssignedGoal, BeliefState, Body, Command, Percept, ServedGoal};
use schemars::generate::{SchemaGenerator, SchemaSettings};
use serde_json::{Map, Value as Json, json};

/// The definitions of the inputs and outputs of brains, and of their belief states.
#[must_use]
pub fn brain_schema() -> Json {
    let mut inputs = SchemaSettings::draft2020_12().into_generator();
    inputs.subschema_for::<Percept>();
    inputs.subschema_for::<Command>();
    inputs.subschema_for::<Body>();
    let mut outputs = SchemaSettings::draft2020_12()
        .for_serialize()
        .into_generator();
    outputs.subschema_for::<BeliefState>();
    outputs.subschema_for::<AssignedGoal>();
    outputs.subschema_for::<ServedGoal>();
    definitions("Percepts, commands, bodies and beliefs", [outputs, inputs])
}

/// The definitions of all messages between the server and the page.
#[must_use]
pub fn page_schema() -> Json {
    let mut from_page = SchemaSettings::draft2020_12().into_generator();
    from_page.subschema_for::<PageMessage>();
    let mut from_server = SchemaSettings::draft2020_12()
        .for_serialize()
        .into_generator();
    from_server.subschema_for::<ServerMessage>();
    from_server.subschema_for::<ScenarioEntry>();
    from_server.subschema_for::<Checked>();
    from_server.subschema_for::<LibraryList>();
    from_server.subschema_for::<Deleted>();
    from_server.subschema_for::<Factors>();
    from_server.subschema_for::<StudyRequest>();
    from_server.subschema_for::<StudyList>();
    from_server.subschema_for::<Study>();
    from_server.subschema_for::<WardenState>();
    from_server.subschema_for::<Drive>();
    definitions(
        "Messages between the server and the page",
        [from_server, from_page],
    )
}

fn definitions<const N: usize>(title: &str, generators: [SchemaGenerator; N]) -> Json {
    let mut all = Map::new();
    for mut generator in generators {
        all.extend(generator.take_definitions(true));
    }
    all.sort_keys();
    json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": title,
        "$defs": all,
    })
}
