//! What is wrong with something a person wrote, in words that tell how to mend it.

use std::borrow::Cow;
use std::fmt;

/// Characters of a path or a value that a message shows.
const SHOWN: usize = 100;

/// Characters of an origin that a message shows: a file's path should be whole.
const SHOWN_OF_ORIGIN: usize = 300;

/// One thing that is wrong: where, what was given, what is allowed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct InputError {
    /// Where it stands, when it stands in a file or an option: `scenario.toml:7`, `--contact`.
    pub origin: Option<String>,
    /// Path of the value: `robots.wanderer.count`, `start[2].x`. Empty for a whole document.
    pub path: String,
    /// What was given, as the person would write it; `None` when it is missing.
    pub given: Option<String>,
    /// What is allowed, as the end of "must be ..." ; a whole sentence if `path` is empty.
    pub allowed: String,
    /// The nearest thing that would be right.
    pub suggestion: Option<String>,
}

impl InputError {
    /// What was `given` at `path`, or is missing there, is not what is `allowed`.
    #[must_use]
    pub fn new(path: String, given: Option<String>, allowed: String) -> Self {
        Self {
            origin: None,
            path,
            given,
            allowed,
            suggestion: None,
        }
    }

    /// The file in which it stands, and the line if it is told; `file` is the one that was read.
    #[must_use]
    pub fn place(&self, file: &str) -> Option<(&str, Option<usize>)> {
        let origin = self.origin.as_deref()?;
        if origin == file {
            return Some((origin, None));
        }
        let (name, line) = origin.rsplit_once(':')?;
        line.parse().ok().map(|line| (name, Some(line)))
    }

    /// A name that is none of `names`; `word` is its bare text, to find the one that was meant.
    pub fn not_one_of<'n>(
        path: String,
        given: Option<String>,
        word: &str,
        names: impl Iterator<Item = &'n str> + Clone,
    ) -> Self {
        let quoted: Vec<String> = names.clone().map(|name| format!("{name:?}")).collect();
        Self {
            suggestion: nearest(word, names).map(|name| format!("{name:?}")),
            ..Self::new(path, given, format!("one of {}", quoted.join(", ")))
        }
    }
}

impl fmt::Display for InputError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(origin) = &self.origin {
            let origin = cut(origin, SHOWN_OF_ORIGIN);
            write!(f, "{}: ", origin.replace(char::is_control, "?"))?;
        }
        let (path, allowed) = (shortened(&self.path), &self.allowed);
        match self.given.as_deref().map(shortened) {
            _ if path.is_empty() => f.write_str(allowed)?,
            Some(given) => write!(f, "{path} = {given}: must be {allowed}")?,
            None => write!(f, "{path} is missing: must be {allowed}")?,
        }
        match &self.suggestion {
            Some(suggestion) => write!(f, "; did you mean {}?", shortened(suggestion)),
            None => Ok(()),
        }
    }
}

/// A path or a value as a message shows it: a long one without its middle.
#[must_use]
pub fn shortened(text: &str) -> Cow<'_, str> {
    cut(text, SHOWN)
}

/// At most so many characters of a `text`: two thirds of them its first, the others its last.
fn cut(text: &str, most: usize) -> Cow<'_, str> {
    if text.chars().nth(most).is_none() {
        return text.into();
    }
    let last = most / 3;
    let head = text.char_indices().nth(most - last - "...".len());
    let tail = text.char_indices().nth_back(last - 1);
    let [head, tail] = [head, tail].map(|at| at.map_or(0, |(at, _)| at));
    format!("{}...{}", &text[..head], &text[tail..]).into()
}

/// Everything that is wrong, at least one error; shown one a line.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{}", .0.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n"))]
pub struct InputErrors(pub Vec<InputError>);

impl InputErrors {
    /// `value` if nothing is wrong, else the errors.
    ///
    /// # Errors
    /// The errors, when there are any or when there is no value.
    pub fn or<T>(errors: Vec<InputError>, value: Option<T>) -> Result<T, Self> {
        match value {
            Some(value) if errors.is_empty() => Ok(value),
            _ => Err(Self(errors)),
        }
    }
}

/// The candidate spelled most like `word`, if one is near enough to be meant.
///
/// One that only goes on where `word` ends is as near as can be: often the unit was left out.
#[must_use]
pub fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let word = word.to_lowercase();
    let distance = |candidate: &str| {
        if word.len() >= LEAST_STEM && candidate.starts_with(&word) {
            1
        } else {
            strsim::damerau_levenshtein(&word, candidate)
        }
    };
    // What is so much longer is no slip of it, and a megabyte would take long to compare.
    let length = word.chars().count();
    let is_near = |candidate: &&str| length <= most_slips(candidate) + candidate.len();
    candidates
        .into_iter()
        .filter(is_near)
        .map(|candidate| (distance(&candidate.to_lowercase()), candidate))
        .filter(|(distance, candidate)| *distance <= most_slips(candidate))
        .min()
        .map(|(_, candidate)| candidate)
}

/// Letters in which a word may differ from a candidate that is meant.
fn most_slips(candidate: &str) -> usize {
    1 + candidate.len() / 4
}

/// Letters from which on a beginning says which word is meant.
const LEAST_STEM: usize = 3;

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
        let (path, given) = (format!("robots.{long}.count"), format!("\"{long}\""));
        let error = InputError {
            origin: Some(format!("--set {path}")),
            suggestion: nearest(&long, ["rover", "ö"]).map(str::to_owned),
            ..InputError::new(path.clone(), Some(given), "a number".to_owned())
        };
        let told = error.to_string();
        assert!(told.chars().count() < 600, "{told}");
        for part in [
            "--set robots.ö",
            "ö...ö",
            "ö.count = \"ö",
            "ö\": must be a number",
        ] {
            assert!(told.contains(part), "{part}\nnot in\n{told}");
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
        let [most, more] = [SHOWN, SHOWN + 1].map(|length| "x".repeat(length));
        assert_eq!(shortened(&most), most);
        assert_eq!(shortened(&more).chars().count(), SHOWN);
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
