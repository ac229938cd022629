"""What a page says to the server, and what the server says to it.

Runs that are watched
---------------------
Over `/ws` go texts in JSON, each with a `type`, and frames in bytes. Numbers of runs can have 64
bits, which JavaScript's cannot: seeds and runs go as texts.

From the page:

* `open`: `scenario` (an id of the gallery), `text` (TOML), `study` (`id` and `configuration`: its
  run is the very one that the study has) or `recording` (an id of `/api/recordings`, which has a
  seed and a run, and changes if none are said), `seed` (left out, the study's, or 0), `run`,
  `changes` (a list of tick, path, value), `tick`. Begins a run, at that tick, standing.
* `play`: `speed`, times real time, or null for as fast as it can. `pause`.
* `step`: `steps`, also less than 0. `go`: `tick`. Both stand then. A run that was opened at a tick,
  or is to step or go there, is on its way for a while: what is said meanwhile is done when it is
  there, but for `pause`, `go` and `open`, which end that way, and for what changes no run.
* `change`: `path`, `value`; `instead`: whether the value takes the place of the one that was said
  before, if the run has not gone on since, as one on the way of a slider that is drawn. `undo`: the
  run as if the last change had not been made, at this tick.
* `save`: the run up to its edge becomes a recording; `cancel`: not so. `export`: the scenario as it
  is now, as a text.
* `select`: `robot`, of which is told what it perceives, decides and believes, or null.
* `layers`: `links` and `footprints`, whether frames are to come with these from now on; at first
  they do not.
* `got`: `frame`, the number of one that has been drawn, which holds for those before it. No more
  than three are on their way.

From the server: `opened`, `setting` (all that stays until something is changed), `state` (at most
ten times a second), `map`, `saving` (`done` of `steps`) and `saved` (`recording`, as
`/api/recordings` has it, or null if it was cancelled), `exported` (`text`), `refused` (`about`, the
`path` of a change, `faults`; nothing has changed) and `ended`.

* `setting`: its `changes` are those made by now, its `log` those up to the edge, null if they are
  the recording's.
* `state`: its `mind`, of the robot selected, is what `Simulation.watched` tells, with `robot`; its
  entries are null, but for `thoughts`, if its brain has not stepped since, or it cannot go on.
  `differs_at` is the tick at which the run was found not to be as recorded.
* `map`: what that robot believes, at most four times a second, if it has changed: `robot`;
  `corner`, `cell_m`, `columns` and `rows` of the whole map; and of the cells `from` a column and
  row, as many columns and rows as `size` says, `occupancy` and `unseen` as `BelievedMap` has them,
  a byte each, in base64. All others are as they were; the first `map` of a robot has all.

A frame in little endian is eight numbers, `u32` but for the time: 1, generation, tick, robots, time
in s (`f64`), items, the frame's number; then what `_core.frame` says. It is drawn in the setting of
its generation.

An overlay comes right before the frame that it lies over, if a layer is on and the engine has such
things. In little endian it is three `u32`: 2, the frame's number, links; then the links and to the
end the footprints, as `_core.drawn_links` and `_core.drawn_footprints` say. Links are at most 4000,
and of more than 300 robots both are of the selected one only.

A state tells of the robot that was selected: its `mind`, and as `robot` what else its engine knows,
in words, with outlines of the cells that it would look at; each null where there is nothing.

Workspace are in the `unit` of the setting's `world`: metres, or the pixels of the classic engine's
window; y is upwards. A `cell` of that world is so wide, or null where there are none.

StudyManager
-------
A study's id is its folder below the server's, as `studies/classic`. What is not allowed is answered
with status 422 and `faults`.

* POST `/api/factors`: `scenario` or `text`. What can be varied, and between which values.
* POST `/api/plan`: an ask, which is `scenario` or `text`; `vary` (values by path, all that is
  varied, or nothing for what the scenario varies), `design`, `delta`, `confidence`, `guarantee`,
  `merit`, `runs`, `max_runs` (each may be null) and `seed`. What the study would compare.
* POST `/api/studies`: an ask. Begins the study in the folder that the command line would use, or
  goes on with it. GET: all studies, the newest first.
* POST `/api/studies/stop`: `id`. `/api/studies/resume`: `id`, and a higher `confidence` or null.
* GET `/api/study?id=`: a study with its plan, and its answer with the report's sections and charts.
* GET `/api/study/runs?id=&configuration=`: its runs, `first` and `count` or a `sample` of them from
  the worst to the best. `/api/study/report?id=`, `/api/study/answer?id=`: its files.
* Over `/ws?study=ID` the server tells `studying`, at most five times a second, until the study does
  not go on: its `state` (running, answered, stopped or damaged) and `message`, rounds and runs, the
  best with their ranges in `standings` (configuration, runs, merit, low, high; the last two null
  where nobody has computed them), who is `eliminated` (configuration, by whom, after how many
  runs), and in the first message all `labels`.

Recordings
----------
GET `/api/recordings`: all below the server's folder, the newest first, by their `id`, and what each
is `of` or what is its `fault`. GET `/api/recordings/file?id=`: its file.
"""

import json
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from agent_economy._core import InputError
from agent_economy.runs.stepped import Change as LoggedChange
from agent_economy.scenario import TomlValue, validation

MAX_TICK = 2**53
MAX_STEPS = 1_000_000
SPEEDS = (0.01, 100_000.0)

Fault = dict[str, Any]
"""What is wrong, as a page takes it."""

FAULT = ("file", "line", "path", "value", "allowed", "suggestion", "message")


@dataclass(frozen=True)
class Member:
    """A configuration of a study."""

    id: str
    configuration: int


@dataclass(frozen=True)
class Open:
    """Begin a run."""

    scenario: str | None
    text: str | None
    study: Member | None
    recording: str | None
    seed: int | None
    run: int
    changes: tuple[LoggedChange, ...] | None
    tick: int


@dataclass(frozen=True)
class Play:
    """Go on; `speed` is times real time, None as fast as it can."""

    speed: float | None


@dataclass(frozen=True)
class Pause:
    """Stand."""


@dataclass(frozen=True)
class Step:
    """Take steps, back if less than 0, and stand."""

    steps: int


@dataclass(frozen=True)
class Seek:
    """Go to a tick, and stand."""

    tick: int


@dataclass(frozen=True)
class Change:
    """Put a value into the scenario; `instead` of the one put there before, at the same tick."""

    path: str
    value: TomlValue
    replaces_last: bool


@dataclass(frozen=True)
class Undo:
    """Take back the last change, as if it had never been made."""


@dataclass(frozen=True)
class Save:
    """Make a recording of the run."""


@dataclass(frozen=True)
class Cancel:
    """Make no recording after all."""


@dataclass(frozen=True)
class Export:
    """Give the scenario as it is now."""


@dataclass(frozen=True)
class Select:
    """Tell of a robot's mind."""

    robot: str | None


@dataclass(frozen=True)
class Layers:
    """Let frames come with these."""

    links: bool
    footprints: bool


@dataclass(frozen=True)
class Acknowledge:
    """A frame has been drawn."""

    frame: int


Message = (
    Open
    | Play
    | Pause
    | Step
    | Seek
    | Change
    | Undo
    | Save
    | Cancel
    | Export
    | Select
    | Layers
    | Acknowledge
)


def read(text: str) -> Message:
    """Return what a page said.

    Raises:
        InputError: If it is not what a page may say.
    """
    try:
        said = json.loads(text)
    except (ValueError, RecursionError):
        said = text[:80]
    validation.of_kind("message", said, dict, "an object with a type, in JSON")
    kind = said.get("type")
    is_known = isinstance(kind, str) and kind in READERS
    validation.check(is_known, "message.type", kind, f"one of {', '.join(READERS)}")
    return READERS[kind](said)


def faults_of(error: InputError) -> list[Fault]:
    """Return what is wrong, as a page takes it."""
    if not error.errors:
        return [dict.fromkeys(FAULT) | {"message": str(error), "path": "", "allowed": ""}]
    return [{key: value for key, value in fault.items() if key in FAULT} for fault in error.errors]


def refused(about: str, error: InputError, path: str | None = None) -> dict[str, Any]:
    """Return what a page is told of what is not done."""
    return {"type": "refused", "about": about, "path": path, "faults": faults_of(error)}


def opened(said: Mapping[str, Any]) -> Open:
    """Return an `open`."""
    study = None if said.get("study") is None else member(said["study"])
    recording = said.get("recording")
    validation.check(
        recording is None or validation.is_text(recording), "open.recording", recording, "a text"
    )
    is_named = study is not None or recording is not None
    scenario, text = (None, None) if is_named else source_of("open", said)
    seed = said.get("seed", None if study else "0")
    log = said.get("changes")
    if log is not None:
        validation.of_kind("open.changes", log, list, "a list of [tick, path, value]")
    return Open(
        scenario,
        text,
        study,
        recording,
        None if seed is None else number("open.seed", seed),
        number("open.run", said.get("run", "0")),
        None if log is None else tuple(map(change, log)),
        whole("open.tick", said.get("tick", 0), MAX_TICK),
    )


def source_of(about: str, said: Mapping[str, Any]) -> tuple[str | None, str | None]:
    """Return the scenario's id or its text: one is None.

    Raises:
        InputError: If not one of them is given.
    """
    scenario, text = said.get("scenario"), said.get("text")
    is_one = (scenario is None) != (text is None)
    validation.check(is_one, about, [scenario, text], "with either a scenario or a text")
    each = scenario if text is None else text
    validation.check(validation.is_text(each), about, each, "a text")
    return scenario, text


def member(said: object) -> Member:
    """Return a configuration of a study."""
    allowed = "an object with an id and a configuration"
    validation.of_kind("open.study", said, dict, allowed)
    assert isinstance(said, dict)  # noqa: S101  (checked above)
    validation.check(validation.is_text(said.get("id")), "open.study.id", said.get("id"), "a text")
    return Member(
        said["id"], whole("open.study.configuration", said.get("configuration"), MAX_TICK)
    )


def change(said: object) -> LoggedChange:
    """Return a change of a log."""
    allowed = "[tick, path, value]"
    is_change = isinstance(said, list) and len(said) == len(LoggedChange._fields)
    validation.check(is_change, "open.changes", said, allowed)
    assert isinstance(said, list)  # noqa: S101  (checked above)
    tick, path, value = said
    validation.check(validation.is_text(path), "open.changes", path, "a path, as a text")
    return LoggedChange(whole("open.changes", tick, MAX_TICK), path, finite("open.changes", value))


def play(said: Mapping[str, Any]) -> Play:
    """Return a `play`."""
    speed = said.get("speed")
    least, most = SPEEDS
    is_number = isinstance(speed, int | float) and not isinstance(speed, bool)
    is_allowed = speed is None or (is_number and least <= speed <= most)
    validation.check(is_allowed, "play.speed", speed, f"from {least} to {most}, or null")
    return Play(speed)


def step(said: Mapping[str, Any]) -> Step:
    """Return a `step`."""
    steps = said.get("steps", 1)
    is_allowed = validation.is_whole(steps, -MAX_TICK, MAX_STEPS)
    validation.check(is_allowed, "step.steps", steps, f"a whole number, {MAX_STEPS:,} at most")
    return Step(steps)


def put(said: Mapping[str, Any]) -> Change:
    """Return a `change`."""
    path = said.get("path")
    validation.check(validation.is_text(path), "change.path", path, "a path, as clock.time_limit_s")
    validation.check("value" in said, "change.value", None, "given")
    instead = said.get("instead", False)
    validation.check(isinstance(instead, bool), "change.instead", instead, "true or false")
    return Change(str(path), finite("change.value", said["value"]), instead)


def select(said: Mapping[str, Any]) -> Select:
    """Return a `select`."""
    robot = said.get("robot")
    validation.check(
        robot is None or validation.is_text(robot), "select.robot", robot, "a name, or null"
    )
    return Select(robot)


def layers(said: Mapping[str, Any]) -> Layers:
    """Return a `layers`."""
    for layer in ("links", "footprints"):
        validation.of_kind(f"layers.{layer}", said.get(layer), bool, "true or false")
    return Layers(links=said["links"], footprints=said["footprints"])


def number(name: str, said: object) -> int:
    """Return a whole number that comes as a text; who uses it says how great it may be."""
    is_number = isinstance(said, str) and said.isascii() and said.isdigit() and len(said) <= 20  # noqa: PLR2004
    validation.check(is_number, name, said, 'a whole number as a text, as "7"')
    return int(str(said))


def whole(name: str, said: Any, most: int) -> int:
    """Return a whole number from 0."""
    validation.check(
        validation.is_whole(said, 0, most), name, said, f"a whole number from 0 to {most}"
    )
    return int(said)


def finite(name: str, said: Any) -> TomlValue:
    """Return a value of a scenario; JSON's null, and numbers that are none, are no values."""
    parts = (
        list(said.values()) if isinstance(said, dict) else said if isinstance(said, list) else []
    )
    for part in parts:
        finite(name, part)
    is_number = not isinstance(said, float) or math.isfinite(said)
    validation.check(said is not None and is_number, name, said, "a value that a scenario can have")
    return said  # type: ignore[no-any-return]


READERS: dict[str, Callable[[Mapping[str, Any]], Message]] = {
    "open": opened,
    "play": play,
    "pause": lambda _: Pause(),
    "step": step,
    "go": lambda said: Seek(whole("go.tick", said.get("tick"), MAX_TICK)),
    "change": put,
    "undo": lambda _: Undo(),
    "save": lambda _: Save(),
    "cancel": lambda _: Cancel(),
    "export": lambda _: Export(),
    "select": select,
    "layers": layers,
    "got": lambda said: Acknowledge(whole("got.frame", said.get("frame"), MAX_TICK)),
}

TYPES = {
    Open: "open",
    Play: "play",
    Pause: "pause",
    Step: "step",
    Seek: "go",
    Change: "change",
    Undo: "undo",
    Save: "save",
    Cancel: "cancel",
    Export: "export",
    Select: "select",
    Layers: "layers",
    Acknowledge: "got",
}


def type_of(message: Message) -> str:
    """Return the type of a message."""
    return TYPES[type(message)]
