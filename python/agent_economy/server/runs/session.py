"""One page's run: what the page says is done, and what the run comes to is sent.

One task listens and one plays. The one that plays owns the run: it takes what was heard, lets the
run go on in a thread for a short while, and sends a frame if one is due and the page has drawn
those before. So a slow page gets fewer frames and costs no memory, and no run holds up another's.
"""

import asyncio
import contextlib
import time
from collections import deque
from collections.abc import Callable
from concurrent.futures import Executor
from typing import Any, TypeVar

from agent_economy import given
from agent_economy._core import InputError
from agent_economy.server import messages
from agent_economy.server.messages import Message
from agent_economy.server.recordings.saver import Saver
from agent_economy.server.recordings.store import RecordingStore
from agent_economy.server.runs import engines
from agent_economy.server.runs.belief_view import Selected
from agent_economy.server.runs.export import as_toml
from agent_economy.server.runs.frames import frame, setting
from agent_economy.server.runs.opening import begun
from agent_economy.server.runs.overlay import Overlay
from agent_economy.server.runs.pending import PendingQueue
from agent_economy.server.runs.playback_clock import PlaybackClock
from agent_economy.server.runs.timeline import Timeline
from agent_economy.server.transport import ConnectionClosedError, Page
from agent_economy.server.workspace import Workspace

FRAME_S, STATE_S, MAP_S = 0.03, 0.1, 0.25
"""Between two frames, two states, and two maps of a robot, at least: steps of a thirtieth each give
a frame."""

SLICE_S = 0.025
"""A run goes on for so long before the page is looked after again."""

ON_THE_WAY = 3
"""Frames that a page has not said it has drawn, at most."""

MAX_HEARD = 256
"""Messages that wait to be done, at most: a page that says more waits."""

IDLE_S = 1800.0
"""A page that stands, and says nothing for so long, is let go."""


T = TypeVar("T")


class Session:
    """What goes on between one page and its run."""

    def __init__(self, page: Page, places: Workspace, threads: Executor) -> None:
        """Begin without a run."""
        self._page, self._places, self._threads = page, places, threads
        self._timeline: Timeline | None = None
        self._saver = Saver(page.send, RecordingStore(places), threads)
        self._pace = PlaybackClock(0.1)
        self._heard: asyncio.Queue[Message | InputError] = asyncio.Queue(MAX_HEARD)
        self._aim: int | None = None
        self._later = PendingQueue()
        self._selected: engines.Selection = Selected()
        self._overlay = Overlay()
        self._generation = 0
        self._told: object = None
        self._number = 0
        self._on_the_way: deque[int] = deque()
        self._is_new = False
        self._frame_at_s = self._state_at_s = self._map_at_s = 0.0
        self._busy_at_s = time.monotonic()

    async def run(self) -> None:
        """Serve the page until it has gone."""
        tasks = {asyncio.create_task(self._listen()), asyncio.create_task(self._play())}
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

    async def _listen(self) -> None:
        while True:
            text = await self._page.receive()
            try:
                said: Message | InputError = messages.read(text)
            except InputError as error:
                said = error
            await self._heard.put(said)

    async def _play(self) -> None:
        while True:
            await self._hear()
            await self._go_on()
            await self._show()

    async def _hear(self) -> None:
        """Do what was said; if there is nothing else to do, wait for it."""
        while self._later and self._aim is None:
            await self._try(self._later.take())
        if self._heard.empty():
            wait_s = self._wait_s()
            if wait_s > 0:
                try:
                    # Not `wait_for`, which may lose that this task is cancelled as the page goes.
                    async with asyncio.timeout(wait_s):
                        said = await self._heard.get()
                except TimeoutError:
                    await self._let_go()
                    return
                await self._do(said)
        while not self._heard.empty() and not self._later.is_full:
            await self._do(self._heard.get_nowait())

    def _wait_s(self) -> float:
        """Return for how long there is nothing to do."""
        if self._timeline is None:
            return IDLE_S
        is_due = self._is_new and len(self._on_the_way) < ON_THE_WAY
        if not self._is_busy():
            return 0.0 if is_due else IDLE_S
        if self._aim is not None:
            return 0.0
        now_s = time.monotonic()
        wait_s = self._pace.wait_s(now_s, self._timeline.tick)
        return min(wait_s, max(0.0, self._frame_at_s + FRAME_S - now_s)) if is_due else wait_s

    def _is_busy(self) -> bool:
        return self._pace.is_playing or self._aim is not None

    async def _let_go(self) -> None:
        if not self._is_busy() and time.monotonic() - self._busy_at_s >= IDLE_S:
            message = "Nothing was done for half an hour. Reload the page to go on."
            await self._page.send({"type": "ended", "why": "idle", "message": message})
            raise ConnectionClosedError

    async def _do(self, said: Message | InputError) -> None:
        self._busy_at_s = time.monotonic()
        if isinstance(said, InputError):
            # So an `open` that cannot be read is refused as one that cannot be opened.
            about = messages.faults_of(said)[0]["path"].partition(".")[0]
            await self._refuse(about, said)
            return
        if isinstance(said, messages.Got):
            while self._on_the_way and self._on_the_way[0] <= said.frame:
                self._on_the_way.popleft()
        elif self._waits(said):
            self._later.put(said)
        else:
            await self._try(said)

    def _waits(self, said: Message) -> bool:
        timeline = self._timeline
        if timeline is None or self._aim is None:
            return False
        return self._later.waits(said, has_changes=timeline.simulation.changes != timeline.log)

    async def _try(self, said: Message) -> None:
        path = said.path if isinstance(said, messages.Put) else None
        about = type(said).__name__.lower() if path is None else "change"
        try:
            await self._obey(said)
        except InputError as error:
            await self._refuse(about, error, path)

    async def _obey(self, said: Message) -> None:
        match said:
            case messages.Open():
                await self._open(said)
            case messages.Play(speed=speed):
                self._pace.play(speed, time.monotonic(), self._run.tick)
            case messages.Pause():
                self._later.pause()
                self._stand()
            case messages.Step(steps=steps):
                # From where the steps said before lead to, if those are not yet taken.
                first = self._run.tick if self._aim is None else self._aim
                self._stand()
                self._aim = max(0, first + steps)
            case messages.Go(tick=tick):
                self._stand()
                self._aim = min(tick, self._run.edge)
            case messages.Put(path=path, value=value, instead=instead):
                await self._in_thread(lambda: self._run.change(path, value, instead=instead))
            case messages.Undo():
                await self._undo()
            case messages.Save() | messages.Cancel() | messages.Export():
                await self._hand_out(said)
            case messages.Select() | messages.Layers():
                self._look(said)
        self._is_new = True

    def _look(self, said: messages.Select | messages.Layers) -> None:
        match said:
            case messages.Select(robot=robot):
                self._selected.choose(robot)
                self._overlay.choose(robot)
                self._map_at_s = 0.0
            case messages.Layers():
                self._overlay.ask(said)

    async def _hand_out(self, said: messages.Save | messages.Cancel | messages.Export) -> None:
        match said:
            case messages.Save():
                self._saver.begin(self._run.course)
            case messages.Cancel():
                self._saver.cancel()
            case messages.Export():
                simulation = self._run.simulation
                text = await self._in_thread(lambda: as_toml(simulation))
                await self._page.send({"type": "exported", "text": text})

    @property
    def _run(self) -> Timeline:
        given.check(self._timeline is not None, "message", None, "after an open")
        assert self._timeline is not None  # noqa: S101  (checked above)
        return self._timeline

    async def _open(self, said: messages.Open) -> None:
        self._later.clear()
        self._timeline, program = await self._in_thread(lambda: begun(self._places, said))
        self._stand()
        self._pace = PlaybackClock(self._run.step_s)
        simulation = self._run.simulation
        scenario = simulation.scenario
        self._aim, self._told = said.tick, None
        self._selected = engines.of(simulation).selected()
        self._overlay.choose(None)
        described: dict[str, Any] = {
            "id": said.scenario,
            "name": scenario.name,
            "engine": scenario.engine,
        }
        described |= {"summary": scenario.summary, "time_limit_s": scenario.time_limit_s}
        names = {"seed": str(simulation.seed), "run": str(simulation.run)}
        recording = {"id": said.recording, "program": program} if program is not None else None
        await self._page.send(
            {"type": "opened", "scenario": described, **names, "recording": recording}
        )

    async def _undo(self) -> None:
        """Take back the last change, and go on to where the run was."""
        aim = self._run.tick if self._aim is None else self._aim
        await self._in_thread(self._run.undo)
        self._aim = aim

    def _stand(self) -> None:
        self._aim = None
        self._pace.pause()

    async def _go_on(self) -> None:
        """Let the run go on for a short while."""
        timeline, now_s = self._timeline, time.monotonic()
        if timeline is None or not self._is_busy():
            return
        before = timeline.tick
        self._pace.measure(timeline.step_s, now_s, before)
        aim = self._aim if self._aim is not None else self._pace.target(now_s, before)
        try:
            is_there = await self._in_thread(
                lambda: timeline.toward(messages.MAX_TICK if aim is None else aim, SLICE_S)
            )
        except InputError as error:
            self._stand()
            await self._refuse("go", error)
            return
        self._is_new = self._is_new or timeline.tick != before or self._aim is not None
        self._busy_at_s = time.monotonic()
        if self._aim is not None and is_there:
            self._aim = None
        if self._pace.is_playing:
            self._pace.note(time.monotonic(), timeline.tick)
            if timeline.simulation.is_over and timeline.tick >= timeline.edge:
                self._pace.pause()

    async def _show(self) -> None:
        """Send what is due."""
        timeline, now_s = self._timeline, time.monotonic()
        if timeline is None or not self._is_new or len(self._on_the_way) >= ON_THE_WAY:
            return
        is_at_rest = not self._is_busy()
        if not is_at_rest and now_s - self._frame_at_s < FRAME_S:
            return
        if (made := (timeline.simulation.changes, timeline.log)) != self._told:
            self._generation += 1
            self._told = made
            await self._page.send(setting(timeline, self._generation))
        self._number += 1
        self._on_the_way.append(self._number)
        self._frame_at_s = now_s
        self._is_new = False
        if self._overlay.is_asked(timeline.simulation):
            await self._page.send_bytes(await self._in_thread(self._over))
        await self._page.send_bytes(frame(timeline.simulation, self._generation, self._number))
        if is_at_rest or now_s - self._state_at_s >= STATE_S:
            self._state_at_s = now_s
            await self._page.send(self._state(timeline))
        if is_at_rest or now_s - self._map_at_s >= MAP_S:
            self._map_at_s = now_s
            if told := self._selected.map(timeline.simulation):
                await self._page.send(told)

    def _over(self) -> bytes:
        return self._overlay.over(self._run.simulation, self._number)

    def _state(self, timeline: Timeline) -> dict[str, Any]:
        simulation = timeline.simulation
        return {
            "type": "state",
            "tick": simulation.tick,
            "edge": timeline.edge,
            "time_s": simulation.time_s,
            "hash": f"{simulation.hash:016x}",
            "playing": self._pace.is_playing,
            "speed": self._pace.speed,
            "real": self._pace.reached,
            "aim": self._aim,
            "over": simulation.is_over,
            "differs_at": timeline.replay.differs_at,
            "outcome": simulation.outcome().row,
            "mind": self._selected.mind(simulation),
            "robot": self._selected.told(simulation),
        }

    async def _refuse(self, about: str, error: InputError, path: str | None = None) -> None:
        await self._page.send(messages.refused(about, error, path))

    async def _in_thread(self, work: Callable[[], T]) -> T:
        return await asyncio.get_running_loop().run_in_executor(self._threads, work)
