"""How many robots, of which kinds, does this job need? Answered by fast simulation.

`classic` is the 2003 grid simulator; `Scenario` reads what a job is; `study` answers.
"""

from importlib.metadata import version

from agent_economy import classic, study
from agent_economy._core import InputError
from agent_economy.scenario import Scenario

__version__ = version("agent-economy")

__all__ = ["InputError", "Scenario", "__version__", "classic", "study"]
