"""An interactive run of the classic engine."""

from pathlib import Path

import numpy as np
import pyarrow as pa

from agent_economy import _core, arrow
from agent_economy.runs.outcome import Outcome
from agent_economy.runs.stepped import Change, Stepped
from agent_economy.scenario import Override, Scenario, TomlValue, as_scenario, validation

COLOURS = np.array(["blue", "yellow", "red"])
"""Colours of robots, by their number in the compiled part."""

KIND = "wanderer"
"""The only robot kind of the classic engine."""


class ClassicSimulation(Stepped):
    """A run of the classic engine in single steps, with the same results as `agent_economy.run`.

    A step is one paint of the original program's window. The team decides in paints 12, 23, 34, ...
    The run ends when all items are found, at the time limit, or when its state recurs, so that no
    further item can be found. It then no longer advances, unless a change makes that possible.

    Attributes:
        scenario: The scenario, with all changes made during the run.
        seed: Seed of the start positions.
        run: Run number.
    """

    _run: _core.ClassicSimulation
    _state_type = _core.ClassicSnapshot

    def __init__(self, scenario: Scenario | str | Path, seed: int = 0, run: int = 0) -> None:
        """Create a run at its first step.

        Args:
            scenario: A scenario of the classic engine, its file, or the name of a bundled one.
            seed: Seed of the start positions, 0 to 2^64 - 1.
            run: Run number, 0 to 2^63 - 10,000,001. Each number has different start positions.

        Raises:
            InputError: If the scenario has errors or is of another engine, or an argument is out of
                range.
        """
        super().__init__(as_scenario(scenario), seed, run)
        self._run = _core.ClassicSimulation(self.scenario.classic(), seed=self.seed, run=self.run)

    def step(self, steps: int = 1) -> None:
        """Advance by `steps`, 0 or more, or to the end of the run. Ctrl-C stops between two steps.

        Raises:
            InputError: If `steps` is not a whole number, 0 or more.
        """
        self._run.step(validation.plain_value("steps", steps))

    def finish(self) -> Outcome:
        """Advance to the end of the run. Ctrl-C stops between two steps."""
        while not self.is_over:
            self._run.step(10_000)
        return self.outcome()

    def change(self, path: str, value: TomlValue) -> None:
        """Change a value of the scenario, and continue with it.

        Robots that are in both teams stay as they are. A smaller team loses the robots with the
        highest indices; additional robots appear at their start positions. Found items stay found.

        Args:
            path: Keys from the root, separated by dots, such as "robots.wanderer.count".
            value: The new value, as in the file.

        Raises:
            InputError: If the value is not allowed. The run is then unchanged.
        """
        override = Override.at(path, value, "change")
        with self._lock:
            changed = self.scenario.changed((override,))
            tick = self._run.change(changed.classic())
            self.scenario = changed
            self._changes += (Change(tick, path, override.value),)

    def belief_state(self, robot: str) -> None:
        """Return None: robots of the classic engine have no beliefs.

        Raises:
            InputError: If there is no such robot.
        """
        self._number(robot)

    def hash_decisions(self, start: int = 0) -> None:
        """Do nothing: robots of the classic engine have no percepts or commands."""

    @property
    def decision_hash(self) -> None:
        """None: see `hash_decisions`."""
        return

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
        """The left-slow score that the next robot to decide starts with."""
        return self._run.carry

    @property
    def decides_in(self) -> int:
        """Paints until the next decision of the team."""
        return self._run.decides_in

    @property
    def robots(self) -> tuple[str, ...]:
        """Names of the robots, wanderer/INDEX, in the order in which they decide."""
        return tuple(f"{KIND}/{index}" for index in range(self.scenario.robots[KIND]))

    @property
    def team(self) -> pa.Table:
        """One row per robot.

        `x_px` to the right and `y_px` down, `column` and `row` of its cell, `heading_deg` clockwise
        from up, `speed` in cells per decision, `left_turns` and `right_turns`, its counters of
        turns, and its `colour` since the last decision: "blue", "yellow" (something is near) or
        "red" (on a shared cell).
        """
        columns = {name: np.array(values) for name, values in self._run.robots.items()}
        colours = COLOURS[columns["colour"]].tolist()
        return arrow.table({**columns, "colour": colours})

    @property
    def contacts(self) -> list[list[tuple[int, int]]]:
        """For each item, the cells (columns and rows) on which a robot can find it.

        Empty if contact depends on the drawn positions, as with "touch".
        """
        return self._run.contacts

    @property
    def items(self) -> pa.Table:
        """One row per item: `column` and `row` of its cell, and `found_s`, null if not found."""
        columns, rows = np.array(_core.classic_world()["items"], np.int64).T
        found_s = np.array(self._run.found_s, np.float64)
        found = arrow.column(found_s, np.isnan(found_s))
        return arrow.table({"column": columns, "row": rows, "found_s": found})
