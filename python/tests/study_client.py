"""A client of the server's studies, for tests."""

import json
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from page_client import OWN, WS
from starlette.testclient import TestClient

from agent_economy.server import Workspace, app

Response = dict[str, Any]


class Folder:
    """A server's folder, and a client of its studies."""

    def __init__(self, client: TestClient, path: Path) -> None:
        """Keep the client and the folder."""
        self.client, self.path = client, path
        self.progress: list[Response] = []

    def post(self, address: str, **body: Any) -> Response:
        """Post a request, and return the response."""
        response = self.client.post(address, json=body)
        assert response.status_code in (200, 201), response.text
        answer: Response = response.json()
        return answer

    def get(self, address: str, **query: Any) -> Response:
        """Return the response of an address."""
        response = self.client.get(address, params=query)
        assert response.status_code == 200, response.text
        answer: Response = response.json()
        return answer

    def refused(self, address: str, **body: Any) -> list[Response]:
        """Post a request that is refused, and return its errors."""
        response = self.client.post(address, json=body)
        assert response.status_code == 422
        errors: list[Response] = response.json()["errors"]
        return errors

    def watched(self, name: str, runs: float = float("inf")) -> list[Response]:
        """Follow a study until its end, or until it has this number of runs."""
        received: list[Response] = []
        with self.client.websocket_connect(f"{WS}?study={name}") as socket:
            while not received or received[-1]["runs"] < runs:
                message = socket.receive()
                if message["type"] == "websocket.close":
                    assert message["code"] == 1000
                    break
                received.append(json.loads(message["text"]))
        return received


@contextmanager
def served(path: Path) -> Iterator[Folder]:
    with TestClient(app(Workspace(path), "127.0.0.1"), OWN) as client:
        yield Folder(client, path)
