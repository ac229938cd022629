//! Do the selection procedures keep their guarantees? Measured on problems whose answer is known.
//!
//! | topic | module |
//! |---|---|
//! | problems whose answer is known | `cases` |
//! | what is measured on them | `lines` |
//! | one selection from its first run to its last | `selection` |
//! | classical procedures, for comparison | `reference` |
//! | what passes | `gate` |
//! | the same for the procedure for requirements | `requirement` |

mod arguments;
mod binomial;
mod cases;
mod coverage;
mod ending;
mod gate;
mod lines;
mod random;
mod reference;
mod report;
mod requirement;
mod selection;
#[cfg(test)]
mod tests;

use arguments::Arguments;
use ending::end;
use std::io;
use std::process::ExitCode;

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    if let Some(("requirement", words)) = words
        .split_first()
        .map(|(first, rest)| (first.as_str(), rest))
    {
        return requirement::main(words);
    }
    let arguments = match Arguments::parse(words.into_iter()) {
        Ok(arguments) => arguments,
        Err(error) => return end(&mut io::stderr(), &error, 2),
    };
    if arguments.help {
        return end(&mut io::stdout(), arguments::HELP, 0);
    }
    match verify(&arguments) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::from(1),
        Err(error) => end(&mut io::stderr(), &error.to_string(), 2),
    }
}

/// Whether every line passed.
fn verify(arguments: &Arguments) -> io::Result<bool> {
    let mut lines = lines::all();
    lines.retain(|line| line.is_named(&arguments.only));
    if lines.is_empty() {
        let error = format!(
            "--only {}: no line has a name that contains these words",
            arguments.only
        );
        return Err(io::Error::new(io::ErrorKind::InvalidInput, error));
    }
    let mut report = report::Report::new(arguments.json);
    report.begin()?;
    for line in &lines {
        let replications = arguments.replications.unwrap_or(line.replications);
        let progress = |done| report::progress(line, done, replications);
        let measured = gate::measure(line, arguments.seed, replications, progress);
        report.line(line, &measured)?;
    }
    report.end()
}
