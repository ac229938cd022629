//! The columns that a function of Python returned, checked against their shape.

use super::shape::{Field, Shape};
use crate::convert::text;
use crate::error::input_error;
use base::error::{InputError, InputErrors};
use numpy::{PyArrayDyn, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::exceptions::{PyOverflowError, PyTypeError, PyValueError};
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// The columns of a type, as far as they were given.
pub(crate) enum Given {
    /// Numbers; several per entry of a vector.
    Numbers(&'static Shape, Vec<f64>),
    Table(Columns),
    List(Items),
}

/// The columns of an object.
pub(crate) struct Columns {
    pub(super) all: Vec<(&'static Field, Given)>,
    /// Whether they are those of its first keys.
    pub(super) is_first: bool,
    /// Whether an entry may have no value for one of them.
    pub(super) may_lack: bool,
}

impl Columns {
    fn new(fields: &[Field], all: Vec<(&'static Field, Given)>) -> Self {
        let mut first = fields.iter().zip(&all);
        Self {
            is_first: first.all(|(field, (given, _))| field.name == given.name),
            may_lack: all
                .iter()
                .any(|(field, given)| !field.is_required && given.may_lack()),
            all,
        }
    }
}

/// The items of a list: the numbers of those of entry `n` are `order[starts[n]..starts[n + 1]]`.
pub(crate) struct Items {
    pub(super) starts: Vec<usize>,
    pub(super) order: Vec<usize>,
    pub(super) item: Box<Given>,
}

/// Where columns are in the returned dict, and their number of entries.
#[derive(Debug, Clone, Copy)]
struct Place<'p> {
    path: &'p str,
    count: usize,
    /// Whether entries may have no value.
    is_optional: bool,
}

impl Given {
    /// Reads the columns of a number of entries; `path` is theirs in errors.
    pub(crate) fn read(
        shape: &'static Shape,
        path: &str,
        given: &Bound<PyAny>,
        count: usize,
    ) -> PyResult<Self> {
        let place = Place {
            path,
            count,
            is_optional: false,
        };
        place.read(shape, given)
    }

    /// Whether an entry may have no value.
    fn may_lack(&self) -> bool {
        match self {
            Self::Numbers(Shape::Number, numbers) => numbers.iter().any(|number| number.is_nan()),
            Self::Numbers(Shape::Integer | Shape::Code(_), numbers) => {
                numbers.iter().any(|number| *number < 0.0)
            }
            Self::Table(columns) => columns.all.iter().all(|(_, given)| given.may_lack()),
            _ => false,
        }
    }
}

impl Place<'_> {
    fn read(&self, shape: &'static Shape, given: &Bound<PyAny>) -> PyResult<Given> {
        match shape {
            Shape::Table(fields) => Ok(Given::Table(self.table(fields, given, &[])?)),
            Shape::List(item) => self.list(item, given),
            _ => self.numbers(shape, given),
        }
    }

    fn below(&self, name: &str) -> String {
        format!("{}.{name}", self.path)
    }

    fn error(&self, given: &Bound<PyAny>, allowed: &str) -> PyErr {
        let given = given.repr().map(|given| given.to_string());
        refusal(self.path.to_owned(), given.ok(), allowed.to_owned())
    }

    /// The columns of the keys that are given; `extra` are further allowed keys.
    fn table(
        &self,
        fields: &'static [Field],
        given: &Bound<PyAny>,
        extra: &[&str],
    ) -> PyResult<Columns> {
        let dict = self.dict(fields, given, extra)?;
        let mut columns = Vec::new();
        let with_columns = |field: &&Field| !matches!(field.shape, Shape::Omitted);
        for field in fields.iter().filter(with_columns) {
            let path = self.below(&field.name);
            match dict.get_item(&field.name).ok().flatten() {
                Some(given) => {
                    let place = Place {
                        path: &path,
                        count: self.count,
                        is_optional: field.is_nullable,
                    };
                    columns.push((field, place.read(&field.shape, &given)?));
                }
                None if field.is_required && self.count > 0 => {
                    let allowed = format!("given: it is a key of {}", self.path);
                    return Err(refusal(path, Some("None".to_owned()), allowed));
                }
                None => {}
            }
        }
        Ok(Columns::new(fields, columns))
    }

    /// A dict with no other keys than these.
    fn dict<'py>(
        &self,
        fields: &[Field],
        given: &Bound<'py, PyAny>,
        extra: &[&str],
    ) -> PyResult<Bound<'py, PyDict>> {
        let names = fields.iter().map(|field| field.name.as_str());
        let names: Vec<&str> = extra.iter().copied().chain(names).collect();
        let known = names.join(", ");
        let Ok(dict) = given.cast::<PyDict>() else {
            return Err(self.error(given, &format!("a dict with {known}")));
        };
        for (key, value) in dict.iter() {
            let key = text(&key);
            if !names.contains(&key.as_str()) {
                let path = self.below(&key);
                let place = Place {
                    path: &path,
                    ..*self
                };
                return Err(place.error(&value, &format!("one of {known}")));
            }
        }
        Ok(dict.clone())
    }

    fn list(&self, item: &'static Shape, given: &Bound<PyAny>) -> PyResult<Given> {
        let dict = self.dict(item.fields(), given, &["row"])?;
        let rows = self.rows(&dict)?;
        let Some(rows) = rows else {
            if !dict.is_empty() {
                let allowed = "given: the row of each item".to_owned();
                return Err(refusal(self.below("row"), Some("None".to_owned()), allowed));
            }
            return Ok(Given::List(Items {
                starts: vec![0; self.count + 1],
                order: Vec::new(),
                item: Box::new(Given::Table(Columns::new(&[], Vec::new()))),
            }));
        };
        let mut order: Vec<usize> = (0..rows.len()).collect();
        order.sort_by_key(|item| rows[*item]);
        let before = |entry: usize| order.partition_point(|item| rows[*item] < entry);
        let starts = (0..=self.count).map(before).collect();
        let entries = Self {
            count: rows.len(),
            ..*self
        };
        let columns = entries.table(item.fields(), given, &["row"])?;
        let item = Box::new(Given::Table(columns));
        Ok(Given::List(Items {
            starts,
            order,
            item,
        }))
    }

    /// The `row` of a dict, each below the number of entries.
    fn rows(&self, dict: &Bound<PyDict>) -> PyResult<Option<Vec<usize>>> {
        let Some(given) = dict.get_item("row").ok().flatten() else {
            return Ok(None);
        };
        let path = self.below("row");
        let place = Place {
            path: &path,
            ..*self
        };
        let rows = place.array(&given, None)?;
        let max = self.count.saturating_sub(1);
        let allowed = format!("a whole number from 0 to {max}");
        place.all(&given, &rows, |row| is_below(row, self.count), &allowed)?;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "whole numbers that are not negative"
        )]
        Ok(Some(rows.into_iter().map(|row| row as usize).collect()))
    }

    /// Numbers as their shape allows them.
    fn numbers(&self, shape: &'static Shape, given: &Bound<PyAny>) -> PyResult<Given> {
        let numbers = match shape {
            Shape::Vector { length, .. } => self.array(given, Some(&[self.count, *length]))?,
            _ => self.array(given, Some(&[self.count]))?,
        };
        match shape {
            Shape::Number if self.is_optional => {
                self.all(
                    given,
                    &numbers,
                    |it| !it.is_infinite(),
                    "a finite number, or NaN for none",
                )?;
            }
            Shape::Number
            | Shape::Vector {
                is_whole: false, ..
            } => {
                self.all(given, &numbers, f64::is_finite, "a finite number")?;
            }
            Shape::Flag => {
                self.all(given, &numbers, |it| is_below(it, 2), "True or False")?;
            }
            Shape::Code(names) => {
                let is_known = |it: f64| is_below(it, names.len());
                let codes = names.iter().enumerate();
                let codes: Vec<String> = codes
                    .map(|(code, name)| format!("{code} ({name})"))
                    .collect();
                self.all(given, &numbers, is_known, &codes.join(", "))?;
            }
            _ => self.all(given, &numbers, |it| it.fract() == 0.0, "a whole number")?,
        }
        Ok(Given::Numbers(shape, numbers))
    }

    fn all(
        &self,
        given: &Bound<PyAny>,
        numbers: &[f64],
        is_allowed: impl Fn(f64) -> bool,
        allowed: &str,
    ) -> PyResult<()> {
        let wrong = numbers.iter().position(|number| !is_allowed(*number));
        wrong.map_or(Ok(()), |index| {
            let path = format!("{}[{index}]", self.path);
            Err(refusal(
                path,
                Some(shown(given, index, numbers[index])),
                allowed.to_owned(),
            ))
        })
    }

    /// An array of floats, repeated to a shape if one is given.
    fn array(&self, given: &Bound<PyAny>, shape: Option<&[usize]>) -> PyResult<Vec<f64>> {
        let convert = || -> PyResult<Vec<f64>> {
            if let Ok(array) = given.cast::<PyArrayDyn<f64>>() {
                return repeated(array, shape);
            }
            let numpy = given.py().import(intern!(given.py(), "numpy"))?;
            let array = numpy.call_method1(intern!(given.py(), "asarray"), (given,))?;
            if array.getattr("dtype")?.getattr("kind")?.eq("c")? {
                return Err(PyTypeError::new_err("complex numbers"));
            }
            let array = numpy.call_method1(intern!(given.py(), "asarray"), (array, "float64"))?;
            repeated(array.cast()?, shape)
        };
        convert().map_err(|error| {
            let py = given.py();
            let is_of_value = error.is_instance_of::<PyTypeError>(py)
                || error.is_instance_of::<PyValueError>(py)
                || error.is_instance_of::<PyOverflowError>(py);
            // Others are those of signals.
            if !is_of_value {
                return error;
            }
            let shape = match shape {
                Some([count]) => format!("({count},)"),
                Some([count, width]) => format!("({count}, {width})"),
                _ => "(n,)".to_owned(),
            };
            self.error(
                given,
                &format!("one value for all, or an array of shape {shape}"),
            )
        })
    }
}

/// The numbers of an array, repeated to a shape if one is given, as numpy does.
fn repeated(array: &Bound<PyArrayDyn<f64>>, shape: Option<&[usize]>) -> PyResult<Vec<f64>> {
    let own = array.shape();
    // A slice is in the order of memory, which may be that of Fortran.
    if let Ok(numbers) = array.readonly().as_slice()
        && array.is_c_contiguous()
    {
        if shape.map_or(own.len() == 1, |shape| own == shape) {
            return Ok(numbers.to_vec());
        }
        if let (Some(shape), [number]) = (shape, numbers)
            && own.is_empty()
        {
            return Ok(vec![*number; shape.iter().product()]);
        }
    }
    let numpy = array.py().import("numpy")?;
    let array = match shape {
        Some(shape) => numpy.call_method1("broadcast_to", (array, shape))?,
        None => numpy.call_method1("atleast_1d", (array,))?,
    };
    // A copy is aligned.
    let flat = array.call_method0("flatten")?;
    Ok(flat
        .cast::<PyArrayDyn<f64>>()?
        .readonly()
        .as_slice()?
        .to_vec())
}

/// A number as it was given: `None` in place of a number is read as NaN.
fn shown(given: &Bound<PyAny>, index: usize, number: f64) -> String {
    let is_none = || -> PyResult<bool> {
        let numpy = given.py().import("numpy")?;
        let items = numpy.call_method1("asarray", (given, "object"))?;
        let items = items.call_method0("ravel")?;
        let item = items.get_item(index % items.len()?.max(1))?;
        Ok(item.is_none())
    };
    if number.is_nan() && is_none().unwrap_or(false) {
        "None".to_owned()
    } else {
        number.to_string()
    }
}

fn refusal(path: String, given: Option<String>, allowed: String) -> PyErr {
    input_error(
        &InputErrors(vec![InputError::new(path, given, allowed)]),
        "",
    )
}

/// Whether it is a whole number from 0 and below `limit`.
#[expect(clippy::cast_precision_loss, reason = "numbers of entries")]
fn is_below(number: f64, limit: usize) -> bool {
    number.fract() == 0.0 && (0.0..limit as f64).contains(&number)
}
