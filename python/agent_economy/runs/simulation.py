"""An interactive run of the metric engine."""

from collections.abc import Mapping
from numbers import Integral
from pathlib import Path
from typing import Any, NamedTuple, cast

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from agent_economy import _core, arrow
from agent_economy.runs.brain import (
    AssignedGoal,
    BeliefState,
    BelievedMap,
    Command,
    Inspection,
    Percept,
)
from agent_economy.runs.external import External, external_bodies, plain
from agent_economy.runs.lane import BelievedLane, believed_lane
from agent_economy.runs.outcome import Outcome
from agent_economy.runs.passage import Vehicle, vehicle
from agent_economy.runs.python_brains import Brains, Controllers, python_brains, resized
from agent_economy.runs.stepped import Change, Snapshot, Stepped
from agent_economy.scenario import Override, Scenario, TomlValue, as_scenario, validation

Floats = NDArray[np.float64]

STATUSES = np.array(["active", "empty", "broken"])
"""Status of a robot, by its number in the compiled part."""


FIXED = (
    "clock.step_s",
    "clock.max_offset_s",
    "clock.max_drift",
    "world.size_m",
    "world.periodic",
)
"""Keys that cannot change in a run: times are counted in steps, clocks never go back, and positions
lie in the world."""


class Footprint(NamedTuple):
    """The area that a sensor covers, with occlusion.

    Attributes:
        bearings_rad: Directions relative to the robot's front, one per degree, from -pi to pi.
        ranges_m: Visible distance in each direction, up to the range of the sensor.
    """

    bearings_rad: Floats
    ranges_m: Floats


class Simulation(Stepped):
    """A run of the metric engine in single steps, with the same results as `agent_economy.run`.

    Arrays and tables are copies: later steps do not change them. Threads may share a simulation;
    each call waits until that of another thread has returned.

    Attributes:
        scenario: The scenario, with all changes made during the run.
        seed: Seed of all random numbers.
        run: Run number.
        declared_external: The bodies that were external from the start, by robot name, sorted.
    """

    _run: _core.Simulation
    _state_type = _core.Snapshot

    def __init__(  # noqa: PLR0913  (keywords with defaults)
        self,
        scenario: Scenario | str | Path,
        seed: int = 0,
        run: int = 0,
        threads: int | None = None,
        brains: Brains | None = None,
        *,
        controllers: Controllers | None = None,
        external: External = (),
    ) -> None:
        """Create a run at its first step.

        Args:
            scenario: A scenario of the metric engine, its file, or the name of a bundled one.
            seed: Seed of all random numbers, 0 to 2^64 - 1.
            run: Run number, 0 to 2^63 - 10,000,001. Each number is a different world.
            threads: Number of threads, 1 to 1024; None for one per processor. It changes no result,
                and matters only with thousands of robots.
            brains: Python brains by kind of robots. Either a class or function that is called with
                the body of a robot and returns its brain: an object with a method `step(percept)`
                that returns a command, as `Brain` has. It decides instead of the scenario's brain,
                at the same steps. Or a `Batch`, which decides for all robots of the kind at once.
            controllers: Python controllers by kind of controllers: a class or function that is
                called with the settings of a controller and returns one: an object with a method
                `step(percept)` that returns a command, as `Controller` has. It decides instead of
                the scenario's controller.
            external: Names of robots that have external bodies from the start: see `step`. Until
                its first percept, such a body is stationary where it starts. A mapping from names
                to `ExternalBody` also states which of its sensors are virtual.

        Raises:
            InputError: If the scenario has errors or is of another engine, an argument is out of
                range, or the world has no room for the team or the items. It lists all errors of
                `brains` and `controllers`.
        """
        super().__init__(as_scenario(scenario), seed, run, external_bodies(external))
        metric, names = self.scenario.metric(), list(self.declared_external)
        numbers = {"seed": self.seed, "run": self.run}
        numbers["threads"] = validation.plain_value("threads", threads)
        self._run = _core.Simulation(metric, **numbers, external=plain(self.declared_external))
        self._brains = python_brains(brains, controllers, self.scenario)
        in_python = [name for name in names if self._is_in_python(name)]
        allowed = "robots with the brain of the scenario: step the brains in `brains` yourself"
        validation.check(not in_python, "external", in_python, allowed)
        self._inspected: str | None = None

    def step(
        self,
        steps: int = 1,
        *,
        percepts: Mapping[str, Percept] | None = None,
        observed: Mapping[str, Percept] | None = None,
        commands: Mapping[str, Command] | None = None,
    ) -> dict[str, Command]:
        """Advance by `steps`, also after the end of the run. Ctrl-C stops between two steps.

        A robot in `percepts` has an external body from then on: its pose comes from its percepts,
        each percept triggers one step of its brain, and the command is returned instead of being
        executed. The run adds the messages of other robots to the percept, and counts the items of
        its contacts as found. In a step without a percept, the robot moves by its last command,
        for two periods of its brain at most, and its brain does not step. A percept with a time
        that is not later than that of the one before is ignored: the last motion is returned again.

        Args:
            steps: Number of steps, 0 or more; 1 with percepts or commands.
            percepts: Percepts of external bodies, by robot name.
            observed: Percepts of other external bodies, which only state where these are: their
                brains do not step, as while a person drives the robot.
            commands: Commands for other robots and for controllers, by name. A command replaces the
                decision of the robot's brain in this step, and holds until the brain steps again.
                It replaces the step of a controller, which then misses the messages of this step.

        Returns:
            The commands of the robots in `percepts`, by name. Empty and broken robots have none.

        Raises:
            InputError: If an argument is not allowed; it lists all errors. The run does not
                advance. An exception of a Python brain leaves this call unchanged, and the run does
                not advance either.
        """
        steps = validation.plain_value("steps", steps)
        if percepts is None and observed is None and commands is None:
            self._step(steps)
            return {}
        is_one = isinstance(steps, Integral) and steps == 1
        validation.check(is_one, "steps", steps, "1 with percepts or commands")
        inputs = (
            as_dict("percepts", percepts),
            as_dict("observed", observed),
            as_dict("commands", commands),
        )
        return cast("dict[str, Command]", self._run.step_with(inputs, self._brains))

    def _step(self, steps: int) -> None:
        if not self._brains:
            self._run.step(steps)
            return
        validation.whole("steps", steps, 0)
        for _ in range(steps):
            self._run.step_with(({}, {}, {}), self._brains)

    @property
    def decided(self) -> dict[str, Command]:
        """The commands of Python brains in the last step, by robot name."""
        return cast("dict[str, Command]", self._run.decided)

    def perceived(self, robot: str) -> Percept | None:
        """Return the last percept of a robot with an external body, with what the run added.

        That is its percept from outside and, if its brain stepped, what its virtual sensors
        measured and the messages that it received: what its brain decided from.

        Args:
            robot: Name of the robot.

        Returns:
            None before its first percept, after `restore` or a change, or if its body is simulated.

        Raises:
            InputError: If there is no such robot.
        """
        return cast("Percept | None", self._run.perceived(robot))

    def percept(self, robot: str) -> Percept | None:
        """Return the percept of a robot or controller in the next step. It does not change the run.

        Args:
            robot: Name of the robot or controller.

        Returns:
            None if its brain does not step then, because of its rate or because the robot is empty
            or broken, or if its body is external; of a controller, None if it has failed. The range
            of a ray without a return is None.

        Raises:
            InputError: If there is no such robot or controller.
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

    def served_goals(self, robot: str) -> list[dict[str, Any]]:
        """Return the goals of controllers that a robot serves, as of its brain's last step.

        They are in the order in which it serves them. Each has `goal` (KIND/INDEX, or None for a
        goal that is not of the scenario), `x_m`, `y_m`, `owner` (the controller that awarded it),
        `lease_s` (the remaining time of its lease, on the robot's clock) and `verdict`.

        Args:
            robot: Name of the robot.

        Returns:
            An empty list if there are none, the robot has failed or has no energy, its brain has
            no behaviour `serve`, or it is a Python brain.

        Raises:
            InputError: If there is no such robot.
        """
        goals = _core.served_goals(self._run, robot)
        return [] if self._is_in_python(robot) else goals

    def assigned_goals(self, robot: str) -> list[AssignedGoal]:
        """Return the goals that a person has assigned to a robot, as of its brain's last step.

        They are in the order of assignment, each with its verdict. Complete goals remain in the
        list until they are withdrawn.

        Args:
            robot: Name of the robot.

        Returns:
            An empty list if there are none, no behaviour of its brain takes orders, or it is a
            Python brain.

        Raises:
            InputError: If there is no such robot.
        """
        goals = self._run.assigned_goals(robot)
        return [] if self._is_in_python(robot) else cast("list[AssignedGoal]", goals)

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
        """Return the current radio links, without random losses. It does not change the run.

        Args:
            robot: Name of a robot, for its links only; None for all links.

        Returns:
            One row per pair, shape (links, 3): the indices of sender and receiver in `robots`, and
            1 if the link works both ways, otherwise 0. Empty and broken robots have no links.

        Raises:
            InputError: If there is no such robot.
        """
        return _core.links(self._run, robot)

    def footprints(self, robot: str) -> dict[str, Footprint]:
        """Return the areas that the range rings and item detectors of a robot cover now.

        Obstacles limit a detector that needs a line of sight. Obstacles and robots limit a range
        ring. Sensor errors are not included. It does not change the run.

        Args:
            robot: Name of the robot.

        Returns:
            One footprint per sensor that is on, by sensor name; empty if the robot is empty or
            broken, or its body is external.

        Raises:
            InputError: If there is no such robot.
        """
        footprints = _core.footprints(self._run, robot)
        return {sensor: Footprint(*each) for sensor, each in footprints.items()}

    def _is_in_python(self, robot: str) -> bool:
        return any(robot.startswith(f"{each.kind}/") for each in self._brains)

    def finish(self) -> Outcome:
        """Advance to the end of the run. Ctrl-C stops between two steps."""
        while self._brains and not self._run.is_over:
            self._step(1)
        self._run.finish()
        return self.outcome()

    def change(self, path: str, value: TomlValue) -> None:
        """Change a value of the scenario, and continue with it.

        Robots and items that exist before and after, by kind and index, stay as they are. New ones
        appear at their start positions, others disappear. A robot with a changed brain, body or
        sensors gets a new brain; a Python brain is kept. A change of the team loses the messages
        that are being transmitted.

        Args:
            path: Keys from the root, separated by dots, such as "robots.rover.count". Not allowed:
                `clock.step_s`, `clock.max_offset_s`, `clock.max_drift`, `world.size_m`,
                `world.periodic`, the positions of goals and controllers that exist, and what
                controllers know of goals that have been issued, such as `goals.NAME.value`.
            value: The new value, as in the file.

        Raises:
            InputError: If the value is not allowed, or there is no room for a new robot or item.
                The run is then unchanged.
        """
        override = Override.at(path, value, "change")
        is_fixed = path in FIXED
        validation.check(not is_fixed, f"change: {path}", value, "as it was when the run began")
        with self._lock:
            changed = self.scenario.changed((override,))
            metric = changed.metric()
            brains = resized(self._brains, changed)
            tick = self._run.change(metric)
            self.scenario, self._brains = changed, brains
            self._changes += (Change(tick, path, override.value),)

    def fail(self, name: str) -> None:
        """Let a robot or controller fail now, as `mean_time_between_failures_s` does.

        A robot is broken from then on; a controller neither sends nor receives. It is a change of
        `robots.KIND.failed` or `controllers.KIND.failed`, and in `changes` as such.

        Args:
            name: Name of the robot or controller, KIND/INDEX.

        Raises:
            InputError: If there is none of that name, or the robot has an external body.
        """
        validation.of_type("name", name, str, "the name of a robot or controller")
        with self._lock:
            path, index = self._run.failure(name)
            group, kind, key = path.split(".")
            failed = self.scenario.to_dict()[group][kind].get(key, [])
            self.change(path, sorted({*failed, index}))

    def set_service(self, name: str, *, in_service: bool) -> None:
        """Take a robot out of service now, or put it back into service.

        Out of service, a robot returns the goals that controllers awarded to it, and bids for none;
        its other behaviours continue. The order reaches each robot that has a radio, whatever its
        range. It is a change of `robots.KIND.out_of_service`, and in `changes` as such.

        Args:
            name: Name of the robot, KIND/INDEX.
            in_service: Whether it is in service.

        Raises:
            InputError: If there is no robot of that name.
        """
        validation.of_type("name", name, str, "the name of a robot")
        validation.of_type("in_service", in_service, bool, "true or false")
        with self._lock:
            path, index = self._run.service(name)
            group, kind, key = path.split(".")
            out = {*self.scenario.to_dict()[group][kind].get(key, [])}
            self.change(path, sorted(out - {index} if in_service else out | {index}))

    def hash_decisions(self, start: int = 0) -> None:
        """Hash all decisions from now on: see `decision_hash`. It changes nothing else.

        Args:
            start: The value to begin with, 0 to 2^64 - 1: to continue a hash, its value at this
                step.

        Raises:
            InputError: If `start` is not allowed.
        """
        self._run.hash_decisions(start)

    @property
    def decision_hash(self) -> int | None:
        """A 64-bit hash of all decisions since `hash_decisions`; None before.

        Each step of each brain adds its percept and its command with all their parts, also those of
        external bodies and of Python brains, and so do `commands` that replace decisions. Two runs
        with the same hash have made the same decisions from the same percepts. Snapshots contain
        it.
        """
        return self._run.decision_hash

    def snapshot(self) -> Snapshot:
        """Return a copy of the complete state of the run. It takes as much memory as the run.

        Raises:
            InputError: If the run has Python brains, whose memory a snapshot cannot contain.
        """
        self._check_no_python_brains("snapshot")
        return super().snapshot()

    def restore(self, snapshot: Snapshot) -> None:
        """Return to a snapshot: its state, its scenario and its changes.

        Raises:
            InputError: If `snapshot` is not a snapshot of this run, as for any run, or the run has
                Python brains.
        """
        self._check_no_python_brains("restore")
        super().restore(snapshot)

    def _check_no_python_brains(self, method: str) -> None:
        kinds = [each.kind for each in self._brains]
        allowed = "none: a snapshot cannot contain their memory; restart the run"
        subject = f"{method}: brains and controllers in Python"
        validation.check(not kinds, subject, kinds, allowed)

    @property
    def robots(self) -> tuple[str, ...]:
        """Names of the robots, KIND/INDEX, in the order of all arrays with one entry per robot."""
        return tuple(self._run.robots)

    @property
    def poses(self) -> Floats:
        """Pose of each robot, shape (robots, 3): x and y in metres, heading in radians.

        The heading is 0 along x, anticlockwise, from -pi to pi.
        """
        return self._run.poses

    @property
    def speeds(self) -> Floats:
        """Forward speed of each robot in m/s, shape (robots,)."""
        return self._run.speeds

    @property
    def status(self) -> NDArray[np.str_]:
        """Status of each robot, shape (robots,): "active", "empty" (battery) or "broken"."""
        return STATUSES[self._run.status]

    @property
    def external(self) -> NDArray[np.bool_]:
        """Whether the body of each robot is external, shape (robots,): see `step`."""
        return self._run.external

    @property
    def battery(self) -> Floats:
        """State of charge of each robot, shape (robots,), 0 to 1.

        It is 1 for a robot without a battery, or whose battery has no limited capacity.
        """
        return self._run.battery

    @property
    def items(self) -> pa.Table:
        """One row per item: `kind`, `x_m`, `y_m`, `found_s`, null if not found, and `found_by`.

        `found_by` is the name of the robot that detected it first, empty if none did or if the
        robot was removed.
        """
        items: dict[str, Any] = self._run.items
        return arrow.table(
            {
                "kind": items["kind"],
                "x_m": items["x_m"],
                "y_m": items["y_m"],
                "found_s": arrow.column(items["found_s"], np.isnan(items["found_s"])),
                "found_by": items["found_by"],
            }
        )

    @property
    def goals(self) -> pa.Table:
        """One row per goal, with times in seconds, null for what has not happened.

        The columns are `name` (KIND/INDEX), `issuer` and `number` of its id in messages, `x_m`,
        `y_m`, `issued_s`, `awarded_s`, `pursued_s` (a robot first drove there), `began_s` and
        `arrived_s` (the robot that served it set out for the last time, and arrived), `served_s`,
        `blocked_s` (time for which it stood under way), `served_by` (empty if it was not served),
        `served_twice`, `expired`, `unserved` (why no robot can serve it, as a controller last
        reported; empty if none did or it was served) and `status`: "pending" before it arrives,
        "waiting" (the operator is to issue it), "owned", "awarded", "in_service", "served",
        "expired", "reported" (with `unserved`) or "unknown" (no working agent knows it).
        """
        goals: dict[str, Any] = _core.goals(self._run)
        return arrow.table(
            {
                name: arrow.column(values, np.isnan(values)) if name.endswith("_s") else values
                for name, values in goals.items()
            }
        )

    @property
    def controllers(self) -> list[dict[str, Any]]:
        """The controllers, with the goals that they own as far as they know.

        Each has `name` (KIND/INDEX), `x_m`, `y_m`, `aboard` (a robot, or None), `range_m`,
        `working`, `transfers` (the number of goals given to others by trade), `refused` (the
        number of goals refused), `lost` (names of goals that no controller owns, as it has
        reported), and `goals`, each with `goal` (KIND/INDEX, or None for a goal that is not of
        the scenario), `x_m`, `y_m`, `assignee` (the robot that it is awarded to, or None),
        `lease_s` (the remaining time of that robot's lease, or None), `votes` (the controllers
        that vote for the owner), `owner_lease_s` (the remaining time for which a majority does,
        or None) and `unserved` (why no robot can serve it, or None).
        """
        return _core.controllers(self._run)

    @property
    def lanes(self) -> list[BelievedLane]:
        """What each controller believes of the mined lane, in the order of `controllers`.

        It is empty if no controller is to clear one. Controllers know only what robots send:
        `mines_left` is the truth.
        """
        return [believed_lane(lane) for lane in _core.lanes(self._run)]

    @property
    def mines_left(self) -> int:
        """The number of mines in the lane that are not destroyed; 0 without a lane.

        It is the truth, which no robot and no controller knows.
        """
        return _core.mines_left(self._run)

    @property
    def vehicles(self) -> list[Vehicle]:
        """The vehicles that pass the lane, in their order; none before it is declared clear."""
        return [vehicle(each) for each in _core.vehicles(self._run)]


def as_dict(name: str, mapping: Mapping[str, Any] | None) -> dict[str, Any]:
    """Return a mapping as a dict; None as an empty one.

    Raises:
        InputError: If it is not a mapping.
    """
    if mapping is None:
        return {}
    validation.of_type(name, mapping, Mapping, "a dict by robot names")
    return cast("dict[str, Any]", validation.plain_value(name, mapping))
