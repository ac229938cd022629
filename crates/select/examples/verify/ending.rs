//! The last words of the program.

use std::io::Write;
use std::process::ExitCode;

/// Prints a string, and returns an exit code.
pub(crate) fn end(stream: &mut impl Write, text: &str, code: u8) -> ExitCode {
    // Nothing can be reported if this fails.
    let _ = writeln!(stream, "{text}");
    ExitCode::from(code)
}
