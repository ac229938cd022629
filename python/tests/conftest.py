"""Fixtures of several test files."""

import signal
from collections.abc import Iterator
from pathlib import Path

import dask_cluster
import pytest
from dask_cluster import Cluster
from page_client import OWN, WS, Page
from starlette.testclient import TestClient

from agent_economy.server import Workspace, app

ROOT = Path(__file__).resolve().parents[2]


def pytest_configure() -> None:
    """Restore the handling of Ctrl-C, which a shell disables for a background process.

    The processes that tests start would inherit that.
    """
    signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture
def classic_toml() -> Path:
    """Return the file of the scenario of the 2003 experiment."""
    return ROOT / "scenarios" / "classic.toml"


@pytest.fixture
def mcap(tmp_path: Path) -> Path:
    """Return the file of a recording that does not exist yet."""
    return tmp_path / "run.mcap"


@pytest.fixture
def cluster() -> Iterator[Cluster]:
    """Return a Dask cluster's address, and its processes: a scheduler and two workers."""
    pytest.importorskip("distributed", reason="Dask is an extra")
    with dask_cluster.running() as cluster:
        yield cluster


@pytest.fixture
def client(tmp_path: Path) -> Iterator[TestClient]:
    """Return a client of a server with its own folder."""
    with TestClient(app(Workspace(tmp_path), "127.0.0.1"), OWN) as client:
        yield client


@pytest.fixture
def page(client: TestClient) -> Iterator[Page]:
    """Return a page that watches a run of that server."""
    with client.websocket_connect(WS) as socket:
        yield Page(socket)
