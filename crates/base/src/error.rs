//! Errors of user input: what is wrong, what is allowed, and how to fix it.

use std::borrow::Cow;
use std::fmt;

/// Maximum length of a path or a value in a message, in characters.
const MAX_SHOWN: usize = 100;

/// Maximum length of an origin in a message, in characters: the path of a file should be whole.
const MAX_SHOWN_ORIGIN: usize = 300;

/// One error of user input: where it is, the value, and what is allowed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct InputError {
    /// The file or option that the value comes from: `scenario.toml:7`, `--contact`.
    pub origin: Option<String>,
    /// Path of the value: `robots.wanderer.count`, `start[2].x`. Empty for a whole document.
    pub path: String,
    /// What kind of error it is.
    pub problem: Problem,
    /// What is allowed, to follow "must be" or "expected"; a whole sentence if `path` is empty.
    pub allowed: String,
    /// The closest correct input.
    pub suggestion: Option<String>,
}

/// What kind of error it is, with the value as the user wrote it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Problem {
    /// The value is not allowed.
    NotAllowed(String),
    /// A required value is missing.
    Missing,
    /// The key of this value is not allowed.
    UnknownKey(String),
    /// A key, or a value, of an earlier version; `allowed` is its new name.
    Renamed(Option<String>),
}

impl InputError {
    /// A `value` at `path` that is not `allowed`, or a missing one.
    #[must_use]
    pub fn new(path: String, value: Option<String>, allowed: String) -> Self {
        Self {
            origin: None,
            path,
            problem: value.map_or(Problem::Missing, Problem::NotAllowed),
            allowed,
            suggestion: None,
        }
    }

    /// The value as the user wrote it; `None` if it is missing.
    #[must_use]
    pub fn value(&self) -> Option<&str> {
        match &self.problem {
            Problem::NotAllowed(value) | Problem::UnknownKey(value) => Some(value),
            Problem::Renamed(value) => value.as_deref(),
            Problem::Missing => None,
        }
    }

    /// A key at `path`, with its `value`, that is none of the `known` keys.
    pub fn unknown_key<'n>(
        path: String,
        key: &str,
        value: String,
        known: impl Iterator<Item = &'n str> + Clone,
    ) -> Self {
        let names: Vec<&str> = known.clone().collect();
        Self {
            problem: Problem::UnknownKey(value),
            suggestion: nearest(key, known).map(str::to_owned),
            ..Self::new(path, None, format!("one of {}", names.join(", ")))
        }
    }

    /// A key or value of an earlier version at `path`, whose `new` name is used now.
    #[must_use]
    pub fn renamed(path: String, value: Option<String>, new: String) -> Self {
        Self {
            problem: Problem::Renamed(value),
            ..Self::new(path, None, new)
        }
    }

    /// The file of the origin, and the line if there is one; `file` is the one that was read. `None`
    /// for an option.
    #[must_use]
    pub fn place(&self, file: &str) -> Option<(&str, Option<usize>)> {
        place_of(self.origin.as_deref()?, file)
    }

    /// A name that is none of `names`; `word` is the name without quotes, to find the closest one.
    pub fn not_one_of<'n>(
        path: String,
        value: Option<String>,
        word: &str,
        names: impl Iterator<Item = &'n str> + Clone,
    ) -> Self {
        let quoted: Vec<String> = names.clone().map(|name| format!("{name:?}")).collect();
        Self {
            suggestion: nearest(word, names).map(|name| format!("{name:?}")),
            ..Self::new(path, value, format!("one of {}", quoted.join(", ")))
        }
    }
}

impl fmt::Display for InputError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(origin) = &self.origin {
            write!(f, "{}: ", shown_origin(origin))?;
        }
        let (path, allowed) = (shortened(&self.path), &self.allowed);
        match &self.problem {
            _ if path.is_empty() => f.write_str(allowed)?,
            Problem::NotAllowed(value) => {
                write!(f, "{path} = {}: must be {allowed}", shortened(value))?;
            }
            Problem::Missing => write!(f, "{path} is missing: expected {allowed}")?,
            Problem::UnknownKey(_) => write!(f, "{path} is not a known key: expected {allowed}")?,
            Problem::Renamed(None) => write!(f, "{path} was renamed: use {allowed}")?,
            Problem::Renamed(Some(value)) => {
                write!(f, "{path} = {value} was renamed: use {allowed}")?;
            }
        }
        match &self.suggestion {
            Some(suggestion) => write!(f, "; did you mean {}?", shortened(suggestion)),
            None => Ok(()),
        }
    }
}

/// The file of an origin, and the line if there is one; `None` for an option.
pub(crate) fn place_of<'o>(origin: &'o str, file: &str) -> Option<(&'o str, Option<usize>)> {
    if origin == file {
        return Some((origin, None));
    }
    let (name, line) = origin.rsplit_once(':')?;
    line.parse().ok().map(|line| (name, Some(line)))
}

/// An origin as a message shows it.
pub(crate) fn shown_origin(origin: &str) -> String {
    cut(origin, MAX_SHOWN_ORIGIN).replace(char::is_control, "?")
}

/// A path or a value as a message shows it: a long one without its middle.
#[must_use]
pub fn shortened(text: &str) -> Cow<'_, str> {
    cut(text, MAX_SHOWN)
}

/// `text` with at most `max` characters: two thirds from its beginning, the others from its end.
fn cut(text: &str, max: usize) -> Cow<'_, str> {
    if text.chars().nth(max).is_none() {
        return text.into();
    }
    let last = max / 3;
    let head = text.char_indices().nth(max - last - "...".len());
    let tail = text.char_indices().nth_back(last - 1);
    let [head, tail] = [head, tail].map(|at| at.map_or(0, |(at, _)| at));
    format!("{}...{}", &text[..head], &text[tail..]).into()
}

/// All errors of an input, at least one; displayed one per line.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{}", .0.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n"))]
pub struct InputErrors(pub Vec<InputError>);

impl InputErrors {
    /// `value` if there are no errors, otherwise the errors.
    ///
    /// # Errors
    /// The errors, if there are any or if there is no value.
    pub fn or<T>(errors: Vec<InputError>, value: Option<T>) -> Result<T, Self> {
        match value {
            Some(value) if errors.is_empty() => Ok(value),
            _ => Err(Self(errors)),
        }
    }
}

/// The candidate with the most similar spelling to `word`, if any is similar enough.
///
/// A candidate that begins with `word` counts as one letter away: often only the unit is missing.
#[must_use]
pub fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let word = word.to_lowercase();
    let distance = |candidate: &str| {
        if word.len() >= MIN_STEM && candidate.starts_with(&word) {
            1
        } else {
            strsim::damerau_levenshtein(&word, candidate)
        }
    };
    // A word that is much longer cannot match, and comparing a megabyte would take long.
    let length = word.chars().count();
    let is_near = |candidate: &&str| length <= max_distance(candidate) + candidate.len();
    candidates
        .into_iter()
        .filter(is_near)
        .map(|candidate| (distance(&candidate.to_lowercase()), candidate))
        .filter(|(distance, candidate)| *distance <= max_distance(candidate))
        .min()
        .map(|(_, candidate)| candidate)
}

/// Maximum edit distance between a word and a candidate for it.
fn max_distance(candidate: &str) -> usize {
    1 + candidate.len() / 4
}

/// Minimum number of letters of a beginning that selects a candidate.
const MIN_STEM: usize = 3;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_is_a_file_and_perhaps_a_line_and_an_option_is_none() {
        let place = |origin: &str| {
            let error = InputError {
                origin: Some(origin.to_owned()),
                ..InputError::new(String::new(), None, String::new())
            };
            let place = error.place("a:b.toml");
            place.map(|(file, line)| (file.to_owned(), line))
        };
        assert_eq!(place("a:b.toml:7"), Some(("a:b.toml".to_owned(), Some(7))));
        assert_eq!(place("a:b.toml"), Some(("a:b.toml".to_owned(), None)));
        assert_eq!(place("map.yaml:2"), Some(("map.yaml".to_owned(), Some(2))));
        assert_eq!(place("--set clock.time_limit_s"), None);
    }

    #[test]
    fn a_megabyte_is_shown_by_its_ends() {
        let long = "ö".repeat(1 << 20);
        let (path, value) = (format!("robots.{long}.count"), format!("\"{long}\""));
        let error = InputError {
            origin: Some(format!("--set {path}")),
            suggestion: nearest(&long, ["rover", "ö"]).map(str::to_owned),
            ..InputError::new(path.clone(), Some(value), "a number".to_owned())
        };
        let message = error.to_string();
        assert!(message.chars().count() < 600, "{message}");
        for part in [
            "--set robots.ö",
            "ö...ö",
            "ö.count = \"ö",
            "ö\": must be a number",
        ] {
            assert!(message.contains(part), "{part}\nnot in\n{message}");
        }
        assert_eq!(error.path, path);
        assert_eq!(error.suggestion, None);
    }

    #[test]
    fn what_controls_a_terminal_is_not_printed() {
        let error = InputError {
            origin: Some("--set robots.\u{1b}[31mred\n".to_owned()),
            ..InputError::new("robots".to_owned(), None, "there".to_owned())
        };
        assert!(!error.to_string().contains(char::is_control));
    }

    #[test]
    fn what_is_short_is_shown_whole() {
        let [whole, long] = [MAX_SHOWN, MAX_SHOWN + 1].map(|length| "x".repeat(length));
        assert_eq!(shortened(&whole), whole);
        assert_eq!(shortened(&long).chars().count(), MAX_SHOWN);
    }

    #[test]
    fn nearest_finds_a_word_whose_unit_was_left_out() {
        assert_eq!(nearest("radius", ["radio", "radius_m"]), Some("radius_m"));
        let keys = ["max_speed_m_s", "max_turn_rate_deg_s"];
        assert_eq!(nearest("max_turn_rate", keys), Some(keys[1]));
        assert_eq!(nearest("m", keys), None);
    }

    #[test]
    fn nearest_finds_a_slip_of_the_finger_and_nothing_far_away() {
        assert_eq!(nearest("tuoch", ["neighbour", "touch"]), Some("touch"));
        assert_eq!(nearest("TOUCH", ["neighbour", "touch"]), Some("touch"));
        assert_eq!(nearest("sonar", ["neighbour", "touch"]), None);
    }
}
