"""The addresses of the server.

GET `/api/scenarios`: the gallery. `/api/pictures?scenario=`: a thumbnail, SVG.
POST `/api/check`: a scenario's text; its errors are the response, with status 422.
GET `/api/recordings`: the recordings below the server's folder, the newest first.
`/api/recordings/file?id=`: the file of one.
`/drive`: where the page finds the warden of the server's drive, and what its map draws. Without a
drive it is `null`, not an error: browsers report errors of requests in the console of every page.
`/ws`: a run (see `agent_economy.types.page`), or the progress of a study with `?study=ID`.
The addresses of studies are in `studies.routes`; those of titles, notes, tags, copies and deletions
are in `library.routes`.
"""

import asyncio
import contextlib
from collections.abc import AsyncIterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from html import escape
from pathlib import Path

from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import (
    FileResponse,
    HTMLResponse,
    JSONResponse,
    PlainTextResponse,
    Response,
)
from starlette.routing import Mount, Route, WebSocketRoute
from starlette.types import ASGIApp
from starlette.websockets import WebSocket

from agent_economy._core import InputError
from agent_economy.built_page import PAGE, missing_page
from agent_economy.server.gallery import grouped
from agent_economy.server.guard import REFUSAL, TOKEN_NAME, Guard, is_same
from agent_economy.server.library.library import Library
from agent_economy.server.library.routes import LibraryRoutes
from agent_economy.server.recordings.store import RecordingStore
from agent_economy.server.request_body import RequestBodyError, error_response, text
from agent_economy.server.runs.connection import PageConnection
from agent_economy.server.runs.host import RunHost
from agent_economy.server.runs.live_run import LiveRun
from agent_economy.server.runs.thumbnail import thumbnail
from agent_economy.server.studies.manager import StudyManager
from agent_economy.server.studies.progress import send_progress
from agent_economy.server.studies.routes import Routes
from agent_economy.server.transfer import COMPRESSED, REVALIDATE, PageFiles
from agent_economy.server.transport import Connection, ConnectionClosedError
from agent_economy.server.workspace import Workspace
from agent_economy.types.warden import Drive

MAX_SESSIONS = 16
"""Maximum number of open runs; each has a thread of its own, so that none delays another."""

MAX_WATCHERS = 64
"""Maximum number of pages that follow studies; each reads its study's folder regularly."""

NOT_BUILT = """<!doctype html><html lang="en"><meta charset="utf-8"><title>Agent Economy</title>
<p>{}; then reload this page.</p></html>"""


def app(
    workspace: Workspace,
    host: str,
    token: str | None = None,
    live: LiveRun | None = None,
    drive: Drive | None = None,
) -> ASGIApp:
    """Return the application.

    Args:
        workspace: The folder of scenarios, studies and recordings.
        host: The host name or address that the server is bound to.
        token: The token that requests need; None if they need none, as those of this machine do
            unless there is a drive.
        live: The run of real robots that pages can join; it is simulated while the server runs.
        drive: The drive that it belongs to; None if there is none.

    Raises:
        ValueError: If there is a drive but no token: other users of this machine could drive it.
    """
    if drive is not None and token is None:
        message = "the page of a drive needs a token"
        raise ValueError(message)
    addresses = Addresses(workspace, PAGE, StudyManager(workspace), token or "", live, drive)
    warden = None if drive is None else f"http://127.0.0.1:{drive['warden']['port']}"
    return Guard(addresses.application(), host, token, warden)


@dataclass
class Addresses:
    """What all requests share."""

    workspace: Workspace
    web: Path
    studies: StudyManager
    token: str
    live: LiveRun | None = None
    drive: Drive | None = None
    live_host: RunHost | None = None
    sessions: int = 0
    watchers: int = 0

    def application(self) -> Starlette:
        """Return the application without its guard."""
        routes = [
            Route("/", self.page),
            Route("/drive", self.current_drive),
            Route("/api/scenarios", self.scenarios, middleware=COMPRESSED),
            Route("/api/pictures", self.picture, middleware=COMPRESSED),
            Route("/api/recordings", self.recordings, middleware=COMPRESSED),
            Route("/api/recordings/file", self.recording),
            Route("/api/check", self.check, methods=["POST"]),
            *Routes(self.studies, self.workspace).all(),
            *LibraryRoutes(Library(self.workspace)).all(),
            WebSocketRoute("/ws", self.connect),
            Mount("/", PageFiles(directory=self.web, check_dir=False)),
        ]
        return Starlette(routes=routes, lifespan=self.lifespan)

    @contextlib.asynccontextmanager
    async def lifespan(self, _: Starlette) -> AsyncIterator[None]:
        """Provide threads, two for each run: one saves it; stop all studies at the end."""
        with ThreadPoolExecutor(2 * MAX_SESSIONS, "run") as self.threads:
            try:
                async with self.live_run_driven():
                    yield
            finally:
                await asyncio.to_thread(self.studies.close)

    @contextlib.asynccontextmanager
    async def live_run_driven(self) -> AsyncIterator[None]:
        """Simulate the live run as its inputs arrive, if there is one."""
        if self.live is None:
            yield
            return
        loop, host = asyncio.get_running_loop(), RunHost(self.threads)
        host.follow(self.live)

        def wake() -> None:
            loop.call_soon_threadsafe(host.wake)

        self.live.notify(wake)
        task = asyncio.create_task(host.drive())
        self.live_host = host
        try:
            yield
        finally:
            self.live.notify(None)
            task.cancel()
            await asyncio.wait({task})

    async def page(self, _: Request) -> Response:
        """Return the page."""
        missing = missing_page(self.web)
        if missing is not None:
            return HTMLResponse(NOT_BUILT.format(escape(missing)), 503)
        return FileResponse(self.web / "index.html", headers={"cache-control": REVALIDATE})

    async def current_drive(self, request: Request) -> Response:
        """Return the drive; the cookie is not enough, because servers on other ports get it too."""
        given = request.headers.get(TOKEN_NAME, request.query_params.get("token", ""))
        if self.drive is not None and not is_same(given, self.token):
            return PlainTextResponse(REFUSAL, 403)
        return JSONResponse(self.drive, headers={"cache-control": "no-store"})

    async def scenarios(self, _: Request) -> Response:
        """Return the gallery."""
        return JSONResponse(grouped(await asyncio.to_thread(self.workspace.listed)))

    async def picture(self, request: Request) -> Response:
        """Return the thumbnail of a scenario, as SVG."""
        name = request.query_params.get("scenario", "")
        try:
            svg = await asyncio.to_thread(lambda: thumbnail(self.workspace.load(name)))
        except InputError as error:
            return error_response(error, 404)
        return Response(svg, media_type="image/svg+xml")

    async def recordings(self, _: Request) -> Response:
        """Return the recordings."""
        return JSONResponse(await asyncio.to_thread(RecordingStore(self.workspace).listed))

    async def recording(self, request: Request) -> Response:
        """Return the file of a recording."""
        name = request.query_params.get("id", "")
        try:
            file = RecordingStore(self.workspace).find(name)
        except InputError as error:
            return error_response(error, 404)
        return FileResponse(file, media_type="application/octet-stream", filename=file.name)

    async def check(self, request: Request) -> Response:
        """Return what a scenario's text describes, or its errors."""
        try:
            body = await text(request)
            scenario = await asyncio.to_thread(lambda: self.workspace.read(body))
        except RequestBodyError as error:
            return error.response
        except InputError as error:
            return error_response(error)
        checked = {"name": scenario.name, "engine": scenario.engine, "summary": scenario.summary}
        return JSONResponse(checked)

    async def connect(self, socket: WebSocket) -> None:
        """Serve a page that follows a run or a study."""
        await socket.accept()
        page = Connection(socket)
        name = socket.query_params.get("study")
        await (self.follow_run(page) if name is None else self.follow_study(page, name))

    async def follow_run(self, page: Connection) -> None:
        """Serve a page that follows a run."""
        if self.sessions >= MAX_SESSIONS:
            await reject(page, f"{MAX_SESSIONS} runs")
            return
        self.sessions += 1
        try:
            await PageConnection(page, self.workspace, self.threads, self.live_host).run()
        finally:
            self.sessions -= 1
        await page.close()

    async def follow_study(self, page: Connection, name: str) -> None:
        """Serve a page that follows a study."""
        if self.watchers >= MAX_WATCHERS:
            await reject(page, f"{MAX_WATCHERS} pages of studies")
            return
        self.watchers += 1
        try:
            await send_progress(page, self.studies, name)
        finally:
            self.watchers -= 1
        await page.close()


async def reject(page: Connection, limit: str) -> None:
    """Disconnect a page because the server is full."""
    message = f"This server has {limit} open, which is its maximum. Close one."
    with contextlib.suppress(ConnectionClosedError):
        await page.send({"type": "ended", "reason": "full", "message": message})
    await page.close(1013)
