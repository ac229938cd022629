"""Drives of which every n-th state is recorded: a replay verifies every step all the same."""

from collections import Counter
from pathlib import Path

import pytest
from command_line import refuse, run
from mcap.reader import make_reader
from mcap.records import Attachment, Channel, Message, Metadata, Schema
from mcap.writer import Writer
from recorded import contents
from recorded_drive import made
from test_recording_survives import whole

from agent_economy import InputError
from agent_economy.live.as_2002 import compare_2002
from agent_economy.live.loop.log import LogOptions
from agent_economy.live.replay import read_drive, replay
from agent_economy.recording.live_topics import SETPOINTS
from agent_economy.recording.reading import read
from agent_economy.recording.records import stream_records

STEPS = 123
WHOLE = ("/wire/", "/live/", "/input")
"""Prefixes of the topics that a replay needs."""


def counts(path: Path) -> Counter[str]:
    topics = contents(path).topics.items()
    return Counter({topic: len(messages) for topic, messages in topics})


@pytest.mark.parametrize("every", [1, 2, 3, 7, 10, 1000])
def test_a_thinned_drive_has_every_input_and_every_nth_state(every: int, tmp_path: Path) -> None:
    full = counts(made(tmp_path / "full.mcap", STEPS))
    thin = counts(made(LogOptions(tmp_path / "thin.mcap", every=every), STEPS))
    needed = {topic: count for topic, count in full.items() if topic.startswith(WHOLE)}
    assert {topic: thin[topic] for topic in needed} == needed
    assert {"/live/ticks", "/live/setpoints", "/live/events", "/input"} <= needed.keys()
    states = len({0, *range(0, STEPS + 1, every), STEPS})
    assert (thin["/run"], thin["/tf"], thin["/robots"]) == (states, states, states)
    # The brain steps every second time; of these, one in each n steps is recorded.
    percepts = len({tick // every for tick in range(0, STEPS, 2)})
    for topic in ("/percept/bender/0", "/command/bender/0", "/scan/bender/0/0"):
        assert thin[topic] == percepts
    assert full["/percept/bender/0"] == len(range(0, STEPS, 2))


@pytest.mark.parametrize("every", [2, 7, 10, 1000])
def test_a_replay_verifies_every_percept_and_setpoint_of_a_thinned_drive(
    every: int, tmp_path: Path
) -> None:
    path = made(LogOptions(tmp_path / "thin.mcap", every=every), STEPS)
    again = replay(path)
    assert (again.agrees, again.is_complete, again.tick) == (True, True, STEPS)
    assert again.hash == replay(made(tmp_path / "full.mcap", STEPS)).hash
    # A changed line between two recorded states is found in its step.
    changed = tmp_path / "changed.mcap"
    rewritten(path, changed, at=60)
    assert replay(changed).mismatch_tick in (60, 61)


def rewritten(path: Path, changed: Path, at: int) -> None:
    """Copy a recording with other compass lines after a step, and with right checksums."""
    topics: dict[int, str] = {}
    with path.open("rb") as source, changed.open("wb") as target:
        writer = Writer(target)
        writer.start()
        for each in stream_records(source):
            match each:
                case Schema():
                    writer.register_schema(each.name, each.encoding, each.data)
                case Channel():
                    topics[each.id] = each.topic
                    writer.register_channel(each.topic, each.message_encoding, each.schema_id)
                case Metadata():
                    writer.add_metadata(each.name, each.metadata)
                case Attachment():
                    writer.add_attachment(0, 0, each.name, each.media_type, each.data)
                case Message():
                    data = each.data
                    is_late = each.log_time > at * 10**8
                    if topics[each.channel_id].endswith("/compass") and is_late:
                        data = data.replace(b'"line":"', b'"line":"2')
                    writer.add_message(each.channel_id, each.log_time, data, each.publish_time)
        writer.finish()  # type: ignore[no-untyped-call]


@pytest.mark.parametrize("every", [1, 10, 1000])
def test_a_thinned_drive_is_replayed_up_to_the_exact_step_of_its_end_or_damage(
    every: int, tmp_path: Path
) -> None:
    full = made(tmp_path / "full.mcap", STEPS)
    hashes = {point.tick: point.hash for point in read(full)[1].points}
    before = whole(made(LogOptions(tmp_path / "thin.mcap", every=every), STEPS))
    cut, seen = tmp_path / "cut.mcap", set()
    for share in (0.3, 0.5, 0.9):
        _, place = before.chunks[int(share * len(before.chunks))]
        cut.write_bytes(before.data[:place])
        steps = 1 + max(tick for tick in setpoints(cut))
        truncated = replay(cut)
        assert (truncated.agrees, truncated.is_complete) == (True, False)
        assert (truncated.tick, truncated.damaged_tick) == (steps, None)
        assert truncated.hash == hashes[steps]
        cut.write_bytes(before.data[:place] + bytes(5000))
        damaged = replay(cut)
        assert (damaged.agrees, damaged.is_complete) == (True, False)
        assert (damaged.tick, damaged.damaged_tick) == (steps, steps)
        assert damaged.hash == hashes[steps]
        assert compare_2002(cut).damaged_tick == steps
        assert f"damaged from step {steps} on" in run("replay", str(cut)).stdout
        seen.add(steps)
    assert len(seen) == 3


def setpoints(path: Path) -> list[int]:
    """Return the ticks of which a truncated file has setpoints."""
    drive = read_drive(path)
    assert drive is not None
    return [message["tick"] for topic, message in drive.messages if topic == SETPOINTS]


def test_the_lines_of_a_thinned_drive_are_in_the_file_within_a_second(tmp_path: Path) -> None:
    path = made(LogOptions(tmp_path / "thin.mcap", every=1000), STEPS)
    with path.open("rb") as stream:
        summary = make_reader(stream).get_summary()
    assert summary is not None
    ends_s = [each.message_end_time / 1e9 for each in summary.chunk_indexes]
    assert max(b - a for a, b in zip([0.0, *ends_s], ends_s, strict=False)) < 1


@pytest.mark.parametrize("every", ["0", "-1", "1.5", "many"])
def test_only_whole_numbers_of_steps_are_accepted(every: str, tmp_path: Path) -> None:
    assert "--every" in refuse("drive", "bender", "--headless", "--arm", "--every", every)
    with pytest.raises(InputError, match="every = 0: must be a whole number, 1 or more"):
        made(LogOptions(tmp_path / "thin.mcap", every=0))
    assert not list(tmp_path.iterdir())
    assert "--every" in run("drive", "--help").stdout
