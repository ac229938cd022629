"""A run of the classic engine, stepped by hand."""

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pyarrow as pa

from agent_economy import _core
from agent_economy.runs.outcome import Outcome
from agent_economy.runs.stepped import Change, Stepped
from agent_economy.scenario import Override, Scenario, TomlValue, as_scenario, validation

COLOURS = np.array(["blue", "yellow", "red"])
"""What a robot can look like, by the compiled part's numbers."""

KIND = "wanderer"
"""All robots of 2003 are of one kind."""


@dataclass(frozen=True)
class ClassicSnapshot:
    """A whole run at one moment, for `ClassicSimulation.restore`."""

    scenario: Scenario
    seed: int
    run: int
    changes: tuple[Change, ...]
    _inside: _core.ClassicSnapshot = field(repr=False)


class ClassicSimulation(Stepped):
    """A run of the classic engine, stepped by hand: it is `run`, paint by paint.

    A step is a paint of the original's window; the team decides in paints 12, 23, 34, ... The run
    is over, and stands, when all items are found, when the cap is reached, or when its state has
    come again, so that what is not found never will be. A change may let it go on.

    Attributes:
        scenario: What the run is of, with all changes so far.
        seed: Of all chance.
        run: Its number.
    """

    _run: _core.ClassicSimulation

    def __init__(self, scenario: Scenario | str | Path, seed: int = 0, run: int = 0) -> None:
        """Begin a run.

        Args:
            scenario: A scenario of the classic engine, its file, or the name of one that ships.
            seed: Of all chance, 0 to 2^64 - 1.
            run: Its number, 0 to 2^63 - 10,000,001; each has other starts.

        Raises:
            InputError: If the scenario is wrong or of another engine, or an argument out of range.
        """
        super().__init__(as_scenario(scenario), seed, run)
        self._run = _core.ClassicSimulation(self.scenario.classic(), seed=seed, run=run)

    def step(self, steps: int = 1) -> None:
        """Take steps, 0 or more, until the run is over; Ctrl-C stops between two.

        Raises:
            InputError: If it is not how many.
        """
        self._run.step(steps)

    def finish(self) -> Outcome:
        """Take steps until the run is over; Ctrl-C stops between two."""
        while not self.is_over:
            self._run.step(10_000)
        return self.outcome()

    def change(self, path: str, value: TomlValue) -> None:
        """Put a value into the scenario, and go on with that.

        Robots that are in both teams stay as they are; those with the highest numbers leave, or
        more come in where they would have started. What was found stays found.

        Args:
            path: Keys from the root, with dots between, such as "robots.wanderer.count".
            value: As the file could have it.

        Raises:
            InputError: If the value is not allowed there; nothing has changed then.
        """
        override = Override.at(path, value, "change")
        with self._lock:
            changed = self.scenario.changed((override,))
            tick = self._run.change(changed.classic())
            self.scenario = changed
            self._changes += (Change(tick, path, value),)

    def snapshot(self) -> ClassicSnapshot:
        """Return the whole run as it is now."""
        with self._lock:
            inside = self._run.snapshot()
            return ClassicSnapshot(self.scenario, self.seed, self.run, self._changes, inside)

    def restore(self, snapshot: ClassicSnapshot) -> None:
        """Be the run that a snapshot is of: its scenario, its seed, its moment, its changes.

        Raises:
            InputError: If it is no `ClassicSnapshot`.
        """
        validation.of_kind("snapshot", snapshot, ClassicSnapshot, "what snapshot() returned")
        with self._lock:
            self._run.restore(snapshot._inside)  # noqa: SLF001  (ours)
            self.scenario, self._changes = snapshot.scenario, snapshot.changes
            self.seed, self.run = snapshot.seed, snapshot.run

    def belief_state(self, robot: str) -> None:
        """Return None: robots of 2003 believe nothing and want nothing.

        Raises:
            InputError: If there is no such robot.
        """
        self._number(robot)

    def examined_cells(self, robot: str) -> list[tuple[int, int]]:
        """Return the cells (columns and rows) that a robot would examine if it decided now.

        Raises:
            InputError: If there is no such robot.
        """
        return self._run.examined_cells(self._number(robot))

    def _number(self, robot: str) -> int:
        allowed = f"one of {KIND}/0 to {KIND}/{len(self.robots) - 1}"
        validation.check(robot in self.robots, "robot", robot, allowed)
        return self.robots.index(robot)

    @property
    def carry(self) -> int:
        """The left-slow score with which the next robot that decides begins."""
        return self._run.carry

    @property
    def decides_in(self) -> int:
        """Paints until the team decides next."""
        return self._run.decides_in

    @property
    def robots(self) -> tuple[str, ...]:
        """Names of the robots, wanderer/INDEX, in the order in which they decide."""
        return tuple(f"{KIND}/{index}" for index in range(self.scenario.robots[KIND]))

    @property
    def team(self) -> pa.Table:
        """A row a robot.

        `x_px` and `y_px` to the right and down, the `column` and `row` of its cell, `heading_deg`
        clockwise from up, `speed` in cells a decision, `left_turns` and `right_turns` as far as
        they count, and the `colour` since the last decision: "blue", "yellow" (something is near)
        or "red" (on a shared cell).
        """
        robots = self._run.robots
        return pa.table({**robots, "colour": COLOURS[robots["colour"]]})

    @property
    def contacts(self) -> list[list[tuple[int, int]]]:
        """For each item the cells, columns and rows, on which a robot can find it.

        None where contact is judged by what is drawn, as "touch" is.
        """
        return self._run.contacts

    @property
    def items(self) -> pa.Table:
        """A row an item: the cell's `column` and `row`, and `found_s`, null until it is found."""
        columns, rows = zip(*_core.classic_world()["items"], strict=True)
        found_s = pa.array(self._run.found_s, pa.float64())
        return pa.table({"column": columns, "row": rows, "found_s": found_s})
