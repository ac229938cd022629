"""Writes the recording of a run: the run is replayed from its beginning to its latest tick."""

import hashlib
import re
from collections.abc import Iterator
from contextlib import contextmanager
from io import BufferedWriter
from pathlib import Path

from agent_economy._core import InputError
from agent_economy.recording import Recording, RecordingError
from agent_economy.recording.output import check_no_drive
from agent_economy.recording.recorder import SUFFIX
from agent_economy.recording.replayer import replay_steps
from agent_economy.runs import factory
from agent_economy.runs.stepped import Stepped
from agent_economy.server.recordings.history import RunHistory
from agent_economy.whole_file import put_in_place, remove_abandoned, temporary_file

MAX_ROBOT_STEPS = 10_000_000
"""Maximum of steps times robots, about half a gigabyte."""

ROBOTS_PER_STEP = 10
"""A step takes the space of this many robots, in addition to that of the team."""

DIGEST_DIGITS = 12
MAX_LETTERS = 60


class RecordingWriter:
    """A recording that is written in a thread of its own, which any other thread can cancel.

    The name of the file ends in a digest of its content: saving a run twice gives one file.

    Attributes:
        history: The run that is recorded.
        done: Steps that have been written.
    """

    history: RunHistory
    done: int

    def __init__(self, history: RunHistory, folder: Path) -> None:
        """Begin with nothing written."""
        self.history, self._folder = history, folder
        self.done, self._is_cancelled = 0, False

    def cancel(self) -> None:
        """Stop between two steps, and leave no file behind."""
        self._is_cancelled = True

    def write(self) -> Path | None:
        """Return the file, complete and on disk; None if it was cancelled.

        Raises:
            InputError: If the run is too long, or the file cannot be written; no file is left.
        """
        history = self.history
        begun = history.scenario, history.seed, history.run
        simulation = factory.create(*begun, history.external)
        check_size(history.latest_tick * size_of_step(simulation))
        with saving_errors(self._folder):
            self._folder.mkdir(exist_ok=True)
            remove_abandoned(self._folder, SUFFIX)
            with temporary_file(self._folder, SUFFIX) as file:
                is_complete = self._record(simulation, file)
                return rename_complete(file, stem(history)) if is_complete else None

    def _record(self, simulation: Stepped, file: BufferedWriter) -> bool:
        robot_steps, history = 0, self.history
        with Recording(simulation, file) as recording:
            replayed = replay_steps(
                simulation, recording.step, history.log, history.inputs, history.latest_tick
            )
            for tick in replayed:
                self.done = tick
                robot_steps += size_of_step(simulation)
                check_size(robot_steps)
                if self._is_cancelled:
                    return False
        return True


def size_of_step(simulation: Stepped) -> int:
    """Return the space of a step, in robots."""
    return len(simulation.robots) + ROBOTS_PER_STEP


def check_size(robot_steps: int) -> None:
    """Check that a recording is not too large.

    Raises:
        InputError: If it is.
    """
    if robot_steps > MAX_ROBOT_STEPS:
        message = (
            f"The run is too long to be saved from the page: the maximum is {MAX_ROBOT_STEPS:,} "
            f"robot steps, and each step counts as {ROBOTS_PER_STEP} robots more than the team "
            "has. agent-economy run --record FILE --every 10 saves longer runs."
        )
        raise InputError(message)


@contextmanager
def saving_errors(folder: Path) -> Iterator[None]:
    """Name the folder in the errors of saving a recording to it.

    Raises:
        InputError: If a file cannot be written.
    """
    try:
        yield
    except RecordingError:
        message = f"{folder}: the disk is full, and the recording was removed: free some space"
    except OSError as error:
        message = f"{folder}: cannot be written: {error.strerror or error}"
    else:
        return
    raise InputError(message)


def rename_complete(file: BufferedWriter, name: str) -> Path:
    """Give a file its final name once its content is on disk.

    Raises:
        InputError: If a recording of a drive has this name.
    """
    path = Path(file.name)
    with path.open("rb") as stream:
        digest = hashlib.file_digest(stream, "sha256").hexdigest()[:DIGEST_DIGITS]
    final = path.with_name(f"{name}-{digest}{SUFFIX}")
    check_no_drive(final)
    put_in_place(file, final)
    return final


def stem(history: RunHistory) -> str:
    """Return the first part of the name of a recording."""
    name = re.sub(r"[^\w-]+", "-", history.scenario.name)[:MAX_LETTERS]
    return f"{name}-{history.seed}-{history.run}"
