"""Recordings of runs: MCAP files that Foxglove displays, and that suffice to replay the run.

`Recording` writes a recording, `replay` replays it. docs/simulation.md describes the topics.
"""

from agent_economy.recording.file import RecordingError
from agent_economy.recording.recorder import Recording
from agent_economy.recording.replayer import Replay, replay

__all__ = ["Recording", "RecordingError", "Replay", "replay"]
