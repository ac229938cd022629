"""The studies of a server: those in its folder, and those that it has at work."""

import threading
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

from agent_economy import study
from agent_economy._core import InputError
from agent_economy.server.studies.job import StudyJob
from agent_economy.server.studies.summary import Summaries, of_plan
from agent_economy.server.workspace import Workspace, is_study
from agent_economy.study import Plan
from agent_economy.study.plan import with_confidence
from agent_economy.study.question import usual_folder
from agent_economy.study.store.folder import disk_errors, is_locked

MAX_AT_WORK = 2
"""StudyManager at work at a time: each uses all processors."""


class StudyManager:
    """All studies of a server; its methods may be called in any thread."""

    def __init__(self, places: Workspace) -> None:
        """Begin with none at work."""
        self._places = places
        self._works: dict[str, StudyJob] = {}
        self._summaries = Summaries()
        self._lock = threading.Lock()

    def listed(self) -> list[dict[str, Any]]:
        """Return all studies, the newest first."""
        rows = [self.of(name) for name, _ in self._places.studies()]
        return sorted(rows, key=lambda row: (-row["changed_s"], row["id"]))

    def of(self, name: str) -> dict[str, Any]:
        """Return a study by its id, as a page takes it.

        Raises:
            InputError: If there is none.
        """
        work = self._works.get(name)
        if work and work.is_alive:
            row = of_plan(work.plan, work.said["runs"], time.time()).listed(name)
            return {**row, "state": "running"}
        folder = self._places.study(name)
        row = self._summaries.of(folder).listed(name)
        if row["state"] == "damaged":
            return row
        if is_locked(folder):
            return {**row, "state": "running"}
        return {**row, "message": work.message if work else None}

    def plan(self, name: str) -> Plan:
        """Return what a study asks.

        Raises:
            InputError: If there is no such study, or it is damaged.
        """
        work = self._works.get(name)
        return work.plan if work and work.is_alive else study.load_plan(self._places.study(name))

    def folder(self, name: str) -> Path:
        """Return the folder of a study.

        Raises:
            InputError: If there is no such study.
        """
        return self._places.study(name)

    def work(self, name: str) -> StudyJob | None:
        """Return a study that this server has, or had, at work."""
        return self._works.get(name)

    def id_of(self, plan: Plan) -> str:
        """Return the id of the folder that a plan's study is kept in.

        Raises:
            InputError: If that is outside of the server's folder, or cannot be read.
        """
        with disk_errors(self._places.folder, "read"):
            return self._places.id_of_study(usual_folder(plan, self._places.folder))

    def state(self, name: str) -> str | None:
        """Return the state of the study that has an id, None if there is none."""
        is_there = is_study(self._places.folder / name)
        return str(self.of(name)["state"]) if is_there else None

    def start(self, plan: Plan) -> dict[str, Any]:
        """Begin a study, or go on with it.

        Raises:
            InputError: If too many are at work, or another process works on it.
        """
        name = self.id_of(plan)
        self._begin(name, lambda: plan)
        return self.of(name)

    def resume(self, name: str, confidence: float | None) -> dict[str, Any]:
        """Go on with a study, or tighten it.

        Raises:
            InputError: As `start` and `plan`; or if the confidence is not allowed.
        """
        folder = self._places.study(name)

        def wanted() -> Plan:
            plan = study.load_plan(folder)
            return plan if confidence is None else with_confidence(plan, confidence)

        self._begin(name, wanted)
        return self.of(name)

    def stop(self, name: str) -> dict[str, Any]:
        """Stop a study; its runs are kept.

        Raises:
            InputError: If there is no such study, or another process works on it.
        """
        work = self._works.get(name)
        if work:
            work.stop()
        row = self.of(name)
        if row["state"] == "running":
            message = f"{name}: another process works on it: stop it there, with Ctrl-C"
            raise InputError(message)
        return row

    def close(self) -> None:
        """Stop all that are at work."""
        works = [work for work in self._works.values() if work.is_alive]
        with ThreadPoolExecutor(MAX_AT_WORK) as threads:
            list(threads.map(StudyJob.stop, works))

    def _begin(self, name: str, wanted: Callable[[], Plan]) -> None:
        folder: Path = self._places.folder / name
        with self._lock:
            at_work = [each for each, work in self._works.items() if work.is_alive]
            if name in at_work or is_locked(folder):
                message = f"{name}: is being worked on: stop it first, or wait for its answer"
                raise InputError(message)
            if len(at_work) >= MAX_AT_WORK:
                message = (
                    f"{' and '.join(at_work)} are running, and this server runs {MAX_AT_WORK} "
                    "studies at a time: stop one, or wait for its answer"
                )
                raise InputError(message)
            work = StudyJob(wanted(), folder)
            work.wait_until_begun()
            if work.message:
                raise InputError(work.message)
            self._works[name] = work
