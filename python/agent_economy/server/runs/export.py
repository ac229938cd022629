"""Exports the scenario of a run, with its changes, as a file."""

from dataclasses import replace

import tomli_w

from agent_economy._core import InputError
from agent_economy.runs.stepped import Stepped
from agent_economy.scenario import Scenario
from agent_economy.server.changed_values import Change, changes_between, comments, exported_from


def as_toml(simulation: Stepped) -> str:
    """Return the current scenario of a run as TOML.

    A scenario without overrides keeps its own text, with all comments.
    """
    scenario, source = simulation.scenario, simulation.scenario.source
    earlier = exported_from(source.text, scenario.to_dict())
    name = one_line(earlier["name"] if earlier else scenario.name)
    which = f"{name}, seed {simulation.seed}, run {simulation.run}"
    lines = [
        f"From {which}, at tick {simulation.tick} ({simulation.time_s:g} s).",
        *comments(changes_of(scenario)),
        *(f"Tick {tick}: {one_line(path)} was changed." for tick, path, _ in simulation.changes),
    ]
    if source.files:
        lines.append(f"This file needs in the same folder: {', '.join(sorted(source.files))}.")
    head = "".join(f"# {line}\n" for line in lines)
    body = tomli_w.dumps(scenario.to_dict()) if source.overrides else source.text
    return f"{head}\n{body}"


def changes_of(scenario: Scenario) -> list[Change]:
    """Return what was changed in a scenario since it was read from its file.

    If the file was itself exported, that includes what was changed before.
    """
    source, document = scenario.source, scenario.to_dict()
    found = {}
    earlier = exported_from(source.text, document)
    for value in earlier["values"] if earlier else ():
        found[value["path"]] = Change(value["path"], value["old"], value["new"])
    try:
        before = Scenario.of(replace(source, overrides=())).to_dict()
    except InputError:  # It is valid with its overrides only.
        before = document
    for each in changes_between(before, document):
        old = found[each.path].old if each.path in found else each.old
        found[each.path] = Change(each.path, old, each.new)
    return [each for each in found.values() if each.old != each.new]


def one_line(text: str) -> str:
    """Return a name of a file or a key in one line: a line feed would end the comment."""
    return "".join(char if char.isprintable() else "?" for char in text)
