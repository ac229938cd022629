"""The addresses of studies; a study's id is its folder below the server's, as `studies/classic`.

POST `/api/factors`: what a study of a scenario can vary. `/api/plan`: what a study would compare.
`/api/studies`: start or resume a study. The body of these three is read by `requests`.
POST `/api/studies/stop`: `id`. `/api/studies/resume`: `id`, and a higher `confidence` or null.
GET `/api/studies`: all studies, the newest first. `/api/study?id=`: one with its plan and answer.
`/api/study/question?id=`: its question, with all values of its scenario.
`/api/study/report?id=` and `/api/study/answer?id=`: its files.
`/api/study/runs?id=&configuration=`: its runs, `first` and `count`, or a `sample` of them from the
worst to the best, or the `median`.
The response to a request with errors is `errors`, with status 422.
"""

import asyncio
from collections.abc import Callable, Coroutine, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from starlette.requests import Request
from starlette.responses import FileResponse, JSONResponse, Response
from starlette.routing import Route

from agent_economy import _core
from agent_economy._core import InputError
from agent_economy.scenario import Scenario, bundled
from agent_economy.scenario.validation import check
from agent_economy.server.messages import number
from agent_economy.server.request_body import (
    RequestBodyError,
    error_response,
    errors_response,
    json_object,
)
from agent_economy.server.studies import requests, run_rows
from agent_economy.server.studies.detail import AnswerCache
from agent_economy.server.studies.factors import described
from agent_economy.server.studies.manager import StudyManager
from agent_economy.server.studies.requests import StudyRequestError
from agent_economy.server.workspace import Workspace
from agent_economy.study.store.folder import ANSWER, REPORT
from agent_economy.types import page

DEFAULT_COUNT = "500"
"""Number of runs in a response, by default."""

Handler = Callable[[Any], Response]
"""Returns a response; it runs in a thread, since it reads files and computes."""


@dataclass(frozen=True)
class Routes:
    """The addresses of studies."""

    studies: StudyManager
    workspace: Workspace
    answers: AnswerCache = field(default_factory=AnswerCache)

    def all(self) -> list[Route]:
        """Return all routes."""
        return [
            Route("/api/factors", post(self.factors), methods=["POST"]),
            Route("/api/plan", post(self.plan), methods=["POST"]),
            Route("/api/studies", get(self.listed), methods=["GET"]),
            Route("/api/studies", post(self.start), methods=["POST"]),
            Route("/api/studies/stop", post(self.stop), methods=["POST"]),
            Route("/api/studies/resume", post(self.resume), methods=["POST"]),
            Route("/api/study", get(self.study)),
            Route("/api/study/question", get(self.question)),
            Route("/api/study/runs", get(self.runs)),
            Route("/api/study/report", get(lambda query: self.file(query, REPORT))),
            Route("/api/study/answer", get(lambda query: self.file(query, ANSWER))),
        ]

    def factors(self, body: dict[str, Any]) -> Response:
        """Return what a study of a scenario can vary."""
        return JSONResponse(described(requests.scenario_of(body, self.workspace)))

    def plan(self, body: dict[str, Any]) -> Response:
        """Return what a study would compare."""
        plan = requests.plan(body, self.workspace)
        name = self.studies.id_of(plan)
        return JSONResponse(requests.planned(plan, name, self.studies.state(name)))

    def listed(self, _: dict[str, str]) -> Response:
        """Return all studies."""
        found: page.StudyList = {"studies": self.studies.listed()}
        return JSONResponse(found)

    def start(self, body: dict[str, Any]) -> Response:
        """Start or resume a study."""
        return JSONResponse(self.studies.start(requests.plan(body, self.workspace)), 201)

    def stop(self, body: dict[str, Any]) -> Response:
        """Stop a study."""
        return JSONResponse(self.studies.stop(id_of(body)))

    def resume(self, body: dict[str, Any]) -> Response:
        """Resume a study, or raise its confidence."""
        return JSONResponse(self.studies.resume(id_of(body), body.get("confidence")))

    def study(self, query: dict[str, str]) -> Response:
        """Return a study with its answer, if it has one."""
        return JSONResponse(self.found(id_of(query)))

    def found(self, name: str) -> page.Study:
        """Return a study by its id."""
        row, plan = self.studies.of(name), self.studies.plan(name)
        return {
            **row,
            "planned": requests.planned(plan, name, row["state"]),
            "source": {"scenario": gallery_id(plan.scenario, self.workspace)},
            "answer": self.answers.of(self.studies.folder(name)),
        }

    def question(self, query: dict[str, str]) -> Response:
        """Return the question of a study with all its values, as one document to compare."""
        name = id_of(query)
        plan = self.studies.plan(name)
        planned: Mapping[str, Any] = requests.planned(plan, name, None)
        own = ("merit", "delta", "guarantee", "requirement", "factors", "configurations")
        return JSONResponse(
            {
                **{key: planned[key] for key in own},
                "confidence": plan.confidence,
                "seed": str(plan.seed),
                "runs_per_configuration": plan.runs,
                "run_budget": plan.max_runs,
                "scenario": _core.read_filled(plan.scenario.source),
            }
        )

    def runs(self, query: dict[str, str]) -> Response:
        """Return runs of a configuration of a study."""
        name = id_of(query)
        plan, folder = self.studies.plan(name), self.studies.folder(name)
        configuration = number("configuration", query.get("configuration"))
        if "sample" in query:
            sample = number("sample", query["sample"])
            return JSONResponse(run_rows.sampled(plan, folder, configuration, sample))
        if "median" in query:
            return JSONResponse(run_rows.median(plan, folder, configuration))
        first = number("first", query.get("first", "0"))
        count = number("count", query.get("count", DEFAULT_COUNT))
        return JSONResponse(run_rows.listed(plan, folder, configuration, first, count))

    def file(self, query: dict[str, str], name: str) -> Response:
        """Return a file of a study as a download."""
        file = self.studies.folder(id_of(query)) / name
        check(file.is_file(), "id", query["id"], f"a study that has its {name}")
        return FileResponse(file, filename=f"{file.parent.name}-{name}")


def id_of(request: dict[str, Any]) -> str:
    """Return the id of the study that a request names.

    Raises:
        InputError: If it names none.
    """
    name = request.get("id")
    check(isinstance(name, str), "id", name, "the id of a study, as a string")
    return str(name)


def gallery_id(scenario: Scenario, workspace: Workspace) -> str | None:
    """Return the id in the gallery of the scenario of a study; None if it is gone.

    A study keeps the text of its scenario and the name of its file, but not the folder.
    """
    file = Path(scenario.source.file)
    builtin = [scenario.name] if scenario.name in bundled.scenarios() else []
    for name in (*builtin, file.name):
        try:
            if workspace.text(name) == scenario.source.text:
                return name
        except InputError:
            continue
    return None


def post(handler: Handler) -> Callable[[Request], Coroutine[Any, Any, Response]]:
    """Return the endpoint that passes the JSON object in the body to a handler."""

    async def respond(request: Request) -> Response:
        try:
            body = await json_object(request)
        except RequestBodyError as error:
            return error.response
        return await handled(handler, body)

    return respond


def get(handler: Handler) -> Callable[[Request], Coroutine[Any, Any, Response]]:
    """Return the endpoint that passes the query to a handler."""

    async def respond(request: Request) -> Response:
        return await handled(handler, dict(request.query_params))

    return respond


async def handled(handler: Handler, request: dict[str, Any]) -> Response:
    """Return the response of a handler, or the errors of the request."""
    try:
        return await asyncio.to_thread(handler, request)
    except StudyRequestError as error:
        return errors_response(error.errors, error.total)
    except InputError as error:
        return error_response(error)
