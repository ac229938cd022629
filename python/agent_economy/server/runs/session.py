"""One page and its run: messages of the page are carried out, and the page is sent what changes.

One task receives messages and one drives the player. Only the second uses the run: it carries out
the messages, advances the run in a thread for a short time, and sends what is due. So a slow page
gets fewer frames and costs no memory, and no run delays another.
"""

import asyncio
import contextlib
import time
from collections.abc import Callable
from concurrent.futures import Executor
from typing import Any, TypeVar

from agent_economy._core import InputError
from agent_economy.build import Build, own_build
from agent_economy.server import messages
from agent_economy.server.recordings.saver import Saver
from agent_economy.server.recordings.store import RecordingStore
from agent_economy.server.runs.display import Display
from agent_economy.server.runs.export import as_toml
from agent_economy.server.runs.opening import open_timeline
from agent_economy.server.runs.player import Player
from agent_economy.server.runs.timeline import Timeline
from agent_economy.server.transport import ConnectionClosedError, Page
from agent_economy.server.workspace import Workspace
from agent_economy.types import page
from agent_economy.types.page import PageMessage

SLICE_S = 0.025
"""A run is advanced for this long before messages are read again."""

MAX_RECEIVED = 256
"""Messages that wait to be carried out; a page that sends more is not read until there is room."""

IDLE_S = 1800.0
"""A page whose run is paused is disconnected after this time without a message."""

T = TypeVar("T")


class Session:
    """The connection between one page and its run."""

    def __init__(self, connection: Page, workspace: Workspace, threads: Executor) -> None:
        """Begin without a run."""
        self._page, self._workspace, self._threads = connection, workspace, threads
        self._received: asyncio.Queue[PageMessage | InputError] = asyncio.Queue(MAX_RECEIVED)
        self._saver = Saver(connection.send, RecordingStore(workspace), threads)
        self._timeline: Timeline | None = None
        self._player, self._display = Player(), Display()

    async def run(self) -> None:
        """Serve the page until it disconnects."""
        tasks = {asyncio.create_task(self._receive()), asyncio.create_task(self._drive())}
        try:
            await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
        finally:
            for task in tasks:
                task.cancel()
            await asyncio.wait(tasks)
            await self._saver.end()
        for task in tasks:
            with contextlib.suppress(ConnectionClosedError, asyncio.CancelledError):
                task.result()

    async def _receive(self) -> None:
        while True:
            text = await self._page.receive()
            try:
                message: PageMessage | InputError = messages.read(text)
            except InputError as error:
                message = error
            await self._received.put(message)

    async def _drive(self) -> None:
        while True:
            await self._carry_out_messages()
            await self._advance()
            await self._send_outputs()

    async def _carry_out_messages(self) -> None:
        """Carry out all messages; wait for one while there is nothing else to do."""
        while (ready := self._player.take_ready()) is not None:
            await self._try(ready)
        wait_s = self._wait_s()
        if self._received.empty() and wait_s > 0:
            try:
                # `wait_for` may lose the cancellation of this task when the page disconnects.
                async with asyncio.timeout(wait_s):
                    message = await self._received.get()
            except TimeoutError:
                if not self._player.is_moving:
                    await self._disconnect()
                return
            await self._accept(message)
        while not self._received.empty() and self._player.accepts_messages:
            await self._accept(self._received.get_nowait())

    def _wait_s(self) -> float:
        now_s = time.monotonic()
        waits_s = (
            self._player.wait_s(now_s),
            self._display.wait_s(now_s, is_moving=self._player.is_moving),
        )
        return (
            IDLE_S
            if self._timeline is None
            else min(each for each in (*waits_s, IDLE_S) if each is not None)
        )

    async def _disconnect(self) -> None:
        message = "The page was idle for half an hour. Reload it to continue."
        await self._page.send({"type": "ended", "reason": "idle", "message": message})
        raise ConnectionClosedError

    async def _accept(self, message: PageMessage | InputError) -> None:
        if isinstance(message, InputError):
            # An `open` that cannot be read is refused like one that cannot be opened.
            about = messages.errors_of(message)[0]["path"].partition(".")[0]
            await self._page.send(messages.refused(about, message))
        elif isinstance(message, page.Acknowledge):
            self._display.acknowledge(message.frame)
        elif not self._player.defers(message):
            await self._try(message)

    async def _try(self, message: PageMessage) -> None:
        try:
            await self._carry_out(message)
        except InputError as error:
            path = message.path if isinstance(message, page.Change) else None
            await self._page.send(messages.refused(messages.type_of(message), error, path))
        else:
            self._display.refresh()

    async def _carry_out(self, message: PageMessage) -> None:
        match message:
            case page.Open():
                await self._open(message)
            case page.Save():
                self._saver.begin(self._opened().history)
            case page.CancelSave():
                self._saver.cancel()
            case page.Export():
                text = await self._in_thread(lambda: as_toml(self._opened().simulation))
                await self._page.send({"type": "exported", "text": text})
            case page.Select(robot=robot):
                self._display.select(robot)
            case page.Layers():
                self._display.set_layers(message)
            case _:
                await self._in_thread(lambda: self._player.handle(message, time.monotonic()))

    def _opened(self) -> Timeline:
        """Return the run.

        Raises:
            InputError: If none is open.
        """
        _ = self._player.run
        assert self._timeline is not None  # noqa: S101  (checked above)
        return self._timeline

    async def _open(self, message: page.Open) -> None:
        self._player.clear_pending()
        timeline, build = await self._in_thread(lambda: open_timeline(self._workspace, message))
        self._timeline = timeline
        self._player.open(timeline, message.tick)
        self._display.open(timeline)
        await self._page.send(opened(timeline, message, build))

    async def _advance(self) -> None:
        """Advance the run for a short time, if it moves."""
        timeline = self._timeline
        if timeline is None or (target := self._player.target(time.monotonic())) is None:
            return
        before, is_seeking = timeline.tick, self._player.target_tick is not None
        try:
            has_arrived = await self._in_thread(lambda: timeline.seek(target, SLICE_S))
        except InputError as error:
            self._player.failed()
            await self._page.send(messages.refused("seek", error))
            return
        self._player.advanced(time.monotonic(), has_arrived=has_arrived)
        if is_seeking or timeline.tick != before:
            self._display.refresh()

    async def _send_outputs(self) -> None:
        timeline, now_s = self._timeline, time.monotonic()
        if timeline is None or self._display.wait_s(now_s, is_moving=self._player.is_moving) != 0:
            return
        outputs = await self._in_thread(
            lambda: self._display.outputs(timeline, self._player, now_s)
        )
        for output in outputs:
            if isinstance(output, bytes):
                await self._page.send_bytes(output)
            else:
                await self._page.send(output)

    async def _in_thread(self, work: Callable[[], T]) -> T:
        return await asyncio.get_running_loop().run_in_executor(self._threads, work)


def opened(timeline: Timeline, message: page.Open, build: Build | None) -> page.Opened:
    """Return the message that a run is open; `build` is the one that recorded it."""
    simulation = timeline.simulation
    scenario = simulation.scenario
    engine: Any = scenario.engine
    recording: Any = None
    if build is not None:
        own = str(own_build())
        recording = {"id": message.recording, "recorded_by": str(build), "replayed_by": own}
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
    }
