//! The Python module `agent_economy._core`: it converts values, releases the interpreter while
//! Rust computes, and maps errors. No logic lives here.

mod arguments;
mod arrays;
mod brain;
mod classic_simulation;
mod columns;
mod configuration;
mod controller;
mod convert;
mod document;
mod economy;
mod engines;
mod error;
mod events;
mod external;
mod external_view;
mod frame;
mod geodesy;
mod inspect;
mod lane;
mod long_work;
mod message_check;
mod metric_scenario;
mod overlay;
mod page;
mod percept_check;
mod polygon;
mod python_brain;
mod recording;
mod scenario;
mod selection;
mod serde_error;
mod simulation;
mod snapshot;

use pyo3::prelude::*;

#[pymodule]
mod _core {
    #[pymodule_export]
    use crate::arguments::refusal;
    #[pymodule_export]
    use crate::brain::Brain;
    #[pymodule_export]
    use crate::classic_simulation::{
        ClassicScenario, ClassicSimulation, ClassicSnapshot, classic_world, read_classic,
    };
    #[pymodule_export]
    use crate::configuration::{
        Configuration, read_configuration, run_block, run_one, scenario_warnings,
    };
    #[pymodule_export]
    use crate::controller::{Controller, assignment};
    #[pymodule_export]
    use crate::document::Document;
    #[pymodule_export]
    use crate::economy::{controllers, goals, served_goals};
    #[pymodule_export]
    use crate::error::{InputError, NoRoomError};
    #[pymodule_export]
    use crate::events::EventReader;
    #[pymodule_export]
    use crate::external_view::{external_views, sensor_kinds};
    #[pymodule_export]
    use crate::frame::frame;
    #[pymodule_export]
    use crate::geodesy::LocalFrame;
    #[pymodule_export]
    use crate::inspect::{believed_map, inspect, inspection};
    #[pymodule_export]
    use crate::lane::{lanes, mines_left, vehicles};
    #[pymodule_export]
    use crate::metric_scenario::{MetricScenario, body, read_metric};
    #[pymodule_export]
    use crate::overlay::{drawn_footprints, drawn_links, footprints, links};
    #[pymodule_export]
    use crate::page::check_page_message;
    #[pymodule_export]
    use crate::polygon::{polygon_contains, polygon_error};
    #[pymodule_export]
    use crate::recording::{recorded_moment, recorded_setting};
    #[pymodule_export]
    use crate::scenario::{
        derived_quantities, missing_files, parameters, read_document, read_filled, read_scenario,
    };
    #[pymodule_export]
    use crate::selection::{
        Procedure, RequirementSearch, equal_allocation, mean_bounds, mean_exceeds, quantile_bounds,
        selection,
    };
    #[pymodule_export]
    use crate::simulation::{Simulation, Snapshot};

    use classic::Contact;
    use pyo3::prelude::*;
    use pyo3::types::PyTuple;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        let none = PyTuple::empty(module.py());
        module.getattr("InputError")?.setattr("errors", none)?;
        module.add("ENGINE", env!("AGENT_ECONOMY_ENGINE"))?;
        module.add("PROFILE", env!("AGENT_ECONOMY_PROFILE"))?;
        module.add(
            "FIRST_ANALYSIS_RUNS",
            select::interim_analyses::next_analysis(0),
        )?;
        module.add("MAX_IMAGE_BYTES", base::map::MAX_IMAGE_BYTES)?;
        module.add("MAX_RUNS", crate::arguments::MAX_RUNS)?;
        module.add("CONTACTS", Contact::NAMES.map(|(name, _)| name))
    }
}
