"""The command `ui`: hosts on which it cannot listen, and the address that it prints."""

import os
import socket
from ipaddress import ip_address

import pytest
import typer
from command_line import refuse

from agent_economy.cli import ui

ANY = {socket.AF_INET: "0.0.0.0", socket.AF_INET6: "::"}  # noqa: S104  (what users type)


@pytest.mark.parametrize(
    "host",
    ["127..0.0.1", ".local", "x" * 64, "a\0b", "größe.invalid", "x y", ""],
)
def test_a_host_that_cannot_be_listened_on_is_named(host: str) -> None:
    errors = refuse("ui", "--no-browser", "--host", host)
    assert "--port 8765: cannot listen there: " in errors
    assert errors.endswith("; choose another\n")


def test_a_name_that_is_not_utf_8_is_no_host() -> None:
    with pytest.raises(typer.Exit):
        ui.bound(os.fsdecode(b"caf\xe9"), 0)


@pytest.mark.parametrize("family", [socket.AF_INET, socket.AF_INET6])
def test_all_addresses_are_printed_as_one_that_other_machines_can_open(
    family: socket.AddressFamily, monkeypatch: pytest.MonkeyPatch
) -> None:
    try:
        listening = ui.bound(ANY[family], 0)
    except typer.Exit:
        pytest.skip("this machine has no IPv6")
    with listening:
        assert not ip_address(ui.reachable(ANY[family], listening)).is_unspecified
        own = {socket.AF_INET: ["192.0.2.7"], socket.AF_INET6: []}
        monkeypatch.setattr(ui, "own_address", own.get)
        assert ui.reachable(ANY[family], listening) == "192.0.2.7"
        own[family] = []
        own[socket.AF_INET] = []
        assert ui.reachable(ANY[family], listening) == "127.0.0.1"


def test_a_host_that_is_named_is_printed_as_it_is() -> None:
    with ui.bound("localhost", 0) as listening:
        assert ui.reachable("localhost", listening) == "localhost"
