//! The columns of the times of finds: how many there are, and their names.

/// Maximum number of finds per kind of items whose times have columns.
const MAX_FIND_TIMES: u32 = 64;

/// Number of columns of times for a kind with this largest number of items.
pub(super) fn find_times(max_count: u32) -> u32 {
    max_count.min(MAX_FIND_TIMES)
}

/// The name of the column of the time of a find of a kind; the first is 1.
pub(super) fn find_time(kind: &str, find: u32) -> String {
    format!("found_{kind}_{find}_s")
}
