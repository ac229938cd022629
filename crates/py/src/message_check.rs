//! Rejects messages, and ids of robots, that no brain could use: brains would ignore them unseen.

use base::error::InputError;
use brain::{About, Act, AgentId, AgentRole, Body, Command, MAX_ACTS, Message, Tool};
use sim::scenario::Scenario;

/// The kinds that messages can be about.
pub(crate) struct Kinds {
    items: usize,
    /// `None` for a body that does not know the kinds of robots.
    robots: Option<usize>,
}

impl Kinds {
    pub(crate) fn of_scenario(scenario: &Scenario) -> Self {
        Self {
            items: scenario.item_kinds().count(),
            robots: Some(scenario.robot_kinds().count()),
        }
    }

    pub(crate) fn of_body(body: &Body) -> Self {
        let robots = body.others.len();
        Self {
            items: body.item_kinds.len(),
            robots: (robots > 0).then_some(robots),
        }
    }

    /// Any kinds: for an agent that knows none.
    pub(crate) fn any() -> Self {
        Self {
            items: usize::MAX,
            robots: None,
        }
    }

    /// An error, unless there is the kind of an item; `at` is its path.
    pub(crate) fn item(&self, at: &str, kind: u16) -> Option<InputError> {
        unless_below(self.items, at, kind.into(), "item")
    }

    /// An error, unless there is the kind of a robot; `at` is the path of its id.
    pub(crate) fn robot(&self, at: &str, id: AgentId) -> Option<InputError> {
        let robots = self.robots?;
        unless_role(at, id, AgentRole::Robot)
            .or_else(|| unless_below(robots, &format!("{at}.kind"), id.kind.into(), "robot"))
    }

    /// An error, unless there is the kind of the sender of a message, if it is a robot; `at` is the path of its id.
    pub(crate) fn sender(&self, at: &str, id: AgentId) -> Option<InputError> {
        id.is_robot().then(|| self.robot(at, id))?
    }

    /// The first error of a message; `at` is its path.
    pub(crate) fn message(&self, at: &str, message: &Message) -> Option<InputError> {
        if !(0.0..=1.0).contains(&message.confidence) {
            let path = format!("{at}.confidence");
            let given = Some(message.confidence.to_string());
            return Some(InputError::new(path, given, "a number from 0 to 1".into()));
        }
        let About::Item {
            kind, provenance, ..
        } = message.about
        else {
            return None;
        };
        let at = format!("{at}.about.item");
        let unknown = self.item(&format!("{at}.kind"), kind);
        unknown.or_else(|| self.robot(&format!("{at}.provenance.observer"), provenance.observer))
    }

    /// `command`, if all of its messages are allowed, and if it has a tool for each of its acts and not too many of
    /// them; `at` is its path.
    pub(crate) fn command(
        &self,
        at: &str,
        tools: &[Tool],
        command: Command,
    ) -> Result<Command, InputError> {
        let mut messages = command.outbox.iter().enumerate();
        let error = messages
            .find_map(|(number, message)| self.message(&format!("{at}.outbox[{number}]"), message));
        let error = error.or_else(|| too_many(at, &command.acts));
        let error = error.or_else(|| without_tool(at, tools, &command.acts));
        error.map_or(Ok(command), Err)
    }
}

/// The tools of robots of a kind; none of controllers.
pub(crate) fn tools_of(scenario: &Scenario, kind: u8) -> &[Tool] {
    let brain = scenario.brain(kind);
    brain.map_or(&[], |brain| brain.body().tools.as_slice())
}

/// An error of more acts than are carried out.
fn too_many(at: &str, acts: &[Act]) -> Option<InputError> {
    (acts.len() > MAX_ACTS).then(|| {
        let given = Some(format!("{} acts", acts.len()));
        let allowed = format!("at most {MAX_ACTS} acts");
        InputError::new(format!("{at}.acts"), given, allowed)
    })
}

/// An error of the first act for which there is no tool.
fn without_tool(at: &str, tools: &[Tool], acts: &[Act]) -> Option<InputError> {
    let has_none = |act: &Act| !tools.iter().any(|tool| tool.act == act.kind);
    let number = acts.iter().position(has_none)?;
    let names: Vec<&str> = tools.iter().map(|tool| tool.act.name()).collect();
    let allowed = if names.is_empty() {
        "no act: the robot has no tools".to_owned()
    } else {
        format!(
            "an act for which the robot has a tool: {}",
            names.join(", ")
        )
    };
    let path = format!("{at}.acts[{number}].kind");
    let given = Some(acts[number].kind.name().to_owned());
    Some(InputError::new(path, given, allowed))
}

/// An error, unless an agent is what it has to be; `at` is the path of its id.
pub(crate) fn unless_role(at: &str, id: AgentId, role: AgentRole) -> Option<InputError> {
    (id.role != role).then(|| {
        let [given, allowed] = [id.role, role].map(|role| format!("{:?}", role.name()));
        InputError::new(format!("{at}.role"), Some(given), allowed)
    })
}

fn unless_below(kinds: usize, at: &str, kind: usize, what: &str) -> Option<InputError> {
    let allowed = format!("a number below {kinds}, the number of {what} kinds");
    (kind >= kinds).then(|| InputError::new(at.to_owned(), Some(kind.to_string()), allowed))
}
