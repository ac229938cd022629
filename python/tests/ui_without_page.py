"""The command `ui` that serves also if the page has not been built: its tests need no Node.

It is a program with the arguments of `agent-economy`.
"""

from agent_economy.cli import app, ui

if __name__ == "__main__":
    ui.missing_page = lambda: None  # type: ignore[attr-defined,assignment,misc]
    app()
