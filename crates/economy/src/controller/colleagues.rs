//! The other controllers.

use alloc::vec::Vec;
use base::hashed::Hashed;
use brain::RobotId;

/// A controller is out of range when nothing has been received of it for this time, in seconds.
const LIFE_S: f64 = 8.0;

/// The other controllers in range.
#[derive(Debug, Clone, Default, Hashed)]
pub(super) struct Colleagues {
    pub(super) list: Vec<Colleague>,
    /// When the next message of presence is due; at once without it.
    pub(super) next_s: Option<f64>,
}

#[derive(Debug, Clone, Copy, Hashed)]
pub(super) struct Colleague {
    pub(super) id: RobotId,
    serial: u32,
    received_s: f64,
}

impl Colleagues {
    pub(super) fn note(&mut self, id: RobotId, serial: u32, now_s: f64) {
        self.list.retain(|colleague| colleague.id != id);
        self.list.push(Colleague {
            id,
            serial,
            received_s: now_s,
        });
    }

    pub(super) fn expire(&mut self, now_s: f64) {
        let is_near = |colleague: &Colleague| now_s < colleague.received_s + LIFE_S;
        self.list.retain(is_near);
    }

    pub(super) fn is_near(&self, id: RobotId) -> bool {
        self.list.iter().any(|colleague| colleague.id == id)
    }

    /// The one with the highest serial number.
    pub(super) fn highest(&self) -> Option<RobotId> {
        let all = self.list.iter();
        let highest = all.max_by_key(|colleague| (colleague.serial, colleague.id));
        highest.map(|colleague| colleague.id)
    }
}
