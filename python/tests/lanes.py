"""A small lane that an air vehicle and two ground vehicles clear."""

from pathlib import Path

SMALL_LANE = Path(__file__).resolve().parents[2] / "web/tests/small_lane.toml"
"""The same lane as in the tests of the page: 40 m x 10 m, three mines, two controllers."""
