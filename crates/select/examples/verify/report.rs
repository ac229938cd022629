//! The table, as lines of text or as JSON.

use crate::gate::Measured;
use crate::lines::{Line, Question};
use serde_json::{Value, json};
use std::io::{self, IsTerminal, Write};

/// Prints lines as they are measured, and whether all passed.
pub(crate) struct Report {
    json: bool,
    printed: Vec<Value>,
    failed: usize,
}

impl Report {
    pub(crate) fn new(json: bool) -> Self {
        Self {
            json,
            printed: Vec::new(),
            failed: 0,
        }
    }

    pub(crate) fn begin(&self) -> io::Result<()> {
        if self.json {
            return Ok(());
        }
        writeln!(
            io::stdout(),
            "{:<7} {:<37} {:>6} {:>8} {:>9} {:>11} {:>9} {:>6}",
            "subject",
            "problem",
            "trials",
            "correct",
            "99% lower",
            "average runs",
            "published",
            "s",
        )
    }

    pub(crate) fn line(&mut self, line: &Line, measured: &Measured) -> io::Result<()> {
        let passes = measured.passes(line);
        self.failed += usize::from(!passes);
        if self.json {
            self.printed.push(object(line, measured));
            return Ok(());
        }
        let published = line
            .published_runs
            .map(|runs| format!("{runs:.0}"))
            .unwrap_or_default();
        writeln!(
            io::stdout(),
            "{:<7} {:<37} {:>6} {:>8.4} {:>9.4} {:>12.1} {:>9} {:>6.1} {}",
            line.subject,
            line.problem,
            measured.replications,
            measured.share(),
            measured.lower(),
            measured.runs,
            published,
            measured.seconds,
            verdict(line, passes),
        )
    }

    /// Whether all passed.
    pub(crate) fn end(self) -> io::Result<bool> {
        let mut stdout = io::stdout();
        match (self.json, self.failed) {
            (true, _) => writeln!(stdout, "{:#}", Value::from(self.printed))?,
            (false, 0) => writeln!(stdout, "Every line passes.")?,
            (false, failed) => writeln!(stdout, "Lines that fail: {failed}.")?,
        }
        Ok(self.failed == 0)
    }
}

fn verdict(line: &Line, passes: bool) -> &'static str {
    match (&line.question, passes) {
        (_, false) => "FAIL",
        (Question::Unfit(_), true) => "pass: unfit, as it must be",
        (_, true) => "pass",
    }
}

fn object(line: &Line, measured: &Measured) -> Value {
    json!({
        "subject": line.subject,
        "problem": line.problem,
        "macro_replications": measured.replications,
        "correct": measured.correct,
        "lower_99": measured.lower(),
        "average_runs": measured.runs,
        "published_runs": line.published_runs,
        "seconds": measured.seconds,
        "passes": measured.passes(line),
    })
}

/// Shows the progress of a line on a terminal.
pub(crate) fn progress(line: &Line, done: u32, of: u32) {
    let mut stderr = io::stderr();
    if stderr.is_terminal() {
        let end = if done < of { "" } else { "\r\x1b[K" };
        // Progress that cannot be shown must not stop the measurement.
        let _ = write!(
            stderr,
            "\r\x1b[K{} {}: {done} of {of}{end}",
            line.subject, line.problem
        );
    }
}
