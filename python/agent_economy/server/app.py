"""What can be asked of the server, by address."""

import asyncio
import contextlib
from collections.abc import AsyncIterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path

from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import FileResponse, HTMLResponse, JSONResponse, Response
from starlette.routing import Mount, Route, WebSocketRoute
from starlette.staticfiles import StaticFiles
from starlette.types import ASGIApp
from starlette.websockets import WebSocket

from agent_economy import _core
from agent_economy._core import InputError
from agent_economy.server.guard import Guard
from agent_economy.server.messages import faults_of
from agent_economy.server.recordings.store import RecordingStore
from agent_economy.server.request_body import RequestBodyError, refused, text
from agent_economy.server.runs.engines import ENGINES
from agent_economy.server.runs.session import Session
from agent_economy.server.runs.thumbnail import thumbnail
from agent_economy.server.studies.factors import schema
from agent_economy.server.studies.manager import StudyManager
from agent_economy.server.studies.progress import watch
from agent_economy.server.studies.routes import Routes
from agent_economy.server.transport import Connection, ConnectionClosedError
from agent_economy.server.workspace import Workspace

MAX_SESSIONS = 16
"""Runs at a time; each has a thread of its own, so that none waits for another's."""

MAX_WATCHERS = 64
"""Pages at a time that watch studies; each reads its study's folder now and then."""

NOT_BUILT = """<!doctype html><meta charset="utf-8"><title>Agent Economy</title>
<p>The page has not been built. In a clone: <code>make web</code>, then reload this page.</p>"""


def app(places: Workspace, host: str, token: str | None = None) -> ASGIApp:
    """Return the application.

    Args:
        places: Where scenarios are.
        host: The name or address that is bound.
        token: What pages on other machines must show; None if only this machine can reach it.
    """
    web = Path(str(files("agent_economy") / "web"))
    return Guard(Server(places, web, StudyManager(places)).routed(), host, token)


@dataclass
class Server:
    """What all requests have in common."""

    places: Workspace
    web: Path
    studies: StudyManager
    sessions: int = 0
    watchers: int = 0

    def routed(self) -> Starlette:
        """Return the application without its guard."""
        routes = [
            Route("/", self.page),
            Route("/api/scenarios", self.scenarios),
            Route("/api/pictures", self.pictures),
            Route("/api/recordings", self.recordings),
            Route("/api/recordings/file", self.recording),
            Route("/api/schema", self.schema),
            Route("/api/check", self.check, methods=["POST"]),
            *Routes(self.studies, self.places).all(),
            WebSocketRoute("/ws", self.speak),
        ]
        if self.web.is_dir():
            routes.append(Mount("/", StaticFiles(directory=self.web)))
        return Starlette(routes=routes, lifespan=self.lifespan)

    @contextlib.asynccontextmanager
    async def lifespan(self, _: Starlette) -> AsyncIterator[None]:
        """Have threads for as many runs as there may be, and to save each; end studies at last."""
        with ThreadPoolExecutor(2 * MAX_SESSIONS, "run") as self.threads:
            try:
                yield
            finally:
                await asyncio.to_thread(self.studies.close)

    async def page(self, _: Request) -> Response:
        """Return the page."""
        index = self.web / "index.html"
        if not index.is_file():
            return HTMLResponse(NOT_BUILT, 503)
        return FileResponse(index, headers={"cache-control": "no-cache"})

    async def scenarios(self, _: Request) -> Response:
        """Return the gallery."""
        return JSONResponse(await asyncio.to_thread(self.places.listed))

    async def pictures(self, request: Request) -> Response:
        """Return the picture of a scenario, as SVG."""
        name = request.query_params.get("scenario", "")
        try:
            svg = await asyncio.to_thread(lambda: thumbnail(self.places.load(name)))
        except InputError as error:
            return refused(faults_of(error), 404)
        return Response(svg, media_type="image/svg+xml")

    async def recordings(self, _: Request) -> Response:
        """Return the recordings."""
        return JSONResponse(await asyncio.to_thread(RecordingStore(self.places).listed))

    async def recording(self, request: Request) -> Response:
        """Return a recording's file."""
        name = request.query_params.get("id", "")
        try:
            file = RecordingStore(self.places).find(name)
        except InputError as error:
            return refused(faults_of(error), 404)
        return FileResponse(file, media_type="application/octet-stream", filename=file.name)

    async def schema(self, request: Request) -> Response:
        """Return the schema of an engine's scenarios."""
        engine = request.query_params.get("engine", "metric")
        if engine not in ENGINES:
            known = f"one of {', '.join(ENGINES)}"
            return refused(faults_of(_core.refusal("engine", engine, known)), 404)
        return JSONResponse(schema(engine), media_type="application/schema+json")

    async def check(self, request: Request) -> Response:
        """Say what is wrong with a scenario."""
        try:
            given = await text(request)
            scenario = await asyncio.to_thread(lambda: self.places.read(given))
        except RequestBodyError as error:
            return error.response
        except InputError as error:
            return refused(faults_of(error))
        about = {"name": scenario.name, "engine": scenario.engine, "summary": scenario.summary}
        return JSONResponse(about)

    async def speak(self, socket: WebSocket) -> None:
        """Serve a page."""
        await socket.accept()
        page = Connection(socket)
        name = socket.query_params.get("study")
        await (self.run(page) if name is None else self.race(page, name))

    async def run(self, page: Connection) -> None:
        """Serve a page that watches a run."""
        if self.sessions >= MAX_SESSIONS:
            await turn_away(page, f"{MAX_SESSIONS} runs")
            return
        self.sessions += 1
        try:
            await Session(page, self.places, self.threads).run()
        finally:
            self.sessions -= 1
        await page.close()

    async def race(self, page: Connection, name: str) -> None:
        """Serve a page that watches a study."""
        if self.watchers >= MAX_WATCHERS:
            await turn_away(page, f"{MAX_WATCHERS} pages of studies")
            return
        self.watchers += 1
        try:
            await watch(page, self.studies, name)
        finally:
            self.watchers -= 1
        await page.close()


async def turn_away(page: Connection, held: str) -> None:
    """Say that no more can be served."""
    message = f"This server has {held} open, which is all it may. Close one."
    with contextlib.suppress(ConnectionClosedError):
        await page.send({"type": "ended", "why": "full", "message": message})
    await page.close(1013)
