"""How a study goes on, told to a page that watches it."""

import asyncio
import contextlib
from pathlib import Path
from typing import Any

from agent_economy import study
from agent_economy._core import InputError
from agent_economy.server.studies.job import NOTHING
from agent_economy.server.studies.manager import StudyManager
from agent_economy.server.studies.summary import read_answer
from agent_economy.server.transport import Connection, ConnectionClosedError
from agent_economy.study.answer.labels import label

MAX_STANDINGS = 50
"""Configurations that are told with their merit."""

LOOK_S = 0.2
"""Between two looks at a study, and two tellings, at least."""


async def watch(page: Connection, studies: StudyManager, name: str) -> None:
    """Tell a page how a study goes on, until it ends or the page has gone."""
    tasks = {asyncio.create_task(tell(page, studies, name)), asyncio.create_task(hear(page))}
    try:
        done, _ = await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
        for task in done:
            with contextlib.suppress(ConnectionClosedError):
                task.result()
    finally:
        for task in tasks:
            task.cancel()
        await asyncio.wait(tasks)


async def hear(page: Connection) -> None:
    """Wait until a page has gone: what it says is not listened to."""
    with contextlib.suppress(ConnectionClosedError):
        while True:
            await page.receive()


async def tell(page: Connection, studies: StudyManager, name: str) -> None:
    """Tell a page what has changed, until the study does not go on."""
    labels: list[str] | None = await asyncio.to_thread(labels_of, studies, name)
    before = None
    while True:
        now = await asyncio.to_thread(seen, studies, name)
        if now != before:
            await page.send({"type": "studying", **now, "labels": labels})
            labels, before = None, now
        if now["state"] != "running":
            return
        await asyncio.sleep(LOOK_S)


def labels_of(studies: StudyManager, name: str) -> list[str]:
    """Return what the configurations of a study are called; nothing if nobody can say."""
    try:
        return [label(values) for values in studies.plan(name).configurations]
    except InputError:
        return []


def seen(studies: StudyManager, name: str) -> dict[str, Any]:
    """Return how far a study is."""
    work = studies.work(name)
    said = work.said if work else NOTHING
    try:
        row = studies.of(name)
        begun = {**NOTHING, "survivors": row["configurations"]}
        if not work:
            said = begun
        if row["state"] != "damaged" and not (work and work.is_alive):
            said = {**said, **(stored(studies.folder(name)) or begun)}
    except InputError as error:
        row = {"state": "damaged", "message": str(error)}
    return {"state": row["state"], "message": row["message"], **rates(said)}


def rates(said: dict[str, Any]) -> dict[str, Any]:
    """Return how far a study is, with how fast it is."""
    seconds, left = said["seconds"], said["left_runs"]
    rate = said["computed"] / seconds if seconds else 0.0
    left_s = left / rate if rate and left is not None else None
    return {**said, "runs_per_s": rate, "left_s": left_s}


def stored(folder: Path) -> dict[str, Any]:
    """Return how far a study is as its folder has it: after its last round, or with its answer.

    Returns:
        Nothing before its first round is over.

    Raises:
        InputError: If it is damaged.
    """
    decisions = study.open(folder).decisions()
    if not decisions:
        return {}
    facts = decisions[-1].facts
    answer = read_answer(folder)
    if answer:
        standings = answered(answer)
    else:
        standings = [[*leader, None, None] for leader in facts["leaders"]]
    return {
        "round": len(decisions),
        "runs": facts["runs"],
        "survivors": facts["survivors"],
        "left_runs": None,
        "standings": standings,
        "eliminated": [row for each in decisions for row in each.facts["eliminated"]],
    }


def answered(answer: dict[str, Any]) -> list[list[Any]]:
    """Return the best that were never put out, with their ranges, as an answer has them."""
    left = [row for row in answer["results"] if row["eliminated"] is None]
    best = sorted(left, key=lambda row: -row["merit"]["value"])[:MAX_STANDINGS]
    return [[row["configuration"], row["runs"], *row["merit"].values()] for row in best]
