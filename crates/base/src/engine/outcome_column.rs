//! Outcome columns, each defined in one place.

use super::column::{Bounds, Column, ColumnKind};
use super::merit_term::MeritTerm;
use std::borrow::Cow;

type BoundsOf<C> = Box<dyn Fn(&C) -> Bounds + Send + Sync>;
type ValueOf<C, O> = Box<dyn Fn(&C, &O) -> f64 + Send + Sync>;

/// An outcome column of an engine: everything that depends on it follows from this definition.
///
/// `C` is a configuration of the engine, and `O` the outcome of one of its runs.
///
/// ```
/// use base::engine::{Bounds, ColumnKind, OutcomeColumn, OutcomeColumns};
/// struct Shots(u32);
/// struct Hits(u32);
/// let columns = OutcomeColumns(vec![
///     OutcomeColumn::new(
///         "hits",
///         ColumnKind::Whole,
///         |shots: &Shots| Bounds::up_to(shots.0.into()),
///         |_, hits: &Hits| hits.0.into(),
///     )
///     .with_term("hits", 0),
/// ]);
/// assert_eq!(columns.of(&Shots(3))[0].bounds, Bounds::up_to(3.0));
/// assert_eq!(columns.values(&Shots(3), &Hits(2)), [2.0]);
/// assert_eq!(columns.merit_terms()[0].name, "hits");
/// ```
pub struct OutcomeColumn<C, O> {
    name: Cow<'static, str>,
    kind: ColumnKind,
    bounds: BoundsOf<C>,
    value: ValueOf<C, O>,
    /// The merit term on it, with its place in the order of summation.
    term: Option<(u32, MeritTerm)>,
}

impl<C, O> OutcomeColumn<C, O> {
    /// A column that no figure of merit can weigh.
    pub fn new(
        name: impl Into<Cow<'static, str>>,
        kind: ColumnKind,
        bounds: impl Fn(&C) -> Bounds + Send + Sync + 'static,
        value: impl Fn(&C, &O) -> f64 + Send + Sync + 'static,
    ) -> Self {
        Self {
            name: name.into(),
            kind,
            bounds: Box::new(bounds),
            value: Box::new(value),
            term: None,
        }
    }

    /// The column with a merit term on it.
    ///
    /// `place` is its place in the order of summation. The last bits of a merit depend on this order, so a new
    /// term comes after the existing ones.
    #[must_use]
    pub fn with_term(mut self, name: &'static str, place: u32) -> Self {
        self.term = Some((place, MeritTerm::new(name, self.name.clone())));
        self
    }

    /// As [`OutcomeColumn::with_term`], for a column without an upper bound: the term needs a `max`, for which
    /// error messages propose `usual_max`.
    #[must_use]
    pub fn with_capped_term(self, name: &'static str, place: u32, usual_max: f64) -> Self {
        let mut column = self.with_term(name, place);
        if let Some((_, term)) = &mut column.term {
            term.usual_max = Some(usual_max);
        }
        column
    }
}

/// The outcome columns of an engine, in the order in which they are stored.
pub struct OutcomeColumns<C, O>(pub Vec<OutcomeColumn<C, O>>);

impl<C, O> OutcomeColumns<C, O> {
    /// The columns of a configuration.
    #[must_use]
    pub fn of(&self, configuration: &C) -> Vec<Column> {
        let column = |column: &OutcomeColumn<C, O>| Column {
            name: column.name.clone(),
            kind: column.kind,
            bounds: (column.bounds)(configuration),
        };
        self.0.iter().map(column).collect()
    }

    /// Their names.
    #[must_use]
    pub fn names(&self) -> Vec<String> {
        self.0
            .iter()
            .map(|column| column.name.to_string())
            .collect()
    }

    /// The values of an outcome, in the order of the columns.
    #[must_use]
    pub fn values(&self, configuration: &C, outcome: &O) -> Vec<f64> {
        let value = |column: &OutcomeColumn<C, O>| (column.value)(configuration, outcome);
        self.0.iter().map(value).collect()
    }

    /// The values of many outcomes, by column; NaN in all columns for a run that is quarantined.
    pub fn table(
        &self,
        configuration: &C,
        outcomes: impl Iterator<Item = Option<O>>,
    ) -> Vec<Vec<f64>> {
        let mut table = vec![Vec::new(); self.0.len()];
        for outcome in outcomes {
            for (column, values) in self.0.iter().zip(&mut table) {
                let value = outcome.as_ref();
                let value = value.map(|outcome| (column.value)(configuration, outcome));
                values.push(value.unwrap_or(f64::NAN));
            }
        }
        table
    }

    /// The terms that a figure of merit can weigh, in the order of summation.
    #[must_use]
    pub fn merit_terms(&self) -> Vec<MeritTerm> {
        let terms = self.0.iter().filter_map(|column| column.term.as_ref());
        let mut terms: Vec<&(u32, MeritTerm)> = terms.collect();
        terms.sort_by_key(|(place, _)| *place);
        terms.into_iter().map(|(_, term)| term.clone()).collect()
    }
}
