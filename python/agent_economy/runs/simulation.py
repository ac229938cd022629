"""A run of the metric engine, stepped by hand."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from numbers import Integral
from pathlib import Path
from typing import Any, NamedTuple, cast

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from agent_economy import _core
from agent_economy.runs.brain import BeliefState, BelievedMap, Command, Inspection, Percept
from agent_economy.runs.outcome import Outcome
from agent_economy.runs.python_brains import Brains, changed_minds, minds
from agent_economy.runs.stepped import Change, Stepped
from agent_economy.scenario import Override, Scenario, TomlValue, as_scenario, validation

Floats = NDArray[np.float64]

STATUSES = np.array(["active", "empty", "broken"])
"""What a robot can be, by the compiled part's numbers."""


FIXED = ("clock.step_s", "world.size_m", "world.periodic")
"""What stays: times are counted in steps, and every place is within the world and its sides."""


class Footprint(NamedTuple):
    """What a sensor covers: how far it sees in each direction, past all that hides things from it.

    Attributes:
        bearings_rad: Directions from the robot's front, one a degree, from -pi to pi.
        ranges_m: How far it sees along each, at most as far as it sees at all.
    """

    bearings_rad: Floats
    ranges_m: Floats


@dataclass(frozen=True)
class Snapshot:
    """A whole run at one moment, for `Simulation.restore` of any simulation of this process.

    It cannot be pickled: keep the scenario, the seed, the run and its `changes`, and step again.
    """

    scenario: Scenario
    seed: int
    run: int
    changes: tuple[Change, ...]
    _inside: _core.Snapshot = field(repr=False)


class Simulation(Stepped):
    """A run of the metric engine, stepped by hand: it is `run`, step by step.

    Arrays and tables are copies: they stay as they are when the run goes on. Threads may share a
    simulation; each call waits until another thread's is done.

    Attributes:
        scenario: What the run is of, with all changes so far.
        seed: Of all chance.
        run: Its number.
    """

    _run: _core.Simulation

    def __init__(
        self,
        scenario: Scenario | str | Path,
        seed: int = 0,
        run: int = 0,
        threads: int | None = None,
        brains: Brains | None = None,
    ) -> None:
        """Begin a run.

        Args:
            scenario: A scenario of the metric engine, its file, or the name of one that ships.
            seed: Of all chance, 0 to 2^64 - 1.
            run: Its number, 0 to 2^63 - 10,000,001; each is another world.
            threads: 1 to 1024, for worlds of thousands of robots; None for as many as there are
                processors. It changes no result.
            brains: By kind of robots, a class or function that makes a brain in Python when it is
                called with a robot's body: an object whose `step(percept)` returns a command, as
                that of `Brain` does. It decides for that robot in place of the scenario's brain,
                in the same steps. Or a `Batch`, which decides for all robots of the kind at once.

        Raises:
            InputError: If the scenario is wrong or of another engine, an argument out of range, or
                the world has no room for the team or the items.
        """
        super().__init__(as_scenario(scenario), seed, run)
        metric = self.scenario.metric()
        self._run = _core.Simulation(metric, seed=seed, run=run, threads=threads)
        self._minds = minds(brains, metric, self.scenario.robots)
        self._inspected: str | None = None

    def step(
        self,
        steps: int = 1,
        *,
        percepts: Mapping[str, Percept] | None = None,
        commands: Mapping[str, Command] | None = None,
    ) -> dict[str, Command]:
        """Take steps, also after the run is over; Ctrl-C stops between two.

        A body can be outside: from the first percept given for a robot on, it is where its percepts
        say, its brain steps with each of them, and the command is returned instead of carried out.
        The run adds what other robots told it to the percept, and counts as found what the percept
        has contacts of. In a step without a percept for it, it stands, and its brain does not step.

        Args:
            steps: How many, 0 or more; 1 with percepts or commands.
            percepts: By name, what robots perceive whose bodies are outside.
            commands: By name, what other robots are to do from this step on, whatever their brains
                would decide in it, until their brains decide again: in the next step, or later if
                they are slower than the steps. Sensors and bodies stay as they are.

        Returns:
            By name, what the brains of the robots in `percepts` want of their bodies; one that is
            empty or broken wants nothing.

        Raises:
            InputError: If anything is not allowed, all faults at once; no step is taken then. Nor
                is it if a brain in Python raises something: what it raises comes out here.
        """
        if percepts is None and commands is None:
            self._step(steps)
            return {}
        is_one = isinstance(steps, Integral) and steps == 1
        validation.check(is_one, "steps", steps, "1 with percepts or commands")
        both = as_dict("percepts", percepts), as_dict("commands", commands)
        return cast("dict[str, Command]", self._run.step_with(*both, self._minds))

    def _step(self, steps: int) -> None:
        if not self._minds:
            self._run.step(steps)
            return
        validation.check(validation.is_whole(steps, 0), "steps", steps, "a whole number, 0 or more")
        for _ in range(steps):
            self._run.step_with({}, {}, self._minds)

    @property
    def decided(self) -> dict[str, Command]:
        """By robot, what the brains in Python that stepped in the last step decided."""
        return cast("dict[str, Command]", self._run.decided)

    def percept(self, robot: str) -> Percept | None:
        """Return what a robot will perceive in the next step; the run does not go on.

        Args:
            robot: Its name.

        Returns:
            None if its brain does not step then, as between two of its periods, or if it is empty
            or broken, or its body outside. Of a ray that meets nothing the range is None.

        Raises:
            InputError: If there is no such robot.
        """
        return cast("Percept | None", self._run.percept(robot))

    def belief_state(self, robot: str) -> BeliefState | None:
        """Return what a robot believes and its goals, as of the last step of its brain.

        Args:
            robot: Name of the robot.

        Returns:
            None if its brain has no beliefs, or is a Python brain.

        Raises:
            InputError: If there is no such robot.
        """
        belief_state = self._run.belief_state(robot)
        return None if self._is_in_python(robot) else cast("BeliefState | None", belief_state)

    def believed_map(self, robot: str) -> BelievedMap | None:
        """Return the map that a robot believes, as of the last step of its brain.

        Args:
            robot: Name of the robot.

        Returns:
            None if its brain has no map, or is a Python brain.

        Raises:
            InputError: If there is no such robot.
        """
        believed = _core.believed_map(self._run, robot)
        return None if self._is_in_python(robot) else cast("BelievedMap | None", believed)

    def inspect(self, robot: str | None) -> None:
        """Select a robot for `inspection`. It does not change the run.

        Args:
            robot: Name of the robot; None to select none.

        Raises:
            InputError: If there is no such robot.
        """
        _core.inspect(self._run, robot)
        self._inspected = robot

    def inspection(self) -> Inspection | None:
        """Return the percept and the decision of the selected robot in the next step, with reasons.

        If its brain does not step then, they are those of its last step.

        Returns:
            None if no robot is selected, if its brain is a Python brain or has not stepped since
            the robot was selected, or if the robot is empty, broken or no longer in the team.
        """
        robot = self._inspected
        if robot is None or self._is_in_python(robot):
            return None
        return cast("Inspection | None", _core.inspection(self._run, robot))

    def links(self, robot: str | None = None) -> NDArray[np.uint32]:
        """Return who hears whom now, but for messages that are lost by chance.

        The run stays the same.

        Args:
            robot: The name of one whose links are asked for; None for those of all.

        Returns:
            A row a pair, shape (links, 3): the places in `robots` of who is heard and of who hears,
            and 1 if each hears the other, 0 if not. Who is broken or empty has no links.

        Raises:
            InputError: If there is no such robot.
        """
        return _core.links(self._run, robot)

    def footprints(self, robot: str) -> dict[str, Footprint]:
        """Return what a robot's range rings and detectors of items cover now.

        Obstacles cut what a detector covers if it needs a line of sight, and all that rays meet,
        robots too, what a ring does; errors and chances are left out. The run stays the same.

        Args:
            robot: Its name.

        Returns:
            By the names of the sensors that are on; empty if the robot is empty or broken, or its
            body outside.

        Raises:
            InputError: If there is no such robot.
        """
        told = _core.footprints(self._run, robot)
        return {sensor: Footprint(*each) for sensor, each in told.items()}

    def _is_in_python(self, robot: str) -> bool:
        return any(robot.startswith(f"{mind.kind}/") for mind in self._minds)

    def finish(self) -> Outcome:
        """Take steps until the run is over; Ctrl-C stops between two."""
        while self._minds and not self._run.is_over:
            self._step(1)
        self._run.finish()
        return self.outcome()

    def change(self, path: str, value: TomlValue) -> None:
        """Put a value into the scenario, and go on with that.

        Robots and items that are in both scenarios, by kind and index, stay as they are; others
        come in where they would start, or go. A robot whose brain, body or sensors are now others
        begins with a new mind; one in Python it keeps. Messages on their way are lost if the team
        changes.

        Args:
            path: Keys from the root, with dots between, such as "robots.rover.count"; any but
                `clock.step_s`, `world.size_m` and `world.periodic`.
            value: As the file could have it.

        Raises:
            InputError: If the value is not allowed there, or there is no room for what comes in;
                nothing has changed then.
        """
        override = Override.at(path, value, "change")
        stays = path in FIXED
        validation.check(not stays, f"change: {path}", value, "as it was when the run began")
        with self._lock:
            changed = self.scenario.changed((override,))
            metric = changed.metric()
            after = changed_minds(self._minds, metric, changed.robots)
            tick = self._run.change(metric)
            self.scenario, self._minds = changed, after
            self._changes += (Change(tick, path, value),)

    def snapshot(self) -> Snapshot:
        """Return the whole run as it is now; it costs as much memory as the run.

        Raises:
            InputError: If it has brains in Python: what they remember is theirs.
        """
        self._have_no_minds("snapshot")
        with self._lock:
            inside = self._run.snapshot()
            return Snapshot(self.scenario, self.seed, self.run, self._changes, inside)

    def restore(self, snapshot: Snapshot) -> None:
        """Be the run that a snapshot is of: its scenario, its seed, its moment, its changes.

        Raises:
            InputError: If it is no `Snapshot`, or the run has brains in Python.
        """
        self._have_no_minds("restore")
        validation.of_kind("snapshot", snapshot, Snapshot, "what snapshot() returned")
        with self._lock:
            self._run.restore(snapshot._inside)  # noqa: SLF001  (ours)
            self.scenario, self._changes = snapshot.scenario, snapshot.changes
            self.seed, self.run = snapshot.seed, snapshot.run

    def _have_no_minds(self, what: str) -> None:
        kinds = [mind.kind for mind in self._minds]
        allowed = "none: what brains in Python remember is in no snapshot; begin the run again"
        validation.check(not kinds, f"{what}: brains", kinds, allowed)

    @property
    def robots(self) -> tuple[str, ...]:
        """Names of the robots, KIND/INDEX, in the order of all arrays of robots."""
        return tuple(self._run.robots)

    @property
    def poses(self) -> Floats:
        """Where each robot is, shape (robots, 3): x and y in metres, heading in radians.

        A heading is 0 along x, anticlockwise, from -pi to pi.
        """
        return self._run.poses

    @property
    def speeds(self) -> Floats:
        """How fast each robot goes ahead, in metres a second, shape (robots,)."""
        return self._run.speeds

    @property
    def status(self) -> NDArray[np.str_]:
        """Whether each robot can go on, shape (robots,): "active", or "empty" or "broken"."""
        return STATUSES[self._run.status]

    @property
    def external(self) -> NDArray[np.bool_]:
        """Whether the body of each robot is external, shape (robots,): see `step`."""
        return self._run.external

    @property
    def battery(self) -> Floats:
        """Share of each robot's battery that is left, shape (robots,), 0 to 1.

        A robot whose battery never empties, or that has none, has 1.
        """
        return self._run.battery

    @property
    def items(self) -> pa.Table:
        """A row an item: `kind`, `x_m`, `y_m`, and `found_s`, null until it is found."""
        items: dict[str, Any] = self._run.items
        return pa.table(
            {
                "kind": pa.array(items["kind"], pa.string()),
                "x_m": items["x_m"],
                "y_m": items["y_m"],
                "found_s": pa.array(items["found_s"], mask=np.isnan(items["found_s"])),
            }
        )


def as_dict(name: str, mapping: Mapping[str, Any] | None) -> dict[str, Any]:
    """Return a mapping as a dict; None is an empty one.

    Raises:
        InputError: If it is no mapping.
    """
    if mapping is None:
        return {}
    validation.of_kind(name, mapping, Mapping, "a dict by the names of robots")
    return dict(mapping)
