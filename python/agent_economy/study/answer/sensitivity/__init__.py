"""Sensitivity analysis: how much of the merit's variance each factor explains.

`statement` states the shares; `means` has the means with their errors, which `grid` or `expansion`
decomposes into components, and `components` makes shares with intervals of these.
"""

from agent_economy.study.answer.sensitivity.statement import Influence, Sensitivity, sensitivity

__all__ = ["Influence", "Sensitivity", "sensitivity"]
