//! Parses plain YAML into nodes with their lines.

use super::node::{Node, Table, Value};
use crate::error::{InputError, InputErrors};
use granit_parser::{Event, Parser, ScalarStyle, ScanError, Span, options};

/// Maximum length of a document, in bytes.
const MAX_BYTES: usize = 1 << 16;

/// Maximum nesting depth of mappings and lists.
const MAX_DEPTH: usize = 8;

/// Reads `text`, or reports what is not plain YAML in it.
pub(super) fn parse(file: &str, text: &str) -> Result<Node, InputErrors> {
    if text.len() > MAX_BYTES {
        let allowed = format!("a file of at most {MAX_BYTES} bytes; it has {}", text.len());
        let error = InputError::new(String::new(), None, allowed);
        let origin = Some(file.to_owned());
        return Err(InputErrors(vec![InputError { origin, ..error }]));
    }
    let options = options! {
        flow_nesting_limit: MAX_DEPTH,
        block_nesting_limit: MAX_DEPTH,
        emit_comments: false,
    };
    let mut reader = Reader {
        file,
        events: Parser::new_from_str_with_options(text, options),
        errors: Vec::new(),
    };
    let root = reader.root();
    let Reader { mut errors, .. } = reader;
    let root = root.map_err(|stop| errors.push(stop)).ok();
    InputErrors::or(errors, root)
}

struct Reader<'t, I> {
    file: &'t str,
    events: I,
    /// Errors that do not stop the parser.
    errors: Vec<InputError>,
}

impl<'t, I> Reader<'t, I>
where
    I: Iterator<Item = Result<(Event<'t>, Span), ScanError>>,
{
    /// The root mapping; empty for an empty text.
    fn root(&mut self) -> Result<Node, InputError> {
        let mut root = None;
        loop {
            match self.next()? {
                (Event::StreamStart | Event::DocumentStart(..) | Event::DocumentEnd, _) => (),
                (Event::StreamEnd, _) => break,
                (_, span) if root.is_some() => {
                    return Err(self.error(&span, "one YAML document, not several"));
                }
                (event, span) => root = Some(self.node(event, &span, MAX_DEPTH)?),
            }
        }
        let origin = self.file.to_owned();
        match root.map(|root| root.value) {
            None => Ok(Value::Table(Table::new())),
            Some(Value::Table(table)) => Ok(Value::Table(table)),
            Some(_) => Err(InputError {
                origin: Some(origin.clone()),
                ..InputError::new(
                    String::new(),
                    None,
                    "not a YAML mapping of keys to values".into(),
                )
            }),
        }
        .map(|value| Node { value, origin })
    }

    fn next(&mut self) -> Result<(Event<'t>, Span), InputError> {
        match self.events.next() {
            Some(Ok(event)) => Ok(event),
            Some(Err(error)) => Err(self.error_at_line(
                error.marker().line(),
                &format!("not valid YAML: {}", error.info()),
            )),
            None => Err(self.error_at_line(1, "not valid YAML: it ends too early")),
        }
    }

    fn node(&mut self, event: Event<'t>, span: &Span, levels: usize) -> Result<Node, InputError> {
        if levels == 0 {
            return Err(self.error(span, "a document with fewer levels"));
        }
        let value = match event {
            Event::Scalar(text, style, _, None) => scalar(&text, style),
            Event::SequenceStart(_, _, None) => self.list(levels - 1)?,
            Event::MappingStart(_, _, None) => self.table(levels - 1)?,
            Event::Alias(_) => return Err(self.error(span, "a document without aliases (*name)")),
            _ => return Err(self.error(span, "a document without tags (!name)")),
        };
        let origin = self.origin(span);
        Ok(Node { value, origin })
    }

    fn list(&mut self, levels: usize) -> Result<Value, InputError> {
        let mut items = Vec::new();
        loop {
            match self.next()? {
                (Event::SequenceEnd, _) => return Ok(Value::List(items)),
                (event, span) => items.push(self.node(event, &span, levels)?),
            }
        }
    }

    fn table(&mut self, levels: usize) -> Result<Value, InputError> {
        let mut table = Table::new();
        loop {
            let (event, span) = self.next()?;
            let key = match event {
                Event::MappingEnd => return Ok(Value::Table(table)),
                Event::Scalar(text, _, _, None) => text.into_owned(),
                _ => return Err(self.error(&span, "a document whose keys are plain names")),
            };
            let (event, value_span) = self.next()?;
            // A key's line is the value's, as in TOML.
            let origin = self.origin(&span);
            let value = Node {
                origin,
                ..self.node(event, &value_span, levels)?
            };
            if table.contains_key(&key) {
                let error = self.error(&span, &format!("a document with {key:?} only once"));
                self.errors.push(error);
            }
            table.insert(key, value);
        }
    }

    fn origin(&self, span: &Span) -> String {
        format!("{}:{}", self.file, span.start.line())
    }

    fn error(&self, span: &Span, allowed: &str) -> InputError {
        self.error_at_line(span.start.line(), &format!("must be {allowed}"))
    }

    fn error_at_line(&self, line: usize, sentence: &str) -> InputError {
        InputError {
            origin: Some(format!("{}:{line}", self.file)),
            ..InputError::new(String::new(), None, sentence.to_owned())
        }
    }
}

/// A value by the rules of YAML 1.2's core schema, but for octal and hexadecimal numbers.
fn scalar(text: &str, style: ScalarStyle) -> Value {
    let as_text = || Value::Text(text.to_owned());
    if style != ScalarStyle::Plain {
        return as_text();
    }
    match text {
        "true" | "True" | "TRUE" => return Value::Bool(true),
        "false" | "False" | "FALSE" => return Value::Bool(false),
        ".nan" | ".NaN" | ".NAN" => return Value::Float(f64::NAN),
        _ => (),
    }
    if let Some(".inf" | ".Inf" | ".INF") = text.strip_prefix(['+', '-']).or(Some(text)) {
        let infinity = f64::INFINITY;
        return Value::Float(infinity.copysign(if text.starts_with('-') { -1.0 } else { 1.0 }));
    }
    // Rust's numbers also have names: `inf`, `nan`.
    let is_number = |c: char| c.is_ascii_digit() || "+-.eE".contains(c);
    if !text.chars().all(is_number) {
        return as_text();
    }
    let integer = text.parse().map(Value::Integer);
    integer
        .or_else(|_| text.parse().map(Value::Float))
        .unwrap_or_else(|_| as_text())
}
