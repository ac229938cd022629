"""The safety rules, as a pure function of what is known and requested: see docs/safety.md."""

from agent_economy.live.rules.faults import FAULTS, Clears, Fault, InManual
from agent_economy.live.rules.interface import (
    Action,
    Decision,
    Inputs,
    Link,
    LoopInputs,
    Mode,
    Outputs,
    Requests,
    RobotInputs,
    Sample,
    Setpoint,
    Unseen,
)
from agent_economy.live.rules.memory import Memory
from agent_economy.live.rules.rules import initial, update

__all__ = [
    "FAULTS",
    "Action",
    "Clears",
    "Decision",
    "Fault",
    "InManual",
    "Inputs",
    "Link",
    "LoopInputs",
    "Memory",
    "Mode",
    "Outputs",
    "Requests",
    "RobotInputs",
    "Sample",
    "Setpoint",
    "Unseen",
    "initial",
    "update",
]
