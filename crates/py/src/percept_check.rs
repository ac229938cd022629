//! Rejects percepts that a body or a controller cannot have: an error in a driver that the agent would not notice.

use crate::message_check::{Kinds, unless_role};
use base::error::InputError;
use brain::{AgentRole, Body, Percept, Scan};

/// `percept`, if `body` can have it; `at` is its path in errors.
pub(crate) fn fitting(at: &str, percept: Percept, body: &Body) -> Result<Percept, InputError> {
    match misfit(at, &percept, body) {
        Some(error) => Err(error),
        None => Ok(percept),
    }
}

/// `percept`, if a controller can have it; `at` is its path in errors.
pub(crate) fn of_controller(at: &str, percept: Percept) -> Result<Percept, InputError> {
    let error = unless_role(&format!("{at}.id"), percept.id, AgentRole::Controller)
        .or_else(|| unknown_kind(at, &percept, &Kinds::any()));
    error.map_or(Ok(percept), Err)
}

fn misfit(at: &str, percept: &Percept, body: &Body) -> Option<InputError> {
    let (scans, rings) = (percept.scans.len(), body.rings.len());
    if scans > rings {
        let allowed = format!("a list of at most {rings}, one for each range sensor of the body");
        return Some(counted(format!("{at}.scans"), scans, allowed));
    }
    unknown_kind(at, percept, &Kinds::of_body(body)).or_else(|| {
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

/// The first item, robot or message of a kind that there is not, or with another invalid value.
fn unknown_kind(at: &str, percept: &Percept, kinds: &Kinds) -> Option<InputError> {
    let own = kinds.robot(&format!("{at}.id"), percept.id);
    let mut contacts = percept.contacts.iter().enumerate();
    let contact = || {
        contacts.find_map(|(number, contact)| {
            kinds.item(&format!("{at}.contacts[{number}].kind"), contact.kind)
        })
    };
    let mut neighbours = percept.neighbours.iter().enumerate();
    let neighbour = || {
        neighbours.find_map(|(number, neighbour)| {
            kinds.robot(&format!("{at}.neighbours[{number}].id"), neighbour.id)
        })
    };
    let mut inbox = percept.inbox.iter().enumerate();
    let received = || {
        inbox.find_map(|(number, received)| {
            let at = format!("{at}.inbox[{number}]");
            let sender = kinds.sender(&format!("{at}.from"), received.from);
            sender.or_else(|| kinds.message(&format!("{at}.message"), &received.message))
        })
    };
    own.or_else(contact).or_else(neighbour).or_else(received)
}

fn is_missing(scan: &Scan) -> bool {
    scan.age_s.is_none() && scan.ranges_m.is_empty()
}

fn counted(path: String, count: usize, allowed: String) -> InputError {
    InputError::new(path, Some(format!("a list of {count}")), allowed)
}
