"""Sends the progress of a study to a page that follows it."""

import asyncio
import contextlib
from pathlib import Path
from typing import Any

from agent_economy import study
from agent_economy._core import InputError
from agent_economy.server.studies.job import NO_PROGRESS
from agent_economy.server.studies.manager import StudyManager
from agent_economy.server.studies.summary import read_answer
from agent_economy.server.transport import Connection, ConnectionClosedError
from agent_economy.study.answer.labels import label
from agent_economy.study.answer.requirement_results import Status
from agent_economy.study.progress import NOTHING

MAX_STANDINGS = 50
"""Maximum number of configurations whose merit is sent."""

POLL_S = 0.2
"""Time between two looks at a study."""


async def send_progress(page: Connection, studies: StudyManager, name: str) -> None:
    """Send the progress of a study until it ends or the page disconnects."""
    tasks = {
        asyncio.create_task(send_changes(page, studies, name)),
        asyncio.create_task(wait_until_closed(page)),
    }
    try:
        done, _ = await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
        for task in done:
            with contextlib.suppress(ConnectionClosedError):
                task.result()
    finally:
        for task in tasks:
            task.cancel()
        await asyncio.wait(tasks)


async def wait_until_closed(page: Connection) -> None:
    """Wait until a page disconnects; its messages are ignored."""
    with contextlib.suppress(ConnectionClosedError):
        while True:
            await page.receive()


async def send_changes(page: Connection, studies: StudyManager, name: str) -> None:
    """Send the progress whenever it has changed, until the study is no longer running."""
    labels: list[str] | None = await asyncio.to_thread(labels_of, studies, name)
    before = None
    while True:
        now: Any = await asyncio.to_thread(progress, studies, name)
        if now != before:
            message: Any = now | {"type": "study_progress", "labels": labels}
            await page.send(message)
            labels, before = None, now
        if now["state"] != "running":
            return
        await asyncio.sleep(POLL_S)


def labels_of(studies: StudyManager, name: str) -> list[str]:
    """Return the labels of the configurations of a study; empty if its plan cannot be read."""
    try:
        return [label(values) for values in studies.plan(name).configurations]
    except InputError:
        return []


def progress(studies: StudyManager, name: str) -> dict[str, Any]:
    """Return the progress of a study."""
    job = studies.job(name)
    counts = job.progress if job else NO_PROGRESS
    try:
        row = studies.of(name)
        begun = {**NO_PROGRESS, "remaining": row["configurations"]}
        if not job:
            counts = begun
        if row["state"] != "damaged" and not (job and job.is_alive):
            counts = {**counts, **(stored(studies.folder(name)) or begun)}
        state, message = row["state"], row["message"]
    except InputError as error:
        state, message = "damaged", str(error)
    return {"state": state, "message": message, **with_rate(counts)}


def with_rate(counts: dict[str, Any]) -> dict[str, Any]:
    """Return the progress of a study with its rate."""
    seconds = counts["seconds"]
    return {**counts, "runs_per_s": counts["computed"] / seconds if seconds else 0.0}


def stored(folder: Path) -> dict[str, Any]:
    """Return the progress that a study's folder contains: after its last round, or its answer.

    The runs are all that are stored, also those of an incomplete round.

    Raises:
        InputError: If the folder is damaged.
    """
    store = study.open(folder)
    decisions = store.decisions()
    if not decisions:
        return {"runs": store.count()}
    facts = decisions[-1].facts
    answer = read_answer(folder)
    if answer:
        standings = final_standings(answer)
    else:
        standings = [stored_standing(*each) for each in facts["leaders"]]
    certified = facts.get("certified")
    return {
        "rounds": len(decisions),
        "runs": facts["runs"] if answer else store.count(),
        "remaining": facts["survivors"],
        "remaining_s": NOTHING if facts["is_over"] else None,
        "standings": standings,
        "eliminated": [row for each in decisions for row in each.facts["eliminated"]],
        "certified": None if certified is None else len(certified),
    }


def stored_standing(
    configuration: int, runs: int, merit: float, status: Status | None = None
) -> list[Any]:
    """Return a row of the standings from the ledger, which has no intervals."""
    return [configuration, runs, merit, None, None, status]


def final_standings(answer: dict[str, Any]) -> list[list[Any]]:
    """Return the best configurations that were not eliminated, with their intervals.

    With a requirement, these are the dearest of all that have runs, the cheapest first.
    """
    if "requirement" in answer:
        known = [row for row in answer["results"] if row["met"] and row["status"] != "impossible"]
        last = sorted(known, key=lambda row: row["cost"])[-MAX_STANDINGS:]
        return [standing(row, row["met"], running_status(row["status"])) for row in last]
    remaining = [
        row
        for row in answer["results"]
        if row["eliminated"] is None and row["standing"]["verdict"] != "impossible"
    ]
    best = sorted(remaining, key=lambda row: -row["merit"]["value"])[:MAX_STANDINGS]
    return [standing(row, row["merit"], None) for row in best]


def standing(row: dict[str, Any], merit: dict[str, Any], status: str | None) -> list[Any]:
    """Return a row of the standings from the answer."""
    return [row["configuration"], row["runs"], *merit.values(), status]


def running_status(status: Status) -> Status:
    """Return the status of a configuration while its study runs, which selects none."""
    return "certified" if status == "selected" else status
