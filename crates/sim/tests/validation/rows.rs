//! What was measured, beside what it should be.

use std::fmt::Write;
use std::path::PathBuf;

/// A normal number is farther than so many standard deviations from its mean once in 26 million, a
/// mean over 40 runs, by Student's law, than so many standard errors once in 400,000. So of a right
/// simulator each check here fails for less than one seed in 10,000. The seeds are fixed.
pub(crate) const SIGMAS: f64 = 5.5;

/// One number that was measured.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Row {
    pub(crate) series: String,
    pub(crate) x: f64,
    pub(crate) measured: f64,
    /// Its standard error; 0 if chance has no part in it.
    pub(crate) error: f64,
    /// By the closed form, if there is one.
    pub(crate) expected: Option<f64>,
}

impl Row {
    /// How many of so many, each with a probability.
    pub(crate) fn share(series: &str, x: f64, count: u32, of: u32, expected: f64) -> Self {
        let of = f64::from(of);
        Self {
            series: series.to_owned(),
            x,
            measured: f64::from(count) / of,
            error: (expected * (1.0 - expected) / of).sqrt(),
            expected: Some(expected),
        }
    }

    /// The mean of independent numbers.
    pub(crate) fn mean(series: &str, x: f64, values: &[f64], expected: Option<f64>) -> Self {
        let count = count(values);
        let mean = values.iter().sum::<f64>() / count;
        let squares = values.iter().map(|value| (value - mean) * (value - mean));
        Self {
            series: series.to_owned(),
            x,
            measured: mean,
            error: (squares.sum::<f64>() / (count - 1.0) / count).sqrt(),
            expected,
        }
    }

    /// A number in which chance has no part.
    pub(crate) fn exact(series: &str, x: f64, measured: f64, expected: f64) -> Self {
        Self {
            series: series.to_owned(),
            x,
            measured,
            error: 0.0,
            expected: Some(expected),
        }
    }

    /// Standard errors from what it should be.
    pub(crate) fn sigmas(&self) -> f64 {
        let off = self.expected.map_or(0.0, |value| self.measured - value);
        if off == 0.0 { 0.0 } else { off / self.error }
    }
}

#[expect(clippy::cast_precision_loss, reason = "counts are small")]
fn count(values: &[f64]) -> f64 {
    values.len() as f64
}

/// The rows that are too far from what they should be for chance.
pub(crate) fn misses(rows: &[Row]) -> Vec<&Row> {
    let is_miss = |row: &&Row| row.sigmas().abs() > SIGMAS;
    rows.iter().filter(is_miss).collect()
}

/// No row is farther from the closed form than chance allows.
pub(crate) fn assert_right(rows: &[Row]) {
    let misses = misses(rows);
    assert!(misses.is_empty(), "{misses:#?}");
}

/// The same check tells a wrong simulator from a right one.
pub(crate) fn assert_wrong(rows: &[Row]) {
    let most = rows
        .iter()
        .map(|row| row.sigmas().abs())
        .fold(0.0, f64::max);
    assert!(most > SIGMAS, "at most {most} standard errors off");
}

/// The file behind the page says the same; with `RENEW_VALIDATION=1` it is written.
pub(crate) fn assert_published(name: &str, rows: &[Row]) {
    let text = written(rows);
    let published = written_anew(name, || text.clone());
    assert!(
        published == text,
        "docs/validation/{name} is not what the simulator gives: `make validation` renews it"
    );
}

/// What a file behind the page says; with `RENEW_VALIDATION=1` it is made and written first.
pub(crate) fn written_anew(name: &str, make: impl FnOnce() -> String) -> String {
    let folder = [env!("CARGO_MANIFEST_DIR"), "../../docs/validation"];
    let file = folder.iter().collect::<PathBuf>().join(name);
    if std::env::var_os("RENEW_VALIDATION").is_some() {
        std::fs::write(&file, make()).unwrap();
    }
    std::fs::read_to_string(&file).unwrap_or_default()
}

fn written(rows: &[Row]) -> String {
    let mut text = "series,x,measured,standard_error,expected\n".to_owned();
    for row in rows {
        let expected = row.expected.map(rounded).unwrap_or_default();
        let [x, measured, error] = [row.x, row.measured, row.error].map(rounded);
        writeln!(text, "{},{x},{measured},{error},{expected}", row.series).unwrap();
    }
    text
}

/// With seven digits.
fn rounded(value: f64) -> String {
    let seven: f64 = format!("{value:.6e}").parse().unwrap();
    format!("{seven:?}")
}

#[test]
fn a_mean_six_standard_errors_off_is_a_miss_and_one_five_off_is_not() {
    let row = |measured| Row {
        error: 0.1,
        ..Row::exact("", 0.0, measured, 1.0)
    };
    assert_eq!(misses(&[row(1.6), row(1.5), row(0.4)]).len(), 2);
    let exact = [Row::exact("", 0.0, 1.0, 1.0), Row::exact("", 0.0, 1.1, 1.0)];
    assert_eq!(misses(&exact), [&exact[1]]);
}
