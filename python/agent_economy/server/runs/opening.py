"""Beginning the run that a page asks for."""

from agent_economy.scenario import Scenario
from agent_economy.server.messages import Open
from agent_economy.server.recordings.store import RecordingStore
from agent_economy.server.runs.timeline import Timeline
from agent_economy.server.workspace import Workspace


def begun(places: Workspace, said: Open) -> tuple[Timeline, str | None]:
    """Return a run at its beginning, and the version that recorded it if a recording is asked for.

    Raises:
        InputError: If there is no such scenario or recording, it is wrong, or has no room.
    """
    if said.recording is not None:
        which, recorded = RecordingStore(places).load(said.recording)
        timeline = Timeline(which.scenario, which.seed, which.run, said.changes, recorded)
        return timeline, which.program
    scenario, seed = what(places, said)
    return Timeline(scenario, seed, said.run, said.changes), None


def what(places: Workspace, said: Open) -> tuple[Scenario, int]:
    """Return the scenario to run, and the seed."""
    if said.study is not None:
        scenario, seed = places.member(said.study.id, said.study.configuration)
        return scenario, seed if said.seed is None else said.seed
    if said.scenario is not None:
        return places.load(said.scenario), said.seed or 0
    return places.read(said.text or ""), said.seed or 0
