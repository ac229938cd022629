"""The numbers, switches and choices of a scenario, which pages list and studies vary."""

from functools import cache
from importlib.resources import files
from typing import Any

from agent_economy import _core
from agent_economy.scenario import Scenario


def parameters(scenario: Scenario) -> list[dict[str, Any]]:
    """Return those of a scenario: see `Parameter` in `agent_economy.types.page`.

    Those of its study and of published results do not change what its runs are.
    """
    found = _core.parameters(scenario.source, schema(scenario.engine))
    return [each for each in found if each["steps"][0] not in {"study", "published"}]


@cache
def schema(engine: str) -> str:
    """Return the JSON Schema of an engine's scenarios."""
    file = files("agent_economy") / "schemas" / f"{engine}.schema.json"
    return file.read_text(encoding="utf-8")
