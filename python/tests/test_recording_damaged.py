"""Truncated, damaged and foreign recordings: they are read up to their end, or rejected."""

import json
import random
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mcap.opcode import Opcode
from mcap.reader import make_reader
from mcap.records import Attachment, Channel, Message, Metadata, Schema
from mcap.stream_reader import StreamReader
from mcap.writer import Writer
from metric import search
from recorded_drive import made
from test_recording import DRIVE, SCENARIOS, SHORT, short
from test_recording_survives import whole

import agent_economy as ae
from agent_economy import InputError
from agent_economy.live.replay import replay
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
"""Invalid values of metadata."""

WRONG: tuple[Any, ...] = (
    None,
    [],
    {},
    {"tick": "a"},
    {"tick": -1, "changes": 0, "hash": ""},
    {"tick": 1, "changes": 0, "hash": 1},
    {"tick": 1, "changes": 0, "hash": "0", "decisions": 1},
    {"tick": 1, "changes": 0, "hash": "0", "decisions": "+000000000000001"},
    {"tick": 1, "percepts": 1, "commands": {}},
    {"tick": 1, "percepts": {"rover/0": 1}, "commands": {}},
    {"tick": 1, "percepts": {}, "commands": {"rover/0": 1}},
)
"""Invalid messages on /run or /input."""

Records = list[Any]


@pytest.fixture(scope="module", params=["metric", "classic"])
def recorded(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a short recording with a change, and for the metric engine with external inputs."""
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


def errors(path: Path) -> list[str]:
    """Return the errors of a file from all readers, which raise no other exceptions."""
    words = []
    read: Callable[[Path], object]
    for read in (ae.replay, summarise):
        try:
            read(path)
        except InputError as error:
            words.append(str(error))
    assert all(str(path) in each and not each.rstrip().endswith(":") for each in words)
    return words


def is_refused_or_damaged(path: Path) -> bool:
    """Return whether a replay refuses a file, or reports that it is damaged."""
    try:
        replayed = ae.replay(path)
    except InputError:
        return True
    return replayed.damaged_tick is not None


def records_of(path: Path) -> Records:
    with path.open("rb") as stream:
        return list(StreamReader(stream).records)


def written(path: Path, records: Iterable[Any]) -> Path:
    """Write a file with given records."""
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


def test_missing_metadata_is_named(recorded: Path, tmp_path: Path) -> None:
    records = records_of(recorded)
    metadata = [each for each in records if isinstance(each, Metadata)]
    entries = {(each.name, key) for each in metadata for key in each.metadata}
    # A recording without an engine is one of an older build; the classic engine has no decisions.
    ends = {("agent_economy.end", key) for key in ("hash", "decisions")}
    optional = {*ends, ("agent_economy.run", "engine")}
    assert len(entries - optional) == 6 + 3 + 1
    for name, key in entries - optional:
        path = written(tmp_path / "lacks.mcap", with_entry(records, name, key, None))
        named = f"{path}: is damaged: its metadata {name!r} has no entry {key!r}"
        if name != "agent_economy.end":  # all states are behind them in this file
            assert named in errors(path)
        else:
            assert ae.replay(path).agrees
            assert summarise(path).steps is None


def test_invalid_metadata_raises_input_errors_only(recorded: Path, tmp_path: Path) -> None:
    records = records_of(recorded)
    refused = 0
    entries = [("overrides", "run"), ("seed", "run"), ("external", "run"), ("tick", "change")]
    for key, name in [*entries, ("tick", "end")]:
        for junk in JUNK:
            edited = with_entry(records, f"agent_economy.{name}", key, junk)
            path = written(tmp_path / "junk.mcap", edited)
            refused += bool(errors(path)) or is_refused_or_damaged(path)
    assert refused > 3 * len(JUNK)


def test_invalid_messages_raise_input_errors_only(recorded: Path, tmp_path: Path) -> None:
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
            path = written(tmp_path / "wrong.mcap", edited)
            errors(path)
            assert is_refused_or_damaged(path), (topic, wrong)


def test_a_file_without_one_of_its_parts_is_rejected(recorded: Path, tmp_path: Path) -> None:
    records = records_of(recorded)
    for place, each in enumerate(records):
        if isinstance(each, Metadata | Attachment):
            path = written(tmp_path / "part.mcap", [*records[:place], *records[place + 1 :]])
            assert is_refused_or_damaged(path) is (each.name != "agent_economy.end")
            is_beginning = each.name.startswith(("agent_economy.run", "scenario/"))
            assert bool(errors(path)) is is_beginning


def test_inputs_of_the_classic_engine_are_rejected(mcap: Path) -> None:
    file = File(mcap)
    file.attach("scenario/classic.toml", "", (SCENARIOS / "classic.toml").read_bytes())
    run = {"format": "1", "program": "0", "scenario": "classic.toml"}
    file.note("agent_economy.run", {**run, "overrides": "[]", "seed": "0", "run": "0"})
    file.declare("/input", '{"title": "input"}')
    file.write_json("/input", {"tick": 0, "percepts": {}, "commands": {"wanderer/0": {}}}, 0)
    file.close()
    with pytest.raises(InputError, match=r"run\.mcap: is damaged: it has percepts or commands for"):
        ae.replay(mcap)


def test_external_bodies_of_the_classic_engine_are_rejected(mcap: Path, tmp_path: Path) -> None:
    with ae.Recording(ae.ClassicSimulation("classic", 1), mcap) as recording:
        recording.step(5)
    edited = with_entry(records_of(mcap), "agent_economy.run", "external", '["wanderer/0"]')
    path = written(tmp_path / "run.mcap", edited)
    with pytest.raises(InputError, match=r"run\.mcap: is damaged: .* has external bodies"):
        ae.replay(path)


def test_a_truncated_file_is_compared_up_to_its_end(tmp_path: Path, mcap: Path) -> None:
    whole = short(mcap).read_bytes()
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


def test_a_file_truncated_within_its_index_is_not_damaged(mcap: Path) -> None:
    with ae.Recording(ae.Simulation(search(SHORT), 1), mcap) as recording:
        recording.step(60)
    whole = mcap.read_bytes()
    with mcap.open("rb") as stream:
        summary = make_reader(stream).get_summary()
    assert summary is not None
    chunks = summary.chunk_indexes
    assert len(chunks) > 2
    end = len(whole) - 1
    inside = [each.chunk_start_offset + each.chunk_length + 20 for each in chunks]
    for length in (*inside, *range(end - 400, end, 7)):
        mcap.write_bytes(whole[:length])
        again = ae.replay(mcap)
        assert (again.agrees, again.is_complete) == (True, False)


def test_damaged_bytes_raise_input_errors_only(recorded: Path, tmp_path: Path) -> None:
    whole = recorded.read_bytes()
    random_source = random.Random(1)  # noqa: S311
    refused = 0
    for _ in range(150):
        damaged = bytearray(whole)
        damaged[random_source.randrange(len(whole))] ^= 1 << random_source.randrange(8)
        if random_source.random() < 1 / 3:
            first = random_source.randrange(len(whole))
            del damaged[first : first + random_source.randrange(60)]
        (tmp_path / "damaged.mcap").write_bytes(damaged)
        errors(tmp_path / "damaged.mcap")
        refused += is_refused_or_damaged(tmp_path / "damaged.mcap")
    assert refused > 60


@pytest.mark.parametrize("content", [b"", b"engine = 'metric'", b"\x89MCAP0\r\n", b"\x00" * 100])
def test_other_files_are_rejected(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "other").write_bytes(content)
    with pytest.raises(InputError, match="other: is not an? "):
        ae.replay(tmp_path / "other")


def test_a_replay_reads_no_other_files(mcap: Path) -> None:
    file = File(mcap)
    text = (SCENARIOS / "open-field.toml").read_bytes()
    file.attach("scenario/open-field.toml", "application/toml", text)
    run = {"format": "1", "program": "0", "scenario": "open-field.toml"}
    file.note("agent_economy.run", {**run, "overrides": "[]", "seed": "0", "run": "0"})
    file.close()
    with pytest.raises(
        InputError, match=r"lacks files that the scenario refers to: open-field\.yaml"
    ):
        ae.replay(mcap)


@pytest.mark.parametrize("end", ["run", "drive"])
def test_every_byte_before_the_index_has_a_checksum(end: str, tmp_path: Path, mcap: Path) -> None:
    if end == "drive":
        made(mcap, 12)
    else:
        with ae.Recording(ae.Simulation(search(SHORT), 1), mcap) as recording:
            recording.step(12)
    assert replay(mcap).is_complete
    before, kinds = whole(mcap), set()
    for kind, start, stop in before.records:
        damaged = bytearray(before.data)
        # Letters and numbers, not the lengths of what follows: the record can still be read.
        damaged[stop - 1 if kind != Opcode.HEADER else start + 20] ^= 1
        (tmp_path / "damaged.mcap").write_bytes(damaged)
        try:
            again = replay(tmp_path / "damaged.mcap")
        except InputError:
            assert kind in (Opcode.METADATA, Opcode.ATTACHMENT, Opcode.CHUNK)
        else:
            assert not again.is_complete, (kind, start)
            assert again.damaged_tick is not None
        kinds.add(kind)
    assert {Opcode.METADATA, Opcode.MESSAGE_INDEX, Opcode.HEADER, Opcode.CHUNK} <= kinds


@pytest.mark.parametrize("key", ["tick", "hash", "decisions"])
def test_an_end_that_is_not_that_of_the_last_state_is_damage(
    key: str, mcap: Path, tmp_path: Path
) -> None:
    with ae.Recording(ae.Simulation(search(SHORT), 1), mcap) as recording:
        recording.step(12)
    value = "11" if key == "tick" else "0123456789abcdef"
    records = with_entry(records_of(mcap), "agent_economy.end", key, value)
    # With right checksums, as no accident leaves it.
    again = replay(written(tmp_path / "end.mcap", records))
    assert (again.agrees, again.is_complete, again.damaged_tick) == (True, False, 12)


def test_a_killed_process_leaves_a_truncated_file_that_can_be_read(mcap: Path) -> None:
    recording = ae.Recording(ae.Simulation(search(SHORT), 1), mcap, flush_s=1.0)
    recording.step(30)
    data = mcap.read_bytes()  # what another process would find
    recording.close()
    mcap.write_bytes(data)
    again = replay(mcap)
    assert (again.agrees, again.is_complete, again.damaged_tick) == (True, False, None)
    assert again.tick >= 20
