//! Measured values and their expected values.

use std::fmt::Write;
use std::path::PathBuf;

/// Tolerance in standard errors. A normal variable exceeds it with probability 1 in 26 million, and
/// the mean of 40 runs, by Student's t distribution, 1 in 400,000. So each check fails for a correct
/// simulator with less than one seed in 10,000. The seeds are fixed.
pub(crate) const SIGMAS: f64 = 5.5;

/// One measured value.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Row {
    pub(crate) series: String,
    pub(crate) x: f64,
    pub(crate) measured: f64,
    /// Standard error; 0 for a deterministic value.
    pub(crate) error: f64,
    /// Value of the closed form, if there is one.
    pub(crate) expected: Option<f64>,
}

impl Row {
    /// The share of `count` in `of` independent trials with the same expected probability.
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

    /// The mean of independent values.
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

    /// A deterministic value.
    pub(crate) fn exact(series: &str, x: f64, measured: f64, expected: f64) -> Self {
        Self {
            series: series.to_owned(),
            x,
            measured,
            error: 0.0,
            expected: Some(expected),
        }
    }

    /// Distance from the expected value, in standard errors.
    pub(crate) fn sigmas(&self) -> f64 {
        let off = self.expected.map_or(0.0, |value| self.measured - value);
        if off == 0.0 { 0.0 } else { off / self.error }
    }
}

#[expect(clippy::cast_precision_loss, reason = "counts are small")]
fn count(values: &[f64]) -> f64 {
    values.len() as f64
}

/// The rows whose deviation from the expected value is significant.
pub(crate) fn misses(rows: &[Row]) -> Vec<&Row> {
    let is_miss = |row: &&Row| row.sigmas().abs() > SIGMAS;
    rows.iter().filter(is_miss).collect()
}

/// Asserts that no row deviates significantly from the closed form.
pub(crate) fn assert_right(rows: &[Row]) {
    let misses = misses(rows);
    assert!(misses.is_empty(), "{misses:#?}");
}

/// Asserts that the check detects a wrong simulator.
pub(crate) fn assert_wrong(rows: &[Row]) {
    let most = rows
        .iter()
        .map(|row| row.sigmas().abs())
        .fold(0.0, f64::max);
    assert!(most > SIGMAS, "at most {most} standard errors off");
}

/// Asserts that the published file has the same rows; with `RENEW_VALIDATION=1` it is written.
pub(crate) fn assert_published(name: &str, rows: &[Row]) {
    let text = written(rows);
    let published = published(name, || text.clone());
    assert!(
        published == text,
        "docs/validation/{name} differs from the simulator's results: run `make validation`"
    );
}

/// Content of a published file; with `RENEW_VALIDATION=1` it is generated and written first.
pub(crate) fn published(name: &str, make: impl FnOnce() -> String) -> String {
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

/// Rounded to seven significant digits.
fn rounded(value: f64) -> String {
    let seven: f64 = format!("{value:.6e}").parse().unwrap();
    format!("{seven:?}")
}

#[test]
fn a_deviation_of_six_standard_errors_is_a_miss_and_of_five_is_not() {
    let row = |measured| Row {
        error: 0.1,
        ..Row::exact("", 0.0, measured, 1.0)
    };
    assert_eq!(misses(&[row(1.6), row(1.5), row(0.4)]).len(), 2);
    let exact = [Row::exact("", 0.0, 1.0, 1.0), Row::exact("", 0.0, 1.1, 1.0)];
    assert_eq!(misses(&exact), [&exact[1]]);
}
