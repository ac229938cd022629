"""The sources of the signals of each engine."""

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

from agent_economy.runs.stepped import Stepped
from agent_economy.server.runs.signals import controllers
from agent_economy.server.runs.signals.bodies import CLASSIC, METRIC, ClassicBodies, MetricBodies
from agent_economy.server.runs.signals.controllers import Controllers
from agent_economy.server.runs.signals.inspections import Inspections
from agent_economy.server.runs.signals.source import Source, Values
from agent_economy.types.page import SignalOffer


class Engine(NamedTuple):
    """The signals of an engine.

    Attributes:
        offer: Returns the signals of a run that are not of its robots.
        robots: The signals of each robot.
        sources: The source of signals, by the first part of their ids.
    """

    offer: Callable[[Any], list[SignalOffer]]
    robots: tuple[SignalOffer, ...]
    sources: dict[str, Callable[[], Source]]


ENGINES = {
    "metric": Engine(
        controllers.offer,
        METRIC,
        {"controller": Controllers, "body": MetricBodies, "robot": Inspections},
    ),
    "classic": Engine(lambda _: [], CLASSIC, {"body": ClassicBodies}),
}


class Sources:
    """The sources of some signals of a run."""

    def __init__(self, simulation: Stepped, signals: Sequence[str]) -> None:
        """Begin at the current step of a run."""
        self._simulation, self._count = simulation, len(signals)
        places: dict[str, list[int]] = {}
        for place, signal in enumerate(signals):
            places.setdefault(signal.partition("/")[0], []).append(place)
        makers = ENGINES[simulation.scenario.engine].sources
        self._parts = [
            (makers[kind](), of, [signals[place].partition("/")[2] for place in of])
            for kind, of in places.items()
            if kind in makers
        ]

    def step(self) -> None:
        """Note the current step."""
        for source, _, paths in self._parts:
            source.step(self._simulation, paths)

    def values(self) -> Values:
        """Return the values of the signals at the current step; None where there is none."""
        values: Values = [None] * self._count
        for source, places, paths in self._parts:
            found = source.values(self._simulation, paths)
            for place, value in zip(places, found, strict=True):
                values[place] = value
        return values
