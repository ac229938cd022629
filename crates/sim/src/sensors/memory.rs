//! Memory that readings and messages take until they reach a brain, in bytes: what the check of scenarios adds up.

use super::backlog;
use super::pending::{self, Pending};
use crate::radio::channel::Transmission;
use brain::{Contact, Heard, Neighbour};

/// A contact that waits for a brain.
pub(crate) const CONTACT_BYTES: usize = size_of::<Pending<(Contact, Option<u32>)>>();

/// A look for items, of which a brain is to be told, without its contacts.
pub(crate) const GLANCE_BYTES: usize = size_of::<Pending<brain::Look>>();

/// A robot that was recognised and waits for a brain.
pub(crate) const NEIGHBOUR_BYTES: usize = size_of::<Pending<Neighbour>>();

/// A message that waits for a brain.
pub(crate) const HEARD_BYTES: usize = size_of::<Pending<Heard>>();

/// A message on its way to one robot.
pub(crate) const SENT_BYTES: usize = size_of::<Transmission>();

/// A look that is kept, without its values.
pub(crate) const LOOK_BYTES: usize = size_of::<backlog::Look>();

/// So many wait at most, besides what is under way and what came in last.
pub(crate) const MAX_PENDING: usize = 2 * pending::MAX_PENDING;
