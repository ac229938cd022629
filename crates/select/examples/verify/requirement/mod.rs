//! Does the procedure for requirements keep its promise? Measured on problems whose answer is known.
//!
//! | topic | module |
//! |---|---|
//! | problems whose answer is known | `problems` |
//! | one study from its first run to its last | `study` |
//! | other procedures, for comparison | `reference` |
//! | what is measured, and what passes | `lines` |

mod lines;
mod problems;
mod reference;
mod study;
#[cfg(test)]
mod tests;

use crate::ending::end;
use std::io::{self, Write};
use std::process::ExitCode;

const HELP: &str = "\
Does the procedure for requirements keep its promise? Minutes on two cores.

verify requirement [--only WORDS] [--replications N] [--seed N]

  --only WORDS      only lines whose name contains these words, such as \"anchor\"
  --replications N  macro-replications of every line, for a quick check [depends on the line]
  --seed N          seed of all random numbers [7]
  --help            print this help

Exit code: 0 if every line passed, 1 if one failed, 2 if the command line is wrong.
A study keeps the promise if the selected configuration meets the requirement and no cheaper one meets
it with tolerance to spare. A line passes if the 99% lower bound (Clopper-Pearson) of the share of such
studies is at least 0.95. A line that is broken on purpose passes if the 99% upper bound is below 0.95.
Anchors, other procedures on the same problems, pass in any case: the column `kept` shows whether they
keep the promise.";

/// The options given.
struct Options {
    only: String,
    replications: Option<u32>,
    seed: u64,
}

/// Runs the gate with the words of the command line.
pub(crate) fn main(words: &[String]) -> ExitCode {
    if words.iter().any(|word| word == "--help" || word == "-h") {
        return end(&mut io::stdout(), HELP, 0);
    }
    let verified =
        parsed(words).and_then(|options| verify(&options).map_err(|error| error.to_string()));
    match verified {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::from(1),
        Err(error) => end(&mut io::stderr(), &error, 2),
    }
}

fn parsed(words: &[String]) -> Result<Options, String> {
    let mut options = Options {
        only: String::new(),
        replications: None,
        seed: 7,
    };
    for option in words.chunks(2) {
        let value = option
            .get(1)
            .ok_or_else(|| format!("{}: expected a value", option[0]))?;
        let number = || {
            let wrong = |_| format!("{} {value}: must be a whole number", option[0]);
            value.parse::<u32>().map_err(wrong)
        };
        match option[0].as_str() {
            "--only" => options.only.clone_from(value),
            "--replications" => options.replications = Some(number()?.max(1)),
            "--seed" => options.seed = number()?.into(),
            other => return Err(format!("{other}: no such option; see --help")),
        }
    }
    Ok(options)
}

/// Whether every line passed.
fn verify(options: &Options) -> io::Result<bool> {
    let mut out = io::stdout();
    writeln!(
        out,
        "{:<50} {:>6} {:>8} {:>9} {:>12}",
        "problem", "trials", "kept", "99% lower", "average runs"
    )?;
    let mut has_failed = false;
    let lines = lines::all()
        .into_iter()
        .filter(|line| line.name.contains(&options.only));
    for line in lines {
        let replications = options.replications.unwrap_or(line.replications);
        let measured = lines::measure(&line, options.seed, replications);
        let passes = line.passes(&measured);
        has_failed |= !passes;
        writeln!(
            out,
            "{:<50} {:>6} {:>8.4} {:>9.4} {:>12.1} {}",
            line.name,
            measured.replications,
            measured.share(),
            measured.lower(),
            measured.runs,
            if passes { "pass" } else { "FAIL" },
        )?;
    }
    writeln!(
        out,
        "{}",
        if has_failed {
            "Some lines fail."
        } else {
            "Every line passes."
        }
    )?;
    Ok(!has_failed)
}
