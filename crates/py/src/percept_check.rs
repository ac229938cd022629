//! Rejects percepts that a body cannot have: an error in a driver that a brain would not notice.

use base::error::InputError;
use brain::{Body, Percept, Scan};

/// `percept`, if `body` can have it; `at` is its path in errors.
pub(crate) fn fitting(at: &str, percept: Percept, body: &Body) -> Result<Percept, InputError> {
    match misfit(at, &percept, body) {
        Some(error) => Err(error),
        None => Ok(percept),
    }
}

fn misfit(at: &str, percept: &Percept, body: &Body) -> Option<InputError> {
    let (scans, rings) = (percept.scans.len(), body.rings.len());
    if scans > rings {
        let allowed = format!("a list of at most {rings}, one for each range sensor of the body");
        return Some(counted(format!("{at}.scans"), scans, allowed));
    }
    let kinds = body.item_kinds.len();
    let is_known = |kind: u16| usize::from(kind) < kinds;
    let mut contacts = percept.contacts.iter().enumerate();
    let unknown = contacts.find(|(_, contact)| !is_known(contact.kind));
    let unknown = unknown.map(|(number, contact)| {
        let path = format!("{at}.contacts[{number}].kind");
        let allowed = format!("a number below {kinds}, the number of item kinds");
        InputError::new(path, Some(contact.kind.to_string()), allowed)
    });
    unknown.or_else(|| {
        let rings = percept.scans.iter().zip(&body.rings).enumerate();
        rings.into_iter().find_map(|(number, (scan, ring))| {
            let rays = ring.bearings_rad.len();
            let is_whole = is_missing(scan) || scan.ranges_m.len() == rays;
            let path = format!("{at}.scans[{number}].ranges_m");
            let allowed = format!("a list of {rays}, one for each ray");
            (!is_whole).then(|| counted(path, scan.ranges_m.len(), allowed))
        })
    })
}

fn is_missing(scan: &Scan) -> bool {
    scan.age_s.is_none() && scan.ranges_m.is_empty()
}

fn counted(path: String, count: usize, allowed: String) -> InputError {
    InputError::new(path, Some(format!("a list of {count}")), allowed)
}
