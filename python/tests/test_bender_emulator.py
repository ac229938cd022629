"""The emulator of Bender over its ports, its control port, and its command."""

import asyncio
import fcntl
import itertools
import json
import re
import signal
import struct
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from bender_client import FAST, Client, emulate, stepped
from command_line import COMMAND, refuse

from agent_economy import InputError
from agent_economy.live.emulator import FAULTS, Emulator, Settings, Setup
from agent_economy.live.emulator.control import reply
from agent_economy.live.emulator.faults import NONE
from agent_economy.live.emulator.settings import rules

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "bender-emulator.md"


async def clients_of(emulator: Emulator, *ports: str) -> list[Client]:
    return [await Client.to(emulator.ports(0)[port]) for port in ports]


def test_each_port_sends_its_lines_at_its_own_rate() -> None:
    async def story(emulator: Emulator) -> None:
        clients = {name: await Client.to(emulator.ports(0)[name]) for name in emulator.ports(0)}
        received = await asyncio.gather(*(client.lines(2.05) for client in clients.values()))
        lines = dict(zip(clients, received, strict=True))
        assert lines["motors"] == []
        for name, rate_hz in (("compass", 10), ("gps", 1), ("sonar", 5)):
            assert abs(len(lines[name]) - 2 * rate_hz) <= max(1, 0.3 * rate_hz), name
        assert all(re.fullmatch(r"\d+\.\d", each) for each in lines["compass"])
        fix = r"36,\d\d\.\d{4},N,121,\d\d\.\d{4},W"
        assert all(re.fullmatch(fix, each) for each in lines["gps"])
        assert all(re.fullmatch(r"(\d+\.\d\d,){5}\d+\.\d\d", each) for each in lines["sonar"])

    emulate(story)


def test_the_line_end_and_the_rate_can_be_set_while_it_runs() -> None:
    async def story(emulator: Emulator) -> None:
        compass, sonar = await clients_of(emulator, "compass", "sonar")
        emulator.set({"line_end": "cr", "compass_hz": 20, "sonar_hz": 0})
        await compass.data(0.1)
        data, none = await asyncio.gather(compass.data(0.6), sonar.data(0.6))
        assert 8 <= data.count(b"\r") <= 16
        assert b"\n" not in data
        assert none.count(b"\r") == 0

    emulate(story, {"line_end": "crlf", "sonar_hz": 0.0001})


def test_every_motor_line_is_logged_with_its_time_also_in_pieces_and_in_one_packet() -> None:
    async def story(emulator: Emulator) -> None:
        motors = await Client.to(emulator.ports(0)["motors"])
        motors.write("x,2,175,\nx,0")
        await asyncio.sleep(0.1)
        motors.write(",75,\r\nnonsense\nx,3,\n")
        await asyncio.sleep(0.1)
        entries = emulator.log.entries("received", robot=0, port="motors")
        assert [(each["line"], each["result"]) for each in entries] == [
            ("x,2,175,", "obeyed"),
            ("x,0,75,", "obeyed"),
            ("nonsense", "malformed"),
            ("x,3,", "obeyed"),
        ]
        times = [each["t_s"] for each in entries]
        assert times == sorted(times)
        assert 0.08 < times[1] - times[0] < 1

    emulate(story)


def test_without_a_deadman_timer_the_robot_drives_on_after_its_connection_is_lost() -> None:
    async def story(emulator: Emulator) -> None:
        motors = await Client.to(emulator.ports(0)["motors"])
        motors.write("x,2,175,\n")
        await asyncio.sleep(0.1)
        motors.writer.close()
        await asyncio.sleep(0.5)
        assert emulator.robots[0].tracks.left == 175
        emulator.set({"deadman_s": 0.3})
        await asyncio.sleep(0.2)
        assert emulator.robots[0].tracks.is_neutral
        assert len(emulator.log.entries("deadman", robot=0, port="motors")) == 1

    emulate(story)


def test_a_deadman_timer_stops_the_robot_only_when_motor_lines_stay_away() -> None:
    async def story(emulator: Emulator) -> None:
        motors = await Client.to(emulator.ports(0)["motors"])
        for _ in range(5):
            motors.write("x,2,175,\n")
            await asyncio.sleep(0.15)
        assert emulator.log.entries("deadman") == []
        assert emulator.robots[0].tracks.left == 175
        await asyncio.sleep(0.5)
        (stop,) = emulator.log.entries("deadman")
        last = emulator.log.entries("received")[-1]
        assert 0.35 < stop["t_s"] - last["t_s"] < 0.6

    emulate(story, {"deadman_s": 0.4})


def test_several_programs_can_share_a_port_unless_the_settings_allow_only_one() -> None:
    async def story(emulator: Emulator) -> None:
        number = emulator.ports(0)["motors"]
        first, second = await Client.to(number), await Client.to(number)
        first.write("x,2,175,\n")
        second.write("x,0,75,\n")
        await asyncio.sleep(0.1)
        assert len(emulator.log.entries("received")) == 2
        for client in (first, second):
            client.writer.close()
        await asyncio.sleep(0.1)
        emulator.set({"motor_connections": "one"})
        third = await Client.to(number)
        await asyncio.sleep(0.05)
        fourth = await Client.to(number)
        assert await fourth.is_closed()
        third.write("x,3,\n")
        await asyncio.sleep(0.1)
        assert emulator.log.entries("received")[-1]["line"] == "x,3,"
        assert len(emulator.log.entries("turned away")) == 1

    emulate(story)


def test_a_stalled_port_stays_open_and_neither_sends_nor_reads_until_it_recovers() -> None:
    async def story(emulator: Emulator) -> None:
        sonar, motors = await clients_of(emulator, "sonar", "motors")
        await sonar.line()
        await emulator.fault(0, "sonar", "stall")
        await emulator.fault(0, "motors", "stall")
        motors.write("x,2,175,\n")
        await sonar.data(0.05)
        assert await sonar.data(0.3) == b""
        assert emulator.log.entries("received") == []
        late = await Client.to(emulator.ports(0)["motors"])
        late.write("x,3,\n")
        await emulator.fault(0, "sonar", "stall", on=False)
        await emulator.fault(0, "motors", "stall", on=False)
        await sonar.line()
        await asyncio.sleep(0.05)
        assert {each["line"] for each in emulator.log.entries("received")} == {"x,2,175,", "x,3,"}

    emulate(story, FAST)


@pytest.mark.skipif(sys.platform != "linux", reason="needs a socket filter of Linux")
def test_a_cut_link_stays_open_and_acknowledges_nothing_until_it_recovers() -> None:
    async def story(emulator: Emulator) -> None:
        sonar, motors = await clients_of(emulator, "sonar", "motors")
        await sonar.line()
        for port in ("sonar", "motors"):
            await emulator.fault(0, port, "cut")
        motors.write("x,3,\n")
        await sonar.data(0.05)
        assert await sonar.data(0.3) == b""
        assert unacknowledged(motors) == len("x,3,\n")
        assert emulator.log.entries("received") == []
        for port in ("sonar", "motors"):
            await emulator.fault(0, port, "cut", on=False)
            await emulator.fault(0, port, "cut", on=False)
        await sonar.line()
        async with asyncio.timeout(5):
            while not emulator.log.entries("received"):
                await asyncio.sleep(0.05)
        assert unacknowledged(motors) == 0

    emulate(story, FAST)


def unacknowledged(client: Client) -> int:
    """Return the number of written bytes that the other side has not acknowledged."""
    number = client.writer.get_extra_info("socket").fileno()
    return int(struct.unpack("i", fcntl.ioctl(number, 0x5411, b"\0" * 4))[0])


def test_a_port_can_close_its_connections_and_refuse_new_ones() -> None:
    async def story(emulator: Emulator) -> None:
        number = emulator.ports(0)["gps"]
        client = await Client.to(number)
        await client.line()
        await emulator.fault(0, "gps", "close")
        assert await client.is_closed()
        again = await Client.to(number)
        await again.line()
        await emulator.fault(0, "gps", "refuse")
        await again.line()
        with pytest.raises(ConnectionError):
            await Client.to(number)
        await emulator.fault(0, "gps", "refuse", on=False)
        await (await Client.to(number)).line()
        assert emulator.ports(0)["gps"] == number

    emulate(story, FAST)


def test_lines_are_damaged_on_one_port_of_one_robot_in_both_directions() -> None:
    async def story(emulator: Emulator) -> None:
        compass, sonar, motors = await clients_of(emulator, "compass", "sonar", "motors")
        other = await Client.to(emulator.ports(1)["compass"])
        await emulator.fault(0, "compass", "duplicate")
        await emulator.fault(0, "sonar", "half")
        await emulator.fault(0, "motors", "delay", 0.3)
        motors.write("x,3,\n")
        await asyncio.gather(*(each.data(0.1) for each in (compass, sonar, other)))
        doubled, cut, plain = await asyncio.gather(
            compass.lines(0.5), sonar.data(0.5), other.lines(0.5)
        )
        assert len(doubled) > 1.5 * len(plain) > 0
        assert cut
        assert b"\n" not in cut
        (stop,) = emulator.log.entries("received")
        begun = emulator.log.entries("fault")[-1]["t_s"]
        assert 0.28 < stop["t_s"] - begun < 0.5

    emulate(story, FAST, robots=2)


def test_a_client_that_does_not_read_loses_lines_and_blocks_no_other() -> None:
    async def story(emulator: Emulator) -> None:
        port = emulator._ports[0]["sonar"]
        number = emulator.ports(0)["sonar"]
        slow, quick = await Client.to(number), await Client.to(number)
        await asyncio.sleep(0.05)
        slow.writer.transport.pause_reading()  # type: ignore[attr-defined]
        for _ in range(200):
            port.send([(0, b"x" * 65_535 + b"\n")])
            await quick.data(0.001)
        assert emulator.log.entries("overflow")
        await quick.data(0.1)
        assert await quick.lines(0.3)

    emulate(story, FAST)


# Control


async def exchanged(client: Client, request: str) -> Any:
    client.write(request + "\n")
    return json.loads(await client.line())


def test_the_control_port_damages_sensors_changes_settings_and_returns_the_state() -> None:
    async def story(emulator: Emulator) -> None:
        client = await Client.to(emulator.control_port)
        sonar = await Client.to(emulator.ports(0)["sonar"])
        reply = await exchanged(client, '{"robot": 0, "port": "sonar", "fault": "nan", "on": true}')
        assert reply == {"ok": True}
        await sonar.data(0.1)
        assert set(await sonar.lines(0.2)) == {"NaN,NaN,NaN,NaN,NaN,NaN"}
        reply = await exchanged(client, '{"set": {"gps_hz": 2, "deadman_s": 1.5}}')
        assert reply["settings"]["gps_hz"] == emulator.settings.gps_hz == 2
        reply = await exchanged(client, '{"get": "state"}')
        (robot,) = reply["state"]["robots"]
        assert robot["faults"] == {"sonar": {"nan": None}}
        assert robot["pose"] == {"x_m": 5, "y_m": 15, "heading_rad": 0, "speed_m_s": 0}
        assert robot["motors"] == {"left": 150, "right": 150}
        assert robot["lines"]["sonar"] == "NaN,NaN,NaN,NaN,NaN,NaN"
        assert robot["connections"] == {"motors": 0, "compass": 0, "gps": 0, "sonar": 1}
        reply = await exchanged(client, '{"get": "settings"}')
        assert reply["settings"]["deadman_s"] == 1.5
        bad = await exchanged(client, "stop!")
        assert not bad["ok"]
        assert (await exchanged(client, '{"get": "settings"}'))["ok"]

    emulate(story, FAST)


@pytest.mark.parametrize(
    ("request_line", "error"),
    [
        ("{", "not a JSON object on one line: expected "),
        ("[1]", "not a JSON object"),
        ("[" * 100_000, "not a JSON object"),
        ('{"get": "poses"}', 'not a request: expected .*{"get": "state"}'),
        ('{"get": "state", "robot": 0}', "not a request"),
        ('{"set": 3}', "not a request"),
        ('{"set": {"gps_hertz": 2}}', "gps_hertz is not a setting: .*did you mean gps_hz"),
        ('{"set": {"gps_hz": "two"}}', "gps_hz = 'two': must be a number from 0 to 20"),
        ('{"set": {"gps_hz": NaN}}', "gps_hz = nan: must be"),
        ('{"set": {"gps_hz": true}}', "gps_hz = True: must be"),
        ('{"robot": 0, "port": "sonar", "fault": "stal"}', "one of drop, .*; did you mean stall"),
        ('{"robot": 0, "port": "motors", "fault": "nan"}', "port motors can have one of"),
        ('{"robot": 0, "port": "radio", "fault": "stall"}', "must be one of motors, compass, gps"),
        ('{"robot": 0, "port": [], "fault": "stall"}', "must be one of motors, compass, gps"),
        ('{"robot": 1, "port": "gps", "fault": "stall"}', "robot = 1: must be a whole number"),
        ('{"robot": true, "port": "gps", "fault": "stall"}', "must be the number of a robot"),
        ('{"port": "gps", "fault": "stall"}', "robot = null: must be the number of a robot"),
        ('{"robot": 0, "port": "gps", "fault": "stall", "on": 1}', "on = 1: must be true or false"),
        ('{"robot": 0, "port": "gps", "fault": "drop", "value": 2}', "a number from 0 to 1"),
        ('{"robot": 0, "port": "gps", "fault": "nan", "value": 2}', "takes no value"),
        ('{"robot": 0, "port": "gps", "fault": "nan", "of": 2}', "not a request"),
    ],
)
def test_a_bad_request_is_answered_with_what_is_allowed_and_changes_nothing(
    request_line: str, error: str
) -> None:
    emulator = stepped()
    before = emulator.settings, emulator.robots[0].state()
    answer = asyncio.run(reply(request_line.encode(), emulator))
    assert answer["ok"] is False
    assert re.search(error, answer["error"])
    assert (emulator.settings, emulator.robots[0].state()) == before


def test_all_damage_can_be_switched_on_with_its_default_and_off_again() -> None:
    async def story(emulator: Emulator) -> None:
        for name, fault in FAULTS.items():
            for port in fault.defaults:
                await emulator.fault(0, port, name)
                is_active = name in emulator.robots[0].faults[port]
                assert is_active == (name != "close")
                await emulator.fault(0, port, name, on=False)
                assert not emulator.robots[0].faults[port]

    emulate(story)


# Setup and command


def test_the_ports_of_the_next_robot_are_10_higher() -> None:
    setup = Setup(ports=(2000, 2001, 2002, 0), robots=3)
    assert setup.numbers(0) == {"motors": 2000, "compass": 2001, "gps": 2002, "sonar": 0}
    assert setup.numbers(2) == {"motors": 2020, "compass": 2021, "gps": 2022, "sonar": 0}

    async def story(emulator: Emulator) -> None:
        one, two = emulator.ports(0), emulator.ports(1)
        assert all(two[name] - one[name] == 10 for name in one)
        assert await (await Client.to(two["sonar"])).line()

    for base in itertools.count(21_000, 137):
        try:
            emulate(story, FAST, ports=(base, base + 1, base + 2, base + 3), robots=2)
        except InputError:
            continue  # another program uses one of them
        break


def test_a_port_in_use_is_an_error_and_frees_the_others() -> None:
    async def story(emulator: Emulator) -> None:
        taken = emulator.ports(0)["sonar"]
        other = Emulator(None, Setup(ports=(0, 0, 0, taken)))
        with pytest.raises(InputError, match=rf"port {taken}: cannot listen there: .*in use"):
            async with other:
                pass
        with pytest.raises(ConnectionError):
            await Client.to(other.ports(0)["motors"])

    emulate(story)


def test_the_command_prints_its_addresses_logs_lines_and_ends_with_ctrl_c(tmp_path: Path) -> None:
    file = tmp_path / "lines.jsonl"
    words = ["bender-emulator", "--ports", "0,0,0,0", "--robots", "2", "--log", str(file)]
    command = [*COMMAND, *words, "--set", "line_end=crlf", "--set", "no_echo=inf"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        try:
            assert process.stdout
            addresses = json.loads(process.stdout.readline())
            line, state = asyncio.run(first_line_and_state(addresses))
            process.send_signal(signal.SIGINT)
            assert process.wait(10) == 130
        finally:
            process.kill()
    assert addresses["host"] == "127.0.0.1"
    assert [robot["name"] for robot in addresses["robots"]] == ["bender/0", "bender/1"]
    assert line.startswith("inf,inf,inf,inf,inf,")
    assert state["ok"]
    entries = [json.loads(line) for line in file.read_text().splitlines()]
    sent = [entry for entry in entries if entry["event"] == "sent"]
    assert {(entry["robot"], entry["port"]) for entry in sent} == {(1, "sonar")}


async def first_line_and_state(addresses: Any) -> tuple[str, Any]:
    sonar = await Client.to(addresses["robots"][1]["sonar"])
    state = await exchanged(await Client.to(addresses["control"]), '{"get": "state"}')
    return await sonar.line(), state


@pytest.mark.parametrize(
    ("arguments", "error"),
    [
        ("--ports 1,2", "--ports = '1,2': must be four port numbers"),
        ("--ports 1,2,3,x", "must be four port numbers"),
        ("--ports 0,0,0,65530 --robots 2", "must be four whole numbers from 0 to 65525"),
        ("--robots 0", "robots = 0: must be a whole number from 1 to 100"),
        ("--robots 9", "must be a list of at least 9 places"),
        ("--control 65536", "control = 65536: must be a whole number from 0 to 65535"),
        ("--set gps_herz=1 --set gain=3", "(?s)did you mean gps_hz.*--set gain = 3: must be"),
        ("--set gain=0 --set gain=1", "--set gain: occurs twice"),
        ("--set slip=0", "--set slip is not a setting: .*; gain replaced it"),
        ("--set gain", "must be NAME=VALUE"),
        ("--scenario search", "missing sonar_0 .*start from the bundled scenario bender"),
        ("--scenario classic", "missing sonar_0"),
        ("--scenario bendr", "did you mean bender"),
        ("--log no/such/folder", "the log cannot be written: No such file"),
        ("--host no.such.host.invalid", "cannot listen there"),
    ],
)
def test_a_bad_option_is_an_error_with_what_is_allowed(
    arguments: str, error: str, tmp_path: Path
) -> None:
    assert re.search(error, refuse("bender-emulator", *arguments.split(), cwd=tmp_path))


def test_every_setting_and_all_damage_is_in_the_documentation() -> None:
    page = PAGE.read_text(encoding="utf-8")
    defaults = Settings()
    for name, rule in rules().items():
        meaning = Settings.__dataclass_fields__[name].metadata["meaning"]
        default = json.dumps(getattr(defaults, name))
        assert f"| `{name}` | {meaning} | {rule.allowed} | `{default}` |" in page
    for name, fault in FAULTS.items():
        ports = ", ".join(fault.defaults)
        defaults_of = ", ".join(json.dumps(each) for each in dict.fromkeys(fault.defaults.values()))
        value = "no value" if fault.rule is NONE else f"{fault.rule.allowed}; default {defaults_of}"
        assert f"| `{name}` | {ports} | {fault.meaning} | {value} |" in page
