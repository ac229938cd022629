"""The build of this program: runs of two builds may differ, so they are never mixed."""

from functools import cache
from importlib.metadata import version
from typing import NamedTuple

from agent_economy import _core


class Build(NamedTuple):
    """A build of this program.

    Attributes:
        program: The version of the program.
        engine: The hash of the sources that decide the outcome of a run: 16 hexadecimal digits;
            None if it is unknown.
    """

    program: str
    engine: str | None

    def __str__(self) -> str:
        """Return it in words."""
        engine = "unknown engine" if self.engine is None else f"engine {self.engine}"
        return f"version {self.program}, {engine}"


def version_line() -> str:
    """Return the version of the program, with the Cargo profile by which its engine was compiled.

    Profiles differ in speed; a run has the same outcome with all.
    """
    return f"agent-economy {version('agent-economy')} ({_core.PROFILE} build)"


@cache
def own_build() -> Build:
    """Return the installed build."""
    return Build(version("agent-economy"), _core.ENGINE)
