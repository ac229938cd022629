//! No allocation: the baseline in which a controller only owns goals.

use super::{Market, Pair};
use alloc::vec::Vec;

pub(super) fn choose(_market: &Market) -> Vec<Pair> {
    Vec::new()
}

#[cfg(test)]
mod tests {
    use super::super::market::market_of;
    use super::*;

    #[test]
    fn nothing_is_awarded() {
        assert_eq!(choose(&market_of(&[&[1.0, 2.0]])), []);
    }
}
