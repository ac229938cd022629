"""Exports the scenario of a run, with its changes, as a file."""

import tomli_w

from agent_economy.runs.stepped import Stepped


def as_toml(simulation: Stepped) -> str:
    """Return the current scenario of a run as TOML.

    A scenario without overrides keeps its own text, with all comments.
    """
    source = simulation.scenario.source
    which = f"{simulation.scenario.name}, seed {simulation.seed}, run {simulation.run}"
    lines = [
        f"From {which}, at tick {simulation.tick} ({simulation.time_s:g} s).",
        *(f"Tick {tick}: {path} was changed." for tick, path, _ in simulation.changes),
    ]
    if source.files:
        lines.append(f"This file needs in the same folder: {', '.join(sorted(source.files))}.")
    head = "".join(f"# {line}\n" for line in lines)
    body = tomli_w.dumps(simulation.scenario.to_dict()) if source.overrides else source.text
    return f"{head}\n{body}"
