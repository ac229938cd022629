//! A kind of goal, converted for runs.

use super::GoalSpec;
use crate::schedule::steps_of;
use base::geometry::Point;
use base::placement::Placement;
use base::random::{Entity, kind_key};
use brain::{GoalId, GoalList, Issuer, Task, Work, issuer_of};

/// What all goals of a kind have in common.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct GoalKind {
    pub(crate) name: String,
    /// Its name in random streams: [`kind_key`].
    pub(crate) key: u32,
    pub(crate) count: u32,
    pub(crate) placement: Placement,
    pub(crate) within_m: f64,
    pub(crate) service_steps: u64,
    /// Steps from its arrival until it expires.
    pub(crate) deadline_steps: Option<u64>,
    /// Number of the kind of controllers that own them.
    pub(crate) owner: Option<u8>,
    pub(crate) issuer: Issuer,
    work: Work,
    value: f64,
    service_s: f64,
    deadline_s: Option<f64>,
    capability: u8,
    requires: Option<String>,
    /// Arrival of the first, and time until the next.
    pub(crate) timetable_s: [f64; 2],
}

/// What a kind depends on besides its own keys.
#[derive(Debug, Clone, Copy)]
pub(crate) struct GoalContext<'a> {
    /// Names of all capabilities, sorted.
    pub(crate) capabilities: &'a [String],
    /// Names of the kinds of controllers.
    pub(crate) controllers: &'a [String],
    pub(crate) step_s: f64,
}

impl GoalKind {
    /// The kind that `spec` describes.
    pub(crate) fn new((name, spec): (&String, &GoalSpec), context: &GoalContext) -> Self {
        let step_s = context.step_s;
        let owner = match &spec.owner {
            Some(owner) => number_of(owner, context.controllers),
            None => (!context.controllers.is_empty()).then_some(0),
        };
        let required = spec.requires.as_ref();
        Self {
            name: name.clone(),
            key: kind_key(name),
            count: spec.count,
            placement: spec.placement.clone(),
            within_m: spec.within_m,
            service_steps: steps_of(spec.service_s, step_s),
            deadline_steps: spec.deadline_s.map(|time_s| steps_of(time_s, step_s)),
            owner,
            issuer: issuer(name, &spec.placement),
            work: spec.work,
            value: spec.value,
            service_s: spec.service_s,
            deadline_s: spec.deadline_s,
            capability: required.map_or(0, |name| capability(name, context.capabilities)),
            requires: spec.requires.clone(),
            timetable_s: [spec.arrive_s, spec.every_s],
        }
    }

    /// The step in which the goal of an index arrives.
    pub(crate) fn arrives_at(&self, index: u32, step_s: f64) -> u64 {
        let [first_s, every_s] = self.timetable_s;
        steps_of(first_s + f64::from(index) * every_s, step_s)
    }

    /// The description of a goal in messages.
    #[expect(
        clippy::cast_possible_truncation,
        reason = "messages have the precision of 32-bit floats"
    )]
    pub(crate) fn task(&self, id: GoalId, at: Point) -> Task {
        Task {
            id,
            at_m: [at.x as f32, at.y as f32],
            radius_m: self.within_m as f32,
            value: self.value as f32,
            service_s: self.service_s as f32,
            due_s: self.deadline_s.map_or(f32::MAX, |time_s| time_s as f32),
            work: self.work,
            capability: self.capability,
        }
    }

    /// The keys whose values agents know of a goal that is issued to a controller, with the values as text.
    pub(crate) fn described(&self) -> [(&'static str, String); 6] {
        let none = || "omitted".to_owned();
        let deadline_s = self.deadline_s.map(|time_s| time_s.to_string());
        [
            ("work", self.work.name().to_owned()),
            ("value", self.value.to_string()),
            ("within_m", self.within_m.to_string()),
            ("service_s", self.service_s.to_string()),
            ("deadline_s", deadline_s.unwrap_or_else(none)),
            ("requires", self.requires.clone().unwrap_or_else(none)),
        ]
    }

    /// The key of one of its goals in random streams.
    pub(crate) fn entity(&self, index: u32) -> Entity {
        Entity {
            kind: self.key,
            index,
        }
    }
}

/// The number of a capability, from 1; 0 if there is none of this name.
pub(crate) fn capability(name: &str, known: &[String]) -> u8 {
    let place = known.iter().position(|capability| capability == name);
    let number = place.and_then(|place| u8::try_from(place + 1).ok());
    number.unwrap_or(0)
}

fn number_of(name: &str, names: &[String]) -> Option<u8> {
    let place = names.iter().position(|known| known == name);
    place.and_then(|place| u8::try_from(place).ok())
}

/// The issuer of the goals of a kind. At random positions it follows from the name, so that goals keep their ids when
/// others are added.
fn issuer(name: &str, placement: &Placement) -> Issuer {
    match placement {
        Placement::Fixed { at_m, .. } => issuer_of(at_m),
        _ => Issuer::List(GoalList {
            list: kind_key(name).clamp(1, u32::MAX - 1),
        }),
    }
}
