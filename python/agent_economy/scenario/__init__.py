"""Scenarios: what a job is, read from TOML and checked as a whole.

`scenario` is the object that everything else takes, `source` the text and files it was read from,
`merit` its figure of merit, `requirement` what a mission must meet, `warning` what is allowed and
probably not meant, `bundled` the scenarios that ship with the package, and `validation` checks the
arguments of public functions.
"""

from agent_economy.scenario.requirement import Condition, Requirement
from agent_economy.scenario.scenario import Factor, Published, Scenario, as_scenario
from agent_economy.scenario.source import Override, Source, TomlValue, Value
from agent_economy.scenario.warning import ScenarioWarning, warnings

__all__ = [
    "Condition",
    "Factor",
    "Override",
    "Published",
    "Requirement",
    "Scenario",
    "ScenarioWarning",
    "Source",
    "TomlValue",
    "Value",
    "as_scenario",
    "warnings",
]
