"""The identity of a recorded run, complete enough to replay it from the file alone."""

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from agent_economy import _core
from agent_economy._core import InputError
from agent_economy.build import Build, own_build
from agent_economy.recording.fields import Entries, hash_text
from agent_economy.recording.file import File, strict
from agent_economy.runs.external import ExternalBody, external_body, plain
from agent_economy.runs.stepped import Change, Stepped
from agent_economy.scenario import Override, Scenario, Source, validation

FORMAT = "1"

RUN, CHANGE, END = "agent_economy.run", "agent_economy.change", "agent_economy.end"
"""Names of metadata: the identity of the run, a change during the run, and its final state."""

FILES = "files/"
"""Prefix of the attachments that the scenario refers to."""


@dataclass(frozen=True)
class Identity:
    """The identity of a recorded run.

    Attributes:
        scenario: The initial scenario.
        seed: Seed of all random numbers.
        run: Run number.
        build: The build that recorded it.
        external: The bodies that were external from the start, by robot name.
    """

    scenario: Scenario
    seed: int
    run: int
    build: Build
    external: Mapping[str, ExternalBody] = field(default_factory=dict)


def write_identity(file: File, simulation: Stepped) -> None:
    """Write the identity of a run, before its first message."""
    source = simulation.scenario.source
    initial = source.overrides[: len(source.overrides) - len(simulation.changes)]
    name = Path(source.file).name
    own, external = own_build(), simulation.declared_external
    file.note(
        RUN,
        {
            "format": FORMAT,
            "program": own.program,
            "engine": str(own.engine),
            "scenario": name,
            "overrides": json.dumps([[list(each.path), strict(each.value)] for each in initial]),
            "seed": str(simulation.seed),
            "run": str(simulation.run),
        }
        | ({"external": json.dumps(plain(external))} if external else {}),
    )
    file.attach(f"scenario/{name}", "application/toml", source.text.encode())


def write_files(file: File, files: Mapping[str, bytes | str], before: set[str]) -> None:
    """Attach the files that a scenario refers to, except those already attached."""
    for name in sorted(files.keys() - before):
        data = files[name]
        if isinstance(data, bytes):
            file.attach(f"{FILES}{name}", "application/octet-stream", data)


def write_change(file: File, change: Change) -> None:
    """Write a change of the scenario."""
    values = {
        "tick": str(change.tick),
        "path": change.path,
        "value": json.dumps(strict(change.value)),
    }
    file.note(CHANGE, values)


def write_end(file: File, tick: int, state_hash: int, decision_hash: int | None) -> None:
    """Write the final state of the recording, and the hash of its decisions if it has one."""
    values = {"tick": str(tick), "hash": hash_text(state_hash)}
    decisions = {} if decision_hash is None else {"decisions": hash_text(decision_hash)}
    file.note(END, values | decisions)


def read_run(values: object) -> Entries:
    """Return the entries that identify a run.

    Raises:
        InputError: If they have another format.
    """
    run = Entries(f"metadata {RUN!r}", values)
    if (found := run.text("format")) != FORMAT:
        message = f"has the format {found!r}: must be {FORMAT!r}"
        raise InputError(message)
    return run


def read_build(run: Entries) -> Build:
    """Return the build that recorded a run; old recordings do not name its engine."""
    return Build(run.text("program"), run.text("engine") if "engine" in run else None)


def read_identity(values: Mapping[str, str], attached: Mapping[str, bytes]) -> Identity:
    """Return the identity of a run from metadata and attachments. No other file is read.

    Raises:
        InputError: If a part of it is missing, or has another format.
    """
    run = read_run(values)
    name = run.text("scenario")
    own = attached.get(f"scenario/{name}")
    if own is None:
        message = f"lacks its scenario, {name}, without which the run cannot be replayed"
        raise InputError(message)
    files: dict[str, bytes | str] = {
        key.removeprefix(FILES): data for key, data in attached.items() if key.startswith(FILES)
    }
    try:
        text = own.decode()
    except UnicodeDecodeError:
        message = f"is damaged: its scenario, {name}, is not UTF-8 text"
        raise InputError(message) from None
    source = Source(name, text, read_overrides(run), files)
    if missing := _core.missing_files(source):
        message = f"lacks files that the scenario refers to: {', '.join(missing)}"
        raise InputError(message)
    scenario, seed, number = Scenario.of(source), run.whole("seed"), run.whole("run")
    external = read_external(run)
    if external and scenario.engine != "metric":
        run.refuse("external bodies, which its engine does not have")
    return Identity(scenario, seed, number, read_build(run), external)


def read_external(run: Entries) -> dict[str, ExternalBody]:
    """Return the bodies that were external from the start; old recordings have their names only."""
    given = run.json("external") if "external" in run else {}
    if isinstance(given, list) and all(map(validation.is_text, given)):
        given = {name: {} for name in given}
    if not isinstance(given, dict):
        run.refuse("external bodies that are neither names nor described by name")
    try:
        return {name: external_body(values) for name, values in sorted(given.items())}
    except (AttributeError, TypeError, ValueError):
        run.refuse("external bodies that are not described as they should be")


def read_overrides(run: Entries) -> tuple[Override, ...]:
    """Return the overrides of the scenario at the start of the run."""
    rows = run.json("overrides")
    if not (isinstance(rows, list) and all(map(is_override, rows))):
        run.refuse("overrides that are not a list of paths and values")
    return tuple(Override(tuple(keys), value, "recording") for keys, value in rows)


def is_override(row: object) -> bool:
    """Return whether an object is a path, as a list of keys, and a value."""
    match row:
        case [[_, *_] as keys, _]:
            return all(map(validation.is_text, keys))
        case _:
            return False


def read_change(values: Mapping[str, str]) -> Change:
    """Return a recorded change."""
    change = Entries(f"metadata {CHANGE!r}", values)
    return Change(change.whole("tick"), change.text("path"), change.json("value"))
