//! Sets `AGENT_ECONOMY_ENGINE`, the identity of the engine, and `AGENT_ECONOMY_PROFILE` for `env!`.

mod engine;

use std::env;
use std::ffi::OsStr;
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
    println!("cargo::rustc-env=AGENT_ECONOMY_PROFILE={}", profile());
    Ok(())
}

/// The name of the Cargo profile. Cargo does not pass that of a custom one, but its folder has it:
/// `target/PROFILE/build/PACKAGE/out`.
fn profile() -> String {
    let out = env::var_os("OUT_DIR").map(PathBuf::from);
    let folder = out
        .as_deref()
        .and_then(|out| out.ancestors().nth(3)?.file_name());
    match folder.and_then(OsStr::to_str) {
        Some("debug") | None => "dev".to_owned(),
        Some(name) => name.to_owned(),
    }
}
