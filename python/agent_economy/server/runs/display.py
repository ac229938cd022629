"""What the page of a run is sent, and when: settings, frames, overlays, states, maps and layers.

A page that draws slowly is sent fewer frames: at most `MAX_IN_FLIGHT` are not acknowledged.
"""

from collections import deque
from typing import Any

from agent_economy.server.runs import engines
from agent_economy.server.runs.belief_view import Selected
from agent_economy.server.runs.follower import Follower
from agent_economy.server.runs.frames import frame, setting
from agent_economy.server.runs.overlay import Overlay
from agent_economy.server.runs.player import Player
from agent_economy.server.runs.run import Run
from agent_economy.server.runs.sent_events import SentEvents
from agent_economy.server.runs.shown import subjects
from agent_economy.types.page import ServerMessage, Show, State

FRAME_S, STATE_S, MAP_S = 0.03, 0.1, 0.25
"""Minimum time between two frames, two states, and two maps of a robot, which layers and
panels come with. Steps of 1/30 s get a frame each."""

MAX_IN_FLIGHT = 3
"""Frames that the page has not acknowledged."""

Output = ServerMessage | bytes


class Display:
    """What a page has been sent of its run, and what it requested."""

    def __init__(self) -> None:
        """Begin with nothing sent."""
        self._selected: engines.Selection = Selected()
        self._overlay = Overlay()
        self._events = SentEvents()
        self._generation = self._number = 0
        self._sent_setting: object = None
        self._in_flight: deque[int] = deque()
        self._has_news = self._owes_state = self._owes_map = False
        self._frame_at_s = self._state_at_s = self._map_at_s = 0.0

    def open(self, run: Run) -> None:
        """Show another run, with no robot selected."""
        self._sent_setting = None
        self._events = SentEvents()
        self._selected = engines.of(run.simulation).selected()
        self._request(robot=None)

    def select(self, robot: str | None) -> None:
        """Show what a robot perceives and believes, or none."""
        self._selected.choose(robot)
        self._request(robot=robot)

    def show(self, message: Show) -> None:
        """Send these layers and panels from now on."""
        self._request(
            layers=frozenset(message.layers),
            panels=frozenset(message.panels),
            choices=message.choices,
        )

    def _request(self, **changed: Any) -> None:
        self._overlay.request = self._overlay.request._replace(**changed)
        self._map_at_s = 0.0

    def acknowledge(self, number: int) -> None:
        """Note that the page has drawn a frame, and all before it."""
        while self._in_flight and self._in_flight[0] <= number:
            self._in_flight.popleft()

    def refresh(self) -> None:
        """Note that the page has not been sent the current moment."""
        self._has_news = True

    def wait_s(self, now_s: float, *, is_moving: bool) -> float | None:
        """Return the time until something is due; None if nothing is."""
        due = (
            (self._has_news, self._frame_at_s + FRAME_S),
            (self._owes_state, self._state_at_s + STATE_S),
            (self._owes_map, self._map_at_s + MAP_S),
        )
        due_s = [at_s for is_due, at_s in due if is_due]
        if not due_s or len(self._in_flight) >= MAX_IN_FLIGHT:
            return None
        return max(0.0, min(due_s) - now_s) if is_moving else 0.0

    def outputs(self, run: Run, player: Player | Follower, now_s: float) -> list[Output]:
        """Return what is due to be sent, in order."""
        is_at_rest = not player.is_moving
        if self.wait_s(now_s, is_moving=player.is_moving) != 0:
            return []
        outputs = self._setting(run)
        if self._has_news:
            outputs += self._frame(run, now_s)
            self._owes_state = self._owes_map = True
        if is_at_rest or now_s >= self._state_at_s + STATE_S:
            self._state_at_s, self._owes_state = now_s, False
            outputs += [*self._events.since_last(run.events), self._state(run, player)]
        if is_at_rest or now_s >= self._map_at_s + MAP_S:
            self._map_at_s, self._owes_map = now_s, False
            if part := self._selected.map(run.simulation):
                outputs.append(part)
            if shown := subjects.shown(run.simulation, self._overlay.request):
                outputs.append(shown)
        return outputs

    def _setting(self, run: Run) -> list[Output]:
        current = run.simulation.changes, run.log, run.versions.current.number
        if current == self._sent_setting:
            return []
        self._generation += 1
        self._sent_setting = current
        return [setting(run, self._generation)]

    def _frame(self, run: Run, now_s: float) -> list[Output]:
        """Return the next frame, behind its overlay if a layer is on."""
        self._number += 1
        self._in_flight.append(self._number)
        self._frame_at_s, self._has_news = now_s, False
        simulation = run.simulation
        drawn = frame(simulation, self._generation, self._number)
        if not self._overlay.is_shown(simulation):
            return [drawn]
        return [self._overlay.over(simulation, self._number), drawn]

    def _state(self, run: Run, player: Player | Follower) -> State:
        simulation = run.simulation
        return {
            "type": "state",
            "tick": simulation.tick,
            "latest_tick": run.latest_tick,
            "time_s": simulation.time_s,
            "hash": f"{simulation.hash:016x}",
            "is_playing": player.is_playing,
            "speed": player.clock.speed,
            "measured_speed": player.clock.measured_speed,
            "target_tick": player.target_tick,
            "is_over": simulation.is_over,
            "mismatch_tick": run.mismatch_tick,
            "outcome": simulation.outcome().row,
            "inspection": self._selected.inspection(simulation),
            "robot": self._selected.details(simulation),
        }
