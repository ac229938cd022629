//! Reading scenarios from documents, and the files that they name.

use super::checked::Checked;
use super::checks;
use super::models;
use super::spec::{SCHEMA, ScenarioSpec};
use base::document::{Document, Files};
use base::error::{InputError, InputErrors, Problem};

impl ScenarioSpec {
    /// Reads [`ScenarioSpec::KEYS`], and nothing else.
    ///
    /// # Errors
    /// Everything that is wrong there. Where a value has the wrong type or is missing, its meaning is unknown, and only
    /// keys and values are checked; positions are checked once all keys and values are valid.
    pub fn read(document: &Document) -> Result<Checked, InputErrors> {
        let filled = Self::filled(document);
        let of_models = models::errors(document);
        let read = match Self::typed(&filled) {
            Ok(spec) if of_models.is_empty() => checks::checked(spec, &filled),
            Ok(_) => Err(InputErrors(of_models)),
            Err(InputErrors(errors)) => {
                let of_meaning = Self::of_meaning(&filled, &errors);
                Err(InputErrors([of_models, errors, of_meaning].concat()))
            }
        };
        read.map_err(|errors| models::at_models(errors, document))
    }

    /// Reads a document that is completed from its models. Keys that a model lacks are missing only where a robot
    /// kind needs them.
    fn typed(filled: &Document) -> Result<Self, InputErrors> {
        filled.typed_unless(&SCHEMA, |error| {
            error.problem == Problem::Missing && error.path.starts_with("models.")
        })
    }

    /// Errors of meaning in a document with other `errors`, as far as its values have the right types. A key that was
    /// misspelled is not missing as well.
    fn of_meaning(filled: &Document, errors: &[InputError]) -> Vec<InputError> {
        let spec: Result<Self, InputErrors> = filled.typed_unless(&SCHEMA, |_| true);
        let mut found = spec.map_or_else(|_| Vec::new(), |spec| checks::of_meaning(&spec, filled));
        found.retain(|error| !errors.iter().any(|known| explains(known, error)));
        found
    }

    /// The same for a document whose files `open` reads: it returns the bytes of a file by its
    /// name, or the reason why it cannot.
    ///
    /// # Errors
    /// As [`ScenarioSpec::read`].
    pub fn read_with(
        document: &Document,
        open: impl Fn(&str) -> Result<Vec<u8>, String>,
    ) -> Result<Checked, InputErrors> {
        let mut document = document.clone();
        let mut files = Files::new();
        // What has been read may name more files.
        loop {
            let wanted = Self::files(&document);
            if wanted.is_empty() {
                return Self::read(&document);
            }
            files.extend(wanted.into_iter().map(|name| (name.clone(), open(&name))));
            document = document.with_files(files.clone());
        }
    }

    /// The files that a document names and that have not been read.
    pub(crate) fn files(document: &Document) -> Vec<String> {
        let spec: Result<Self, InputErrors> = Self::typed(&Self::filled(document));
        spec.map_or_else(
            |_| Vec::new(),
            |spec| checks::missing_files(&spec, document),
        )
    }
}

/// Whether an error at the same place, or of a misspelled key, explains another one.
fn explains(known: &InputError, error: &InputError) -> bool {
    let meant = match (&known.problem, &known.suggestion) {
        (Problem::UnknownKey(_), Some(key)) => known
            .path
            .rsplit_once('.')
            .map(|(at, _)| format!("{at}.{key}")),
        _ => None,
    };
    meant.is_some_and(|path| path == error.path) || known.path == error.path
}
