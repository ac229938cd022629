//! Reads values from columns.

use super::given::Given;
use super::shape::{Field, Shape};
use serde::de::value::{Error, StrDeserializer};
use serde::de::{
    DeserializeSeed, Deserializer, EnumAccess, IntoDeserializer, MapAccess, SeqAccess,
    VariantAccess, Visitor,
};
use serde::forward_to_deserialize_any;
use std::slice;

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

    /// The alternative of a union.
    fn alternative(&self) -> Option<(&'g str, Self)> {
        let Given::Union(union) = self.given else {
            return None;
        };
        let (number, entry) = union.chosen[self.entry]?;
        let (field, content) = &union.all[number];
        Some((field.name.as_str(), content.cell(entry)))
    }

    fn below(&self, key: &str) -> Option<Self> {
        match self.given {
            Given::Table(columns) => {
                let (_, given) = columns.all.iter().find(|(field, _)| field.name == key)?;
                Some(given.cell(self.entry))
            }
            _ => self
                .alternative()
                .filter(|(name, _)| *name == key)
                .map(|(_, cell)| cell),
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
                visitor.visit_seq(Numbers(numbers[first..first + length].iter(), *is_whole))
            }
            Given::Numbers(shape, numbers) => scalar(shape, numbers[self.entry], visitor),
            Given::Table(columns) => visitor.visit_map(Keys {
                rest: columns.all.iter(),
                entry: self.entry,
                value: None,
            }),
            Given::List(items) => visitor.visit_seq(Entries(self.items().iter(), &items.item)),
            Given::Union(_) => visitor.visit_map(Only(self.alternative(), None)),
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
        if let Given::Numbers(shape, _) = self.given {
            return visitor.visit_enum(name(shape, self.number()).into_deserializer());
        }
        visitor.visit_enum(self)
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
                visitor.visit_seq(Values(columns.all.iter(), self.entry))
            }
            _ => self.deserialize_any(visitor),
        }
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf unit
        unit_struct seq tuple tuple_struct map identifier ignored_any
    }
}

/// The name of a code.
fn name(shape: &Shape, code: Option<f64>) -> &str {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "whole numbers that are not negative"
    )]
    let number = code.unwrap_or_default() as usize;
    match shape {
        Shape::Code(names) => names.get(number).map_or("", String::as_str),
        _ => "",
    }
}

fn scalar<'de, V: Visitor<'de>>(shape: &Shape, number: f64, to: V) -> Result<V::Value, Error> {
    #[expect(clippy::cast_possible_truncation, reason = "whole numbers")]
    match shape {
        Shape::Integer => to.visit_i64(number as i64),
        Shape::Flag => to.visit_bool(number != 0.0),
        Shape::Code(_) => to.visit_str(name(shape, Some(number))),
        _ => to.visit_f64(number),
    }
}

/// The numbers of a vector, and whether they are whole.
struct Numbers<'g>(slice::Iter<'g, f64>, bool);

impl<'de> SeqAccess<'de> for Numbers<'_> {
    type Error = Error;

    fn next_element_seed<S: DeserializeSeed<'de>>(
        &mut self,
        seed: S,
    ) -> Result<Option<S::Value>, Error> {
        let Some(number) = self.0.next().copied() else {
            return Ok(None);
        };
        #[expect(clippy::cast_possible_truncation, reason = "whole numbers")]
        let value = if self.1 {
            seed.deserialize((number as i64).into_deserializer())
        } else {
            seed.deserialize(number.into_deserializer())
        };
        value.map(Some)
    }
}

/// The values of the first keys of an object.
struct Values<'g>(slice::Iter<'g, (&'static Field, Given)>, usize);

impl<'de> SeqAccess<'de> for Values<'de> {
    type Error = Error;

    fn next_element_seed<S: DeserializeSeed<'de>>(
        &mut self,
        seed: S,
    ) -> Result<Option<S::Value>, Error> {
        let column = self.0.next();
        let value = column.map(|(_, given)| seed.deserialize(given.cell(self.1)));
        value.transpose()
    }
}

/// The items of a list.
struct Entries<'g>(slice::Iter<'g, usize>, &'g Given);

impl<'de> SeqAccess<'de> for Entries<'de> {
    type Error = Error;

    fn next_element_seed<S: DeserializeSeed<'de>>(
        &mut self,
        seed: S,
    ) -> Result<Option<S::Value>, Error> {
        let entry = self.0.next();
        let value = entry.map(|entry| seed.deserialize(self.1.cell(*entry)));
        value.transpose()
    }
}

/// The keys of an object that have a value.
struct Keys<'g> {
    rest: slice::Iter<'g, (&'static Field, Given)>,
    entry: usize,
    value: Option<Cell<'g>>,
}

impl<'de> MapAccess<'de> for Keys<'de> {
    type Error = Error;

    fn next_key_seed<S: DeserializeSeed<'de>>(
        &mut self,
        seed: S,
    ) -> Result<Option<S::Value>, Error> {
        for (field, given) in self.rest.by_ref() {
            let cell = given.cell(self.entry);
            if field.is_required || !cell.is_missing() {
                self.value = Some(cell);
                let key: StrDeserializer<Error> = field.name.as_str().into_deserializer();
                return seed.deserialize(key).map(Some);
            }
        }
        Ok(None)
    }

    fn next_value_seed<S: DeserializeSeed<'de>>(&mut self, seed: S) -> Result<S::Value, Error> {
        let value = self.value.take();
        match value {
            Some(cell) => seed.deserialize(cell),
            None => seed.deserialize(().into_deserializer()),
        }
    }
}

/// The alternative of a union as the only key of an object.
struct Only<'g>(Option<(&'g str, Cell<'g>)>, Option<Cell<'g>>);

impl<'de> MapAccess<'de> for Only<'de> {
    type Error = Error;

    fn next_key_seed<S: DeserializeSeed<'de>>(
        &mut self,
        seed: S,
    ) -> Result<Option<S::Value>, Error> {
        let Some((name, cell)) = self.0.take() else {
            return Ok(None);
        };
        self.1 = Some(cell);
        let key: StrDeserializer<Error> = name.into_deserializer();
        seed.deserialize(key).map(Some)
    }

    fn next_value_seed<S: DeserializeSeed<'de>>(&mut self, seed: S) -> Result<S::Value, Error> {
        let value = self.1.take();
        match value {
            Some(cell) => seed.deserialize(cell),
            None => seed.deserialize(().into_deserializer()),
        }
    }
}

impl<'de> EnumAccess<'de> for Cell<'de> {
    type Error = Error;
    type Variant = Self;

    fn variant_seed<S: DeserializeSeed<'de>>(self, seed: S) -> Result<(S::Value, Self), Error> {
        let (name, content) = self.alternative().unwrap_or(("", self));
        let name: StrDeserializer<Error> = name.into_deserializer();
        Ok((seed.deserialize(name)?, content))
    }
}

impl<'de> VariantAccess<'de> for Cell<'de> {
    type Error = Error;

    fn unit_variant(self) -> Result<(), Error> {
        Ok(())
    }

    fn newtype_variant_seed<S: DeserializeSeed<'de>>(self, seed: S) -> Result<S::Value, Error> {
        seed.deserialize(self)
    }

    fn tuple_variant<V: Visitor<'de>>(self, _: usize, visitor: V) -> Result<V::Value, Error> {
        self.deserialize_any(visitor)
    }

    fn struct_variant<V: Visitor<'de>>(
        self,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        self.deserialize_any(visitor)
    }
}
