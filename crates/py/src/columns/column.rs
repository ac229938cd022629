//! Columns that are filled value by value, and their arrays.

use super::shape::Shape;
use numpy::{Element, IntoPyArray, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// The column of a type.
pub(crate) struct Column {
    pub(super) shape: &'static Shape,
    pub(super) data: Data,
}

pub(super) enum Data {
    Numbers(Vec<f64>),
    Integers(Vec<i64>),
    Flags(Vec<bool>),
    Table(Vec<Column>),
    /// The entry that each item is of, and the items.
    List(Vec<i64>, Box<Column>),
    Omitted,
}

impl Column {
    /// A column with room for a number of entries.
    pub(super) fn new(shape: &'static Shape, entries: usize) -> Self {
        let data = match shape {
            Shape::Number => Data::Numbers(Vec::with_capacity(entries)),
            Shape::Vector { length, is_whole } => {
                let room = length * entries;
                if *is_whole {
                    Data::Integers(Vec::with_capacity(room))
                } else {
                    Data::Numbers(Vec::with_capacity(room))
                }
            }
            Shape::Integer | Shape::Code(_) => Data::Integers(Vec::with_capacity(entries)),
            Shape::Flag => Data::Flags(Vec::with_capacity(entries)),
            Shape::Table(fields) => {
                let columns = fields.iter().map(|field| Self::new(&field.shape, entries));
                Data::Table(columns.collect())
            }
            Shape::List(item) => Data::List(Vec::new(), Box::new(Self::new(item, 0))),
            Shape::Omitted => Data::Omitted,
        };
        Self { shape, data }
    }

    /// Adds an entry without a value.
    pub(super) fn skip(&mut self) {
        let times = match self.shape {
            Shape::Vector { length, .. } => *length,
            _ => 1,
        };
        match &mut self.data {
            Data::Numbers(numbers) => numbers.extend((0..times).map(|_| f64::NAN)),
            Data::Integers(integers) => integers.extend((0..times).map(|_| -1)),
            Data::Flags(flags) => flags.push(false),
            Data::Table(columns) => columns.iter_mut().for_each(Self::skip),
            Data::List(..) | Data::Omitted => {}
        }
    }

    /// An array, or a dict of arrays.
    pub(crate) fn arrays(self, py: Python<'_>) -> PyResult<Bound<'_, PyAny>> {
        match self.data {
            Data::Numbers(numbers) => array(py, self.shape, numbers),
            Data::Integers(integers) => array(py, self.shape, integers),
            Data::Flags(flags) => array(py, self.shape, flags),
            _ => {
                let dict = PyDict::new(py);
                self.put_into(&dict)?;
                Ok(dict.into_any())
            }
        }
    }

    /// Adds the arrays of this column to a dict, by their names.
    pub(crate) fn put_into(self, dict: &Bound<PyDict>) -> PyResult<()> {
        let (py, fields) = (dict.py(), self.shape.fields());
        match self.data {
            Data::Table(columns) => {
                for (field, column) in fields.iter().zip(columns) {
                    if !matches!(column.data, Data::Omitted) {
                        dict.set_item(&field.name, column.arrays(py)?)?;
                    }
                }
            }
            Data::List(rows, items) => {
                dict.set_item("row", rows.into_pyarray(py))?;
                items.put_into(dict)?;
            }
            _ => dict.set_item("value", self.arrays(py)?)?,
        }
        Ok(())
    }
}

fn array<'py, T: Element>(
    py: Python<'py>,
    shape: &Shape,
    values: Vec<T>,
) -> PyResult<Bound<'py, PyAny>> {
    let count = values.len();
    let array = values.into_pyarray(py);
    match shape {
        Shape::Vector { length, .. } => Ok(array.reshape([count / length, *length])?.into_any()),
        _ => Ok(array.into_any()),
    }
}
