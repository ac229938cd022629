"""What a host and its pages need of a run, whichever kind it is."""

from typing import Protocol

from agent_economy.runs.stepped import Change, Stepped
from agent_economy.server.recordings.history import RunHistory
from agent_economy.server.runs.outcome_series import OutcomeSeries
from agent_economy.server.runs.run_events import RunEvents
from agent_economy.server.runs.versions import Versions

FOREVER = 2**53
"""A tick that no run reaches."""


class Progress(Protocol):
    """How far a run is."""

    @property
    def tick(self) -> int:
        """The current tick."""

    @property
    def latest_tick(self) -> int:
        """The last tick that was reached or recorded, or to which there are inputs."""

    @property
    def step_s(self) -> float:
        """The simulated duration of a step."""

    @property
    def is_finished(self) -> bool:
        """Whether the run cannot go beyond the current tick."""


class Run(Progress, Protocol):
    """A run that pages display: see `Timeline` and `LiveRun`."""

    @property
    def simulation(self) -> Stepped:
        """The run at its current tick."""

    @property
    def series(self) -> OutcomeSeries:
        """The outcome over time."""

    @property
    def events(self) -> RunEvents:
        """What has happened."""

    @property
    def versions(self) -> Versions:
        """The versions that changes have made."""

    @property
    def log(self) -> tuple[Change, ...]:
        """All changes up to the latest tick, in order."""

    @property
    def is_recorded(self) -> bool:
        """Whether the changes are those of a recording."""

    @property
    def mismatch_tick(self) -> int | None:
        """The first tick at which the run differed from its recording; None if it never did."""

    @property
    def history(self) -> RunHistory:
        """Everything that is needed to replay the run."""

    def seek(self, tick: int, budget_s: float) -> bool:
        """Move towards a tick for about `budget_s` of wall-clock time.

        Returns:
            Whether the run has arrived, or is finished before.

        Raises:
            InputError: If the run cannot continue.
        """
