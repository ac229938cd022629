//! Memory that readings and messages take until they reach a brain, in bytes: what the check of
//! scenarios adds up.

use super::backlog;
use super::pending::{self, Pending};
use crate::radio::channel::Transmission;
use brain::{Contact, Neighbour, ReceivedMessage};

/// A contact in the queue of a brain.
pub(crate) const CONTACT_BYTES: usize = size_of::<Pending<(Contact, Option<u32>)>>();

/// A measurement of an item detector in the queue of a brain, without its contacts.
pub(crate) const OBSERVATION_BYTES: usize = size_of::<Pending<brain::Observation>>();

/// A detected robot in the queue of a brain.
pub(crate) const NEIGHBOUR_BYTES: usize = size_of::<Pending<Neighbour>>();

/// A message in the queue of a brain.
pub(crate) const MESSAGE_BYTES: usize = size_of::<Pending<ReceivedMessage>>();

/// A message in transit to one robot.
pub(crate) const SENT_BYTES: usize = size_of::<Transmission>();

/// A stored measurement, without its values.
pub(crate) const MEASUREMENT_BYTES: usize = size_of::<backlog::StoredMeasurement>();

/// Maximum length of a queue, besides what is in transit and what arrived last.
pub(crate) const MAX_PENDING: usize = 2 * pending::MAX_PENDING;
