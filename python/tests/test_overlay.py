"""Overlays of frames: radio links and the areas that sensors cover."""

import asyncio
import json
import struct
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from metric import world

import agent_economy as ae
from agent_economy.server import Workspace
from agent_economy.server.runs.connection import PageConnection
from agent_economy.server.runs.display import MAX_IN_FLIGHT
from agent_economy.server.transport import ConnectionClosedError

Message = dict[str, Any]

Corners = list[list[float]]
"""Of an outline: bearings in radians and distances in metres."""

FRAME, OVERLAY = 1, 2

WALL = "{ polygon_m = [[10, 9], [10.5, 9], [10.5, 11], [10, 11]] }"


def field(robots: int = 2, obstacles: str = "", range_m: float = 5) -> str:
    """Return a scenario whose first two robots stand on both sides of where a wall may be."""
    places = [[9, 10], [12, 10], *([1 + i % 50, 20 + i // 50] for i in range(robots))]
    headings = [0] * len(places)
    return world(f"""
clock.time_limit_s = 100
[world]
size_m = [60, 60]
obstacles = [{obstacles}]
[items.mine]
count = 1
[robots.rover]
count = {robots}
radius_m = 0.2
start = {{ kind = "fixed", at_m = {places}, heading_deg = {headings} }}
drive = {{ max_speed_m_s = 1, max_turn_rate_deg_s = 90 }}
brain = {{ behaviours = [] }}
radio = {{ range_m = {range_m}, needs_line_of_sight = true }}
sensors.camera = {{ kind = "items", range_m = 3, fov_deg = 90 }}
""")


class Page:
    """A page that sends messages in order, each when the one before has reached its tick."""

    def __init__(self, script: Sequence[tuple[Message, int]], *, draws: bool = True) -> None:
        """Begin with the first message."""
        self.script, self.draws = iter(script), draws
        self.sent: list[bytes | Message] = []
        self.outgoing: asyncio.Queue[Message | None] = asyncio.Queue()
        self._send_next()

    def _send_next(self) -> None:
        message, self.tick = next(self.script, (None, -1))
        self.outgoing.put_nowait(message)

    async def receive(self) -> str:
        """Return the next message; disconnect after the last one."""
        message = await self.outgoing.get()
        if message is None:
            raise ConnectionClosedError
        return json.dumps(message)

    async def send(self, message: Any) -> None:
        """Keep a message of the server, and send the next one when the tick is reached."""
        self.sent.append(message)
        is_reached = message["type"] == "state" and message["tick"] == self.tick
        if is_reached or message["type"] == "refused":
            self._send_next()

    async def send_bytes(self, frame: bytes) -> None:
        """Keep a frame or an overlay, and acknowledge frames."""
        self.sent.append(frame)
        if self.draws and kind_of(frame) == FRAME:
            self.outgoing.put_nowait({"type": "acknowledge", "frame": number_of(frame)})


def kind_of(sent: bytes) -> int:
    return int(struct.unpack_from("<I", sent)[0])


def number_of(sent: bytes) -> int:
    return int(struct.unpack_from("<I", sent, 28 if kind_of(sent) == FRAME else 4)[0])


def serve_page(page: Page, folder: Path) -> None:
    """Serve a page until it has sent its script."""

    async def serve() -> None:
        with ThreadPoolExecutor(2) as threads:
            await asyncio.wait_for(PageConnection(page, Workspace(folder), threads).run(), 30)

    asyncio.run(serve())


def served(
    folder: Path, script: Sequence[tuple[Message, int]], *, draws: bool = True
) -> list[bytes]:
    """Return the frames and overlays that a page with this script receives."""
    page = Page(script, draws=draws)
    serve_page(page, folder)
    return [sent for sent in page.sent if isinstance(sent, bytes)]


def opening(scenario: str, tick: int = 0) -> tuple[Message, int]:
    """Return an `open`, of the text of a scenario or of one that ships."""
    key = "text" if "\n" in scenario else "scenario"
    return {"type": "open", key: scenario, "seed": "7", "tick": tick}, tick


def layers(*, links: bool, footprints: bool) -> Message:
    shown = {"links": links, "footprints": footprints}
    return {"type": "show", "layers": [name for name, is_shown in shown.items() if is_shown]}


def read(overlay: bytes) -> tuple[list[list[int]], list[tuple[int, int, float, Corners]]]:
    """Return links, and footprints: robot, whether it finds items, range, corners."""
    count = struct.unpack_from("<3I", overlay)[2]
    links = np.frombuffer(overlay, "<u4", 3 * count, 12).reshape(count, 3)
    at, footprints = 12 + links.nbytes, []
    while at < len(overlay):
        robot, finds_items, corners, range_m = struct.unpack_from("<3If", overlay, at)
        outline = np.frombuffer(overlay, "<f4", 2 * corners, at + 16).reshape(corners, 2)
        footprints.append((robot, finds_items, range_m, outline.tolist()))
        at += 16 + outline.nbytes
    return links.tolist(), footprints


def test_frames_have_an_overlay_while_a_layer_is_on(tmp_path: Path) -> None:
    script = [
        opening("open-field"),
        ({"type": "step", "steps": 5}, 5),
        (layers(links=True, footprints=False), 5),
        ({"type": "step", "steps": 5}, 10),
        (layers(links=False, footprints=False), 10),
        ({"type": "step", "steps": 5}, 15),
    ]
    sent = served(tmp_path, script)
    overlays = [number for number, each in enumerate(sent) if kind_of(each) == OVERLAY]
    assert overlays
    # Each right before its frame, and all those after one another.
    assert all(number_of(sent[at]) == number_of(sent[at + 1]) for at in overlays)
    assert all(kind_of(sent[at + 1]) == FRAME for at in overlays)
    ticks = [struct.unpack_from("<3I", sent[at + 1])[2] for at in overlays]
    assert ticks[0] == 5
    assert ticks[-1] == 10
    assert kind_of(sent[0]) == kind_of(sent[-1]) == kind_of(sent[-2]) == FRAME
    for at in overlays:
        links, footprints = read(sent[at])
        assert links
        assert not footprints


def test_an_overlay_shows_the_tick_of_its_frame(tmp_path: Path) -> None:
    script = [
        opening("open-field", 40),
        ({"type": "select", "robot": "rover/0"}, 40),
        (layers(links=True, footprints=True), 40),
        ({"type": "step", "steps": 25}, 65),
    ]
    sent = served(tmp_path, script)
    links, footprints = read(sent[-2])
    simulation = ae.Simulation("open-field", 7)
    simulation.step(65)
    assert links == simulation.links().tolist()
    own = [each for each in footprints if each[0] == 1]
    expected = simulation.footprints("rover/0")
    assert len(own) == len(expected)
    assert [each[1] for each in own] == [int("camera" in name) for name in expected]
    for (*_, range_m, corners), footprint in zip(own, expected.values(), strict=True):
        assert footprint.ranges_m.max() <= range_m * (1 + 1e-6)
        # Each corner is one of the places up to which it sees.
        for bearing_rad, distance_m in corners:
            off = np.cos(footprint.bearings_rad - bearing_rad)
            nearest = footprint.ranges_m[off > off.max() - 1e-9]
            assert np.abs(nearest - distance_m).min() == pytest.approx(0, abs=1e-5)
    # Of the others only what finds items.
    assert {each[0] for each in footprints} == {0, 1, 2, 3}
    assert all(each[1] for each in footprints if each[0] != 1)


def test_a_wall_cuts_links_and_footprints(tmp_path: Path) -> None:
    request_overlays = (layers(links=True, footprints=True), 0)
    links, footprints = read(
        served(tmp_path, [opening(field(obstacles=WALL)), request_overlays])[-2]
    )
    assert links == []
    (nearest,) = (min(at[1] for at in corners) for robot, *_, corners in footprints if robot == 0)
    assert nearest < 1.5
    links, footprints = read(served(tmp_path, [opening(field()), request_overlays])[-2])
    assert links == [[0, 1, 1]]
    assert [at[1] for *_, corners in footprints for at in corners] == [3] * 4


def test_overlays_of_large_teams_contain_the_selected_robot_only(tmp_path: Path) -> None:
    script = [
        opening(field(301)),
        (layers(links=True, footprints=True), 0),
        ({"type": "select", "robot": "rover/300"}, 0),
        ({"type": "change", "path": "robots.rover.count", "value": 300}, 0),
    ]
    sent = [each for each in served(tmp_path, script) if kind_of(each) == OVERLAY]
    alone, selected, all_of_300 = map(read, sent)
    assert alone == ([], [])
    assert {robot for robot, *_ in selected[1]} == {300}
    assert selected[0]
    assert all(300 in link[:2] for link in selected[0])
    # The selected one is gone.
    assert {robot for robot, *_ in all_of_300[1]} == set(range(300))
    assert len(all_of_300[0]) > len(selected[0])


def test_at_most_4000_links_are_sent_with_all_of_the_selected_robot(tmp_path: Path) -> None:
    script = [
        opening(field(300, range_m=100)),
        (layers(links=True, footprints=False), 0),
        ({"type": "select", "robot": "rover/250"}, 0),
    ]
    links, _ = read(served(tmp_path, script)[-2])
    assert len(links) == len({tuple(link) for link in links}) == 4000
    assert sum(250 in link[:2] for link in links) == 299


def test_the_classic_engine_has_no_overlays(tmp_path: Path) -> None:
    script = [
        opening("classic"),
        (layers(links=True, footprints=True), 0),
        ({"type": "step", "steps": 1}, 1),
    ]
    assert {kind_of(each) for each in served(tmp_path, script)} == {FRAME}


def test_a_page_that_draws_nothing_gets_no_more_overlays_than_frames(tmp_path: Path) -> None:
    script = [
        opening("open-field"),
        (layers(links=True, footprints=True), 0),
        ({"type": "step", "steps": 1}, 1),
        *[({"type": "step", "steps": "bogus"}, -1)] * 50,
    ]
    sent = served(tmp_path, script, draws=False)
    assert [kind_of(each) for each in sent].count(FRAME) == MAX_IN_FLIGHT
    assert [kind_of(each) for each in sent].count(OVERLAY) == MAX_IN_FLIGHT - 1


def test_invalid_layers_are_refused_with_a_reason(tmp_path: Path) -> None:
    page = Page([({"type": "show", "layers": 1}, 0)])
    serve_page(page, tmp_path)
    (refused,) = page.sent
    assert isinstance(refused, dict)
    reason = refused["errors"][0]["message"]
    assert "show.layers = 1: must be a list of at most 100 strings" in reason


@pytest.mark.parametrize("name", ["open-field", "flock"])
def test_queries_of_links_and_footprints_change_nothing(name: str) -> None:
    queried, other = (ae.Simulation(name, 3) for _ in range(2))
    for _ in range(40):
        queried.step(5)
        other.step(5)
        assert queried.links().shape[1] == 3
        for robot in queried.robots:
            queried.footprints(robot)
        assert queried.hash == other.hash
    assert queried.outcome() == other.outcome()


def test_links_of_a_robot_are_its_own_and_unknown_robots_are_rejected() -> None:
    simulation = ae.Simulation(ae.Scenario.loads(field()), 7)
    assert simulation.links().dtype == np.uint32
    assert simulation.links("rover/1").tolist() == [[0, 1, 1]]
    camera = simulation.footprints("rover/0")["camera"]
    assert camera.bearings_rad.shape == camera.ranges_m.shape
    for query in (simulation.links, simulation.footprints):
        with pytest.raises(ae.InputError, match="rover/9"):
            query("rover/9")
