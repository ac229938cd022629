"""The command `ui`: hosts on which it cannot listen, and the address that it prints."""

import os
import shlex
import socket
from ipaddress import ip_address
from pathlib import Path

import pytest
import typer
from command_line import refuse

from agent_economy.built_page import PAGE, missing_page
from agent_economy.cli import drive, ui

ANY = {socket.AF_INET: "0.0.0.0", socket.AF_INET6: "::"}  # noqa: S104  (what users type)


@pytest.fixture(autouse=True)
def _page(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let the page be built, as far as the command knows."""
    monkeypatch.setattr(ui, "missing_page", lambda: None)


def clone_without_page(folder: Path) -> Path:
    """Return where the page would be in a clone with an unusual name."""
    clone = folder / "my clone"
    (clone / "web").mkdir(parents=True)
    (clone / "web" / "package.json").touch()
    return clone / "python" / "agent_economy" / "web"


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


def test_without_a_page_ui_prints_the_command_that_builds_it_and_listens_nowhere(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    page = clone_without_page(tmp_path)
    monkeypatch.setattr(ui, "missing_page", lambda: missing_page(page))
    monkeypatch.setattr(ui, "bound", pytest.fail)
    printed = refuse("ui", "--no-browser", code=1)
    assert printed.startswith(f"the page has not been built: {page / 'index.html'} is missing; ")
    command = shlex.split(printed.rpartition(": ")[2])
    assert command == ["make", "-C", str(tmp_path / "my clone"), "web"]


def test_without_a_page_an_installed_package_is_to_be_installed_again(tmp_path: Path) -> None:
    message = missing_page(tmp_path / "agent_economy" / "web")
    assert message is not None
    assert message.endswith("pip install --force-reinstall agent-economy")


def test_a_built_page_is_not_missing(tmp_path: Path) -> None:
    (tmp_path / "index.html").touch()
    assert missing_page(tmp_path) is None
    assert PAGE.parent.name == "agent_economy"


@pytest.mark.parametrize("options", [[], ["--json"]])
def test_without_a_page_a_drive_reports_it_unless_it_is_headless(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, options: list[str]
) -> None:
    page, printed = clone_without_page(tmp_path), list[str]()
    monkeypatch.setattr(drive, "missing_page", lambda: missing_page(page))
    monkeypatch.setattr(drive, "write", lambda _, line: printed.append(line))
    refuse("drive", tmp_path / "none.toml", *options)
    assert "the page has not been built" in printed[0]
    printed.clear()
    refuse("drive", tmp_path / "none.toml", "--headless", "--arm", *options)
    assert "has not been built" not in printed[0]
