"""A drive that takes requests, without the server of a page: it saves its time.

It is a program with the arguments of `agent-economy`.
"""

from collections.abc import Sequence

from agent_economy.cli import app
from agent_economy.live.plan import FleetPlan
from agent_economy.live.warden.warden import Warden

load = Warden.load


async def load_without_page(warden: Warden, arguments: Sequence[str]) -> FleetPlan | None:
    """Start the loop of a drive without what a page needs."""
    return await load(warden, [each for each in arguments if each != "--page"])


if __name__ == "__main__":
    Warden.load = load_without_page  # type: ignore[method-assign,assignment]
    app()
