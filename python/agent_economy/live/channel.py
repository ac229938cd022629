"""Messages between the warden and the loop: JSON, one per line, over pipes.

The warden sends: `line` (a stamped line of a robot, for the recording), directly followed by its
`reading` if it is valid (see `Reading.message`), `written` (a line that it wrote), `event` (a
change of a robot's state, with its reasons), `order` (a waypoint that an operator ordered), `peer`
(the address of a motor port), `beat` (it is running), `end` (close the recording), `cancel` (remove
it: the drive has not begun).

The loop sends: `plan` (the fleet, once), `invalid` (the errors of its input, then it ends),
`setpoint` (the motion of one robot), `beat` (one per tick, with its lateness and the time by which
the run is behind the clock), `goal` (a verdict), `message` (to the operator, in words),
`radio` (a robot has become silent for its team, or is so no more),
`recording_error`. If there is a page, also `run` (what it needs to step the same run, before
`plan`) and `input` (the percepts of one step, and the stops before it). `ended` stands for the end
of its pipe.
"""

import json
from collections.abc import Mapping
from typing import Any

Message = Mapping[str, Any]

BEAT_S = 0.05
"""Time between two beats of the warden."""

SILENCE_S = 0.3
"""Silence after which one process regards the other as dead or suspended."""


def encode(message: Message) -> bytes:
    """Return a message as a line. Numbers keep all their digits."""
    return json.dumps(message, separators=(",", ":")).encode() + b"\n"


class Decoder:
    """Collects bytes of a pipe, and returns complete messages."""

    def __init__(self) -> None:
        """Start at the beginning of a message."""
        self._rest = b""

    def feed(self, data: bytes) -> list[dict[str, Any]]:
        """Return the messages that are complete now, in order."""
        *lines, self._rest = (self._rest + data).split(b"\n")
        return [json.loads(line) for line in lines if line]
