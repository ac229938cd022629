"""Opens the run that a page requests."""

from agent_economy.build import Build
from agent_economy.runs.stepped import Change
from agent_economy.scenario import Scenario
from agent_economy.server.recordings.store import RecordingStore
from agent_economy.server.runs.timeline import Timeline
from agent_economy.server.workspace import Workspace
from agent_economy.types.page import Open


def open_timeline(workspace: Workspace, message: Open) -> tuple[Timeline, Build | None]:
    """Return a run at its beginning; of a recorded run also the build that recorded it.

    Raises:
        InputError: If there is no such scenario or recording, it has errors, or the world has no
            room for the team.
    """
    log = None if message.changes is None else [Change(*each) for each in message.changes]
    if message.recording is not None:
        identity, recorded = RecordingStore(workspace).load(message.recording)
        timeline = Timeline(identity.scenario, identity.seed, identity.run, log, recorded)
        return timeline, identity.build
    scenario, seed = scenario_and_seed(workspace, message)
    return Timeline(scenario, seed, int(message.run or 0), log), None


def scenario_and_seed(workspace: Workspace, message: Open) -> tuple[Scenario, int]:
    """Return the scenario to run, and the seed."""
    if message.study is not None:
        scenario, seed = workspace.member(message.study.id, message.study.configuration)
        return scenario, seed if message.seed is None else int(message.seed)
    seed = int(message.seed or 0)
    if message.scenario is not None:
        return workspace.load(message.scenario), seed
    return workspace.read(message.text or ""), seed
