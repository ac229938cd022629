"""What can be asked about studies, by address."""

import asyncio
from collections.abc import Callable, Coroutine
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from starlette.requests import Request
from starlette.responses import FileResponse, JSONResponse, Response
from starlette.routing import Route

from agent_economy._core import InputError
from agent_economy.scenario import Scenario, bundled
from agent_economy.scenario.validation import check
from agent_economy.server.messages import faults_of, number
from agent_economy.server.request_body import RequestBodyError, asked, refused
from agent_economy.server.studies import requests, run_rows
from agent_economy.server.studies.detail import AnswerCache
from agent_economy.server.studies.factors import described
from agent_economy.server.studies.manager import StudyManager
from agent_economy.server.studies.requests import StudyRequestError
from agent_economy.server.workspace import Workspace
from agent_economy.study.store.folder import ANSWER, REPORT

USUAL_COUNT = "500"
"""Runs that are told if nobody says how many."""

Work = Callable[[Any], Response]
"""What answers: in a thread, since it reads files and computes."""


@dataclass(frozen=True)
class Routes:
    """The addresses of studies."""

    studies: StudyManager
    places: Workspace
    answers: AnswerCache = field(default_factory=AnswerCache)

    def all(self) -> list[Route]:
        """Return them."""
        return [
            Route("/api/factors", posted(self.factors), methods=["POST"]),
            Route("/api/plan", posted(self.plan), methods=["POST"]),
            Route("/api/studies", got(self.listed), methods=["GET"]),
            Route("/api/studies", posted(self.start), methods=["POST"]),
            Route("/api/studies/stop", posted(self.stop), methods=["POST"]),
            Route("/api/studies/resume", posted(self.resume), methods=["POST"]),
            Route("/api/study", got(self.study)),
            Route("/api/study/runs", got(self.runs)),
            Route("/api/study/report", got(lambda told: self.file(told, REPORT))),
            Route("/api/study/answer", got(lambda told: self.file(told, ANSWER))),
        ]

    def factors(self, said: dict[str, Any]) -> Response:
        """Return what can be varied in a scenario."""
        return JSONResponse(described(requests.scenario_of(said, self.places)))

    def plan(self, said: dict[str, Any]) -> Response:
        """Return what a study would compare."""
        plan = requests.plan(said, self.places)
        name = self.studies.id_of(plan)
        return JSONResponse(requests.planned(plan, name, self.studies.state(name)))

    def listed(self, _: dict[str, str]) -> Response:
        """Return all studies."""
        return JSONResponse({"studies": self.studies.listed()})

    def start(self, said: dict[str, Any]) -> Response:
        """Begin a study, or go on with it."""
        return JSONResponse(self.studies.start(requests.plan(said, self.places)), 201)

    def stop(self, said: dict[str, Any]) -> Response:
        """Stop a study."""
        return JSONResponse(self.studies.stop(id_of(said)))

    def resume(self, said: dict[str, Any]) -> Response:
        """Go on with a study, or tighten it."""
        return JSONResponse(self.studies.resume(id_of(said), said.get("confidence")))

    def study(self, told: dict[str, str]) -> Response:
        """Return a study with its answer, if it has one."""
        name = id_of(told)
        row, plan = self.studies.of(name), self.studies.plan(name)
        return JSONResponse(
            {
                **row,
                "planned": requests.planned(plan, name, row["state"]),
                "source": {"scenario": gallery_id(plan.scenario, self.places)},
                "answer": self.answers.of(self.studies.folder(name)),
            }
        )

    def runs(self, told: dict[str, str]) -> Response:
        """Return runs of a configuration of a study."""
        name = id_of(told)
        plan, folder = self.studies.plan(name), self.studies.folder(name)
        configuration = number("configuration", told.get("configuration"))
        if "sample" in told:
            sample = number("sample", told["sample"])
            return JSONResponse(run_rows.sampled(plan, folder, configuration, sample))
        first = number("first", told.get("first", "0"))
        count = number("count", told.get("count", USUAL_COUNT))
        return JSONResponse(run_rows.listed(plan, folder, configuration, first, count))

    def file(self, told: dict[str, str], name: str) -> Response:
        """Return a file of a study, to be kept."""
        file = self.studies.folder(id_of(told)) / name
        check(file.is_file(), "id", told["id"], f"a study that has its {name}")
        return FileResponse(file, filename=f"{file.parent.name}-{name}")


def id_of(told: dict[str, Any]) -> str:
    """Return the id of a study that a page names.

    Raises:
        InputError: If it names none.
    """
    name = told.get("id")
    check(isinstance(name, str), "id", name, "the id of a study, as a text")
    return str(name)


def gallery_id(scenario: Scenario, places: Workspace) -> str | None:
    """Return the id in the gallery of the scenario that a study was asked of; None if it is gone.

    A study keeps the text of its scenario, and the name of its file: no folder.
    """
    file = Path(scenario.source.file)
    shipping = [scenario.name] if scenario.name in bundled.scenarios() else []
    for name in (*shipping, file.name):
        try:
            if places.text(name) == scenario.source.text:
                return name
        except InputError:
            continue
    return None


def posted(work: Work) -> Callable[[Request], Coroutine[Any, Any, Response]]:
    """Return what answers to an object that is sent."""

    async def answer(request: Request) -> Response:
        try:
            said = await asked(request)
        except RequestBodyError as error:
            return error.response
        return await answered(work, said)

    return answer


def got(work: Work) -> Callable[[Request], Coroutine[Any, Any, Response]]:
    """Return what answers to an address."""

    async def answer(request: Request) -> Response:
        return await answered(work, dict(request.query_params))

    return answer


async def answered(work: Work, told: dict[str, Any]) -> Response:
    """Return the answer, or what is wrong with what is asked."""
    try:
        return await asyncio.to_thread(work, told)
    except StudyRequestError as error:
        return refused(error.faults)
    except InputError as error:
        return refused(faults_of(error))
