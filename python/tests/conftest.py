"""What tests share."""

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
    """Restore Ctrl-C: a shell that runs the tests in the background has it ignored.

    Processes that tests start, and send it to, would inherit that.
    """
    signal.signal(signal.SIGINT, signal.default_int_handler)


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


@pytest.fixture
def client(tmp_path: Path) -> Iterator[TestClient]:
    """Return who asks a server whose folder is the test's own."""
    with TestClient(app(Workspace(tmp_path), "127.0.0.1"), OWN) as client:
        yield client


@pytest.fixture
def page(client: TestClient) -> Iterator[Page]:
    """Return a page that watches a run of that server."""
    with client.websocket_connect(WS) as socket:
        yield Page(socket)
