"""Recordings of runs: MCAP files that Foxglove shows, and that are enough to take the run again.

`Recording` writes one, `replay` takes its run again; docs/simulation.md says what is in it.
"""

from agent_economy.recording.file import RecordingError
from agent_economy.recording.recorder import Recording
from agent_economy.recording.replayer import Replay, replay

__all__ = ["Recording", "RecordingError", "Replay", "replay"]
