"""The studies of a server: those in its folder, and those that it runs."""

import threading
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from pathlib import Path

from agent_economy import study
from agent_economy._core import InputError
from agent_economy.server.studies.job import StudyJob
from agent_economy.server.studies.summary import Summaries, of_plan
from agent_economy.server.workspace import Workspace, is_study
from agent_economy.study import Plan
from agent_economy.study.description import usual_folder
from agent_economy.study.plan import check_build, with_confidence
from agent_economy.study.store.folder import is_locked
from agent_economy.types import page

MAX_RUNNING = 2
"""Maximum number of studies that run at the same time: each uses all processors."""


class StudyManager:
    """All studies of a server; its methods may be called in any thread."""

    def __init__(self, workspace: Workspace) -> None:
        """Begin with none running."""
        self._workspace = workspace
        self._jobs: dict[str, StudyJob] = {}
        self._summaries = Summaries()
        self._lock = threading.Lock()

    def listed(self) -> list[page.StudySummary]:
        """Return all studies, the newest first."""
        rows = []
        for name, _ in self._workspace.studies():
            with suppress(InputError):  # The study has been removed meanwhile.
                rows.append(self.of(name))
        return sorted(rows, key=lambda row: (-row["changed_s"], row["id"]))

    def of(self, name: str) -> page.StudySummary:
        """Return the row of a study in the list by its id.

        Raises:
            InputError: If there is none.
        """
        job = self._jobs.get(name)
        if job and job.is_alive:
            row = of_plan(job.plan, job.progress["runs"], time.time()).listed(name)
            return {**row, "state": "running"}
        folder = self._workspace.study(name)
        row = self._summaries.of(folder).listed(name)
        if row["state"] == "damaged":
            return row
        if is_locked(folder):
            return {**row, "state": "running"}
        return {**row, "message": job.message if job else None}

    def plan(self, name: str) -> Plan:
        """Return the plan of a study.

        Raises:
            InputError: If there is no such study, or it is damaged.
        """
        job = self._jobs.get(name)
        return job.plan if job and job.is_alive else study.load_plan(self._workspace.study(name))

    def folder(self, name: str) -> Path:
        """Return the folder of a study.

        Raises:
            InputError: If there is no such study.
        """
        return self._workspace.study(name)

    def job(self, name: str) -> StudyJob | None:
        """Return the job of a study that this server has started."""
        return self._jobs.get(name)

    def id_of(self, plan: Plan) -> str:
        """Return the id of the folder of a plan's study.

        Raises:
            InputError: If that is outside of the server's folder, or cannot be read.
        """
        return self._workspace.id_of_study(usual_folder(plan, self._workspace.folder))

    def state(self, name: str) -> page.StudyState | None:
        """Return the state of a study by its id; None if there is none."""
        exists = is_study(self._workspace.folder / name)
        return self.of(name)["state"] if exists else None

    def start(self, plan: Plan) -> page.StudySummary:
        """Start or resume a study.

        Raises:
            InputError: If too many studies are running, another process runs this one, or another
                build of this program has computed its runs.
        """
        name = self.id_of(plan)
        self._begin(name, lambda: plan)
        return self.of(name)

    def resume(self, name: str, confidence: float | None) -> page.StudySummary:
        """Resume a study, with a higher confidence unless that is None.

        Raises:
            InputError: As `start` and `plan`; or if the confidence is not allowed.
        """
        folder = self._workspace.study(name)

        def resumed() -> Plan:
            plan = study.load_plan(folder)
            return plan if confidence is None else with_confidence(plan, confidence)

        self._begin(name, resumed)
        return self.of(name)

    def stop(self, name: str) -> page.StudySummary:
        """Stop a study; its runs are kept.

        Raises:
            InputError: If there is no such study, or another process runs it.
        """
        job = self._jobs.get(name)
        if job:
            job.stop()
        row = self.of(name)
        if row["state"] == "running":
            message = f"{name}: another process runs it: stop that process with Ctrl-C"
            raise InputError(message)
        return row

    def close(self) -> None:
        """Stop all running studies."""
        jobs = [job for job in self._jobs.values() if job.is_alive]
        with ThreadPoolExecutor(MAX_RUNNING) as threads:
            list(threads.map(StudyJob.stop, jobs))

    def _begin(self, name: str, plan: Callable[[], Plan]) -> None:
        folder: Path = self._workspace.folder / name
        with self._lock:
            running = [each for each, job in self._jobs.items() if job.is_alive]
            if name in running or is_locked(folder):
                message = f"{name}: is running already: stop it first, or wait for its answer"
                raise InputError(message)
            if len(running) >= MAX_RUNNING:
                message = (
                    f"{' and '.join(running)} are running, and this server runs at most "
                    f"{MAX_RUNNING} studies at a time: stop one, or wait for its answer"
                )
                raise InputError(message)
            begun = plan()
            if is_study(folder):
                # The job would refuse it too, but only after the page has its response.
                check_build(Path(name), study.open(folder).question, begun.computed_by)
            job = StudyJob(begun, folder)
            job.wait_until_begun()
            if job.message:
                raise InputError(job.message)
            self._jobs[name] = job
