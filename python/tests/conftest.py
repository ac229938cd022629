"""What tests share."""

from collections.abc import Iterator
from pathlib import Path

import dask_cluster
import pytest
from dask_cluster import Cluster

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture
def classic_toml() -> Path:
    """Return the 2003 experiment's scenario."""
    return ROOT / "scenarios" / "classic.toml"


@pytest.fixture
def cluster() -> Iterator[Cluster]:
    """Return a Dask cluster's address, and its processes: a scheduler and two workers."""
    pytest.importorskip("distributed", reason="Dask is an extra")
    with dask_cluster.running() as cluster:
        yield cluster
