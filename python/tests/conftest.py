"""What tests share."""

from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture
def classic_toml() -> Path:
    """Return the 2003 experiment's scenario."""
    return ROOT / "scenarios" / "classic.toml"
