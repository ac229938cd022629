"""Recordings that are cut, damaged or of others: each is read as far as it goes, or told of."""

import json
import random
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mcap.reader import make_reader
from mcap.records import Attachment, Channel, Message, Metadata, Schema
from mcap.stream_reader import StreamReader
from mcap.writer import Writer
from metric import search
from test_recording import DRIVE, SCENARIOS, SHORT, short

import agent_economy as ae
from agent_economy import InputError
from agent_economy.recording.file import File
from agent_economy.recording.summary import summarise

JUNK = (
    "",
    "x",
    "-1",
    "1e9",
    "9" * 40,
    "[]",
    "{}",
    "null",
    "[[[], 1]]",
    '[[["robots"], null]]',
    "\0",
)
"""Instead of an entry of metadata."""

WRONG: tuple[Any, ...] = (
    None,
    [],
    {},
    {"tick": "a"},
    {"tick": -1, "changes": 0, "hash": ""},
    {"tick": 1, "changes": 0, "hash": 1},
    {"tick": 1, "percepts": 1, "commands": {}},
    {"tick": 1, "percepts": {"rover/0": 1}, "commands": {}},
    {"tick": 1, "percepts": {}, "commands": {"rover/0": 1}},
)
"""Instead of a message on /run or /input."""

Records = list[Any]


@pytest.fixture(scope="module", params=["metric", "classic"])
def recorded(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A short recording with a change, and of the metric engine with input."""
    path = tmp_path_factory.mktemp("recorded") / "run.mcap"
    if request.param == "classic":
        classic = ae.ClassicSimulation("classic", 1)
        with ae.Recording(classic, path) as recording:
            recording.step(20)
            classic.change("robots.wanderer.count", 6)
            recording.step(10)
        return path
    simulation = ae.Simulation(search(SHORT), 1)
    with ae.Recording(simulation, path) as recording:
        recording.step(5)
        simulation.change("robots.rover.count", 2)
        recording.step(commands={"rover/0": DRIVE})
    return path


def told(path: Path) -> list[str]:
    """Return what is wrong with a file, by all that reads it; nothing but that comes out of it."""
    words = []
    read: Callable[[Path], object]
    for read in (ae.replay, summarise):
        try:
            read(path)
        except InputError as error:
            words.append(str(error))
    assert all(str(path) in each and not each.rstrip().endswith(":") for each in words)
    return words


def records_of(path: Path) -> Records:
    with path.open("rb") as stream:
        return list(StreamReader(stream).records)


def written(path: Path, records: Iterable[Any]) -> Path:
    """Write a file of some records."""
    schemas, channels = {0: 0}, {}
    with path.open("wb") as stream:
        writer = Writer(stream)
        writer.start()
        for each in records:
            match each:
                case Schema():
                    schemas[each.id] = writer.register_schema(each.name, each.encoding, each.data)
                case Channel():
                    schema = schemas[each.schema_id]
                    channels[each.id] = writer.register_channel(
                        each.topic, each.message_encoding, schema
                    )
                case Message():
                    channel = channels[each.channel_id]
                    writer.add_message(channel, each.log_time, each.data, each.publish_time)
                case Metadata():
                    writer.add_metadata(each.name, each.metadata)
                case Attachment():
                    writer.add_attachment(0, 0, each.name, each.media_type, each.data)
        writer.finish()  # type: ignore[no-untyped-call]
    return path


def with_entry(records: Records, name: str, key: str, value: str | None) -> Records:
    """Return records with another value in metadata, or without it."""

    def edited(record: Any) -> Any:
        if not isinstance(record, Metadata) or record.name != name:
            return record
        rest = {each: text for each, text in record.metadata.items() if each != key}
        return Metadata(name=name, metadata=rest if value is None else rest | {key: value})

    return [edited(record) for record in records]


def test_what_metadata_lacks_is_told_by_name(recorded: Path, tmp_path: Path) -> None:
    records = records_of(recorded)
    metadata = [each for each in records if isinstance(each, Metadata)]
    entries = {(each.name, key) for each in metadata for key in each.metadata}
    assert len(entries) == 6 + 3 + 2
    for name, key in entries - {("agent_economy.end", "hash")}:
        path = written(tmp_path / "lacks.mcap", with_entry(records, name, key, None))
        assert f"{path}: is damaged: its metadata {name!r} has no entry {key!r}" in told(path)


def test_metadata_that_says_nonsense_never_ends_in_anything_but_a_word(
    recorded: Path, tmp_path: Path
) -> None:
    records = records_of(recorded)
    refused = 0
    for name, key in [("run", "overrides"), ("run", "seed"), ("change", "tick"), ("end", "tick")]:
        for junk in JUNK:
            edited = with_entry(records, f"agent_economy.{name}", key, junk)
            refused += bool(told(written(tmp_path / "junk.mcap", edited)))
    assert refused > 3 * len(JUNK)


def test_messages_that_say_nonsense_never_end_in_anything_but_a_word(
    recorded: Path, tmp_path: Path
) -> None:
    records = records_of(recorded)
    topics = {each.id: each.topic for each in records if isinstance(each, Channel)}
    for topic in {"/run", "/input"} & set(topics.values()):
        for wrong in WRONG:
            data = json.dumps(wrong).encode()
            edited = [
                Message(each.channel_id, each.log_time, data, each.publish_time, each.sequence)
                if isinstance(each, Message) and topics[each.channel_id] == topic
                else each
                for each in records
            ]
            assert told(written(tmp_path / "wrong.mcap", edited)), (topic, wrong)


def test_a_file_without_a_part_of_it_is_told_or_has_none(recorded: Path, tmp_path: Path) -> None:
    records = records_of(recorded)
    for place, each in enumerate(records):
        if isinstance(each, Metadata | Attachment):
            path = written(tmp_path / "part.mcap", [*records[:place], *records[place + 1 :]])
            assert bool(told(path)) is (each.name != "agent_economy.end")


def test_input_for_robots_that_take_none_is_told(tmp_path: Path) -> None:
    path = tmp_path / "run.mcap"
    file = File(path)
    file.attach("scenario/classic.toml", "", (SCENARIOS / "classic.toml").read_bytes())
    run = {"format": "1", "program": "0", "scenario": "classic.toml"}
    file.note("agent_economy.run", {**run, "overrides": "[]", "seed": "0", "run": "0"})
    file.declare("/input", '{"title": "input"}')
    file.write_json("/input", {"tick": 0, "percepts": {}, "commands": {"wanderer/0": {}}}, 0)
    file.close()
    with pytest.raises(InputError, match=r"run\.mcap: is damaged: it has percepts or commands for"):
        ae.replay(path)


def test_a_file_that_is_cut_is_compared_as_far_as_it_goes(tmp_path: Path) -> None:
    whole = short(tmp_path / "run.mcap").read_bytes()
    (cut := tmp_path / "cut.mcap").touch()
    ticks = []
    for length in np.linspace(len(whole) - 1, 0, 24, dtype=int).tolist():
        cut.write_bytes(whole[:length])
        try:
            again = ae.replay(cut)
        except InputError as error:
            assert "is not a recording of a run" in str(error) or "lacks its sc" in str(error)  # noqa: PT017
        else:
            assert (again.agrees, again.is_complete) == (True, False)
            ticks.append(again.tick)
    assert ticks == sorted(ticks, reverse=True)
    assert ticks[0] == 100


def test_a_file_that_is_cut_within_an_index_is_no_damaged_one(tmp_path: Path) -> None:
    path = tmp_path / "run.mcap"
    with ae.Recording(ae.Simulation(search(SHORT), 1), path) as recording:
        recording.step(60)
    whole = path.read_bytes()
    with path.open("rb") as stream:
        summary = make_reader(stream).get_summary()
    assert summary is not None
    chunks = summary.chunk_indexes
    assert len(chunks) > 2
    end = len(whole) - 1
    inside = [each.chunk_start_offset + each.chunk_length + 20 for each in chunks]
    for length in (*inside, *range(end - 400, end, 7)):
        path.write_bytes(whole[:length])
        again = ae.replay(path)
        assert (again.agrees, again.is_complete) == (True, False)


def test_damage_never_ends_in_anything_but_a_word(recorded: Path, tmp_path: Path) -> None:
    whole = recorded.read_bytes()
    dice = random.Random(1)  # noqa: S311
    refused = 0
    for _ in range(150):
        damaged = bytearray(whole)
        damaged[dice.randrange(len(whole))] ^= 1 << dice.randrange(8)
        if dice.random() < 1 / 3:
            first = dice.randrange(len(whole))
            del damaged[first : first + dice.randrange(60)]
        (tmp_path / "damaged.mcap").write_bytes(damaged)
        refused += bool(told(tmp_path / "damaged.mcap"))
    assert refused > 60


@pytest.mark.parametrize("content", [b"", b"engine = 'metric'", b"\x89MCAP0\r\n", b"\x00" * 100])
def test_what_is_no_recording_is_refused(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "other").write_bytes(content)
    with pytest.raises(InputError, match="other: is not an? "):
        ae.replay(tmp_path / "other")


def test_a_recording_does_not_make_the_program_read_other_files(tmp_path: Path) -> None:
    path = tmp_path / "run.mcap"
    file = File(path)
    text = (SCENARIOS / "open-field.toml").read_bytes()
    file.attach("scenario/open-field.toml", "application/toml", text)
    run = {"format": "1", "program": "0", "scenario": "open-field.toml"}
    file.note("agent_economy.run", {**run, "overrides": "[]", "seed": "0", "run": "0"})
    file.close()
    with pytest.raises(
        InputError, match=r"lacks files that the scenario refers to: open-field\.yaml"
    ):
        ae.replay(path)
