//! The simulators that scenarios can name.

use base::engine::Engine;
use classic::scenario::Classic;
use sim::runner::Metric;

/// Every engine; a new one is added here.
pub(crate) const ENGINES: [&dyn Engine; 2] = [&Classic, &Metric];
