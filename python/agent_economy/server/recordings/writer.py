"""Saving a run: it is taken again from its beginning to its edge, into a recording."""

import hashlib
import os
import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from agent_economy._core import InputError
from agent_economy.begin import begun
from agent_economy.recording import Recording, RecordingError
from agent_economy.recording.recorder import ENDING
from agent_economy.recording.replayer import taken_again
from agent_economy.server.recordings.history import RunHistory
from agent_economy.server.recordings.temporary_files import clear, unfinished
from agent_economy.stepped import Stepped

MAX_ROBOT_STEPS = 10_000_000
"""Steps times robots: half a gigabyte."""

STEP_ROBOTS = 10
"""A step takes as much room besides as so many robots."""

DIGITS = 12
MAX_LETTERS = 60


class Saving:
    """A run on its way into a recording, in a thread of its own; any other can stop it.

    Its name ends in a digest of what is in it: the same run saved once more is the same file.

    Attributes:
        course: What is saved.
        done: Steps that are in the file.
    """

    course: RunHistory
    done: int

    def __init__(self, course: RunHistory, folder: Path) -> None:
        """Begin with nothing written."""
        self.course, self._folder = course, folder
        self.done, self._is_stopped = 0, False

    def stop(self) -> None:
        """Give up between two steps; nothing is left of the file."""
        self._is_stopped = True

    def write(self) -> Path | None:
        """Return the file, whole and on the disk; None if this was stopped.

        Raises:
            InputError: If the run is too long, or the file cannot be written; nothing is left.
        """
        course = self.course
        simulation = begun(course.scenario, course.seed, course.run)
        see_to_room(course.latest_tick * room_of(simulation))
        with in_words(self._folder):
            self._folder.mkdir(exist_ok=True)
            clear(self._folder, ENDING)
            with unfinished(self._folder, ENDING) as file:
                is_whole = self._record(simulation, file)
                return put_away(file, stem(course)) if is_whole else None

    def _record(self, simulation: Stepped, file: Path) -> bool:
        robot_steps, course = 0, self.course
        with Recording(simulation, file) as recording:
            again = (simulation, recording.step, course.log, course.inputs, course.latest_tick)
            for tick in taken_again(*again):
                self.done = tick
                robot_steps += room_of(simulation)
                see_to_room(robot_steps)
                if self._is_stopped:
                    return False
        return True


def room_of(simulation: Stepped) -> int:
    """Return what a step takes, in robots."""
    return len(simulation.robots) + STEP_ROBOTS


def see_to_room(robot_steps: int) -> None:
    """Refuse what is too long.

    Raises:
        InputError: If so.
    """
    if robot_steps > MAX_ROBOT_STEPS:
        message = (
            f"The run is too long to be saved from here: at most {MAX_ROBOT_STEPS:,} steps of a "
            f"robot are, and each step counts for {STEP_ROBOTS} more. agent-economy run --record "
            "FILE --every 10 saves longer ones."
        )
        raise InputError(message)


@contextmanager
def in_words(folder: Path) -> Iterator[None]:
    """Say why nothing can be written into a folder.

    Raises:
        InputError: If so.
    """
    try:
        yield
    except RecordingError:
        message = f"{folder}: takes no more, so that the recording is not kept: make room there"
    except OSError as error:
        message = f"{folder}: cannot be written: {error.strerror or error}"
    else:
        return
    raise InputError(message)


def put_away(unfinished: Path, name: str) -> Path:
    """Give a file its name, once it is on the disk."""
    with unfinished.open("rb") as stream:
        digest = hashlib.file_digest(stream, "sha256").hexdigest()[:DIGITS]
        os.fsync(stream.fileno())
    return unfinished.replace(unfinished.with_name(f"{name}-{digest}{ENDING}"))


def stem(course: RunHistory) -> str:
    """Return what a name begins with."""
    name = re.sub(r"[^\w-]+", "-", course.scenario.name)[:MAX_LETTERS]
    return f"{name}-{course.seed}-{course.run}"
