from collections.abc import Sequence
from collections.abc import Mapping
from typing import Any, Literal, TypedDict, final, type_check_only

import numpy as np
from numpy.typing import NDArray

__all__ = [
    "CONTACTS",
    "FIRST_LOOK",
    "Brain",
    "Configuration",
    "InputError",
    "Procedure",
    "exhaust",
    "mean_bounds",
    "mean_exceeds",
    "random_start",
    "read_configuration",
    "read_document",
    "read_scenario",
    "reference",
    "replicate",
    "run_block",
    "selection",
    "trace",
]

CONTACTS: list[str]
FIRST_LOOK: int

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

@final
class Brain:
    def __new__(cls, spec: Mapping[str, Any], body: Mapping[str, Any]) -> Brain: ...
    def step(self, percept: Mapping[str, Any]) -> dict[str, Any]: ...
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

def read_scenario(
    file: str, text: str, overrides: list[tuple[list[str], Any, str]]
) -> dict[str, Any]: ...
def read_document(
    file: str, text: str, overrides: list[tuple[list[str], Any, str]]
) -> dict[str, Any]: ...
def read_configuration(
    file: str,
    text: str,
    overrides: list[tuple[list[str], Any, str]],
    values: dict[str, str | int | float],
) -> Configuration: ...
def run_block(
    configurations: list[Configuration],
    *,
    seed: int,
    first_run: int,
    runs: int,
    threads: int | None,
) -> dict[str, NDArray[np.float64]]: ...
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
