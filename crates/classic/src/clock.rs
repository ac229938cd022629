//! When the team decides. Time is counted in paints of the original's window.

/// Paint of the first decision.
pub const FIRST_DECISION: u64 = 12;

/// Paints between two decisions.
pub const DECISION_PERIOD: u64 = 11;

/// Whether the team decides in a paint: 12, 23, 34, ...
pub(crate) fn is_decision(paint: u64) -> bool {
    paint >= FIRST_DECISION && (paint - FIRST_DECISION).is_multiple_of(DECISION_PERIOD)
}

/// Paints until the team decides next.
pub(crate) fn decides_in(paint: u64) -> u64 {
    match paint.checked_sub(FIRST_DECISION) {
        None => FIRST_DECISION - paint,
        Some(since) => DECISION_PERIOD - since % DECISION_PERIOD,
    }
}

/// The paint of a decision, counted from 1; 0 is the start.
pub(crate) fn paint_of(decision: u64) -> u64 {
    match decision {
        0 => 0,
        _ => FIRST_DECISION + DECISION_PERIOD * (decision - 1),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_paint_of_a_decision_is_when_the_team_decides() {
        let decisions = (1..=500).filter(|paint| is_decision(*paint));
        assert!(
            decisions
                .zip(1..)
                .all(|(paint, decision)| paint_of(decision) == paint)
        );
    }

    #[test]
    fn after_so_many_paints_the_team_decides_and_not_before() {
        for paint in 0..100 {
            let next = paint + decides_in(paint);
            assert!(is_decision(next));
            assert!((paint + 1..next).all(|between| !is_decision(between)));
        }
    }
}
