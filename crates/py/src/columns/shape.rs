//! The columns that a type has, by its schema.

use schemars::JsonSchema;
use serde_json::{Map, Value as Json};

/// The columns of a type.
pub(crate) enum Shape {
    Number,
    Integer,
    Flag,
    /// One of some names, by its number.
    Code(Vec<String>),
    /// A list of a fixed length of numbers, which are all whole or may be any.
    Vector {
        length: usize,
        is_whole: bool,
    },
    Table(Vec<Field>),
    List(Box<Shape>),
    /// Without columns.
    Omitted,
}

/// A key of an object.
pub(crate) struct Field {
    pub(crate) name: String,
    pub(crate) shape: Shape,
    pub(crate) is_required: bool,
    /// Whether it may have no value.
    pub(super) is_nullable: bool,
}

impl Shape {
    /// The columns of a type, without those of some of its keys.
    pub(crate) fn of<T: JsonSchema>(omitted: &[&str]) -> Self {
        let schema = schemars::schema_for!(T).to_value();
        let definitions = schema.get("$defs").cloned().unwrap_or_default();
        let mut shape = Definitions(&definitions).shape(&schema);
        if let Self::Table(fields) = &mut shape {
            let hidden = fields.iter_mut();
            hidden
                .filter(|field| omitted.contains(&field.name.as_str()))
                .for_each(|field| field.shape = Self::Omitted);
        }
        shape
    }

    /// The keys of a table.
    pub(super) fn fields(&self) -> &[Field] {
        match self {
            Self::Table(fields) => fields,
            _ => &[],
        }
    }
}

/// The definitions to which a schema refers.
struct Definitions<'s>(&'s Json);

impl Definitions<'_> {
    fn shape(&self, schema: &Json) -> Shape {
        let name = schema.get("$ref").and_then(Json::as_str);
        if let Some(name) = name.and_then(|path| path.rsplit('/').next()) {
            return self.0.get(name).map_or(Shape::Omitted, |it| self.shape(it));
        }
        let one_of = ["oneOf", "anyOf"].map(|key| schema.get(key).and_then(Json::as_array));
        if let Some(parts) = one_of.into_iter().flatten().next() {
            return self.alternatives(parts);
        }
        if let Some(names) = schema.get("enum").and_then(Json::as_array) {
            return Shape::Code(names.iter().filter_map(text).collect());
        }
        match kind(schema) {
            Some("number") => Shape::Number,
            Some("integer") => Shape::Integer,
            Some("boolean") => Shape::Flag,
            Some("array") => self.list(schema),
            Some("object") => self.table(schema),
            _ => Shape::Omitted,
        }
    }

    /// An optional value, or an enumeration.
    fn alternatives(&self, parts: &[Json]) -> Shape {
        let is_null = |part: &&Json| kind(part) == Some("null");
        if let [only] = parts
            .iter()
            .filter(|part| !is_null(part))
            .collect::<Vec<_>>()[..]
        {
            return self.shape(only);
        }
        let names = parts.iter().map(|part| text(part.get("const")?));
        let names: Option<Vec<String>> = names.collect();
        names.map_or(Shape::Omitted, Shape::Code)
    }

    fn list(&self, schema: &Json) -> Shape {
        let count = |key: &str| schema.get(key).and_then(Json::as_u64);
        let prefix = schema.get("prefixItems").and_then(Json::as_array);
        let items = prefix
            .and_then(|items| items.first())
            .or(schema.get("items"));
        let item = items.map_or(Shape::Omitted, |items| self.shape(items));
        let length = count("maxItems").filter(|length| count("minItems") == Some(*length));
        match (
            length.and_then(|length| usize::try_from(length).ok()),
            &item,
        ) {
            (Some(length), Shape::Number | Shape::Integer) => Shape::Vector {
                length,
                is_whole: matches!(item, Shape::Integer),
            },
            _ => Shape::List(Box::new(item)),
        }
    }

    fn table(&self, schema: &Json) -> Shape {
        let required = schema.get("required").and_then(Json::as_array);
        let is_required =
            |name: &str| required.is_some_and(|names| names.iter().any(|each| each == name));
        let none = Map::new();
        let properties = schema.get("properties").and_then(Json::as_object);
        let fields = properties.unwrap_or(&none).iter();
        let fields = fields.map(|(name, it)| Field {
            name: name.clone(),
            shape: self.shape(it),
            is_required: is_required(name),
            is_nullable: is_nullable(it),
        });
        Shape::Table(fields.collect())
    }
}

fn is_nullable(schema: &Json) -> bool {
    let kinds = ["type", "anyOf"].map(|key| schema.get(key).and_then(Json::as_array));
    let is_null = |kind: &Json| kind == "null" || kind.get("type").is_some_and(|it| it == "null");
    kinds.into_iter().flatten().flatten().any(is_null)
}

/// The type of a schema that is not null.
fn kind(schema: &Json) -> Option<&str> {
    match schema.get("type")? {
        Json::String(kind) => Some(kind),
        Json::Array(kinds) => kinds
            .iter()
            .filter_map(Json::as_str)
            .find(|kind| *kind != "null"),
        _ => None,
    }
}

fn text(json: &Json) -> Option<String> {
    json.as_str().map(str::to_owned)
}
