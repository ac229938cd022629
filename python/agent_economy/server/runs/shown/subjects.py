"""The subjects of runs, and what a page is sent of them."""

from agent_economy.runs.stepped import Stepped
from agent_economy.server.runs.shown import columns, economy, lane, passage, real_robots
from agent_economy.server.runs.shown.events import EVENTS
from agent_economy.server.runs.shown.subject import Request, Subject
from agent_economy.server.runs.signals.sources import ENGINES as SIGNALS
from agent_economy.types.page import Layer, Offer, Panel, Shown

SUBJECTS: dict[str, tuple[Subject, ...]] = {
    "metric": (lane.SUBJECT, passage.SUBJECT, economy.SUBJECT, real_robots.SUBJECT),
    "classic": (),
}
"""The subjects of each engine, in the order of their layers and panels."""


def offer(simulation: Stepped) -> Offer:
    """Return what pages can show of a run."""
    subjects = subjects_of(simulation)
    signals = SIGNALS[simulation.scenario.engine]
    return {
        "layers": [layer for subject in subjects for layer in subject.layers],
        "panels": [panel for subject in subjects for panel in subject.panels],
        "events": list(EVENTS),
        "signals": signals.offer(simulation),
        "robot_signals": list(signals.robots),
        "columns": columns.offer_of(simulation),
    }


def shown(simulation: Stepped, request: Request) -> Shown | None:
    """Return the layers and panels that a page has requested; None if there are none."""
    layers: dict[str, Layer] = {}
    panels: dict[str, Panel] = {}
    for subject in subjects_of(simulation):
        offered = {each["id"] for each in (*subject.layers, *subject.panels)}
        if not offered & request.ids:
            continue
        if contents := subject.contents(simulation, request):
            layers |= {
                name: make() for name, make in contents.layers.items() if name in request.layers
            }
            made = {
                name: make() for name, make in contents.panels.items() if name in request.panels
            }
            panels |= {name: panel for name, panel in made.items() if panel is not None}
    if not layers and not panels:
        return None
    return {"type": "shown", "tick": simulation.tick, "layers": layers, "panels": panels}


def subjects_of(simulation: Stepped) -> list[Subject]:
    """Return the subjects that a run has."""
    return [
        subject for subject in SUBJECTS[simulation.scenario.engine] if subject.is_in(simulation)
    ]
