"""Links to robots that are slow to find, unreachable or half open: no robot delays another."""

import asyncio
import gc
import socket
import time
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest
from bare_timer import repeated_if_late
from live_bench import driving, emulated, fleet_text
from wire_faults import lanes

from agent_economy.live.clock import now_s
from agent_economy.live.emulator import packet_loss
from agent_economy.live.locks import AddressLocks, LockedError
from agent_economy.live.warden import port_link
from agent_economy.live.warden.connection import Connection, Share
from agent_economy.live.warden.name_lookup import NameLookup
from agent_economy.live.warden.port_link import PortLink


def link_to(host: str, port: int, lookup: NameLookup, lines: list[bytes]) -> PortLink:
    return PortLink((host, port), lookup, lambda: Connection(lines.append, Share()), lambda: None)


@pytest.fixture
def lookups(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Make the lookup of some names slow, and return all that are looked up."""
    found: list[str] = []
    ordinary = socket.getaddrinfo

    def slow(host: Any, *arguments: Any, **options: Any) -> Any:
        found.append(str(host))
        if host == "slow.invalid":
            time.sleep(1.0)
            raise socket.gaierror(socket.EAI_NONAME, "Name or service not known")
        return ordinary(host, *arguments, **options)

    monkeypatch.setattr(socket, "getaddrinfo", slow)
    return found


def test_a_slow_name_is_looked_up_once_for_all_ports_and_delays_no_other_robot(
    lookups: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(port_link, "CONNECT_TIMEOUT_S", 0.3)

    async def connect() -> tuple[float, list[PortLink]]:
        server = await asyncio.start_server(lambda _, writer: writer.write(b"1\n"), "127.0.0.1", 0)
        port = server.sockets[0].getsockname()[1]
        slow, lines = NameLookup("slow.invalid"), list[bytes]()
        links = [link_to("slow.invalid", port, slow, lines) for _ in range(4)]
        good = link_to("localhost", port, NameLookup("localhost"), lines)
        began_s = now_s()
        tasks = [asyncio.create_task(each.run()) for each in (*links, good)]
        while not lines:
            await asyncio.sleep(0.01)
        connected_s = now_s() - began_s
        await asyncio.sleep(0.8)
        reasons = [each.connection.reason for each in links]
        assert all("lookup of the name of slow.invalid" in reason for reason in reasons)
        await asyncio.sleep(0.35)
        for task in tasks:
            task.cancel()
        server.close()
        return connected_s, links

    connected_s, links = asyncio.run(connect())
    assert connected_s < 0.9
    assert lookups.count("slow.invalid") <= 2
    assert any("Name or service not known" in each.connection.reason for each in links)


def test_a_motor_port_that_another_program_has_locked_is_not_connected_until_it_is_free() -> None:
    accepted: list[Any] = []

    async def connect() -> tuple[str, int]:
        server = await asyncio.start_server(lambda *each: accepted.append(each), "127.0.0.1", 0)
        port = server.sockets[0].getsockname()[1]
        others, own = AddressLocks(), AddressLocks()
        others.take([("127.0.0.1", port)])
        # By a name: at the start of the drive, its address may have been unknown or another one.
        link = PortLink(
            ("localhost", port),
            NameLookup("localhost"),
            lambda: Connection(lambda _: None, Share()),
            lambda: None,
            own,
        )
        task = asyncio.create_task(link.run())
        await asyncio.sleep(0.5)
        reason, connections = link.connection.reason, len(accepted)
        assert not link.connection.is_up
        others.close()
        while not link.connection.is_up:
            await asyncio.sleep(0.01)
        with pytest.raises(LockedError):
            others.take([("127.0.0.1", port)])
        task.cancel()
        own.close()
        server.close()
        return reason, connections

    reason, connections = asyncio.run(asyncio.wait_for(connect(), 10))
    assert "is being driven by another" in reason
    assert connections == 0


def test_a_host_that_refuses_is_tried_again_with_growing_pauses_up_to_a_limit(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    pauses_s: list[float] = []

    async def refuse(*_: Any) -> None:
        raise ConnectionRefusedError(111, "Connect call failed ('127.0.0.1', 9)")

    async def pause(duration_s: float) -> None:
        pauses_s.append(duration_s)
        if len(pauses_s) == 10:
            raise asyncio.CancelledError

    async def connect() -> PortLink:
        monkeypatch.setattr(asyncio.get_running_loop(), "create_connection", refuse)
        monkeypatch.setattr("agent_economy.live.warden.port_link.asyncio.sleep", pause)
        link = link_to("127.0.0.1", 9, NameLookup("127.0.0.1"), [])
        with suppress(asyncio.CancelledError):
            await link.run()
        return link

    link = asyncio.run(connect())
    assert link.connection.reason == "127.0.0.1:9: Connection refused"
    assert pauses_s == pytest.approx([0.05, 0.1, 0.2, *[0.4] * 7])


@pytest.mark.skipif(not packet_loss.IS_SUPPORTED, reason="packets are dropped on Linux only")
@pytest.mark.parametrize("outage_s", [2.2, 2.7, 3.5])
@repeated_if_late
def test_a_half_open_motor_link_is_stopped_soon_after_its_return(
    tmp_path: Path, outage_s: float
) -> None:
    scenario, fleet = lanes(tmp_path, 1), tmp_path / "fleet.toml"
    with emulated(tmp_path, 1, arguments=("--scenario", str(scenario))) as bench:
        fleet.write_text(fleet_text(bench, scenario=str(scenario)), encoding="utf-8")
        with driving(fleet) as drive:
            bench.wait_for_motion(1)
            bench.fault(0, "motors", "cut")
            time.sleep(outage_s)
            returned_s = bench.fault(0, "motors", "cut", on=False)
            drive.wait_for_fault("bender/0", "lost_link")
            time.sleep(4.0)
            stops_s = bench.stops_after(0, returned_s)
            assert stops_s[0] - returned_s < 0.5
            # A motion that was queued during the outage never arrives behind the stop.
            assert bench.moves_after(0, stops_s[0]) == []


def test_a_silent_connection_is_kept_until_another_one_is_established() -> None:
    async def connect() -> tuple[bool, bool, int]:
        accepted: list[asyncio.StreamWriter] = []
        server = await asyncio.start_server(
            lambda _, writer: accepted.append(writer), "127.0.0.1", 0
        )
        port = server.sockets[0].getsockname()[1]
        link = link_to("127.0.0.1", port, NameLookup("127.0.0.1"), [])
        task = asyncio.create_task(link.run())
        while not link.connection.is_up:
            await asyncio.sleep(0.01)
        old = link.connection
        old.lost.set()  # as if nothing were acknowledged
        was_up = old.is_up
        while link.connection is old:
            await asyncio.sleep(0.01)
        await asyncio.sleep(0.1)
        task.cancel()
        server.close()
        return was_up, old.is_up, len(accepted)

    assert asyncio.run(connect()) == (True, False, 2)


def test_attempts_that_fail_together_leave_no_error_behind(monkeypatch: pytest.MonkeyPatch) -> None:
    """As those to a robot that is off, when no machine has its hardware address."""
    errors: list[Any] = []

    async def fail(*_: Any) -> None:
        await asyncio.sleep(0.35)
        raise OSError(113, "No route to host")

    async def connect() -> str:
        loop = asyncio.get_running_loop()
        loop.set_exception_handler(lambda _, context: errors.append(context))
        monkeypatch.setattr(loop, "create_connection", fail)
        monkeypatch.setattr(port_link, "ATTEMPT_S", 0.05)
        link = link_to("127.0.0.1", 9, NameLookup("127.0.0.1"), [])
        task = asyncio.create_task(link.run())
        await asyncio.sleep(1.0)
        task.cancel()
        await asyncio.sleep(0.1)
        return link.connection.reason

    reason = asyncio.run(connect())
    gc.collect()
    assert reason == "127.0.0.1:9: No route to host"
    assert errors == []


def test_a_robot_that_takes_one_connection_only_is_connected_again_when_it_refuses() -> None:
    async def connect() -> list[str]:
        events: list[str] = []
        server: asyncio.Server

        async def serve(reader: asyncio.StreamReader, _: asyncio.StreamWriter) -> None:
            events.append("accepted")
            server.close()  # while it has a client, it refuses others
            with suppress(OSError):
                await reader.read()
            events.append("ended")
            await listen(port)

        async def listen(number: int) -> int:
            nonlocal server
            server = await asyncio.start_server(serve, "127.0.0.1", number)
            return int(server.sockets[0].getsockname()[1])

        port = await listen(0)
        link = link_to("127.0.0.1", port, NameLookup("127.0.0.1"), [])
        task = asyncio.create_task(link.run())
        while not link.connection.is_up:
            await asyncio.sleep(0.01)
        old = link.connection
        old.lost.set()  # as if nothing were acknowledged
        async with asyncio.timeout(2):
            while link.connection is old:
                await asyncio.sleep(0.01)
        await asyncio.sleep(0.05)
        task.cancel()
        server.close()
        return events

    assert asyncio.run(connect())[:3] == ["accepted", "ended", "accepted"]


def test_a_slow_link_that_acknowledges_each_line_is_not_lost() -> None:
    outstanding = 0
    connection = Connection(lambda _: None, Share())
    connection._outstanding = lambda: outstanding  # type: ignore[method-assign]
    connection._transport, connection.is_up = Writer(), True  # type: ignore[assignment]
    for turn in range(100):
        now = 0.1 * turn
        connection.write(b"x,3,\n", now)
        outstanding = 10  # the last two lines are under way
        assert connection.unacknowledged_s(now + 0.05) < 0.3
    for turn in range(4):
        silent_s = connection.unacknowledged_s(10.0 + 0.1 * turn)
    assert silent_s > 0.25


class Writer:
    """A transport that takes everything."""

    def write(self, data: bytes) -> None:
        """Take it."""
