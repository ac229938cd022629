"""How many robots, of which kinds, does a job need? The answer comes from fast simulation.

`Scenario` describes the job; `run`, `replicate` and `Simulation` simulate it; `study` selects the
best team. `ClassicSimulation` runs the 2003 grid simulator.
"""

from importlib import import_module

TYPE_CHECKING = False
if TYPE_CHECKING:
    from agent_economy import study
    from agent_economy._core import InputError
    from agent_economy.api import replicate, run
    from agent_economy.live.replay import replay
    from agent_economy.recording import Recording, Replay
    from agent_economy.runs.batch import Batch
    from agent_economy.runs.brain import Brain
    from agent_economy.runs.classic_simulation import ClassicSimulation
    from agent_economy.runs.controller import Controller
    from agent_economy.runs.external import ExternalBody
    from agent_economy.runs.outcome import Outcome
    from agent_economy.runs.simulation import Simulation
    from agent_economy.scenario import Scenario
    from agent_economy.study.errors import StudyError

    __version__: str

__all__ = [
    "Batch",
    "Brain",
    "ClassicSimulation",
    "Controller",
    "ExternalBody",
    "InputError",
    "Outcome",
    "Recording",
    "Replay",
    "Scenario",
    "Simulation",
    "StudyError",
    "__version__",
    "replay",
    "replicate",
    "run",
    "study",
]

_HOMES = {
    "Batch": "agent_economy.runs.batch",
    "Brain": "agent_economy.runs.brain",
    "ClassicSimulation": "agent_economy.runs.classic_simulation",
    "Controller": "agent_economy.runs.controller",
    "ExternalBody": "agent_economy.runs.external",
    "InputError": "agent_economy._core",
    "Outcome": "agent_economy.runs.outcome",
    "Recording": "agent_economy.recording",
    "Replay": "agent_economy.recording",
    "Scenario": "agent_economy.scenario",
    "Simulation": "agent_economy.runs.simulation",
    "StudyError": "agent_economy.study.errors",
    "replay": "agent_economy.live.replay",
    "replicate": "agent_economy.api",
    "run": "agent_economy.api",
}


def __getattr__(name: str) -> object:
    """Load a public name when it is first used.

    numpy, pyarrow and scipy take half a second to load. Before that, the command line must be able
    to print its version, and to stop at Ctrl-C without a traceback.
    """
    if name == "__version__":
        return import_module("importlib.metadata").version("agent-economy")
    if name in _HOMES:
        return getattr(import_module(_HOMES[name]), name)
    if name in __all__:
        return import_module(f"agent_economy.{name}")
    message = f"module 'agent_economy' has no attribute {name!r}"
    raise AttributeError(message)


def __dir__() -> list[str]:
    """Return the public names, also those that are not loaded yet."""
    return sorted(__all__)
