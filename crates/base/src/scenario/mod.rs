//! The part of a scenario that is common to all engines: how runs are scored, what a study varies,
//! and published results. The other keys belong to the [`Engine`].
//!
//! ```toml
//! engine = "classic"                      # selects the simulator, which reads the keys not shown here
//! summary = "One line of description."
//! merit = "equation-5.2"                  # a name, or a table of weights: see below
//!
//! [study]
//! vary = { "robots.wanderer.count" = "1..8" }
//! design = "factorial"                    # or "lhs:200" or "sobol:256" (space-filling)
//! delta = 0.05                            # optional: the smallest difference in merit that matters
//! confidence = 0.95                       # above 0.5, below 1; probability that the answer is right
//!
//! [require]                               # optional: a study then selects the least `minimize` that meets it
//! all = ["time_s <= 120"]
//!
//! [published]                             # optional: results to show beside those of a study
//! source = "Williams 2003"
//! choice = 3
//! time_limit_s = 120
//! times_s = { 1 = [120, 44], 2 = [120, 43] }
//! ```
//!
//! **What is varied** is a path in the scenario, with its values as a string:
//!
//! | string | values |
//! |---|---|
//! | `1..40` | whole numbers, both ends included |
//! | `1,2,4` or `1..4,8` or `0.5,1.0` | the listed numbers |
//! | `touch,ahead` or `false,true` | the listed names or booleans |
//! | `1..41 by 5` or `0.1..0.5 by 0.1` | numbers with this step |
//! | `1..1000 log 7` | seven numbers, each the same multiple of the one before |
//! | `41.0..57.0` | any number in the range: only for the designs `lhs:` and `sobol:` |
//!
//! **A custom figure of merit** is a table of weights on the outcome of a run; higher is better:
//!
//! ```toml
//! merit = { time = -0.03, robots = -0.2, failed = -5, paints = { weight = -0.01, max = 100 } }
//! ```
//!
//! A value above `max` counts as `max`. On the command line: `--merit time=-0.03,robots=-0.2`.

pub mod condition;
mod factors;
mod merit;
mod published;
mod require;
mod schema;
mod study;
mod unknown_names;
mod value_checks;
mod values;

pub use factors::{Factor, largest};
pub use merit::{Merit, Term};
pub use published::Published;
pub use require::Requirement;
pub use schema::schema;
pub use study::{Design, Study};
pub use values::Values;

use self::condition::ConditionColumns;
use crate::document::{Document, Section, Value};
use crate::engine::{Configuration, Engine, MeritTerm};
use crate::error::{InputError, InputErrors};
use crate::warning::Warning;

/// A scenario that has been read and checked.
pub struct Scenario {
    /// Name of the engine that runs it.
    pub engine: &'static str,
    /// One line of description.
    pub summary: String,
    /// How runs are scored.
    pub merit: Merit,
    /// The configuration of a single run, which a study varies.
    pub configuration: Configuration,
    /// Settings of a study.
    pub study: Study,
    /// What a mission must meet; `None` to compare merits.
    pub requirement: Option<Requirement>,
    /// Published results for comparison.
    pub published: Option<Published>,
}

impl Scenario {
    /// Reads a scenario of one of `engines`.
    ///
    /// # Errors
    /// All errors of the scenario. If the engine is unknown, only that error, since the engine decides
    /// which other keys are allowed.
    pub fn read(engines: &[&dyn Engine], mut document: Document) -> Result<Self, InputErrors> {
        merit::make_table(&mut document);
        let engine = engine_of(engines, &document)?;
        let (_, mut errors) = document.read_all(|root| {
            check_keys(root, engine, engines);
            Some(())
        });
        let read = unknown_names::read(engine, &document);
        let configuration = read.map_err(|more| errors.extend(more.0)).ok();
        let merit_terms = engine.merit_terms(&document);
        let (common, more) = document.read_all(|root| common(root, engine, &merit_terms));
        errors.extend(more);
        let base = configuration.as_ref();
        let columns = engine.condition_columns(&document);
        let (requirement, more) = document.read_all(|root| requirement(root, &columns));
        errors.extend(more);
        errors.extend(value_checks::errors_of_values(
            engine, &document, base, &errors,
        ));
        let scenario = common.zip(configuration).zip(requirement).map(
            |((common, configuration), requirement)| Self {
                engine: engine.name(),
                summary: common.summary,
                merit: common.merit,
                configuration,
                study: common.study,
                requirement,
                published: common.published,
            },
        );
        InputErrors::or(errors, scenario)
    }
}

/// The files that a document refers to and that have not been read yet.
#[must_use]
pub fn missing_files(engines: &[&dyn Engine], document: &Document) -> Vec<String> {
    engine_of(engines, document).map_or_else(|_| Vec::new(), |engine| engine.files(document))
}

/// Reads the configuration of a scenario, with `values` at the paths of factors. The common keys are
/// not checked.
///
/// # Errors
/// Each path that is not a factor; otherwise everything that is wrong with the configuration.
pub fn read_configuration(
    engines: &[&dyn Engine],
    mut document: Document,
    values: &[(String, Value)],
) -> Result<Configuration, InputErrors> {
    let engine = engine_of(engines, &document)?;
    let unknown = values.iter().filter_map(|(path, value)| {
        let error = factors::refusal(engine, path, path.clone(), value)?;
        let origin = Some(ORIGIN.to_owned());
        Some(InputError { origin, ..error })
    });
    InputErrors::or(unknown.collect(), Some(()))?;
    for (path, value) in values {
        factors::put(&mut document, path, value, ORIGIN);
    }
    unknown_names::read(engine, &document)
}

/// Warnings about configurations of a scenario, each with values at the paths of factors.
#[must_use]
pub fn warnings(
    engines: &[&dyn Engine],
    document: &Document,
    configurations: &[Vec<(String, Value)>],
) -> Vec<Warning> {
    engine_of(engines, document).map_or_else(
        |_| Vec::new(),
        |engine| engine.warnings(document, configurations),
    )
}

/// Quantities that follow from the values of a scenario: see [`Engine::derived`].
#[must_use]
pub fn derived(engines: &[&dyn Engine], document: &Document) -> Vec<(String, String)> {
    engine_of(engines, document).map_or_else(|_| Vec::new(), |engine| engine.derived(document))
}

/// Origin of a configuration's values in error messages.
const ORIGIN: &str = "study.vary";

/// The keys that all engines share.
struct Common {
    summary: String,
    merit: Merit,
    study: Study,
    published: Option<Published>,
}

fn common(root: &Section, engine: &dyn Engine, merit_terms: &[MeritTerm]) -> Option<Common> {
    let summary = root.line("summary");
    let merit = merit::merit(root, merit_terms, engine.merits());
    let study = study::study(&root.section("study"), engine);
    let published = root.has("published").then(|| {
        let section = root.section("published");
        published::published(&section, engine.max_robots())
    });
    Some(Common {
        summary: summary?,
        merit: merit?,
        study: study?,
        published: match published {
            Some(read) => Some(read?),
            None => None,
        },
    })
}

/// The requirement of a scenario: `Some(None)` if it has none.
#[expect(clippy::option_option, reason = "an error, a missing key, and a value")]
fn requirement(root: &Section, columns: &ConditionColumns) -> Option<Option<Requirement>> {
    if !root.has("require") {
        return Some(None);
    }
    require::requirement(&root.section("require"), columns).map(Some)
}

fn engine_of<'e>(
    engines: &[&'e dyn Engine],
    document: &Document,
) -> Result<&'e dyn Engine, InputErrors> {
    let names: Vec<(&str, &dyn Engine)> = engines.iter().map(|each| (each.name(), *each)).collect();
    document.read(|root| root.choice("engine", &names))
}

/// Reports every key that is not the engine's, and of which other engine it is.
fn check_keys(root: &Section, engine: &dyn Engine, engines: &[&dyn Engine]) {
    let known = all_keys(engine);
    for key in root.keys().filter(|key| !known.contains(key)) {
        let mut others = engines.iter().filter(|each| each.keys().contains(&key));
        match others.next() {
            Some(other) => {
                let [this, other] = [engine.name(), other.name()];
                let allowed = format!("left out: only the engine {other:?} has it, not {this:?}");
                root.error(key, &allowed);
            }
            None => root.report_unknown(key, &known),
        }
    }
}

fn all_keys(engine: &dyn Engine) -> Vec<&'static str> {
    let (before, after) = (
        ["engine", "summary"],
        ["merit", "require", "study", "published"],
    );
    let own = engine.keys().iter().copied();
    before.into_iter().chain(own).chain(after).collect()
}

#[cfg(test)]
mod tests;
