//! Writes values to columns.

use super::column::{Column, Data};
use super::shape::{Field, Shape};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use serde::Serialize;
use serde::ser::{self, Impossible, SerializeSeq, SerializeStruct, SerializeTuple};
use std::fmt::Display;
use std::slice;

/// The column of some values.
pub(crate) fn write<'v, T: Serialize + 'v>(
    shape: &'static Shape,
    values: impl ExactSizeIterator<Item = &'v T>,
) -> PyResult<Column> {
    let mut column = Column::new(shape, values.len());
    for (entry, value) in (0..).zip(values) {
        let written = value.serialize(Writer::new(&mut column, entry));
        written.map_err(|Mismatch(what)| PyRuntimeError::new_err(what))?;
    }
    Ok(column)
}

/// A type that is not as its schema describes it.
#[derive(Debug)]
struct Mismatch(String);

impl Mismatch {
    fn of<T>(what: &str) -> Result<T, Self> {
        Err(Self(format!("no column of a schema takes {what}")))
    }
}

impl Display for Mismatch {
    fn fmt(&self, to: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        to.write_str(&self.0)
    }
}

impl std::error::Error for Mismatch {}

impl ser::Error for Mismatch {
    fn custom<T: Display>(what: T) -> Self {
        Self(what.to_string())
    }
}

/// Writes one value to a column.
struct Writer<'c> {
    column: &'c mut Column,
    /// The number of the item, in the list it is in, that the value belongs to.
    entry: i64,
}

impl<'c> Writer<'c> {
    fn new(column: &'c mut Column, entry: i64) -> Self {
        Self { column, entry }
    }

    #[inline]
    fn number(self, number: f64) -> Result<(), Mismatch> {
        match &mut self.column.data {
            Data::Numbers(numbers) => numbers.push(number),
            _ => return Mismatch::of("a number"),
        }
        Ok(())
    }

    #[inline]
    fn integer(self, number: i64) -> Result<(), Mismatch> {
        match &mut self.column.data {
            Data::Integers(integers) => integers.push(number),
            _ => return Mismatch::of("an integer"),
        }
        Ok(())
    }

    /// An object with a number of keys.
    fn table(self, keys: usize) -> Result<TableWriter<'c>, Mismatch> {
        let fields = self.column.shape.fields();
        match &mut self.column.data {
            Data::Table(columns) => Ok(TableWriter {
                has_all: keys == columns.len(),
                columns: columns.iter_mut(),
                fields: fields.iter(),
                entry: self.entry,
            }),
            _ => Mismatch::of("an object"),
        }
    }
}

/// Methods of a serializer for whole numbers.
macro_rules! integers {
    ($($method:ident $type:ty,)+) => {
        $(fn $method(self, number: $type) -> Result<(), Mismatch> {
            self.integer(number.into())
        })+
    };
}

impl<'c> ser::Serializer for Writer<'c> {
    type Ok = ();
    type Error = Mismatch;
    type SerializeSeq = ItemWriter<'c>;
    type SerializeTuple = ItemWriter<'c>;
    type SerializeTupleStruct = Impossible<(), Mismatch>;
    type SerializeTupleVariant = Impossible<(), Mismatch>;
    type SerializeMap = Impossible<(), Mismatch>;
    type SerializeStruct = TableWriter<'c>;
    type SerializeStructVariant = Impossible<(), Mismatch>;

    integers! {
        serialize_i8 i8, serialize_i16 i16, serialize_i32 i32, serialize_i64 i64,
        serialize_u8 u8, serialize_u16 u16, serialize_u32 u32,
    }

    fn serialize_u64(self, number: u64) -> Result<(), Mismatch> {
        self.integer(i64::try_from(number).unwrap_or(i64::MAX))
    }

    fn serialize_f32(self, number: f32) -> Result<(), Mismatch> {
        self.number(number.into())
    }

    fn serialize_f64(self, number: f64) -> Result<(), Mismatch> {
        self.number(number)
    }

    fn serialize_bool(self, flag: bool) -> Result<(), Mismatch> {
        match &mut self.column.data {
            Data::Flags(flags) => flags.push(flag),
            _ => return Mismatch::of("a boolean"),
        }
        Ok(())
    }

    fn serialize_none(self) -> Result<(), Mismatch> {
        self.column.skip();
        Ok(())
    }

    fn serialize_some<T: ?Sized + Serialize>(self, value: &T) -> Result<(), Mismatch> {
        value.serialize(self)
    }

    fn serialize_newtype_struct<T: ?Sized + Serialize>(
        self,
        _: &'static str,
        value: &T,
    ) -> Result<(), Mismatch> {
        value.serialize(self)
    }

    fn serialize_unit_variant(
        self,
        _: &'static str,
        number: u32,
        _: &'static str,
    ) -> Result<(), Mismatch> {
        self.integer(number.into())
    }

    fn serialize_newtype_variant<T: ?Sized + Serialize>(
        self,
        _: &'static str,
        _: u32,
        name: &'static str,
        _: &T,
    ) -> Result<(), Mismatch> {
        Mismatch::of(name)
    }

    fn serialize_struct_variant(
        self,
        _: &'static str,
        _: u32,
        name: &'static str,
        _: usize,
    ) -> Result<Impossible<(), Mismatch>, Mismatch> {
        Mismatch::of(name)
    }

    fn serialize_struct(self, _: &'static str, keys: usize) -> Result<TableWriter<'c>, Mismatch> {
        self.table(keys)
    }

    fn serialize_seq(self, _: Option<usize>) -> Result<ItemWriter<'c>, Mismatch> {
        Ok(ItemWriter(self))
    }

    fn serialize_tuple(self, _: usize) -> Result<ItemWriter<'c>, Mismatch> {
        Ok(ItemWriter(self))
    }

    fn serialize_char(self, _: char) -> Result<(), Mismatch> {
        Mismatch::of("a character")
    }

    fn serialize_str(self, _: &str) -> Result<(), Mismatch> {
        Mismatch::of("a string")
    }

    fn serialize_bytes(self, _: &[u8]) -> Result<(), Mismatch> {
        Mismatch::of("bytes")
    }

    fn serialize_unit(self) -> Result<(), Mismatch> {
        Mismatch::of("nothing")
    }

    fn serialize_unit_struct(self, name: &'static str) -> Result<(), Mismatch> {
        Mismatch::of(name)
    }

    fn serialize_tuple_struct(
        self,
        name: &'static str,
        _: usize,
    ) -> Result<Impossible<(), Mismatch>, Mismatch> {
        Mismatch::of(name)
    }

    fn serialize_tuple_variant(
        self,
        _: &'static str,
        _: u32,
        name: &'static str,
        _: usize,
    ) -> Result<Impossible<(), Mismatch>, Mismatch> {
        Mismatch::of(name)
    }

    fn serialize_map(self, _: Option<usize>) -> Result<Impossible<(), Mismatch>, Mismatch> {
        Mismatch::of("a map")
    }
}

/// Writes the items of a list, or the numbers of a vector.
struct ItemWriter<'c>(Writer<'c>);

impl ItemWriter<'_> {
    fn item<T: ?Sized + Serialize>(&mut self, item: &T) -> Result<(), Mismatch> {
        let Writer { column, entry } = &mut self.0;
        match &mut column.data {
            Data::List(rows, items) => {
                let number = i64::try_from(rows.len()).unwrap_or(i64::MAX);
                rows.push(*entry);
                item.serialize(Writer::new(items, number))
            }
            _ => item.serialize(Writer::new(column, *entry)),
        }
    }
}

impl SerializeSeq for ItemWriter<'_> {
    type Ok = ();
    type Error = Mismatch;

    fn serialize_element<T: ?Sized + Serialize>(&mut self, item: &T) -> Result<(), Mismatch> {
        self.item(item)
    }

    fn end(self) -> Result<(), Mismatch> {
        Ok(())
    }
}

impl SerializeTuple for ItemWriter<'_> {
    type Ok = ();
    type Error = Mismatch;

    fn serialize_element<T: ?Sized + Serialize>(&mut self, item: &T) -> Result<(), Mismatch> {
        self.item(item)
    }

    fn end(self) -> Result<(), Mismatch> {
        Ok(())
    }
}

/// Writes the values of an object. Its keys come in the order of the schema; some may be missing.
struct TableWriter<'c> {
    /// The columns that are left, and their names.
    columns: slice::IterMut<'c, Column>,
    fields: slice::Iter<'static, Field>,
    /// Whether no key is missing: names need not be compared.
    has_all: bool,
    entry: i64,
}

impl TableWriter<'_> {
    #[inline]
    fn field<T: ?Sized + Serialize>(
        &mut self,
        name: &'static str,
        value: &T,
    ) -> Result<(), Mismatch> {
        let entry = self.entry;
        let column = if self.has_all {
            self.columns.next()
        } else {
            self.named(name)
        };
        match column {
            Some(column) if matches!(column.data, Data::Omitted) => Ok(()),
            Some(column) => value.serialize(Writer::new(column, entry)),
            None => Mismatch::of(name),
        }
    }

    /// The column of a name; those before it have no value.
    fn named(&mut self, name: &str) -> Option<&mut Column> {
        let before = self.fields.position(|field| field.name == name)?;
        let skipped = self.columns.by_ref().take(before);
        skipped.for_each(Column::skip);
        self.columns.next()
    }

    fn end(self) {
        self.columns.for_each(Column::skip);
    }
}

impl SerializeStruct for TableWriter<'_> {
    type Ok = ();
    type Error = Mismatch;

    fn serialize_field<T: ?Sized + Serialize>(
        &mut self,
        name: &'static str,
        value: &T,
    ) -> Result<(), Mismatch> {
        self.field(name, value)
    }

    fn end(self) -> Result<(), Mismatch> {
        self.end();
        Ok(())
    }
}
