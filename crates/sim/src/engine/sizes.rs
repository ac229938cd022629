//! How much memory it takes to keep what has not reached a brain yet, for whoever checks scenarios.

use super::air;
use super::mind;
use super::waiting::{self, Late};
use brain::{Contact, Heard, Neighbour};

/// A contact that waits for a brain.
pub(crate) const CONTACT_BYTES: usize = size_of::<Late<(Contact, Option<u32>)>>();

/// A look for items, of which a brain is to be told, without its contacts.
pub(crate) const GLANCE_BYTES: usize = size_of::<Late<brain::Look>>();

/// A robot that was recognised and waits for a brain.
pub(crate) const NEIGHBOUR_BYTES: usize = size_of::<Late<Neighbour>>();

/// A message that waits for a brain.
pub(crate) const HEARD_BYTES: usize = size_of::<Late<Heard>>();

/// A message on its way to one robot.
pub(crate) const SENT_BYTES: usize = size_of::<air::Sent>();

/// A look that is kept, without its values.
pub(crate) const LOOK_BYTES: usize = size_of::<mind::Look>();

/// So many wait at most, besides what is under way and what came in last.
pub(crate) const MOST_WAITING: usize = 2 * waiting::MOST_WAITING;
