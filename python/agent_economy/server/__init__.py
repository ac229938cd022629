"""The server of the page: it shows and changes runs and studies, which are computed elsewhere.

`app` has the addresses. A page that follows a run has a WebSocket and a connection (`runs`); the
messages are those of `agent_economy.types.page`. `guard` rejects requests of other sites.
"""

from agent_economy.server.app import app
from agent_economy.server.workspace import Workspace

__all__ = ["Workspace", "app"]
