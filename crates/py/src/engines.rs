//! The simulators that scenarios can name.

use base::question::Engine;
use classic::scenario::Classic;
use sim::runner::Metric;
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// The metric engine, with maps from this machine's files.
pub(crate) const METRIC: Metric = Metric { open };

/// Every engine; a new one is added here.
pub(crate) const ENGINES: [&dyn Engine; 2] = [&Classic, &METRIC];

/// Bytes that a file named in a scenario may have: those of a map of 64 million cells, and some more.
const MAX_BYTES: u64 = 1 << 28;

/// The bytes of a file beside the scenario's.
fn open(scenario: &str, name: &str) -> Result<Vec<u8>, String> {
    let path = Path::new(scenario).with_file_name(name);
    let file = File::open(path).map_err(|error| error.to_string())?;
    let mut bytes = Vec::new();
    let read = file.take(MAX_BYTES + 1).read_to_end(&mut bytes);
    read.map_err(|error| error.to_string())?;
    if bytes.len() as u64 > MAX_BYTES {
        return Err(format!("it has more than {MAX_BYTES} bytes"));
    }
    Ok(bytes)
}
