"""What is fixed while the emulator runs."""

from dataclasses import dataclass
from pathlib import Path

from agent_economy.live.emulator.faults import PORTS
from agent_economy.scenario import Scenario, validation

STRIDE = 10
"""Distance between the port numbers of two robots."""

MAX_ROBOTS = 100
HIGHEST_PORT = 65_535


@dataclass(frozen=True)
class Setup:
    """What is fixed while the emulator runs.

    Attributes:
        host: Name or address to listen on.
        ports: Ports of the motors, compass, GPS and sonars of robot 0; 0 for any free port. Those
            of each next robot are 10 higher.
        robots: Number of robots.
        scenario: The scenario, its file, or the name of a bundled one.
        control: The control port; 0 for any free port.
        log: A file that is replaced by the log.
        seed: Seed of all random numbers.
    """

    host: str = "127.0.0.1"
    ports: tuple[int, ...] = (0, 0, 0, 0)
    robots: int = 1
    scenario: Scenario | str | Path = "bender"
    control: int = 0
    log: Path | None = None
    seed: int = 0

    def check(self) -> None:
        """Check the numbers.

        Raises:
            InputError: If one is not allowed.
        """
        validation.whole("robots", self.robots, 1, MAX_ROBOTS)
        highest = HIGHEST_PORT - STRIDE * (self.robots - 1)
        is_allowed = len(self.ports) == len(PORTS) and all(
            validation.is_whole(each, 0, highest) for each in self.ports
        )
        allowed = f"four whole numbers from 0 to {highest}; 0 for any free port"
        validation.check(is_allowed, "ports", list(self.ports), allowed)
        validation.whole("control", self.control, 0, HIGHEST_PORT)
        validation.whole("seed", self.seed, 0, 2**64 - 1)

    def numbers(self, robot: int) -> dict[str, int]:
        """Return the port numbers of a robot; 0 for any free one."""
        numbers = (number and number + STRIDE * robot for number in self.ports)
        return dict(zip(PORTS, numbers, strict=True))
