"""The drive that a server belongs to: where its page finds the warden and what its map draws.

GET `/drive` is the drive as JSON, for requests with the token of the page in their address or in
the field `agent-economy-token`; `null` if the server has none. That is no error, because browsers
report errors of requests in the console of every page.
"""

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field

from starlette.responses import JSONResponse

Point = tuple[float, float]


@dataclass(frozen=True)
class Sonar:
    """A range sensor as the map draws it.

    Attributes:
        facing_deg: Its direction from the robot's heading, counterclockwise.
        max_m: Its longest range.
    """

    facing_deg: float
    max_m: float


@dataclass(frozen=True)
class RobotOnMap:
    """What the map draws of a robot besides its state.

    Attributes:
        fence_m: The corners of its fence; None if it has none.
        sonars: Its range sensors, in the order of its ranges.
    """

    fence_m: tuple[Point, ...] | None = None
    sonars: tuple[Sonar, ...] = ()


@dataclass(frozen=True)
class Drive:
    """A drive.

    Attributes:
        port: The port of the warden, on the loopback interface.
        token: The token that its requests contain.
        fleet: The name of the fleet.
        origin: Where the world lies, as in the scenario's `[world.origin]`.
        robots: What the map draws of each robot, by name.
    """

    port: int
    token: str
    fleet: str
    origin: Mapping[str, float]
    robots: Mapping[str, RobotOnMap] = field(default_factory=dict)

    @property
    def address(self) -> str:
        """The address of the warden, for pages."""
        return f"http://127.0.0.1:{self.port}"


def drive_response(drive: Drive | None) -> JSONResponse:
    """Return the response to GET `/drive`."""
    headers = {"cache-control": "no-store"}
    if drive is None:
        return JSONResponse(None, headers=headers)
    content = {
        "warden": {"port": drive.port, "token": drive.token},
        "fleet": drive.fleet,
        "origin": dict(drive.origin),
        "robots": {name: asdict(robot) for name, robot in drive.robots.items()},
    }
    return JSONResponse(content, headers=headers)
