"""The command `ui`."""

import secrets
import socket
import webbrowser
from contextlib import suppress
from pathlib import Path
from typing import Annotated

import typer
import uvicorn

from agent_economy.cli.told import BAD_INPUT, faults_told
from agent_economy.server import Workspace, app
from agent_economy.server.guard import is_loopback
from agent_economy.server.request_body import MAX_BYTES


def ui(
    *,
    host: Annotated[str, typer.Option(help="Name or address to listen at.")] = "127.0.0.1",
    port: Annotated[int, typer.Option(min=0, max=65535, help="0 for any that is free.")] = 8765,
    no_browser: Annotated[
        bool, typer.Option("--no-browser", help="Only print the page's address.")
    ] = False,
) -> None:
    """Open a page on which runs are seen, and changed while they run.

    It serves this machine only, unless told otherwise by --host: then pages need the token in the
    address that it prints. Scenarios are those that ship, and those in and below this folder.
    Ctrl-C ends it. Exit codes: 0 ended, 2 something given is not allowed.

    Example: agent-economy ui --no-browser
    """
    with faults_told():
        listening = bound(host, port)
        token = None if is_loopback(host) else secrets.token_urlsafe(24)
        address = address_of(host, listening.getsockname()[1], token)
        typer.echo(f"Agent Economy is at {address}   (Ctrl-C ends it)")
        if not no_browser:
            webbrowser.open(address)
        served = app(Workspace(Path.cwd()), host, token)
        config = uvicorn.Config(
            served,
            log_level="warning",
            ws="websockets-sansio",
            ws_max_size=MAX_BYTES,
            # Frames are floats, which pack badly: of 10,000 robots it took 7 ms each.
            ws_per_message_deflate=False,
            lifespan="on",
        )
        with suppress(KeyboardInterrupt):
            uvicorn.Server(config).run(sockets=[listening])


def bound(host: str, port: int) -> socket.socket:
    """Return a socket that listens; end the program if it cannot."""
    try:
        family, kind, protocol, _, address = socket.getaddrinfo(
            host, port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE
        )[0]
        listening = socket.socket(family, kind, protocol)
        listening.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listening.bind(address)
        # From now on who comes waits: the address is told before the server has begun.
        listening.listen()
    except OSError as error:
        typer.echo(
            f"--host {host} --port {port}: cannot be listened at: {error.strerror}; give another",
            err=True,
        )
        raise typer.Exit(BAD_INPUT) from None
    return listening


def address_of(host: str, port: int, token: str | None) -> str:
    """Return the address of the page."""
    name = f"[{host}]" if ":" in host else host
    query = f"?token={token}" if token else ""
    return f"http://{name}:{port}/{query}"
