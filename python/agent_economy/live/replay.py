"""Reads and replays the recording of a drive: `verification` compares it, bit for bit."""

import json
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import IO, Any

from mcap.exceptions import EndOfFile
from mcap.records import Channel, McapRecord, Message, Metadata

from agent_economy import recording
from agent_economy._core import InputError
from agent_economy.live.loop.team import Team
from agent_economy.live.plan import plan_of
from agent_economy.live.verification import INPUT, Mismatch, Verification
from agent_economy.recording import Replay
from agent_economy.recording.fields import Entries, hash_text
from agent_economy.recording.live_topics import (
    EVENTS,
    LIVE,
    ORDERS,
    READINGS,
    SETPOINTS,
    TICKS,
    WIRE,
)
from agent_economy.recording.reading import file_errors, named, read_records
from agent_economy.regular_file import open_regular
from agent_economy.runs.simulation import Simulation

TOPICS = (EVENTS, ORDERS, TICKS, SETPOINTS, INPUT)


@dataclass
class Drive:
    """What a recording has of a drive, in the order in which the loop took it.

    Attributes:
        values: Its metadata; None if the recording is not of a drive.
        messages: The lines, readings and events, the ticks, the percepts and the setpoints.
        is_damaged: Whether the file is damaged behind them.
    """

    values: Mapping[str, str] | None = None
    messages: list[tuple[str, dict[str, Any]]] = field(default_factory=list)
    is_damaged: bool = False
    _topics: dict[int, str] = field(default_factory=dict)
    _tick: int = -1

    def read_all(self, stream: IO[bytes]) -> None:
        """Add the records of a file, up to its end, or to where it is truncated or damaged."""
        with suppress(EndOfFile):
            self.is_damaged = read_records(stream, self.add) is not None

    def add(self, record: McapRecord) -> None:
        """Add a record of the file."""
        match record:
            case Metadata() if record.name == LIVE:
                self.values = record.metadata
            case Channel():
                self._topics[record.id] = record.topic
            case Message():
                topic = self._topics.get(record.channel_id, "")
                if topic.startswith((WIRE, READINGS)) or topic in TOPICS:
                    self._add_message(topic, json.loads(record.data))

    def _add_message(self, topic: str, message: dict[str, Any]) -> None:
        if topic == TICKS:
            if message["tick"] <= self._tick:
                error = "is damaged: its steps are not in order"
                raise InputError(error)
            self._tick = message["tick"]
        self.messages.append((topic, message))

    @property
    def lines(self) -> int:
        """The number of lines that robots sent."""
        return sum(message.get("type") == "line" for _, message in self.messages)

    @property
    def readings(self) -> int:
        """The number of recorded readings."""
        return sum(topic.startswith(READINGS) for topic, _ in self.messages)

    def lines_of(self, robot: str) -> list[dict[str, Any]]:
        """Return the lines of a robot, read and written, in order."""
        lines = (message for topic, message in self.messages if topic.startswith(WIRE))
        return [each for each in lines if each["robot"] == robot]

    @property
    def steps(self) -> int:
        """The number of steps that are whole: the tick up to which a replay can verify it.

        It does not depend on which states are recorded.
        """
        ticks = (message["tick"] for topic, message in self.messages if topic == SETPOINTS)
        return 1 + max(ticks, default=-1)

    def replayed(self, run: Replay) -> Replay:
        """Return the replay of its run, with what its messages give up to its last whole step.

        Raises:
            InputError: If its metadata or messages are damaged.
        """
        simulation, found = self._verified(run)
        is_damaged = self.is_damaged or run.damaged_tick is not None
        done = simulation.tick
        result = replace(
            run,
            is_complete=run.is_complete and not is_damaged,
            tick=done,
            hash=hash_text(simulation.hash),
            outcome=simulation.outcome(),
            lines=self.lines,
            readings=self.readings,
            damaged_tick=done if is_damaged else None,
        )
        before = run.mismatch_tick
        if found is None or (before is not None and before < found.tick):
            return result
        return replace(result, mismatch_tick=found.tick, mismatch=found.what)

    def _verified(self, replayed: Replay) -> tuple[Simulation, Mismatch | None]:
        """Return its run, and the first step that its messages do not reproduce.

        Raises:
            InputError: If its metadata are damaged.
        """
        run = Entries(f"metadata {LIVE!r}", self.values)
        try:
            plan = plan_of(run.json("plan"))
            simulation = Simulation(
                replayed.scenario, seed=replayed.seed, run=replayed.run, external=replayed.external
            )
            team = Team(
                plan,
                simulation,
                run.json("waypoints_m"),
                seed=replayed.seed,
                start_s=float(run.text("start_s")),
            )
            verification = Verification(plan, team, simulation, self.messages)
            return simulation, verification.run(self.steps)
        except (KeyError, TypeError, ValueError) as error:
            if isinstance(error, InputError):
                raise
            message = f"is damaged: the metadata or a message of its drive: {error!r}"
            raise InputError(message) from None


def replay(path: str | Path, *, verify: bool = True) -> Replay:
    """Replay a recorded run or drive from its file alone. Ctrl-C stops it between two steps.

    Of a drive, the readings are made again of the recorded lines of the robots, and the percepts
    of the recorded readings; they have to be the recorded ones, as have the setpoints: of every
    step, also if only every n-th state is recorded. Recordings of earlier versions have no
    readings: theirs are made of the lines.

    Args:
        path: A recording. A truncated file is compared up to its end, a damaged one up to the
            damage.
        verify: Whether to refuse a recording of another build of this program, which may give
            another run. Without it, such a recording is replayed and compared all the same.

    Raises:
        InputError: If the file cannot be read, is damaged before its first state, is not a
            recording of a run, contains a scenario that this version does not accept, or is of
            another build.
    """
    replayed = recording.replay(path, verify=verify)
    # The robots of a drive are external: other files are read once.
    drive = read_drive(Path(path)) if replayed.external else None
    if drive is None:
        return replayed
    with named(Path(path)):
        return drive.replayed(replayed)


def read_drive(path: Path) -> Drive | None:
    """Return what a recording has of a drive; None if it is not of one.

    Raises:
        InputError: If it cannot be read, or the metadata of its drive are missing.
    """
    drive = Drive()
    with file_errors(path), open_regular(path) as stream:
        drive.read_all(stream)
        if drive.values is None and any(topic != INPUT for topic, _ in drive.messages):
            message = f"is damaged: it has lines of robots, but no metadata {LIVE!r}"
            raise InputError(message)
    return None if drive.values is None else drive
