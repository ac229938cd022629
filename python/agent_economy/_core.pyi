from collections.abc import Callable, Mapping, Sequence
from typing import Any, Literal, Protocol, TypedDict, final, type_check_only

import numpy as np
from numpy.typing import NDArray

__all__ = [
    "CONTACTS",
    "FIRST_LOOK",
    "MAX_IMAGE_BYTES",
    "MAX_RUNS",
    "Brain",
    "Configuration",
    "InputError",
    "MetricScenario",
    "NoRoomError",
    "Procedure",
    "Simulation",
    "Snapshot",
    "body",
    "exhaust",
    "files_wanted",
    "frame",
    "mean_bounds",
    "mean_exceeds",
    "random_start",
    "read_configuration",
    "read_document",
    "read_metric",
    "read_scenario",
    "recorded_moment",
    "recorded_setting",
    "reference",
    "refusal",
    "replicate",
    "run_block",
    "run_one",
    "selection",
    "trace",
]

CONTACTS: list[str]
FIRST_LOOK: int
MAX_IMAGE_BYTES: int
MAX_RUNS: int

@type_check_only
class Fault(TypedDict):
    origin: str | None
    file: str | None
    line: int | None
    path: str
    given: str | None
    allowed: str
    suggestion: str | None
    message: str

class InputError(ValueError):
    faults: Sequence[Fault]

class NoRoomError(InputError): ...

def refusal(name: str, given: object, allowed: str) -> InputError: ...

@final
class Brain:
    def __new__(cls, spec: Mapping[str, Any], body: Mapping[str, Any]) -> Brain: ...
    @staticmethod
    def of(scenario: MetricScenario, kind: str) -> Brain: ...
    def step(self, percept: Mapping[str, Any]) -> dict[str, Any]: ...
    def thoughts(self) -> dict[str, Any] | None: ...
    def copy(self) -> Brain: ...
    @staticmethod
    def schemas() -> dict[str, dict[str, Any]]: ...

@final
class Procedure:
    @property
    def best(self) -> int: ...
    @property
    def runs(self) -> NDArray[np.int64]: ...
    @property
    def survivors(self) -> NDArray[np.int64]: ...
    @property
    def eliminations(self) -> list[tuple[int, int, int]]: ...
    def next(self) -> tuple[NDArray[np.int64], int, int] | None: ...
    def tell(self, merits: NDArray[np.float64]) -> None: ...

def selection(
    bounds: NDArray[np.float64],
    *,
    delta: float,
    confidence: float,
    guarantee: Literal["indifference", "pgs"],
) -> Procedure: ...
def reference(
    name: Literal["equal", "rinott", "kn"],
    configurations: int,
    *,
    delta: float,
    confidence: float,
    runs: int,
) -> Procedure: ...
def mean_bounds(
    values: NDArray[np.float64], least: float, greatest: float, alpha: float
) -> tuple[float, float]: ...
def mean_exceeds(
    values: NDArray[np.float64], bounds: tuple[float, float], candidate: float, alpha: float
) -> bool: ...

@final
class Configuration:
    @property
    def columns(
        self,
    ) -> list[tuple[str, Literal["whole", "real", "flag"], float | None, float | None]]: ...

@type_check_only
class _Source(Protocol):
    @property
    def file(self) -> str: ...
    @property
    def text(self) -> str: ...
    @property
    def changes(self) -> list[tuple[list[str], Any, str]]: ...
    @property
    def files(self) -> Mapping[str, bytes | str]: ...

def files_wanted(source: _Source) -> list[str]: ...
def read_scenario(source: _Source) -> dict[str, Any]: ...
def read_document(source: _Source) -> dict[str, Any]: ...
def read_configuration(source: _Source, values: dict[str, str | int | float]) -> Configuration: ...
def run_block(
    configurations: list[Configuration],
    *,
    seed: int,
    first_run: int,
    runs: int,
    threads: int | None,
) -> dict[str, NDArray[np.float64]]: ...
def run_one(configuration: Configuration, *, seed: int, run: int) -> dict[str, float]: ...

@final
class MetricScenario: ...

def read_metric(source: _Source) -> MetricScenario: ...
def body(scenario: MetricScenario, path: str, kind: str) -> dict[str, Any]: ...

@final
class Snapshot: ...

@type_check_only
class _Mind(Protocol):
    @property
    def kind(self) -> str: ...
    @property
    def is_in_arrays(self) -> bool: ...
    @property
    def step(self) -> Callable[..., object]: ...

@final
class Simulation:
    def __new__(
        cls, scenario: MetricScenario, *, seed: int, run: int, threads: int | None
    ) -> Simulation: ...
    @property
    def columns(
        self,
    ) -> list[tuple[str, Literal["whole", "real", "flag"], float | None, float | None]]: ...
    @property
    def tick(self) -> int: ...
    @property
    def step_s(self) -> float: ...
    @property
    def time_s(self) -> float: ...
    @property
    def is_over(self) -> bool: ...
    @property
    def hash(self) -> int: ...
    @property
    def robots(self) -> list[str]: ...
    @property
    def poses(self) -> NDArray[np.float64]: ...
    @property
    def speeds(self) -> NDArray[np.float64]: ...
    @property
    def status(self) -> NDArray[np.uint8]: ...
    @property
    def battery(self) -> NDArray[np.float64]: ...
    @property
    def items(self) -> dict[str, Any]: ...
    @property
    def outside(self) -> NDArray[np.bool_]: ...
    def step(self, steps: int) -> None: ...
    def step_with(
        self, percepts: dict[str, Any], commands: dict[str, Any], brains: Sequence[_Mind]
    ) -> dict[str, dict[str, Any]]: ...
    @property
    def decided(self) -> dict[str, dict[str, Any]]: ...
    def percept(self, robot: str) -> dict[str, Any] | None: ...
    def thoughts(self, robot: str) -> dict[str, Any] | None: ...
    def finish(self) -> None: ...
    def outcome(self) -> dict[str, float] | None: ...
    def change(self, scenario: MetricScenario) -> int: ...
    def snapshot(self) -> Snapshot: ...
    def restore(self, snapshot: Snapshot) -> None: ...

def frame(simulation: Simulation) -> bytes: ...
def recorded_moment(simulation: Simulation) -> dict[str, Any]: ...
def recorded_setting(simulation: Simulation) -> dict[str, Any]: ...
def trace(start: list[dict[str, float]], decisions: int) -> dict[str, Any]: ...
def random_start(robots: int, seed: int, run: int) -> list[dict[str, float]]: ...
def replicate(
    robots: int,
    runs: int,
    *,
    contact: str,
    cap_paints: int,
    seed: int,
    first_run: int,
    threads: int | None,
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]: ...
def exhaust(
    robots: int, contact: str, *, threads: int | None
) -> tuple[NDArray[np.int64], NDArray[np.int64]]: ...
