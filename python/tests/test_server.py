"""The server of the page: its responses, and the clients that it admits."""

import asyncio
import base64
import json
import math
import re
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from page_client import HEADER, OWN, WS, Page
from starlette.testclient import TestClient
from starlette.websockets import WebSocketDisconnect

import agent_economy as ae
from agent_economy.scenario import bundled
from agent_economy.server import Workspace, app
from agent_economy.server.app import MAX_SESSIONS
from agent_economy.server.gallery import GROUPS, ORDER, START, YOURS
from agent_economy.server.messages import MAX_ERRORS
from agent_economy.server.request_body import MAX_BYTES
from agent_economy.server.runs.connection import PageConnection
from agent_economy.server.runs.display import MAX_IN_FLIGHT
from agent_economy.server.runs.thumbnail import ITEM, ROBOT, WALL
from agent_economy.server.transport import ConnectionClosedError


def stepped(steps: int) -> ae.Simulation:
    """Return the run that pages open, after some steps."""
    simulation = ae.Simulation("search-beliefs", 7)
    simulation.step(steps)
    return simulation


def test_the_gallery_begins_with_three_scenarios_and_then_those_of_the_folder(
    client: TestClient, tmp_path: Path
) -> None:
    for name in ("b", "a"):
        (tmp_path / f"{name}.toml").write_text(ae.Scenario.load("search").source.text)
    rows = client.get("/api/scenarios").json()
    groups = [row["group"] for row in rows]
    assert groups[:5] == [START] * 3 + [YOURS] * 2
    assert [row["id"] for row in rows[3:5]] == ["a.toml", "b.toml"]
    assert groups == sorted(groups, key=ORDER.index)


MANY = 80_000


def many_errors() -> str:
    """Return a scenario of less than a megabyte with many unknown keys."""
    keys = "".join(f"k{i} = 1\n" for i in range(MANY))
    return f'engine = "metric"\nsummary = "x"\n{keys}'


def test_of_many_errors_the_first_are_sent_with_their_total(client: TestClient) -> None:
    response = client.post("/api/check", content=many_errors())
    answer = response.json()
    assert (response.status_code, len(answer["errors"])) == (422, MAX_ERRORS)
    assert answer["total"] > MANY
    lines = [row["line"] or 0 for row in answer["errors"]]
    assert lines == sorted(lines)
    assert {"k0", "k1", "k150"} <= {row["path"] for row in answer["errors"]}
    assert len(response.content) < 200_000
    few = client.post("/api/check", content="engine = 1").json()
    assert few["total"] == len(few["errors"]) > 0


def test_a_run_and_a_study_of_many_errors_are_refused_with_their_total(
    client: TestClient, page: Page
) -> None:
    text = many_errors()
    page.send("open", text=text, seed="0", run="0")
    refused = page.wait_for("refused")
    assert (len(refused["errors"]), refused["total"] > MANY) == (MAX_ERRORS, True)
    answer = client.post("/api/plan", json={"text": text}).json()
    assert (len(answer["errors"]), answer["total"] > MANY) == (MAX_ERRORS, True)


def test_each_bundled_scenario_is_in_a_group_of_the_gallery() -> None:
    advice = "add its line to GROUPS in python/agent_economy/server/gallery.py"
    assert set(GROUPS) == set(bundled.scenarios()), advice
    assert list(GROUPS.values()).count(START) == 3
    assert list(GROUPS.values()) == sorted(GROUPS.values(), key=ORDER.index)


def test_the_gallery_lists_bundled_scenarios_and_those_of_the_folder(
    client: TestClient, tmp_path: Path
) -> None:
    text = ae.Scenario.load("search").source.text
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "field.toml").write_text(text)
    (tmp_path / "marked.toml").write_text(f"\ufeff{text}")
    (tmp_path / "other.toml").write_text("[tool]\n")
    (tmp_path / "deep.toml").write_text(f"a = {'[' * 5000}")
    (tmp_path / ".hidden").mkdir()
    (tmp_path / ".hidden" / "field.toml").write_text(text)
    rows = {row["id"]: row for row in client.get("/api/scenarios").json()}
    assert rows.keys() >= {
        "classic",
        "search",
        "search-beliefs",
        "open-field",
        "warehouse",
        "marked.toml",
        "mine/field.toml",
    }
    assert rows["mine/field.toml"]["where"] == "folder"
    assert not {"other.toml", ".hidden/field.toml"} & rows.keys()


def test_an_invalid_scenario_is_listed_and_its_errors_are_reported_when_it_is_opened(
    client: TestClient, page: Page, tmp_path: Path
) -> None:
    (tmp_path / "broken.toml").write_text('engine = "metric"\nsummary = "Mine."\n')
    rows = {row["id"]: row for row in client.get("/api/scenarios").json()}
    assert rows["broken.toml"]["summary"] == "Mine."
    assert "clock is missing" in page.refusal("open", scenario="broken.toml")


@pytest.mark.parametrize("name", ["classic", "search", "open-field", "flock"])
def test_each_scenario_has_a_thumbnail(client: TestClient, name: str) -> None:
    response = client.get("/api/pictures", params={"scenario": name})
    assert response.status_code == 200
    assert response.headers["content-type"] == "image/svg+xml"
    assert response.text.startswith("<svg")
    assert "polygon" in response.text


@pytest.mark.parametrize("name", ["../secret.toml", "/etc/passwd", "link.toml", "nothing", "a\0b"])
def test_nothing_outside_of_the_folder_is_opened(
    client: TestClient, tmp_path: Path, name: str
) -> None:
    secret = tmp_path.parent / "secret.toml"
    secret.write_text(ae.Scenario.load("search").source.text)
    (tmp_path / "link.toml").symlink_to(secret)
    response = client.get("/api/pictures", params={"scenario": name})
    assert response.status_code == 404
    assert "one of the gallery" in response.json()["errors"][0]["message"]


def test_a_map_outside_of_the_folder_is_not_read(client: TestClient) -> None:
    text = ae.Scenario.load("open-field").source.text
    response = client.post("/api/check", content=text.replace('"open-field.yaml"', '"../map.yaml"'))
    assert response.status_code == 422
    assert "not below the folder" in response.text


def test_errors_of_a_scenario_are_reported_with_their_lines(client: TestClient) -> None:
    text = ae.Scenario.load("search").source.text
    assert client.post("/api/check", content=text).json()["engine"] == "metric"
    wrong = text.replace("time_limit_s = 120", "time_limit_s = -1").replace(
        "count = 4", "cuont = 4", 1
    )
    errors = client.post("/api/check", content=wrong).json()["errors"]
    response = {error["path"].split(".")[-1]: error for error in errors}
    line = 1 + wrong[: wrong.index("time_limit_s = -1")].count("\n")
    assert response["time_limit_s"]["line"] == line
    assert response["cuont"]["suggestion"] == "count"


@pytest.mark.parametrize("content", [b"\xff\xfe", b"x" * (MAX_BYTES + 1), b"= 3", b""])
def test_content_that_is_not_a_scenario_is_rejected(client: TestClient, content: bytes) -> None:
    response = client.post("/api/check", content=content)
    assert response.status_code in (413, 422)
    assert response.json()["errors"][0]["message"]


def test_a_run_is_opened_played_and_paused(page: Page) -> None:
    page.open()
    over = page.finish()
    assert over["outcome"]["complete"]
    expected = ae.run("search-beliefs", seed=7)
    assert over["outcome"]["time_s"] == expected.time_s
    response = page.seek(50)
    assert response["hash"] == f"{stepped(50).hash:016x}"
    assert response["latest_tick"] == over["tick"]


def test_a_frame_contains_the_poses_of_the_robots(page: Page) -> None:
    page.open(tick=30)
    kind, generation, tick, robots, time_s, items, _ = HEADER.unpack_from(page.frames[-1])
    assert (kind, tick, robots, items) == (1, 30, 4, 4)
    assert (
        generation
        == [each for each in page.received if each["type"] == "setting"][-1]["generation"]
    )
    assert time_s == pytest.approx(3.0)
    drawn = np.frombuffer(page.frames[-1], np.float32, 16, HEADER.size).reshape(4, 4)
    assert drawn[:, :3] == pytest.approx(stepped(30).poses.astype(np.float32))
    assert len(page.frames[-1]) == HEADER.size + 16 * robots + items


def test_a_classic_run_is_opened_played_changed_and_replayed(page: Page) -> None:
    page.open(scenario="classic", tick=30)
    page.send("select", robot="wanderer/1")
    response = page.wait_for("state")
    assert response["inspection"] is None
    assert dict(response["robot"]["facts"])["Next decision"] == "in 4 paints"
    assert len(response["robot"]["examined_cells"]) == 6
    setting = page.change("robots.wanderer.count", 7)
    assert len(setting["robots"]) == setting["kinds"][0]["count"] == 7
    over = page.finish()
    assert over["outcome"]["complete"]
    again = page.open(scenario="classic", changes=setting["changes"], tick=over["tick"])
    assert (again["hash"], again["outcome"]) == (over["hash"], over["outcome"])


def test_a_classic_run_is_the_same_as_that_of_run(page: Page) -> None:
    page.open(scenario="classic", seed="3")
    over = page.finish()
    assert over["outcome"] == ae.run("classic", seed=3).row


def test_a_frame_of_a_classic_run_is_its_window_with_y_upwards(page: Page) -> None:
    page.open(scenario="classic", tick=40)
    simulation = ae.ClassicSimulation("classic", 7)
    simulation.step(40)
    team = simulation.team.to_pydict()
    drawn = np.frombuffer(page.frames[-1], np.float32, 16, HEADER.size).reshape(4, 4)
    assert drawn[:, 0].tolist() == team["x_px"]
    assert drawn[:, 1] == pytest.approx(500 - np.array(team["y_px"]))
    assert drawn[:, 2] == pytest.approx(np.radians(90 - np.array(team["heading_deg"])))
    looks = ["blue", "yellow", "red"]
    assert drawn[:, 3].tolist() == [looks.index(colour) for colour in team["colour"]]
    setting = next(each for each in page.received if each["type"] == "setting")
    assert setting["world"] == {"size": [500, 500], "periodic": False, "unit": "px", "cell": 20}
    assert setting["items"][0] == {
        "kind": "item",
        "at": [70, 150],
        "target": True,
        "contact": [],
    }
    cells = base64.b64decode(setting["maps"][0]["cells"])
    assert cells.count(2) == 96 + 6 + 3 + 4 + 3 + 4
    # The item in column 3, in the eighth row from below.
    assert cells[7 * 25 + 3] == 2


def test_a_classic_run_is_exported_as_its_current_scenario(page: Page) -> None:
    page.open(scenario="classic", tick=20)
    page.change("robots.wanderer.count", 9)
    page.send("export")
    text = page.wait_for("exported")["text"]
    assert ae.Scenario.loads(text).robots == {"wanderer": 9}


def test_the_clock_of_a_classic_run_can_be_changed_while_it_plays(page: Page) -> None:
    page.open(scenario="classic", tick=56)
    assert page.received[-1]["time_s"] == 1
    page.send("play", speed=1)
    assert page.change("clock.paints_per_s", 560)["step_s"] == 1 / 560
    page.send("pause")
    response = page.wait_for("state", is_playing=False)
    assert response["time_s"] == pytest.approx(response["tick"] / 560)


def test_the_thumbnail_of_2003_contains_its_walls_and_items(client: TestClient) -> None:
    svg = client.get("/api/pictures", params={"scenario": "classic"}).text
    walls, items = (re.search(f'd="([^"]*)" fill="{colour}"', svg) for colour in (WALL, ITEM))
    assert walls
    assert items
    assert walls[1].count("M") == 96 + 6 + 3 + 4 + 3
    assert items[1].count("M") == 4
    assert "M60,140h20v20h-20z" in items[1]
    assert svg.count(ROBOT) == 4


def test_the_page_and_the_thumbnail_show_every_copy_of_an_obstacle(
    page: Page, client: TestClient, tmp_path: Path
) -> None:
    new = (
        "{ rectangle = { at_m = [4, 5], size_m = [1, 2] }, "
        "repeat = { columns = 3, rows = 2, spacing_m = [4, 6] } }"
    )
    text = ae.Scenario.load("search").source.text
    before, after = text.split("obstacles = [")
    text = f"{before}obstacles = [{{ circle = {{ at_m = [20, 3], radius_m = 0.5 }} }}, {new}]"
    (tmp_path / "hall.toml").write_text(text + after.split("\n]", 1)[1])
    page.open(scenario="hall.toml")
    setting = next(each for each in page.received if each["type"] == "setting")
    assert [each["entry"] for each in setting["obstacles"]] == [0, *[1] * 6]
    assert setting["obstacles"][0]["circle"] == {"at": [20, 3], "radius": 0.5}
    assert [11.5, 10] in setting["obstacles"][-1]["polygon"]
    svg = client.get("/api/pictures", params={"scenario": "hall.toml"}).text
    assert svg.count(WALL) == 7


def test_contact_outlines_of_an_item_follow_the_contact_rule(page: Page) -> None:
    page.open(scenario="classic")
    contact = page.change("contact", "neighbour")["items"][0]["contact"]
    # A robot on the item's own cell would be at the upper left corner of the square drawn.
    assert len(contact) == 9
    assert [[50, 150], [70, 150], [70, 170], [50, 170]] in contact


def test_steps_go_forward_and_back(page: Page) -> None:
    page.open()
    page.step(3, to=3)
    page.step(-2, to=1)
    page.step(-9, to=0)


def test_steps_requested_in_quick_succession_are_all_taken(page: Page) -> None:
    page.open()
    for _ in range(20):
        page.send("step", steps=1)
    page.wait_for("state", tick=20)


def test_a_change_is_displayed_and_its_log_replays_the_run(page: Page) -> None:
    page.open(tick=40)
    setting = page.change("robots.rover.count", 7)
    assert setting["kinds"][0]["count"] == len(setting["robots"]) == 7
    response = page.step(20, to=60)
    again = page.open(changes=setting["changes"], tick=60)
    assert again["hash"] == response["hash"]
    page.send("undo")
    assert page.wait_for("setting", changes=[])["log"] == []
    assert page.wait_for("state", tick=60)["hash"] == f"{stepped(60).hash:016x}"


def test_settings_distinguish_flying_kinds(page: Page) -> None:
    page.open(scenario="search")
    assert page.change("robots.rover.layer", "air")["kinds"][0]["is_flying"] is True
    page.send("undo")
    assert page.wait_for("setting", changes=[])["kinds"][0]["is_flying"] is False


def test_the_state_contains_the_inspection_of_the_selected_robot(page: Page) -> None:
    page.open(tick=30)
    page.send("select", robot="rover/1")
    inspection = page.wait_for("state")["inspection"]
    simulation = stepped(30)
    simulation.inspect("rover/1")
    expected = simulation.inspection()
    assert expected is not None
    assert inspection == json.loads(json.dumps({"robot": "rover/1", **expected}))
    page.send("select", robot="rover/99")
    assert page.wait_for("state")["inspection"] is None


def test_the_parts_of_a_map_add_up_to_the_whole_map(page: Page) -> None:
    page.open(tick=30)
    page.send("select", robot="rover/1")
    page.wait_for("map", robot="rover/1")
    for message, tick in (({"type": "step", "steps": 2}, 32), ({"type": "seek", "tick": 20}, 20)):
        page.socket.send_text(json.dumps(message))
        page.wait_for("state", tick=tick, is_playing=False)
    # A map comes behind the state that it is of.
    page.send("pause")
    page.wait_for("state")
    maps = [message for message in page.received if message["type"] == "map"]
    shape = (maps[0]["rows"], maps[0]["columns"])
    believed = {"occupancy": np.zeros(shape, np.int8), "unseen": np.zeros(shape, np.uint8)}
    for response in maps:
        (left, low), (columns, rows) = response["from"], response["size"]
        for key, cells in believed.items():
            part = np.frombuffer(base64.b64decode(response[key]), cells.dtype)
            cells[low : low + rows, left : left + columns] = part.reshape(rows, columns)
    expected = stepped(20).believed_map("rover/1")
    assert expected is not None
    assert (believed["occupancy"] == expected["occupancy"]).all()
    assert (believed["unseen"] == expected["unseen"]).all()
    assert maps[0]["size"] == [shape[1], shape[0]]
    assert math.prod(maps[1]["size"]) < math.prod(shape) / 2


def test_a_robot_without_beliefs_has_a_percept_and_a_command_and_no_map(page: Page) -> None:
    page.open(scenario="search", tick=6)
    page.send("select", robot="rover/0")
    inspection = page.wait_for("state")["inspection"]
    assert inspection["percept"]["scans"]
    assert inspection["command"]["motion"]
    assert inspection["leading"] is not None
    assert inspection["belief_state"] is None
    page.send("select", robot=None)
    assert page.wait_for("state")["inspection"] is None
    assert not [message for message in page.received if message["type"] == "map"]


@pytest.mark.parametrize(
    ("text", "response"),
    [
        ('{"type": "bogus"}', "one of open, play"),
        ('{"type": ["open"]}', "one of open, play"),
        ("{", "in JSON"),
        ("[" * 100_000, "in JSON"),
        ('{"type": "play", "speed": "fast"}', "play.speed"),
        ('{"type": "play", "speed": NaN}', "play.speed"),
        ('{"type": "seek", "tick": 1}', "after an open"),
        ('{"type": "open"}', "exactly one of `scenario`, `text`, `study`"),
        ('{"type": "open", "scenario": "search", "seed": 7}', "as a string"),
        ('{"type": "open", "scenario": "search", "seed": "99999999999999999999"}', "seed"),
        ('{"type": "open", "scenario": "nothing"}', "one of the gallery"),
        ('{"type": "open", "scenario": "search", "changes": [[1, 2]]}', "[tick, path, value]"),
        (f'{{"type": "open", "recording": "{"a" * 300}.mcap"}}', "one below the folder"),
    ],
)
def test_invalid_messages_are_refused_with_a_reason(page: Page, text: str, response: str) -> None:
    page.socket.send_text(text)
    refused = page.wait_for("refused")
    assert response in refused["errors"][0]["message"]
    page.open()


@pytest.mark.parametrize("text", ["pause", "cancel_save", "select"])
def test_messages_before_a_run_is_opened_block_nothing(
    client: TestClient, page: Page, text: str
) -> None:
    page.send(text, **({"robot": None} if text == "select" else {}))
    with client.websocket_connect(WS) as other:
        Page(other).open()
    page.open()


def test_an_invalid_open_is_refused_as_an_open(page: Page) -> None:
    page.send("open", scenario="search", tick=10**20)
    assert page.wait_for("refused")["about"] == "open"


def test_a_page_that_disconnects_while_it_sends_leaves_nothing_behind(tmp_path: Path) -> None:
    text = iter([{"type": "open", "scenario": "search"}, {"type": "pause"}])

    class Hasty:
        def __init__(self) -> None:
            self.has_seen = asyncio.Event()

        async def receive(self) -> str:
            message = next(text, None)
            if message is None:
                raise ConnectionClosedError
            if message["type"] == "pause":
                await self.has_seen.wait()
            return json.dumps(message)

        async def send(self, response: Any) -> None:
            if response["type"] == "state":
                # After the session has begun to wait for the next message.
                asyncio.get_running_loop().call_later(0.1, self.has_seen.set)

        async def send_bytes(self, frame: bytes) -> None:
            pass

    async def served() -> None:
        with ThreadPoolExecutor(2) as threads:
            session = PageConnection(Hasty(), Workspace(tmp_path), threads)
            await asyncio.wait_for(session.run(), 10)

    asyncio.run(served())


def test_a_change_that_is_not_allowed_changes_nothing(page: Page) -> None:
    before = page.open(tick=10)
    for path, value in [("robots.rover.count", -1), ("clock.step_s", 1), ("a", None)]:
        page.send("change", path=path, value=value)
        assert page.wait_for("refused")["path"] in (path, None)
    page.send("step", steps=0)
    assert page.wait_for("state")["hash"] == before["hash"]


def test_a_page_that_draws_nothing_gets_three_frames_and_the_run_continues(
    client: TestClient,
) -> None:
    with client.websocket_connect(WS) as socket:
        page = Page(socket, draws=False)
        page.open()
        page.send("play", speed=0.5)
        # Refusals are response in any case: so it is known when frames could have come.
        waited = 0
        while waited < 30:
            time.sleep(0.02)
            page.send("bogus")
            page.wait_for("refused")
            waited += len(page.frames) >= MAX_IN_FLIGHT
        assert len(page.frames) == MAX_IN_FLIGHT
        page.draws = True
        page.send("acknowledge", frame=MAX_IN_FLIGHT)
        assert page.wait_for("state")["tick"] > 0


def test_the_number_of_open_runs_is_limited(client: TestClient) -> None:
    sockets = [client.websocket_connect(WS) for _ in range(MAX_SESSIONS)]
    for socket in sockets:
        socket.__enter__()
    with client.websocket_connect(WS) as socket:
        assert Page(socket).next()["reason"] == "full"
    sockets[0].__exit__(None, None, None)
    with client.websocket_connect(WS) as socket:
        Page(socket).open()
    for socket in sockets[1:]:
        socket.__exit__(None, None, None)


@pytest.mark.parametrize(
    ("headers", "is_let_in"),
    [
        ({}, True),
        ({"origin": OWN}, True),
        ({"origin": "http://127.0.0.1:9999"}, False),
        ({"origin": "https://evil.example"}, False),
        ({"origin": "null"}, False),
        ({"origin": "http://["}, False),
        ({"host": "evil.example"}, False),
        ({"host": "localhost:8765", "origin": "http://localhost:8765"}, True),
        ({"host": "localhost:8765", "origin": OWN}, False),
        ({"host": "192.168.0.7:8765"}, False),
        ({"host": "[::1]:8765"}, True),
        ({"host": "["}, False),
    ],
)
def test_only_pages_of_this_server_on_this_machine_are_admitted(
    client: TestClient, headers: dict[str, str], *, is_let_in: bool
) -> None:
    assert (client.get("/api/scenarios", headers=headers).status_code == 200) == is_let_in
    if is_let_in:
        with client.websocket_connect(WS, headers=headers):
            return
    with pytest.raises(WebSocketDisconnect), client.websocket_connect(WS, headers=headers):
        pass


def test_other_machines_need_a_token_which_is_kept_in_a_cookie(tmp_path: Path) -> None:
    served = app(Workspace(tmp_path), "192.168.0.7", "secret")
    with TestClient(served, "http://192.168.0.7:8765") as client:
        assert client.get("/api/scenarios").status_code == 403
        assert client.get("/api/scenarios", params={"token": "other"}).status_code == 403
        assert client.get("/api/scenarios", params={"token": "secret"}).status_code == 200
        assert client.get("/api/scenarios").status_code == 200
        with client.websocket_connect("ws://192.168.0.7:8765/ws?token=secret"):
            pass
        with (
            pytest.raises(WebSocketDisconnect),
            client.websocket_connect(
                "ws://192.168.0.7:8765/ws?token=other", headers={"cookie": ""}
            ),
        ):
            pass


def test_pages_load_nothing_from_other_sites(client: TestClient) -> None:
    headers = client.get("/api/scenarios").headers
    assert "default-src 'self'" in headers["content-security-policy"]
    assert headers["x-content-type-options"] == "nosniff"
