"""One page: its messages, and what it has been sent of the run that it displays.

One task receives messages and one sends; the task of the host that the page has joined carries
the messages out. A page begins with a host of its own, and joins the shared one of a live run.
"""

import asyncio
import contextlib
import time
from concurrent.futures import Executor
from typing import Any

from agent_economy._core import InputError
from agent_economy.build import Build, own_build
from agent_economy.scenario import validation
from agent_economy.server import messages
from agent_economy.server.recordings.saver import Saver
from agent_economy.server.recordings.store import RecordingStore
from agent_economy.server.runs.display import Display, Output
from agent_economy.server.runs.export import as_toml
from agent_economy.server.runs.host import RunHost
from agent_economy.server.runs.opening import open_timeline
from agent_economy.server.runs.run import Run
from agent_economy.server.runs.signals.sampling import Sampling
from agent_economy.server.transport import ConnectionClosedError, Page
from agent_economy.server.workspace import Workspace
from agent_economy.types import page
from agent_economy.types.page import PageMessage, ServerMessage
from agent_economy.whole_file import is_being_written

MAX_RECEIVED = 256
"""Messages that wait to be carried out; a page that sends more is not read until there is room."""

MAX_POSTED = 64
"""Answers that wait to be sent; until the page has taken some, its messages are not carried out."""

IDLE_S = 1800.0
"""A page whose run is paused is disconnected after this time without a message."""


class PageConnection:
    """The connection with one page."""

    def __init__(
        self,
        connection: Page,
        workspace: Workspace,
        threads: Executor,
        live: RunHost | None = None,
    ) -> None:
        """Begin without a run; `live` is the host of the server's live run."""
        self._page, self._workspace, self._live = connection, workspace, live
        self._received: asyncio.Queue[PageMessage | InputError] = asyncio.Queue(MAX_RECEIVED)
        self._posted: asyncio.Queue[Output] = asyncio.Queue()
        self._saver = Saver(self._send_later, RecordingStore(workspace), threads)
        self._own = self._host = RunHost(threads)
        self._display = Display()
        self._sampling = Sampling(threads, self.post, self._has_room)
        self._received_s = time.monotonic()
        # An `open` that the own host carries out before all other messages.
        self._opening: page.Open | None = None

    async def run(self) -> None:
        """Serve the page until it disconnects."""
        self._own.join(self)
        messages = self._receive(), self._send(), self._end_when_idle()
        work = *messages, self._own.drive(), self._sampling.drive()
        tasks = {asyncio.create_task(each) for each in work}
        try:
            await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
        finally:
            # Before anything is awaited: a cancellation of this task may end the next await.
            self._saver.cancel()
            self._host.leave(self)
            for task in tasks:
                task.cancel()
            await asyncio.wait(tasks)
            await self._saver.end()
        for task in tasks:
            with contextlib.suppress(ConnectionClosedError, asyncio.CancelledError):
                task.result()

    # The tasks.

    async def _receive(self) -> None:
        while True:
            text = await self._page.receive()
            self._received_s = time.monotonic()
            try:
                message: PageMessage | InputError = messages.read(text)
            except InputError as error:
                message = error
            await self._received.put(message)
            self._host.wake()

    async def _send(self) -> None:
        while True:
            output = await self._posted.get()
            if isinstance(output, bytes):
                await self._page.send_bytes(output)
            else:
                await self._page.send(output)
            self._host.wake()

    async def _end_when_idle(self) -> None:
        while (left_s := self._received_s + IDLE_S - time.monotonic()) > 0 or self._is_moving:
            await asyncio.sleep(max(left_s, 1.0))
        message = "The page was idle for half an hour. Reload it to continue."
        await self._page.send({"type": "ended", "reason": "idle", "message": message})
        raise ConnectionClosedError

    @property
    def _is_moving(self) -> bool:
        return self._host.player.is_moving

    # What the host calls.

    def has_messages(self) -> bool:
        """Return whether a message can be carried out now."""
        has_any = self._opening is not None or not self._received.empty()
        return has_any and self._has_room() and self._host.player.accepts_messages

    async def carry_out_messages(self, host: RunHost) -> None:
        """Carry out the messages that have arrived, as long as the page stays at the host."""
        while self._host is host and self.has_messages():
            opening, self._opening = self._opening, None
            await self._accept(opening or self._received.get_nowait())

    async def carry_out(self, message: PageMessage) -> None:
        """Carry out a message; if that is not allowed, refuse it."""
        try:
            await self._carry_out(message)
        except InputError as error:
            path = message.path if isinstance(message, page.Change) else None
            self.post(messages.refused(messages.type_of(message), error, path))
        else:
            # The page requests the series after each state: another state would follow without end.
            if not isinstance(message, page.RequestSeries | page.Chart):
                self._display.refresh()

    def post(self, message: ServerMessage) -> None:
        """Send a message when the page has room for it."""
        self._posted.put_nowait(message)

    def refresh(self) -> None:
        """Note that the page has not been sent the current moment."""
        self._display.refresh()

    def wait_s(self, host: RunHost, now_s: float) -> float | None:
        """Return the time until the page is due to be sent something; None if it is not."""
        if not host.has_run or not self._has_room():
            return None
        return self._display.wait_s(now_s, is_moving=host.player.is_moving)

    async def show(self, host: RunHost) -> None:
        """Send what is due."""
        now_s = time.monotonic()
        if self._host is not host or self.wait_s(host, now_s) != 0:
            return
        run, player = host.run, host.player
        outputs = await host.in_thread(lambda: self._display.outputs(run, player, now_s))
        for output in outputs:
            self._posted.put_nowait(output)

    def _has_room(self) -> bool:
        return self._posted.qsize() < MAX_POSTED

    # Messages.

    async def _accept(self, message: PageMessage | InputError) -> None:
        if isinstance(message, InputError):
            # An `open` that cannot be read is refused like one that cannot be opened.
            about = messages.errors_of(message)[0]["path"].partition(".")[0]
            self.post(messages.refused(about, message))
        elif isinstance(message, page.Acknowledge):
            self._display.acknowledge(message.frame)
        elif not self._host.player.defers(message):
            await self.carry_out(message)

    async def _carry_out(self, message: PageMessage) -> None:
        host = self._host
        match message:
            case page.Open():
                await self._open(message)
            case page.Save():
                self._saver.begin(host.run.history)
            case page.CancelSave():
                self._saver.cancel()
            case page.Export():
                text = await host.in_thread(lambda: as_toml(host.run.simulation))
                self.post({"type": "exported", "text": text})
            case page.RequestSeries(since=since):
                self.post(await host.in_thread(lambda: host.run.series.since(since)))
            case page.Select(robot=robot):
                self._display.select(robot)
            case page.Show():
                self._display.show(message)
            case page.Chart(signals=signals):
                self._sampling.select(signals)
            case _:
                await host.in_thread(lambda: host.player.handle(message, time.monotonic()))

    async def _open(self, message: page.Open) -> None:
        if message.live:
            self._join_live(message)
        elif self._host is not self._own:
            # The shared host would be delayed: the own one opens the run.
            self._opening = message
            self._move_to(self._own)
        else:
            timeline, build = await self._own.in_thread(
                lambda: open_timeline(self._workspace, message)
            )
            self._own.open(timeline, message.tick)
            self._show_opened(timeline, message, build)

    def _join_live(self, message: page.Open) -> None:
        validation.check(self._live is not None, "open.live", True, "of a server with a live run")  # noqa: FBT003
        assert self._live is not None  # noqa: S101  (checked above)
        self._own.close()
        self._move_to(self._live)
        self._show_opened(self._live.run, message, None)

    def _move_to(self, host: RunHost) -> None:
        self._host.leave(self)
        self._host = host
        host.join(self)

    def _show_opened(self, run: Run, message: page.Open, build: Build | None) -> None:
        self._display.open(run)
        self._sampling.open(run)
        self.post(opened(run, message, build, self._workspace))

    async def _send_later(self, message: ServerMessage) -> None:
        self.post(message)


def opened(run: Run, message: page.Open, build: Build | None, workspace: Workspace) -> page.Opened:
    """Return the message that a run is open; `build` is the one that recorded it."""
    simulation = run.simulation
    scenario = simulation.scenario
    engine: Any = scenario.engine
    recording: Any = None
    if build is not None:
        own = str(own_build())
        recording = {
            "id": message.recording,
            "recorded_by": str(build),
            "replayed_by": own,
            "is_being_written": is_being_written(workspace.folder / str(message.recording)),
        }
    return {
        "type": "opened",
        "scenario": {
            "id": message.scenario,
            "name": scenario.name,
            "engine": engine,
            "summary": scenario.summary,
            "time_limit_s": scenario.time_limit_s,
        },
        "seed": str(simulation.seed),
        "run": str(simulation.run),
        "recording": recording,
        "is_live": message.live,
    }
