"""What robots perceive, decide and believe."""

from collections.abc import Mapping, Sequence
from typing import Any

from agent_economy.runs.simulation import Simulation
from agent_economy.server.runs.signals.source import Values, number, owner_of


class Inspections:
    """The inspections of robots, each as of the last step of its brain."""

    def __init__(self) -> None:
        """Begin before the first step."""
        self._last: dict[str, Any] = {}

    def step(self, simulation: Simulation, paths: Sequence[str]) -> None:
        """Note what the brains of the robots decide in the next step, if they step in it."""
        for robot in robots_of(paths, simulation.robots):
            # A run inspects one robot at a time.
            simulation.inspect(robot)
            if found := simulation.inspection():
                self._last[robot] = found

    def values(self, simulation: Simulation, paths: Sequence[str]) -> Values:
        """Return the numbers at some paths, ROBOT/KEY/KEY/..., of its inspection."""
        return [self._value(path, simulation.robots) for path in paths]

    def _value(self, path: str, names: Sequence[str]) -> float | None:
        found = owner_of(path, names)
        return None if found is None else number(at(self._last.get(found[0]), found[1]))


def robots_of(paths: Sequence[str], names: Sequence[str]) -> list[str]:
    """Return the robots that paths begin with, each once."""
    found = (owner_of(path, names) for path in paths)
    return list(dict.fromkeys(each[0] for each in found if each is not None))


def at(value: Any, path: str) -> Any:
    """Return what is at a path of keys and indices; None if nothing is."""
    for key in path.split("/"):
        if isinstance(value, Mapping):
            value = value.get(key)
        elif isinstance(value, list | tuple) and key.isascii() and key.isdecimal():
            value = value[int(key)] if len(key) < 10 and int(key) < len(value) else None  # noqa: PLR2004
        else:
            return None
    return value
