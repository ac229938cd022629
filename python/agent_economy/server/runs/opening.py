"""Opens the run that a page requests."""

from agent_economy.scenario import Scenario
from agent_economy.server.messages import Open
from agent_economy.server.recordings.store import RecordingStore
from agent_economy.server.runs.timeline import Timeline
from agent_economy.server.workspace import Workspace


def open_timeline(workspace: Workspace, message: Open) -> tuple[Timeline, str | None]:
    """Return a run at its beginning; of a recorded run also the version that recorded it.

    Raises:
        InputError: If there is no such scenario or recording, it has errors, or the world has no
            room for the team.
    """
    if message.recording is not None:
        identity, recorded = RecordingStore(workspace).load(message.recording)
        timeline = Timeline(
            identity.scenario, identity.seed, identity.run, message.changes, recorded
        )
        return timeline, identity.program
    scenario, seed = scenario_and_seed(workspace, message)
    return Timeline(scenario, seed, message.run, message.changes), None


def scenario_and_seed(workspace: Workspace, message: Open) -> tuple[Scenario, int]:
    """Return the scenario to run, and the seed."""
    if message.study is not None:
        scenario, seed = workspace.member(message.study.id, message.study.configuration)
        return scenario, seed if message.seed is None else message.seed
    if message.scenario is not None:
        return workspace.load(message.scenario), message.seed or 0
    return workspace.read(message.text or ""), message.seed or 0
