"""A small lane that an air vehicle and two ground vehicles clear."""

from pathlib import Path

SMALL_LANE = Path(__file__).resolve().parents[2] / "web/tests/small_lane.toml"
"""The same lane as in the tests of the page: 40 m x 10 m, three mines, two controllers."""

PASSAGE = """
[passage]
width_m = 3
vehicles = 3
speed_m_s = 4
gap_m = 8
destroy_probability = 0.8
"""
"""Vehicles that pass that lane."""


def with_passage(folder: Path) -> Path:
    """Write the lane with vehicles that pass it."""
    path = folder / "passage.toml"
    path.write_text(SMALL_LANE.read_text() + PASSAGE)
    return path
