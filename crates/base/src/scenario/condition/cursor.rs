//! The tokens of a condition, and errors with their positions.

/// What is wrong first with the text of a condition, as [`crate::document::Section::error_for`] takes it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ConditionError {
    /// What is allowed, to follow "must be".
    pub allowed: String,
    /// The corrected condition, quoted.
    pub suggestion: Option<String>,
}

/// Reads a condition token by token.
pub(super) struct Cursor<'t> {
    text: &'t str,
    /// What is not read yet.
    rest: &'t str,
}

/// Successive characters of the text; empty if the first one there is of another kind.
#[derive(Clone, Copy)]
pub(super) struct Token<'t> {
    pub(super) text: &'t str,
    /// Where it begins, in bytes.
    start: usize,
}

impl<'t> Cursor<'t> {
    pub(super) fn new(text: &'t str) -> Self {
        Self { text, rest: text }
    }

    /// Skips white space, and takes all characters up to the first that is not `in_token`.
    pub(super) fn take(&mut self, in_token: impl Fn(char) -> bool) -> Token<'t> {
        let rest = self.rest.trim_start();
        let start = self.text.len() - rest.len();
        let length = rest.find(|c| !in_token(c)).unwrap_or(rest.len());
        let (text, rest) = rest.split_at(length);
        self.rest = rest;
        Token { text, start }
    }

    /// Takes one character.
    pub(super) fn expect(&mut self, wanted: char) -> Result<(), ConditionError> {
        let next = self.take(|_| false);
        let rest = self.rest.strip_prefix(wanted);
        self.rest = rest.ok_or_else(|| self.error_at(next, &format!("{wanted:?}"), None))?;
        Ok(())
    }

    /// Checks that nothing is left.
    pub(super) fn expect_end(&mut self) -> Result<(), ConditionError> {
        let next = self.take(|_| false);
        if self.rest.is_empty() {
            return Ok(());
        }
        let expected = "nothing more: a condition is one comparison";
        Err(self.error_at(next, expected, None))
    }

    /// The error of a token that is not what was `expected`; `instead` of it, another would be right.
    pub(super) fn error_at(
        &self,
        token: Token,
        expected: &str,
        instead: Option<&str>,
    ) -> ConditionError {
        let (before, rest) = self.text.split_at(token.start);
        let after = &rest[token.text.len()..];
        let place = if rest.is_empty() {
            "the end".to_owned()
        } else {
            format!("character {}", before.chars().count() + 1)
        };
        ConditionError {
            allowed: format!("a condition, such as \"found >= 3\"; expected {expected} at {place}"),
            suggestion: instead.map(|instead| format!("{:?}", [before, instead, after].concat())),
        }
    }
}
