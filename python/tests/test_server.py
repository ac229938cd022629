"""What the page's server answers, and whom."""

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
from starlette.testclient import TestClient
from starlette.websockets import WebSocketDisconnect
from watching import HEADER, OWN, WS, Page

import agent_economy as ae
from agent_economy.server import Workspace, app
from agent_economy.server.app import MAX_SESSIONS
from agent_economy.server.request_body import MAX_BYTES
from agent_economy.server.runs.display import MAX_IN_FLIGHT
from agent_economy.server.runs.session import Session
from agent_economy.server.runs.thumbnail import ITEM, ROBOT, WALL
from agent_economy.server.transport import ConnectionClosedError


def test_the_gallery_has_what_ships_and_what_is_in_the_folder(
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
        "marked.toml",
        "mine/field.toml",
    }
    assert rows["mine/field.toml"]["where"] == "folder"
    assert not {"other.toml", ".hidden/field.toml"} & rows.keys()


def test_a_scenario_with_faults_is_in_the_gallery_and_tells_them_when_it_is_opened(
    client: TestClient, page: Page, tmp_path: Path
) -> None:
    (tmp_path / "broken.toml").write_text('engine = "metric"\nsummary = "Mine."\n')
    rows = {row["id"]: row for row in client.get("/api/scenarios").json()}
    assert rows["broken.toml"]["summary"] == "Mine."
    page.say("open", scenario="broken.toml")
    assert "clock is missing" in page.until("refused")["errors"][0]["message"]


@pytest.mark.parametrize("name", ["classic", "search", "open-field", "flock"])
def test_each_scenario_has_a_picture(client: TestClient, name: str) -> None:
    told = client.get("/api/pictures", params={"scenario": name})
    assert told.status_code == 200
    assert told.headers["content-type"] == "image/svg+xml"
    assert told.text.startswith("<svg")
    assert "polygon" in told.text


@pytest.mark.parametrize("name", ["../secret.toml", "/etc/passwd", "link.toml", "nothing", "a\0b"])
def test_nothing_outside_of_the_folder_is_opened(
    client: TestClient, tmp_path: Path, name: str
) -> None:
    secret = tmp_path.parent / "secret.toml"
    secret.write_text(ae.Scenario.load("search").source.text)
    (tmp_path / "link.toml").symlink_to(secret)
    told = client.get("/api/pictures", params={"scenario": name})
    assert told.status_code == 404
    assert "one of the gallery" in told.json()["errors"][0]["message"]


def test_a_map_outside_of_the_folder_is_not_read(client: TestClient) -> None:
    text = ae.Scenario.load("open-field").source.text
    told = client.post("/api/check", content=text.replace('"open-field.yaml"', '"../map.yaml"'))
    assert told.status_code == 422
    assert "not below the folder" in told.text


def test_faults_of_a_text_are_told_with_their_lines(client: TestClient) -> None:
    text = ae.Scenario.load("search").source.text
    assert client.post("/api/check", content=text).json()["engine"] == "metric"
    wrong = text.replace("time_limit_s = 120", "time_limit_s = -1").replace(
        "count = 4", "cuont = 4", 1
    )
    faults = client.post("/api/check", content=wrong).json()["errors"]
    told = {fault["path"].split(".")[-1]: fault for fault in faults}
    line = 1 + wrong[: wrong.index("time_limit_s = -1")].count("\n")
    assert told["time_limit_s"]["line"] == line
    assert told["cuont"]["suggestion"] == "count"


@pytest.mark.parametrize("content", [b"\xff\xfe", b"x" * (MAX_BYTES + 1), b"= 3", b""])
def test_what_is_no_scenario_is_told(client: TestClient, content: bytes) -> None:
    told = client.post("/api/check", content=content)
    assert told.status_code in (413, 422)
    assert told.json()["errors"][0]["message"]


def test_a_run_is_opened_played_and_paused(page: Page) -> None:
    page.open()
    page.say("play", speed=None)
    over = page.until("state", is_over=True, is_playing=False)
    assert over["outcome"]["complete"]
    expected = ae.run("search-beliefs", seed=7)
    assert over["outcome"]["time_s"] == expected.time_s
    page.say("seek", tick=50)
    simulation = ae.Simulation("search-beliefs", 7)
    simulation.step(50)
    told = page.until("state", tick=50)
    assert told["hash"] == f"{simulation.hash:016x}"
    assert told["latest_tick"] == over["tick"]


def test_a_frame_is_of_where_the_robots_are(page: Page) -> None:
    page.open(tick=30)
    simulation = ae.Simulation("search-beliefs", 7)
    simulation.step(30)
    kind, generation, tick, robots, time_s, items, _ = HEADER.unpack_from(page.frames[-1])
    assert (kind, tick, robots, items) == (1, 30, 4, 4)
    assert generation == [each for each in page.said if each["type"] == "setting"][-1]["generation"]
    assert time_s == pytest.approx(3.0)
    drawn = np.frombuffer(page.frames[-1], np.float32, 16, HEADER.size).reshape(4, 4)
    assert drawn[:, :3] == pytest.approx(simulation.poses.astype(np.float32))
    assert len(page.frames[-1]) == HEADER.size + 16 * robots + items


def test_a_classic_run_is_opened_played_changed_and_taken_again(page: Page) -> None:
    page.open(scenario="classic", tick=30)
    page.say("select", robot="wanderer/1")
    told = page.until("state")
    assert told["inspection"] is None
    assert dict(told["robot"]["facts"])["Next decision"] == "in 4 paints"
    assert len(told["robot"]["examined_cells"]) == 6
    page.say("change", path="robots.wanderer.count", value=7)
    setting = page.until("setting")
    assert len(setting["robots"]) == setting["kinds"][0]["count"] == 7
    page.say("play", speed=None)
    over = page.until("state", is_over=True, is_playing=False)
    assert over["outcome"]["complete"]
    again = page.open(scenario="classic", changes=setting["changes"], tick=over["tick"])
    assert (again["hash"], again["outcome"]) == (over["hash"], over["outcome"])


def test_a_classic_run_is_the_one_that_run_gives(page: Page) -> None:
    page.open(scenario="classic", seed="3")
    page.say("play", speed=None)
    over = page.until("state", is_over=True, is_playing=False)
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
    setting = next(each for each in page.said if each["type"] == "setting")
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


def test_a_classic_run_is_exported_as_the_scenario_that_it_came_to(page: Page) -> None:
    page.open(scenario="classic", tick=20)
    page.say("change", path="robots.wanderer.count", value=9)
    page.until("setting")
    page.say("export")
    text = page.until("exported")["text"]
    assert ae.Scenario.loads(text).robots == {"wanderer": 9}


def test_the_clock_of_a_classic_run_can_be_changed_while_it_plays(page: Page) -> None:
    page.open(scenario="classic", tick=56)
    assert page.said[-1]["time_s"] == 1
    page.say("play", speed=1)
    page.say("change", path="clock.paints_per_s", value=560)
    assert page.until("setting")["step_s"] == 1 / 560
    page.say("pause")
    told = page.until("state", is_playing=False)
    assert told["time_s"] == pytest.approx(told["tick"] / 560)


@pytest.mark.parametrize("engine", ["metric", "classic"])
def test_each_engine_has_a_schema(client: TestClient, engine: str) -> None:
    schema = client.get("/api/schema", params={"engine": engine}).json()
    assert schema["properties"]["engine"]["const"] == engine


def test_of_other_engines_there_is_no_schema(client: TestClient) -> None:
    told = client.get("/api/schema", params={"engine": "../secret"})
    assert told.status_code == 404
    assert "metric, classic" in told.json()["errors"][0]["message"]


def test_the_picture_of_2003_has_its_walls_and_its_items(client: TestClient) -> None:
    svg = client.get("/api/pictures", params={"scenario": "classic"}).text
    walls, items = (re.search(f'd="([^"]*)" fill="{colour}"', svg) for colour in (WALL, ITEM))
    assert walls
    assert items
    assert walls[1].count("M") == 96 + 6 + 3 + 4 + 3
    assert items[1].count("M") == 4
    assert "M60,140h20v20h-20z" in items[1]
    assert svg.count(ROBOT) == 4


def test_where_an_item_can_be_found_is_told_and_follows_the_contact(page: Page) -> None:
    page.open(scenario="classic")
    page.say("change", path="contact", value="neighbour")
    contact = page.until("setting")["items"][0]["contact"]
    # A robot on the item's own cell would be at the upper left corner of the square drawn.
    assert len(contact) == 9
    assert [[50, 150], [70, 150], [70, 170], [50, 170]] in contact


def test_steps_go_forth_and_back(page: Page) -> None:
    page.open()
    page.say("step", steps=3)
    page.until("state", tick=3)
    page.say("step", steps=-2)
    page.until("state", tick=1)
    page.say("step", steps=-9)
    page.until("state", tick=0)


def test_steps_said_fast_are_all_taken(page: Page) -> None:
    page.open()
    for _ in range(20):
        page.say("step", steps=1)
    page.until("state", tick=20)


def test_a_change_in_the_run_is_seen_and_its_log_gives_the_run_again(page: Page) -> None:
    page.open(tick=40)
    page.say("change", path="robots.rover.count", value=7)
    setting = page.until("setting")
    assert setting["kinds"][0]["count"] == len(setting["robots"]) == 7
    page.say("step", steps=20)
    told = page.until("state", tick=60)
    again = page.open(changes=setting["changes"], tick=60)
    assert again["hash"] == told["hash"]
    page.say("undo")
    assert page.until("setting", changes=[])["log"] == []
    simulation = ae.Simulation("search-beliefs", 7)
    simulation.step(60)
    assert page.until("state", tick=60)["hash"] == f"{simulation.hash:016x}"


def test_kinds_that_fly_are_told_from_those_that_do_not(page: Page) -> None:
    page.open(scenario="search")
    page.say("change", path="robots.rover.layer", value="air")
    assert page.until("setting")["kinds"][0]["is_flying"] is True
    page.say("undo")
    assert page.until("setting", changes=[])["kinds"][0]["is_flying"] is False


def test_the_mind_of_a_selected_robot_is_told(page: Page) -> None:
    page.open(tick=30)
    page.say("select", robot="rover/1")
    mind = page.until("state")["inspection"]
    simulation = ae.Simulation("search-beliefs", 7)
    simulation.step(30)
    simulation.watch("rover/1")
    decided = simulation.watched()
    assert decided is not None
    expected = {"robot": "rover/1", "belief_state": decided["thoughts"], **decided}
    assert mind == {key: json.loads(json.dumps(expected[key])) for key in mind}
    assert mind.keys() | {"thoughts"} == expected.keys()
    page.say("select", robot="rover/99")
    assert page.until("state")["inspection"] is None


def test_what_is_told_of_a_map_comes_to_all_of_it(page: Page) -> None:
    page.open(tick=30)
    page.say("select", robot="rover/1")
    page.until("map", robot="rover/1")
    for said, tick in (({"type": "step", "steps": 2}, 32), ({"type": "seek", "tick": 20}, 20)):
        page.socket.send_text(json.dumps(said))
        page.until("state", tick=tick, is_playing=False)
    # A map comes behind the state that it is of.
    page.say("pause")
    page.until("state")
    maps = [said for said in page.said if said["type"] == "map"]
    shape = (maps[0]["rows"], maps[0]["columns"])
    believed = {"occupancy": np.zeros(shape, np.int8), "unseen": np.zeros(shape, np.uint8)}
    for told in maps:
        (left, low), (columns, rows) = told["from"], told["size"]
        for key, cells in believed.items():
            part = np.frombuffer(base64.b64decode(told[key]), cells.dtype)
            cells[low : low + rows, left : left + columns] = part.reshape(rows, columns)
    simulation = ae.Simulation("search-beliefs", 7)
    simulation.step(20)
    expected = simulation.believed_map("rover/1")
    assert expected is not None
    assert (believed["occupancy"] == expected["occupancy"]).all()
    assert (believed["unseen"] == expected["unseen"]).all()
    assert maps[0]["size"] == [shape[1], shape[0]]
    assert math.prod(maps[1]["size"]) < math.prod(shape) / 2


def test_a_robot_without_a_mind_has_a_percept_and_a_command_and_no_map(page: Page) -> None:
    page.open(scenario="search", tick=6)
    page.say("select", robot="rover/0")
    mind = page.until("state")["inspection"]
    assert mind["percept"]["scans"]
    assert mind["command"]["motion"]
    assert mind["leading"] is not None
    assert mind["belief_state"] is None
    page.say("select", robot=None)
    assert page.until("state")["inspection"] is None
    assert not [said for said in page.said if said["type"] == "map"]


@pytest.mark.parametrize(
    ("said", "told"),
    [
        ('{"type": "bogus"}', "one of open, play"),
        ('{"type": ["open"]}', "one of open, play"),
        ("{", "in JSON"),
        ("[" * 100_000, "in JSON"),
        ('{"type": "play", "speed": "fast"}', "play.speed"),
        ('{"type": "play", "speed": NaN}', "play.speed"),
        ('{"type": "seek", "tick": 1}', "after an open"),
        ('{"type": "open"}', "either a scenario or a text"),
        ('{"type": "open", "scenario": "search", "seed": 7}', "as a string"),
        ('{"type": "open", "scenario": "search", "seed": "99999999999999999999"}', "seed"),
        ('{"type": "open", "scenario": "nothing"}', "one of the gallery"),
        ('{"type": "open", "scenario": "search", "changes": [[1, 2]]}', "[tick, path, value]"),
        (f'{{"type": "open", "recording": "{"a" * 300}.mcap"}}', "one below the folder"),
    ],
)
def test_what_a_page_may_not_say_is_refused_in_words(page: Page, said: str, told: str) -> None:
    page.socket.send_text(said)
    refused = page.until("refused")
    assert told in refused["errors"][0]["message"]
    page.open()


@pytest.mark.parametrize("said", ["pause", "cancel_save", "select"])
def test_what_is_said_before_a_run_is_opened_holds_nobody_up(
    client: TestClient, page: Page, said: str
) -> None:
    page.say(said, **({"robot": None} if said == "select" else {}))
    with client.websocket_connect(WS) as other:
        Page(other).open()
    page.open()


def test_an_open_that_cannot_be_read_is_refused_as_one(page: Page) -> None:
    page.say("open", scenario="search", tick=10**20)
    assert page.until("refused")["about"] == "open"


def test_a_page_that_goes_as_it_speaks_leaves_nothing_behind(tmp_path: Path) -> None:
    said = iter([{"type": "open", "scenario": "search"}, {"type": "pause"}])

    class Hasty:
        def __init__(self) -> None:
            self.has_seen = asyncio.Event()

        async def receive(self) -> str:
            message = next(said, None)
            if message is None:
                raise ConnectionClosedError
            if message["type"] == "pause":
                await self.has_seen.wait()
            return json.dumps(message)

        async def send(self, told: Any) -> None:
            if told["type"] == "state":
                # Not before the run stands and what is said next is waited for.
                asyncio.get_running_loop().call_later(0.1, self.has_seen.set)

        async def send_bytes(self, frame: bytes) -> None:
            pass

    async def served() -> None:
        with ThreadPoolExecutor(2) as threads:
            session = Session(Hasty(), Workspace(tmp_path), threads)
            await asyncio.wait_for(session.run(), 10)

    asyncio.run(served())


def test_a_change_that_is_not_allowed_changes_nothing(page: Page) -> None:
    before = page.open(tick=10)
    for path, value in [("robots.rover.count", -1), ("clock.step_s", 1), ("a", None)]:
        page.say("change", path=path, value=value)
        assert page.until("refused")["path"] in (path, None)
    page.say("step", steps=0)
    assert page.until("state")["hash"] == before["hash"]


def test_a_page_that_draws_nothing_gets_three_frames_and_the_run_goes_on(
    client: TestClient,
) -> None:
    with client.websocket_connect(WS) as socket:
        page = Page(socket, draws=False)
        page.open()
        page.say("play", speed=0.5)
        # Refusals are told in any case: so it is known when frames could have come.
        waited = 0
        while waited < 30:
            time.sleep(0.02)
            page.say("bogus")
            page.until("refused")
            waited += len(page.frames) >= MAX_IN_FLIGHT
        assert len(page.frames) == MAX_IN_FLIGHT
        page.draws = True
        page.say("acknowledge", frame=MAX_IN_FLIGHT)
        assert page.until("state")["tick"] > 0


def test_no_more_than_so_many_runs_are_open(client: TestClient) -> None:
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
def test_only_its_own_pages_on_this_machine_are_let_in(
    client: TestClient, headers: dict[str, str], *, is_let_in: bool
) -> None:
    assert (client.get("/api/scenarios", headers=headers).status_code == 200) == is_let_in
    if is_let_in:
        with client.websocket_connect(WS, headers=headers):
            return
    with pytest.raises(WebSocketDisconnect), client.websocket_connect(WS, headers=headers):
        pass


def test_from_elsewhere_a_token_is_needed_and_kept(tmp_path: Path) -> None:
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


def test_pages_may_load_nothing_from_elsewhere(client: TestClient) -> None:
    headers = client.get("/api/scenarios").headers
    assert "default-src 'self'" in headers["content-security-policy"]
    assert headers["x-content-type-options"] == "nosniff"
