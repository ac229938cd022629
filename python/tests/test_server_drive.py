"""The server of a drive: what its page receives, what it may reach, and what is refused."""

from pathlib import Path
from typing import Any

import pytest
from starlette.testclient import TestClient
from starlette.websockets import WebSocketDisconnect

from agent_economy.server.app import app
from agent_economy.server.guard import cookie_of
from agent_economy.server.workspace import Workspace
from agent_economy.types.warden import Drive, Warden, WorldOrigin

FENCE = ((1.0, 1.0), (39.0, 1.0), (39.0, 29.0))
ORIGIN: WorldOrigin = {
    "latitude_deg": 36.6,
    "longitude_deg": -121.9,
    "rotation_deg": 0.0,
    "declination_deg": 0.0,
}
WARDEN: Warden = {"port": 40123, "token": "secret"}
DRIVE: Drive = {
    "warden": WARDEN,
    "fleet": "bender",
    "origin": ORIGIN,
    "robots": {
        "bender/0": {"fence_m": FENCE, "sonars": [{"facing_deg": 20.0, "max_m": 6.0}]},
    },
}


SECRET = "secret-of-the-page"  # noqa: S105  (of a test)
OWN = "http://127.0.0.1:8765"
COOKIE = f"agent-economy-token-8765={cookie_of(SECRET)}"
FIELD = {"agent-economy-token": SECRET}
FOREIGN = [{"sec-fetch-site": site} for site in ("cross-site", "same-site")]
OPENED = {"sec-fetch-mode": "navigate", "sec-fetch-dest": "document"}


def stranger(folder: Path, drive: Drive | None) -> TestClient:
    """Return a client of a server that does not know its secret, if it has one."""
    token = None if drive is None else SECRET
    return TestClient(app(Workspace(folder), "127.0.0.1", token, drive=drive), OWN)


def client(folder: Path, drive: Drive | None) -> TestClient:
    """Return a client of a server, with the cookie of a page that was opened."""
    client = stranger(folder, drive)
    client.headers.update({"cookie": COOKIE, **FIELD})
    return client


def test_the_page_of_a_drive_receives_port_and_token_of_the_warden(tmp_path: Path) -> None:
    response = client(tmp_path, DRIVE).get("/drive")
    assert response.json() == {
        "warden": {"port": 40123, "token": "secret"},
        "fleet": "bender",
        "origin": ORIGIN,
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


def test_the_page_of_a_drive_is_not_served_without_a_secret(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="needs a token"):
        app(Workspace(tmp_path), "127.0.0.1", drive=DRIVE)


@pytest.mark.parametrize(
    "path",
    [
        "/",
        "/drive",
        "//drive",
        "/drive/",
        "/%64rive",
        "/api/scenarios",
        "/favicon.svg",
        "/x/../drive",
    ],
)
@pytest.mark.parametrize("method", ["GET", "HEAD", "OPTIONS", "POST"])
def test_a_page_without_the_secret_learns_nothing(tmp_path: Path, method: str, path: str) -> None:
    response = stranger(tmp_path, DRIVE).request(method, path)
    assert response.status_code == 403
    known = response.text + str(response.headers)
    assert not [
        secret for secret in (WARDEN["token"], SECRET, str(WARDEN["port"])) if secret in known
    ]


@pytest.mark.parametrize(
    "headers",
    [
        {},
        {"cookie": COOKIE.replace("-8765", "")},
        {"cookie": COOKIE.replace("8765", "8766")},
        {"cookie": f"agent-economy-token-8765={SECRET}"},
        {"cookie": "agent-economy-token-8765=other"},
        {"cookie": "agent-economy-token-8765="},
        {"cookie": f"{COOKIE}x"},
        {"cookie": COOKIE, "host": "127.0.0.1:8766"},
        {"cookie": COOKIE, "host": "192.168.0.7:8765"},
        FIELD,
        {"token": SECRET},
        {"x-token": SECRET},
        {"authorization": f"Bearer {SECRET}"},
    ],
)
def test_a_wrong_cookie_and_a_secret_elsewhere_are_refused(
    tmp_path: Path, headers: dict[str, str]
) -> None:
    other = stranger(tmp_path, DRIVE)
    assert other.get("/drive", headers=headers).status_code == 403
    with pytest.raises(WebSocketDisconnect), other.websocket_connect("/ws", headers=headers):
        pass


def test_the_printed_address_gives_a_cookie_that_opens_everything(tmp_path: Path) -> None:
    page = stranger(tmp_path, DRIVE)
    given = page.get("/drive", params={"token": SECRET}).headers["set-cookie"]
    assert given == f"{COOKIE}; HttpOnly; SameSite=Strict; Path=/"
    assert page.get("/drive", headers=FIELD).status_code == 200
    with page, page.websocket_connect(f"ws://{OWN.removeprefix('http://')}/ws"):
        pass


def test_a_server_that_gets_the_cookie_on_another_port_cannot_take_the_robots(
    tmp_path: Path,
) -> None:
    thief = stranger(tmp_path, DRIVE)
    assert SECRET not in COOKIE
    for stolen in ({}, {"agent-economy-token": cookie_of(SECRET)}, {"agent-economy-token": ""}):
        response = thief.get("/drive", headers={"cookie": COOKIE, **stolen})
        assert response.status_code == 403
        assert WARDEN["token"] not in response.text


def test_two_servers_on_one_host_keep_their_cookies(tmp_path: Path) -> None:
    served = {
        port: app(Workspace(tmp_path), "127.0.0.1", str(port), drive=DRIVE) for port in (1, 2)
    }
    cookies: Any = None
    for port, each in served.items():
        page = TestClient(each, f"http://127.0.0.1:{port}", cookies=cookies)
        assert page.get("/drive", params={"token": str(port)}).status_code == 200
        cookies = page.cookies
    for port, each in served.items():
        page = TestClient(each, f"http://127.0.0.1:{port}", cookies=cookies)
        assert page.get("/api/scenarios").status_code == 200


@pytest.mark.parametrize("drive", [DRIVE, None])
@pytest.mark.parametrize("site", FOREIGN)
def test_a_page_of_another_site_that_hides_its_origin_may_only_open_ours(
    tmp_path: Path, site: dict[str, str], drive: Drive | None
) -> None:
    page = client(tmp_path, drive)
    for path, headers, status in (
        ("/drive", {}, 403),
        ("/drive", OPENED, 403),
        ("/", {}, 403),
        ("/", {**OPENED, "sec-fetch-dest": "iframe"}, 403),
        ("/api/scenarios", {"sec-fetch-mode": "no-cors"}, 403),
    ):
        assert page.get(path, headers={**site, **headers}).status_code == status, path
    assert page.get("/", headers={**site, **OPENED}).status_code != 403
    assert page.post("/", headers={**site, **OPENED}).status_code == 403
    for own in ("same-origin", "none"):
        assert page.get("/drive", headers={"sec-fetch-site": own}).status_code == 200
