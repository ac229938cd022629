"""The server of a drive: what its page receives, and which addresses its page may reach."""

from pathlib import Path

from starlette.testclient import TestClient

from agent_economy.server.app import app
from agent_economy.server.drive import Drive, RobotOnMap, Sonar
from agent_economy.server.workspace import Workspace

FENCE = ((1.0, 1.0), (39.0, 1.0), (39.0, 29.0))
DRIVE = Drive(
    40123,
    "secret",
    "bender",
    {"latitude_deg": 36.6, "longitude_deg": -121.9},
    {"bender/0": RobotOnMap(FENCE, (Sonar(20.0, 6.0),))},
)


def client(folder: Path, drive: Drive | None) -> TestClient:
    """Return a client of a server."""
    return TestClient(app(Workspace(folder), "127.0.0.1", drive=drive), "http://127.0.0.1:8765")


def test_the_page_of_a_drive_receives_port_and_token_of_the_warden(tmp_path: Path) -> None:
    response = client(tmp_path, DRIVE).get("/drive")
    assert response.json() == {
        "warden": {"port": 40123, "token": "secret"},
        "fleet": "bender",
        "origin": {"latitude_deg": 36.6, "longitude_deg": -121.9},
        "robots": {
            "bender/0": {
                "fence_m": [[1, 1], [39, 1], [39, 29]],
                "sonars": [{"facing_deg": 20, "max_m": 6}],
            }
        },
    }
    assert response.headers["cache-control"] == "no-store"


def test_pages_of_other_sites_do_not_receive_the_token(tmp_path: Path) -> None:
    headers = {"origin": "http://example.org"}
    assert client(tmp_path, DRIVE).get("/drive", headers=headers).status_code == 403


def test_only_the_page_of_a_drive_may_reach_another_port(tmp_path: Path) -> None:
    policy = "content-security-policy"
    own = client(tmp_path, None).get("/drive").headers[policy]
    assert "connect-src" not in own
    of_drive = client(tmp_path, DRIVE).get("/drive").headers[policy]
    assert of_drive == f"{own}; connect-src 'self' http://127.0.0.1:40123"


def test_a_server_without_a_drive_has_none(tmp_path: Path) -> None:
    assert client(tmp_path, None).get("/drive").json() is None
