"""What is whole in a damaged recording is replayed, whatever comes behind it."""

import random
from collections.abc import Callable
from io import BytesIO
from pathlib import Path
from typing import NamedTuple

import pytest
from command_line import refuse, run
from mcap.exceptions import EndOfFile
from mcap.opcode import Opcode
from metric import search
from page_client import Page
from recorded_drive import made
from starlette.testclient import TestClient
from test_recording import DRIVE

import agent_economy as ae
from agent_economy import InputError
from agent_economy.live.loop.log import LogOptions
from agent_economy.live.replay import Drive, replay
from agent_economy.recording.reading import Point, Recorded, read
from agent_economy.recording.records import HEAD, MAGIC
from agent_economy.recording.summary import summarise

STEPS = 300
PAGE = 4096
"""A page of a disk."""


class Whole(NamedTuple):
    """A complete recording.

    Attributes:
        data: Its bytes.
        points: Its states.
        records: The kind, the start and the end of each of its records before the index.
    """

    data: bytes
    points: list[Point]
    records: list[tuple[int, int, int]]

    def states(self, length: int) -> list[Point]:
        """Return the states of the records that are whole in the first bytes."""
        recorded = Recorded()
        recorded.read_all(BytesIO(self.data[:length]))
        return recorded.points

    def steps(self, length: int) -> int:
        """Return the step up to which the first bytes can be compared."""
        drive = Drive()
        drive.read_all(BytesIO(self.data[:length]))
        # The state of a step of a drive can be in the file without its setpoints.
        return self.states(length)[-1].tick if drive.values is None else drive.steps

    @property
    def chunks(self) -> list[tuple[int, int]]:
        """The starts and the ends of its chunks."""
        return [(start, end) for kind, start, end in self.records if kind == Opcode.CHUNK]


def whole(path: Path) -> Whole:
    data = path.read_bytes()
    records: list[tuple[int, int, int]] = []
    place = len(MAGIC)
    while not records or records[-1][0] != Opcode.DATA_END:
        kind, length = HEAD.unpack(data[place : place + HEAD.size])
        records.append((kind, place, place + HEAD.size + length))
        place = records[-1][2]
    return Whole(data, read(path)[1].points, records)


@pytest.fixture(scope="module", params=["metric", "classic", "drive"])
def recorded(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Whole:
    path = tmp_path_factory.mktemp("recorded") / "run.mcap"
    if request.param == "drive":
        return whole(made(LogOptions(path), STEPS))
    if request.param == "classic":
        simulation: ae.Simulation | ae.ClassicSimulation = ae.ClassicSimulation("classic", 1)
    else:
        simulation = ae.Simulation(search({"clock.time_limit_s": 60}), 1)
    with ae.Recording(simulation, path) as recording:
        recording.step(STEPS // 2)
        if request.param == "metric":
            recording.step(commands={"rover/0": DRIVE})
        recording.step(STEPS // 2)
    return whole(path)


Damage = Callable[[Whole, random.Random, int], bytes]


def zeros(before: Whole, source: random.Random, place: int) -> bytes:
    return before.data[:place] + bytes(source.choice([1, 8, 9, 100, PAGE, 2**16]))


def garbage(before: Whole, source: random.Random, place: int) -> bytes:
    return before.data[:place] + source.randbytes(source.choice([1, 9, 100, PAGE, 2**16]))


def own_chunks(before: Whole, source: random.Random, place: int) -> bytes:
    place = source.choice([place, *(end for _, end in before.chunks)])
    start, end = source.choice([each for each in before.chunks if each[1] <= place] or [(0, 0)])
    return before.data[:place] + before.data[start:end] * source.choice([1, 2])


def repeated(before: Whole, source: random.Random, place: int) -> bytes:  # noqa: ARG001
    (start, end), (_, after) = sorted(source.choices(before.chunks, k=2))
    return before.data[:after] + before.data[start:end] + before.data[after:]


def flipped(before: Whole, source: random.Random, place: int) -> bytes:
    data = bytearray(before.data)
    data[place] ^= 1 << source.randrange(8)
    return bytes(data)


def lost_page(before: Whole, source: random.Random, place: int) -> bytes:
    lost = source.choice([bytes(PAGE), source.randbytes(PAGE)])
    return before.data[:place] + lost + before.data[place + PAGE :]


def removed(before: Whole, source: random.Random, place: int) -> bytes:
    return before.data[:place] + before.data[place + source.randrange(1, 100) :]


DAMAGES = [zeros, garbage, own_chunks, repeated, flipped, lost_page, removed]


@pytest.mark.parametrize("damage", DAMAGES)
def test_everything_before_the_damage_is_read_and_nothing_false_behind_it(
    damage: Damage, recorded: Whole, mcap: Path
) -> None:
    source = random.Random(damage.__name__)  # noqa: S311
    end, seen = recorded.records[-1][1], 0
    for _ in range(60):
        given = damage(recorded, source, source.randrange(end))
        mcap.write_bytes(given)
        pairs = enumerate(zip(given, recorded.data, strict=False))
        same = next((place for place, (one, other) in pairs if one != other), len(given))
        try:
            before = recorded.states(same)
        except (InputError, EndOfFile):
            before = []
        try:
            points = read(mcap)[1].points
        except InputError:
            assert not before
            continue
        # What is whole is read; if more is read, as behind a harmless index, it is true.
        assert len(before) <= len(points)
        assert points == recorded.points[: len(points)]
        seen += 1
        summarise(mcap)
    assert seen > 30


@pytest.mark.parametrize("damage", DAMAGES)
def test_a_replay_claims_nothing_behind_the_damage(
    damage: Damage, recorded: Whole, mcap: Path
) -> None:
    source = random.Random(f"replay {damage.__name__}")  # noqa: S311
    end = recorded.records[-1][1]
    damaged = 0
    for _ in range(12):
        mcap.write_bytes(damage(recorded, source, source.randrange(end // 4, end)))
        again = replay(mcap)
        assert again.agrees
        assert again.damaged_tick is None or again.damaged_tick <= again.tick
        assert again.tick == recorded.points[-1].tick or not again.is_complete
        damaged += again.damaged_tick is not None
    assert damaged > 0


def after(before: Whole, share: float) -> int:
    """Return the end of a chunk, at a share of the file."""
    return before.chunks[int(len(before.chunks) * share)][1]


def test_the_command_line_tells_a_truncated_file_from_a_damaged_one(
    recorded: Whole, mcap: Path
) -> None:
    half = recorded.data[: after(recorded, 0.5)]
    step = recorded.steps(len(half))
    for tail in (bytes(2**16), b"\xff" * 100, b"\x20" * 9):
        mcap.write_bytes(half + tail)
        done = run("replay", mcap)
        assert (done.returncode, done.stderr) == (0, "")
        assert done.stdout.strip().endswith(f"the recording is damaged from step {step} on")
        assert f"reproduced up to step {step} " in done.stdout
    mcap.write_bytes(half)
    assert f"the recording is truncated: it ends at step {step}" in run("replay", mcap).stdout
    mcap.write_bytes(recorded.data + bytes(2**16))
    done = run("replay", mcap)
    assert "damaged" not in done.stdout
    assert "truncated" not in done.stdout


def test_a_file_without_a_run_before_the_damage_is_refused(recorded: Whole, mcap: Path) -> None:
    first = recorded.chunks[0][0]
    for place in (0, len(MAGIC), len(MAGIC) + HEAD.size, 100, first):
        mcap.write_bytes(recorded.data[:place] + bytes(2**16))
        assert str(mcap) in refuse("replay", mcap)
        refuse("replay", "--as-2002", mcap)


def test_the_program_of_2002_is_given_the_lines_before_the_damage(mcap: Path) -> None:
    before = whole(made(LogOptions(mcap), STEPS))
    complete = run("replay", "--as-2002", mcap)
    assert (complete.returncode, complete.stderr) == (0, "")
    mcap.write_bytes(before.data[: after(before, 0.5)] + bytes(2**16))
    step = before.steps(after(before, 0.5))
    damaged = run("replay", "--as-2002", mcap)
    assert damaged.returncode == 0
    assert damaged.stderr.strip() == f"The recording is damaged from step {step} on."
    rows = [
        {line.rstrip() for line in each.stdout.splitlines() if "2,175" in line}
        for each in (damaged, complete)
    ]
    assert rows[0] <= rows[1]
    mcap.write_bytes(before.data[: after(before, 0.5)])
    assert run("replay", "--as-2002", mcap).stderr.strip() == "The recording is truncated."


def test_a_drive_without_its_metadata_is_damaged(mcap: Path) -> None:
    before = made(LogOptions(mcap)).read_bytes()
    mcap.write_bytes(before.replace(b"agent_economy.live", b"agent_economy.lhve"))
    with pytest.raises(InputError, match="is damaged: it has lines of robots, but no metadata"):
        replay(mcap)


def test_a_page_opens_a_damaged_recording_up_to_the_damage(
    recorded: Whole, page: Page, client: TestClient, tmp_path: Path
) -> None:
    place = after(recorded, 0.5)
    step = recorded.states(place)[-1].tick
    (tmp_path / "damaged.mcap").write_bytes(recorded.data[:place] + bytes(2**16))
    (row,) = client.get("/api/recordings").json()
    assert row["error"] is None
    assert row["run"]["steps"] is None
    assert page.open_recording("damaged.mcap")["latest_tick"] == step
    assert page.seek(step)["mismatch_tick"] is None
