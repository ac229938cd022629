"""The command `ui`."""

import os
import secrets
import socket
import webbrowser
from contextlib import suppress
from ipaddress import ip_address
from pathlib import Path
from typing import Annotated

import typer

from agent_economy._core import InputError
from agent_economy.built_page import missing_page
from agent_economy.cli.errors import BAD_INPUT, FAILED, error_exits, print_stopped
from agent_economy.listening import listening_socket
from agent_economy.server import Workspace, app
from agent_economy.server.guard import is_loopback
from agent_economy.server.serving import http_server

ELSEWHERE = {socket.AF_INET: "192.0.2.1", socket.AF_INET6: "2001:db8::1"}
"""An address of another network by family (RFC 5737, RFC 3849)."""


def ui(
    *,
    host: Annotated[str, typer.Option(help="Host name or address to listen on.")] = "127.0.0.1",
    port: Annotated[
        int, typer.Option(min=0, max=65535, help="Port to listen on; 0 for any free port.")
    ] = 8765,
    no_browser: Annotated[
        bool, typer.Option("--no-browser", help="Print the address without opening a browser.")
    ] = False,
) -> None:
    """Open the browser interface, to watch and change runs and to start studies.

    By default it serves this machine only. With another --host, pages need the token in the
    printed address. It offers the bundled scenarios and those in and below the current folder.
    Press Ctrl-C to stop; running studies are interrupted, and keep their runs.

    Exit codes: 0 stopped; 1 the page has not been built; 2 an argument is invalid.

    Example: agent-economy ui --no-browser
    """
    with error_exits():
        check_page()
        listening = bound(host, port)
        token = None if is_loopback(host) else secrets.token_urlsafe(24)
        address = address_of(reachable(host, listening), listening.getsockname()[1], token)
        with suppress(KeyboardInterrupt):
            typer.echo(f"Agent Economy is at {address}   (Ctrl-C stops it)")
            if not no_browser:
                webbrowser.open(address)
            served = app(Workspace(Path.cwd()), host, token)
            http_server(served, stop_at_once).run(sockets=[listening])
        print_stopped()


def check_page() -> None:
    """Exit with a code and the command that builds the page, if it has not been built."""
    missing = missing_page()
    if missing is not None:
        typer.echo(missing, err=True)
        raise typer.Exit(FAILED)


def stop_at_once() -> None:
    """End the process, whatever its threads do; studies end by themselves then."""
    print_stopped()
    os._exit(0)


def bound(host: str, port: int) -> socket.socket:
    """Return a listening socket; exit with a code if the address cannot be used."""
    try:
        return listening_socket(host, port)
    except InputError as error:
        typer.echo(f"--host {host} --port {port}: {error}", err=True)
        raise typer.Exit(BAD_INPUT) from None


def reachable(host: str, listening: socket.socket) -> str:
    """Return a host that other machines can open: an address if all of them are listened on."""
    if not ip_address(listening.getsockname()[0].partition("%")[0]).is_unspecified:
        return host
    families = [listening.family, socket.AF_INET]
    found = [address for family in families for address in own_address(family)]
    return found[0] if found else "127.0.0.1"


def own_address(family: socket.AddressFamily) -> list[str]:
    """Return the address from which this machine reaches others; empty without a network."""
    with suppress(OSError), socket.socket(family, socket.SOCK_DGRAM) as probe:
        # This sends nothing: it selects a route to an address of documentation.
        probe.connect((ELSEWHERE[family], 9))
        return [str(probe.getsockname()[0])]
    return []


def address_of(host: str, port: int, token: str | None) -> str:
    """Return the address of the page."""
    name = f"[{host}]" if ":" in host else host
    query = f"?token={token}" if token else ""
    return f"http://{name}:{port}/{query}"
