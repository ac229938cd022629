"""Warnings about scenarios: what is allowed, and probably not meant."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from agent_economy import _core
from agent_economy.scenario.source import Source, Value


@dataclass(frozen=True)
class ScenarioWarning:
    """A value that is allowed, and probably not meant, such as a map that is partly cut off.

    Attributes:
        origin: Where the value comes from: "FILE:LINE", "study.vary" or an option.
        file: The file, if the value comes from one.
        line: Its line there.
        path: Dotted keys from the scenario's root.
        value: The value as it is written; None if it is missing.
        effect: The effect of the value, and what to do.
        message: All of this in a line.
    """

    origin: str
    file: str | None
    line: int | None
    path: str
    value: str | None
    effect: str
    message: str

    def __str__(self) -> str:
        """Return the message."""
        return self.message


def warnings(
    source: Source, configurations: Iterable[Mapping[str, Value]]
) -> tuple[ScenarioWarning, ...]:
    """Return the warnings about configurations of a valid scenario.

    Args:
        source: The scenario.
        configurations: Of each, values by path; {} for the scenario as it is.
    """
    found = _core.scenario_warnings(source, [dict(values) for values in configurations])
    return tuple(ScenarioWarning(**each) for each in found)
