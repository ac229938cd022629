//! What a study asks: how runs are scored, what is varied, what others published.
//!
//! All of it is the same for every simulator; what differs, an [`Engine`] declares. A scenario:
//!
//! ```toml
//! engine = "classic"                      # who reads the keys that are not shown here
//! summary = "One line for people."
//! merit = "equation-5.2"                  # a name, or weights of your own: see below
//!
//! [study]
//! vary = { "robots.wanderer.count" = "1..8" }
//! design = "factorial"                    # or "lhs:200" or "sobol:256": points that fill the space
//! delta = 0.05                            # may be left out: a difference of merit worth knowing
//! confidence = 0.95                       # above 0.5, below 1; how often the answer is right
//!
//! [published]                             # may be left out: results to show beside ours
//! source = "Williams 2003"
//! choice = 3
//! cap_s = 120
//! times_s = { 1 = [120, 44], 2 = [120, 43] }
//! ```
//!
//! **What is varied** is a path in the scenario and a text of its values:
//!
//! | text | values |
//! |---|---|
//! | `1..40` | whole numbers, both ends included |
//! | `1,2,4` or `1..4,8` or `0.5,1.0` | these |
//! | `touch,ahead` or `false,true` | these names |
//! | `41.0..57.0` | any number of the range: for `lhs:` and `sobol:` only |
//!
//! **A figure of merit of your own** is a table of weights on what a run gives; higher is better:
//!
//! ```toml
//! merit = { time = -0.03, robots = -0.2, failed = -5, paints = { weight = -0.01, max = 100 } }
//! ```
//!
//! A value above `max` counts as `max`. On the command line it is `--merit time=-0.03,robots=-0.2`.

mod engine;
mod merit;
mod names;
mod published;
mod schema;
mod study;
mod trial;
mod values;
mod vary;

pub use engine::{Configuration, Engine};
pub use merit::{Measure, Merit, NamedMerit, Term};
pub use published::Published;
pub use schema::schema;
pub use study::{Design, Study};
pub use values::Values;
pub use vary::Factor;

use crate::document::{Document, Section, Value};
use crate::error::InputErrors;

/// Largest time after which a run has failed, in seconds.
pub const MAX_CAP_S: f64 = 1e6;

/// A scenario: what a run depends on, and what is asked.
pub struct Scenario {
    /// Which simulator runs it.
    pub engine: &'static str,
    /// One line for people.
    pub summary: String,
    /// How runs are scored.
    pub merit: Merit,
    /// A single run; a study varies it.
    pub configuration: Configuration,
    /// What a study does.
    pub study: Study,
    /// Results of others.
    pub published: Option<Published>,
}

impl Scenario {
    /// Reads a scenario of one of `engines`.
    ///
    /// # Errors
    /// Everything that is wrong with it; of a scenario of no known engine only that, since all else
    /// that is allowed follows from the engine.
    pub fn read(engines: &[&dyn Engine], mut document: Document) -> Result<Self, InputErrors> {
        merit::make_table(&mut document);
        let engine = engine_of(engines, &document)?;
        let (_, mut errors) = document.read_all(|root| {
            root.only(&all_keys(engine));
            Some(())
        });
        let read = names::read(engine, &document);
        let configuration = read.map_err(|told| errors.extend(told.0)).ok();
        let measures = engine.measures(&document);
        let (asked, told) = document.read_all(|root| asked(root, engine, &measures));
        errors.extend(told);
        let given = configuration.as_ref();
        errors.extend(trial::errors_of_values(engine, &document, given, &errors));
        let scenario = asked.zip(configuration).map(|(asked, configuration)| Self {
            engine: engine.name(),
            summary: asked.summary,
            merit: asked.merit,
            configuration,
            study: asked.study,
            published: asked.published,
        });
        InputErrors::or(errors, scenario)
    }
}

/// The files that a document of one of `engines` names and that have not been read.
#[must_use]
pub fn files_wanted(engines: &[&dyn Engine], document: &Document) -> Vec<String> {
    engine_of(engines, document).map_or_else(|_| Vec::new(), |engine| engine.files(document))
}

impl Configuration {
    /// Reads what a run depends on, and nothing else, of a scenario with `values` at the paths of
    /// factors.
    ///
    /// # Errors
    /// Everything that is wrong with that part; or each path that is none of a factor.
    pub fn read(
        engines: &[&dyn Engine],
        mut document: Document,
        values: &[(String, Value)],
    ) -> Result<Self, InputErrors> {
        let engine = engine_of(engines, &document)?;
        let unknown = values.iter().filter_map(|(path, value)| {
            let refusal = vary::refusal(engine, path)?;
            Some(refusal.of(path, value, ORIGIN))
        });
        InputErrors::or(unknown.collect(), Some(()))?;
        for (path, value) in values {
            vary::put(&mut document, path, value, ORIGIN);
        }
        names::read(engine, &document)
    }
}

/// How errors name a configuration's values.
const ORIGIN: &str = "study.vary";

/// The part of a scenario that is the question's.
struct Asked {
    summary: String,
    merit: Merit,
    study: Study,
    published: Option<Published>,
}

fn asked(root: &Section, engine: &dyn Engine, measures: &[Measure]) -> Option<Asked> {
    let summary = root.line("summary");
    let merit = merit::merit(root, measures, engine.merits());
    let study = study::study(&root.section("study"), engine);
    let published = root.has("published").then(|| {
        let section = root.section("published");
        published::published(&section, engine.most_robots())
    });
    Some(Asked {
        summary: summary?,
        merit: merit?,
        study: study?,
        published: match published {
            Some(read) => Some(read?),
            None => None,
        },
    })
}

fn engine_of<'e>(
    engines: &[&'e dyn Engine],
    document: &Document,
) -> Result<&'e dyn Engine, InputErrors> {
    let names: Vec<(&str, &dyn Engine)> = engines.iter().map(|each| (each.name(), *each)).collect();
    document.read(|root| root.choice("engine", &names))
}

fn all_keys(engine: &dyn Engine) -> Vec<&'static str> {
    let (before, after) = (["engine", "summary"], ["merit", "study", "published"]);
    let own = engine.keys().iter().copied();
    before.into_iter().chain(own).chain(after).collect()
}

#[cfg(test)]
mod tests;
