"""How many robots, of which kinds, does this job need? Answered by fast simulation.

`classic` is the 2003 grid simulator; `Scenario` reads what a job is; `study` answers.
"""

from importlib import import_module

TYPE_CHECKING = False
if TYPE_CHECKING:
    from agent_economy import classic, study
    from agent_economy._core import InputError
    from agent_economy.brain import Brain
    from agent_economy.scenario import Scenario
    from agent_economy.study.errors import StudyError

    __version__: str

__all__ = ["Brain", "InputError", "Scenario", "StudyError", "__version__", "classic", "study"]

_HOMES = {
    "Brain": "agent_economy.brain",
    "InputError": "agent_economy._core",
    "Scenario": "agent_economy.scenario",
    "StudyError": "agent_economy.study.errors",
}


def __getattr__(name: str) -> object:
    """Load a public name when it is first used.

    numpy, pyarrow and scipy take half a second to load; the command must be able to say its
    version, and to end at Ctrl-C without a traceback, before they have.
    """
    if name == "__version__":
        return import_module("importlib.metadata").version("agent-economy")
    if name in _HOMES:
        return getattr(import_module(_HOMES[name]), name)
    if name in __all__:
        return import_module(f"agent_economy.{name}")
    message = f"module 'agent_economy' has no attribute {name!r}"
    raise AttributeError(message)
