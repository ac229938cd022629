"""A client of the server's library, for tests."""

import json
from pathlib import Path
from typing import Any

from small_study import run_plan
from starlette.testclient import TestClient

import agent_economy as ae

Response = dict[str, Any]


TEXT = ae.Scenario.load("search").source.text


IDS = {"studies": "studies/one", "recordings": "recordings/one.mcap", "scenarios": "mine/one.toml"}


KIND_NAMES = list(IDS)


def post(client: TestClient, address: str, **body: Any) -> Response:
    response = client.post(f"/api/library/{address}", json=body)
    assert response.status_code == 200, response.text
    answer: Response = response.json()
    return answer


def refused(client: TestClient, address: str, **body: Any) -> str:
    response = client.post(f"/api/library/{address}", content=json.dumps(body))
    assert response.status_code == 422, response.text
    return " ".join(error["message"] for error in response.json()["errors"])


def listed(client: TestClient, kind: str) -> dict[str, Response]:
    rows = client.get(f"/api/library/{kind}").raise_for_status().json()["entries"]
    return {row["id"]: row for row in rows if not row["is_bundled"]}


def ids_of_page(client: TestClient, kind: str) -> set[str]:
    """Return the ids in the list of the page, without bundled scenarios."""
    rows = client.get(f"/api/{kind}").raise_for_status().json()
    rows = rows["studies"] if isinstance(rows, dict) else rows
    return {row["id"] for row in rows if row.get("where") != "bundled"}


def files_in(folder: Path) -> dict[str, bytes]:
    """Return the content of all files that are not hidden."""
    found = (file for file in folder.rglob("*") if file.is_file())
    return {
        str(file.relative_to(folder)): file.read_bytes()
        for file in found
        if not any(part.startswith(".") for part in file.relative_to(folder).parts)
    }


def make_entries(folder: Path) -> None:
    """Make one entry of each kind."""
    run_plan(folder / IDS["studies"])
    for name in ("recordings", "mine"):
        (folder / name).mkdir()
    ae.run("flock", record=folder / IDS["recordings"])
    (folder / IDS["scenarios"]).write_text(TEXT)
