"""A scenario as it was changed in a run, as a file."""

import tomli_w

from agent_economy.runs.stepped import Stepped


def as_toml(simulation: Stepped) -> str:
    """Return a text that reads as the scenario that a run has come to.

    Of a scenario that nothing was put over, it is its own text, with all comments.
    """
    source = simulation.scenario.source
    which = f"{simulation.scenario.name}, seed {simulation.seed}, run {simulation.run}"
    lines = [
        f"From {which}, as it was at tick {simulation.tick} ({simulation.time_s:g} s).",
        *(f"Tick {tick}: {path} was changed." for tick, path, _ in simulation.changes),
    ]
    if source.files:
        lines.append(f"Beside this file must lie: {', '.join(sorted(source.files))}.")
    head = "".join(f"# {line}\n" for line in lines)
    body = tomli_w.dumps(simulation.scenario.to_dict()) if source.overrides else source.text
    return f"{head}\n{body}"
