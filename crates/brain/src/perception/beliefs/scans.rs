//! Range scans of a step.

use super::others::Others;
use crate::io::percept::Percept;
use crate::perception::rays::{Ray, Ring};
use alloc::vec::Vec;

/// Scans that have not been used before.
pub(super) fn new_scans<'p>(
    percept: &'p Percept,
    rings: &'p [Ring],
    elapsed_s: f64,
) -> impl Iterator<Item = (&'p Ring, &'p [f64])> {
    let scans = rings.iter().zip(&percept.scans);
    scans.filter_map(move |(ring, scan)| {
        let (age_s, ranges_m) = ring.fresh(Some(scan))?;
        (age_s < ring.latency_s() + elapsed_s).then_some((ring, ranges_m))
    })
}

/// Collects the rays that currently hit static obstacles.
pub(crate) fn static_hits(others: &Others, rings: &[Ring], percept: &Percept, into: &mut Vec<Ray>) {
    into.clear();
    for (ring, scan) in rings.iter().zip(&percept.scans) {
        let Some((_, ranges_m)) = ring.fresh(Some(scan)) else {
            continue;
        };
        let is_static = |ray: &Ray| ray.range_m < ring.range_m() && !others.is_on_mover(ray.end());
        into.extend(ring.rays(ranges_m).filter(is_static));
    }
}
