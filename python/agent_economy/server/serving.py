"""How the application is served, by whichever program."""

import uvicorn
from starlette.types import ASGIApp

from agent_economy.server.request_body import MAX_BYTES


def http_server(application: ASGIApp) -> uvicorn.Server:
    """Return a server of the application; run it with the sockets that it listens on."""
    config = uvicorn.Config(
        application,
        log_level="warning",
        ws="websockets-sansio",
        ws_max_size=MAX_BYTES,
        # Frames are floats, which compress badly: with 10,000 robots it took 7 ms each.
        ws_per_message_deflate=False,
        lifespan="on",
    )
    return uvicorn.Server(config)
