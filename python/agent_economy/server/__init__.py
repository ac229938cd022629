"""The server of the page: it shows runs and changes them; what it shows is computed elsewhere.

A page opens one WebSocket; behind it is a `Session` with one `Timeline`, a run that can be gone
back and forth in. `messages` says what they say to each other, `guard` who may.
"""

from agent_economy.server.app import app
from agent_economy.server.workspace import Workspace

__all__ = ["Workspace", "app"]
