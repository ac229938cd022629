//! Reads values from columns.

use super::given::Given;
use super::shape::Shape;
use serde::de::value::{Error, MapDeserializer, SeqDeserializer};
use serde::de::{Deserializer, IntoDeserializer, Visitor};
use serde::forward_to_deserialize_any;

/// One entry of columns.
#[derive(Clone, Copy)]
pub(crate) struct Cell<'g> {
    given: &'g Given,
    entry: usize,
}

impl Given {
    /// An entry of these columns.
    pub(crate) fn cell(&self, entry: usize) -> Cell<'_> {
        Cell { given: self, entry }
    }

    /// The path in the columns of a key in an entry, by the keys and indices that lead there.
    pub(crate) fn path<'k>(&self, entry: usize, keys: impl Iterator<Item = &'k str>) -> String {
        let (mut path, mut cell) = (String::new(), self.cell(entry));
        for key in keys {
            if let Ok(number) = key.parse::<usize>() {
                cell = cell.item(number).unwrap_or(cell);
            } else {
                path = format!("{path}.{key}");
                cell = cell.below(key).unwrap_or(cell);
            }
        }
        format!("{path}[{}]", cell.entry)
    }
}

impl<'g> Cell<'g> {
    fn number(&self) -> Option<f64> {
        match self.given {
            Given::Numbers(_, numbers) => numbers.get(self.entry).copied(),
            _ => None,
        }
    }

    /// The items of a list.
    fn items(&self) -> &'g [usize] {
        match self.given {
            Given::List(items) => {
                &items.order[items.starts[self.entry]..items.starts[self.entry + 1]]
            }
            _ => &[],
        }
    }

    fn item(&self, number: usize) -> Option<Self> {
        match self.given {
            Given::List(items) => Some(items.item.cell(*self.items().get(number)?)),
            _ => None,
        }
    }

    fn below(&self, key: &str) -> Option<Self> {
        match self.given {
            Given::Table(columns) => {
                let (_, given) = columns.all.iter().find(|(field, _)| field.name == key)?;
                Some(given.cell(self.entry))
            }
            _ => None,
        }
    }

    /// Whether a key has no value that may be omitted.
    fn lacks_any(&self) -> bool {
        match self.given {
            Given::Table(columns) if columns.may_lack => {
                let mut optional = columns.all.iter().filter(|(field, _)| !field.is_required);
                optional.any(|(_, given)| given.cell(self.entry).is_missing())
            }
            _ => false,
        }
    }

    /// Whether it has no value.
    fn is_missing(&self) -> bool {
        match self.given {
            Given::Numbers(Shape::Number, numbers) => numbers[self.entry].is_nan(),
            Given::Numbers(Shape::Integer | Shape::Code(_), numbers) => numbers[self.entry] < 0.0,
            Given::Table(columns) => columns
                .all
                .iter()
                .all(|(_, given)| given.cell(self.entry).is_missing()),
            _ => false,
        }
    }
}

impl<'de> Deserializer<'de> for Cell<'de> {
    type Error = Error;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        match self.given {
            Given::Numbers(Shape::Vector { length, is_whole }, numbers) => {
                let first = self.entry * length;
                let numbers = numbers[first..first + length].iter();
                if *is_whole {
                    visitor.visit_seq(SeqDeserializer::new(numbers.map(|number| whole(*number))))
                } else {
                    visitor.visit_seq(SeqDeserializer::new(numbers.copied()))
                }
            }
            Given::Numbers(shape, numbers) => scalar(shape, numbers[self.entry], visitor),
            Given::Table(columns) => {
                let keys = columns.all.iter().filter_map(|(field, given)| {
                    let cell = given.cell(self.entry);
                    let is_given = field.is_required || !cell.is_missing();
                    is_given.then_some((field.name.as_str(), cell))
                });
                visitor.visit_map(MapDeserializer::new(keys))
            }
            Given::List(items) => {
                let cells = self.items().iter().map(|entry| items.item.cell(*entry));
                visitor.visit_seq(SeqDeserializer::new(cells))
            }
        }
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        if self.is_missing() {
            visitor.visit_none()
        } else {
            visitor.visit_some(self)
        }
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        let code = self.number().unwrap_or_default();
        let name = match self.given {
            Given::Numbers(shape, _) => name(shape, code),
            _ => "",
        };
        visitor.visit_enum(name.into_deserializer())
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        visitor: V,
    ) -> Result<V::Value, Error> {
        visitor.visit_newtype_struct(self)
    }

    /// The first keys of an object need no names.
    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        match self.given {
            Given::Table(columns) if columns.is_first && !self.lacks_any() => {
                let cells = columns.all.iter().map(|(_, given)| given.cell(self.entry));
                visitor.visit_seq(SeqDeserializer::new(cells))
            }
            _ => self.deserialize_any(visitor),
        }
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf unit
        unit_struct seq tuple tuple_struct map identifier ignored_any
    }
}

impl<'de> IntoDeserializer<'de, Error> for Cell<'de> {
    type Deserializer = Self;

    fn into_deserializer(self) -> Self {
        self
    }
}

/// The name of a code.
fn name(shape: &Shape, code: f64) -> &str {
    match shape {
        Shape::Code(names) => usize::try_from(whole(code))
            .ok()
            .and_then(|number| names.get(number))
            .map_or("", String::as_str),
        _ => "",
    }
}

fn scalar<'de, V: Visitor<'de>>(shape: &Shape, number: f64, to: V) -> Result<V::Value, Error> {
    match shape {
        Shape::Integer => to.visit_i64(whole(number)),
        Shape::Flag => to.visit_bool(number != 0.0),
        Shape::Code(_) => to.visit_str(name(shape, number)),
        _ => to.visit_f64(number),
    }
}

#[expect(clippy::cast_possible_truncation, reason = "whole numbers")]
fn whole(number: f64) -> i64 {
    number as i64
}
