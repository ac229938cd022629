"""The loop: receive readings, step the brains, send setpoints; at the pace of the clock."""

from collections import deque
from collections.abc import Mapping
from contextlib import suppress
from typing import Any

from agent_economy.live.clock import now_s
from agent_economy.live.external import bodies_of
from agent_economy.live.fleet import Fleet
from agent_economy.live.loop.log import Log, LogOptions
from agent_economy.live.loop.pacer import MIN_PERIOD, Pacer
from agent_economy.live.loop.pipe import Pipe
from agent_economy.live.loop.team import Team
from agent_economy.recording import RecordingError
from agent_economy.recording.file import strict
from agent_economy.recording.stops import Stop, StopReader
from agent_economy.runs.simulation import Simulation


class Loop:
    """One drive, between the plan and the end.

    Attributes:
        peers: The numeric addresses of connected motor ports.
        record: The recording.
    """

    _pacer: Pacer

    def __init__(
        self, fleet: Fleet, pipe: Pipe, options: LogOptions, seed: int, *, has_page: bool
    ) -> None:
        """Create the run at its first step; a page needs the inputs of all steps.

        Raises:
            InputError: If the run or its recording cannot be created.
        """
        self._inputs: deque[Mapping[str, Any]] | None = deque() if has_page else None
        self._stop_reader = StopReader()
        self._stops: list[Stop] = []
        self.peers: dict[str, tuple[str, int]] = {}
        self._pipe = pipe
        external = bodies_of(fleet.plan)
        self._simulation = Simulation(fleet.scenario, seed=seed, external=external)
        self._start_s = start_s = now_s()
        self._team = Team(
            fleet.plan, self._simulation, fleet.waypoints_m, seed=seed, start_s=start_s
        )
        self._log: Log | None = Log(self._simulation, options, fleet, start_s)
        self.record = self._log.path

    def run(self) -> None:
        """Run until the warden ends the drive.

        Raises:
            WardenLostError: If the warden has ended or is silent.
        """
        step_s = self._simulation.step_s
        # After a step, as much time has been simulated as has passed, never more.
        self._pacer = Pacer(step_s, self._start_s + step_s, now_s() + step_s)
        while self._receive():
            self._tick()
        self.close()

    def _receive(self) -> bool:
        """Take messages until the next tick is due; return whether the drive continues."""
        for message in self._pipe.receive_until(self._pacer.due_s):
            match message["type"]:
                case "end":
                    return False
                case "cancel":
                    self._discard()
                    return False
                case "peer":
                    self.peers[message["robot"]] = tuple(message["address"])
                case "line" | "written":
                    self._add(message)
                case "reading" | "event" | "order":
                    self._team.add(message)
                    self._add(message)
                    self._note_stop(message)
        return True

    def _tick(self) -> None:
        """Take one step, unless the recording has failed: what is not recorded is not driven."""
        now = now_s()
        lateness_s = self._pacer.tick(now)
        if self._log is not None:
            try:
                self._step(self._log, now, lateness_s)
            except RecordingError as error:
                self._fail(error)
        if self._pacer.must_report():
            self._pipe.send({"type": "message", "message": explanation(self._pacer)})
        beat = {"type": "beat", "lateness_s": now_s() - now + lateness_s}
        self._pipe.send(beat | self._pacer.counts())

    def _step(self, log: Log, now: float, lateness_s: float) -> None:
        tick = self._simulation.tick
        log.tick(tick, now, lateness_s, self._pacer.behind_s)
        percepts = self._team.percepts(tick, now)
        observed = self._team.observed(tick, now)
        commands = log.step(percepts, observed)
        motions = self._team.motions(commands)
        log.setpoints(tick, motions, now)
        for robot, motion in motions.items():
            self._pipe.send({"type": "setpoint", "robot": robot, "tick": tick, "motion": motion})
        for goal in self._team.new_verdicts():
            if not self._pipe.send({"type": "goal", **goal}):
                break  # The others are new in the next step, too.
        for silence in self._team.new_silence():
            if not self._pipe.send({"type": "radio", **silence}):
                break
        if self._inputs is not None:
            stops, self._stops = self._stops, []
            inputs = strict({"percepts": percepts, "observed": observed})
            self._inputs.append({"type": "input", "tick": tick, "inputs": inputs, "stops": stops})
            while self._inputs and self._pipe.send(self._inputs[0]):
                self._inputs.popleft()

    def _add(self, message: Mapping[str, Any]) -> None:
        if self._log is not None:
            try:
                self._log.add(message)
            except RecordingError as error:
                self._fail(error)

    def _note_stop(self, message: Mapping[str, Any]) -> None:
        if self._inputs is not None and message["type"] == "event":
            stop = self._stop_reader.read(self._simulation.tick, message)
            self._stops += [] if stop is None else [stop]

    def _fail(self, error: RecordingError) -> None:
        self._log = None
        self._pipe.send({"type": "recording_error", "message": str(error)})

    def _discard(self) -> None:
        if self._log is not None:
            log, self._log = self._log, None
            with suppress(RecordingError, OSError):
                log.discard()

    def close(self) -> None:
        """Close the recording; also after the warden was lost."""
        if self._log is not None:
            try:
                self._log.close()
            except RecordingError as error:
                self._fail(error)


def explanation(pacer: Pacer) -> str:
    """Return why a run is behind the clock, in words, and how long that lasts."""
    fast_s = MIN_PERIOD * pacer.period_s
    return (
        f"The run is {pacer.behind_s:.1f} s behind the clock, because steps of the brains were "
        f"late. It steps 10% faster until both agree again: for about {pacer.slew_s:.0f} s, if "
        f"each step takes less than {fast_s:g} s. If this is reported again, steps take longer for "
        "good: use a longer clock.step_s, fewer simulated robots, or a faster machine."
    )
