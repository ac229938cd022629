"""Files that a scenario refers to, such as maps: they are stored with it."""

import os
import shutil
from pathlib import Path

import pytest

import agent_economy as ae
from agent_economy import _core, study
from agent_economy.scenario import source
from agent_economy.scenario.bundled import find

YAML = """image: room.pgm
resolution: 1
origin: [0, 0, 0]
negate: 0
occupied_thresh: 0.65
free_thresh: 0.196
"""

TEXT = """
engine = "metric"
summary = "A room of two cells, one of them solid."
merit = { distance = 1 }
clock = { time_limit_s = 1 }
world = { size_m = [2, 1], obstacles = [{ map = "maps/room.yaml" }] }

[robots.rover]
count = 1
radius_m = 0.1
drive = { max_speed_m_s = 1, max_turn_rate_deg_s = 90 }

[study]
vary = { "robots.rover.count" = "1,2" }
delta = 0.5
"""


@pytest.fixture
def room(tmp_path: Path) -> Path:
    maps = tmp_path / "maps"
    maps.mkdir()
    (maps / "room.yaml").write_text(YAML)
    (maps / "room.pgm").write_text("P2 2 1 255  0 254")
    file = tmp_path / "room.toml"
    file.write_text(TEXT)
    return file


def test_a_loaded_scenario_no_longer_needs_its_files(room: Path) -> None:
    scenario = ae.Scenario.load(room)
    assert set(scenario.source.files) == {"maps/room.yaml", "maps/room.pgm"}
    shutil.rmtree(room.parent / "maps")
    assert scenario.replace("clock.time_limit_s", 2).time_limit_s == 2
    assert scenario.configuration({"robots.rover.count": 2}).columns


def test_a_study_continues_without_the_files_of_its_scenario(room: Path) -> None:
    out = room.parent / "study"
    first = study.run(ae.Scenario.load(room), out=out)
    shutil.rmtree(room.parent / "maps")
    assert study.resume(out).sentence == first.sentence


def test_a_study_with_a_changed_map_is_another_study(room: Path) -> None:
    out = room.parent / "study"
    study.run(ae.Scenario.load(room), out=out)
    (room.parent / "maps" / "room.pgm").write_text("P2 2 1 255  254 0")
    with pytest.raises(ae.InputError, match="contains another study"):
        study.run(ae.Scenario.load(room), out=out)


def test_a_damaged_file_of_a_study_is_named(room: Path) -> None:
    out = room.parent / "study"
    study.run(ae.Scenario.load(room), out=out)
    damaged = min((out / "files").iterdir())
    damaged.write_bytes(b"")
    with pytest.raises(ae.InputError, match=f"{damaged.name}: is missing or damaged"):
        study.resume(out)


def test_a_missing_file_is_reported_at_its_line(room: Path) -> None:
    (room.parent / "maps" / "room.pgm").unlink()
    with pytest.raises(ae.InputError) as caught:
        ae.Scenario.load(room)
    assert "maps/room.yaml:1: image" in str(caught.value)
    (room.parent / "maps" / "room.yaml").unlink()
    with pytest.raises(ae.InputError) as caught:
        ae.Scenario.load(room)
    assert 'room.toml:6: world.obstacles[0].map = "maps/room.yaml"' in str(caught.value)
    assert "No such file" in str(caught.value)


@pytest.mark.parametrize("name", ["maps/room.yaml", "maps/room.pgm", "room.toml"])
@pytest.mark.parametrize("other", ["/dev/zero", "pipe"])
def test_pipes_and_devices_are_not_read(room: Path, name: str, other: str) -> None:
    os.mkfifo(room.parent / "pipe")
    (room.parent / name).unlink()
    (room.parent / name).symlink_to(room.parent / other)
    with pytest.raises(ae.InputError) as caught:
        ae.Scenario.load(room)
    assert Path(name).name in str(caught.value)
    assert "is a pipe or a device; save its output to a file and pass that" in str(caught.value)


def test_a_map_may_have_the_maximum_size_of_its_reader(
    room: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert _core.MAX_IMAGE_BYTES == 5 * 64_000_000
    size = (room.parent / "maps" / "room.yaml").stat().st_size
    monkeypatch.setattr(_core, "MAX_IMAGE_BYTES", size)
    assert ae.Scenario.load(room).source.files
    monkeypatch.setattr(_core, "MAX_IMAGE_BYTES", size - 1)
    with pytest.raises(
        ae.InputError, match=rf"room.toml:6: .* larger than the limit of {size - 1} bytes"
    ):
        ae.Scenario.load(room)


def test_a_file_that_is_too_large_is_not_read_to_its_end(tmp_path: Path) -> None:
    with (tmp_path / "large.toml").open("wb") as large:
        large.truncate(2**40)
    with pytest.raises(
        ae.InputError, match=f"large.toml: .* larger than the limit of {source.MAX_BYTES:,}"
    ):
        ae.Scenario.load(tmp_path / "large.toml")
    with (tmp_path / "large.toml").open("r+b") as large:
        large.write(source.RECORDING_MAGIC)
    with pytest.raises(ae.InputError, match="got a recording"):
        ae.Scenario.load(tmp_path / "large.toml")


def test_an_impossible_file_name_is_an_error(room: Path) -> None:
    room.write_text(TEXT.replace("maps/room.yaml", "maps/\\u0000.yaml"))
    with pytest.raises(ae.InputError, match="room.toml:6: .* null"):
        ae.Scenario.load(room)


def test_bundled_maps_are_found_by_the_name_of_their_scenario() -> None:
    assert find("open-field").with_suffix(".yaml").exists()
    assert ae.Scenario.load("open-field").source.files
