//! Sets `AGENT_ECONOMY_ENGINE`, the identity of the engine, for `env!`.

mod engine;

use std::env;
use std::io;
use std::path::PathBuf;

#[expect(clippy::print_stdout, reason = "cargo reads it")]
fn main() -> io::Result<()> {
    let own = env::var_os("CARGO_MANIFEST_DIR").map(PathBuf::from);
    let root = own.unwrap_or_default().join("../..");
    let sources = engine::Sources::read(&root)?;
    for path in engine::watched() {
        println!("cargo::rerun-if-changed={}", root.join(path).display());
    }
    println!("cargo::rustc-env=AGENT_ECONOMY_ENGINE={}", sources.hash());
    Ok(())
}
