from typing import Any, Literal, final

import numpy as np
from numpy.typing import NDArray

__all__ = [
    "CONTACTS",
    "MERITS",
    "InputError",
    "Procedure",
    "exhaust",
    "mean_bounds",
    "mean_exceeds",
    "random_start",
    "read_scenario",
    "replicate",
    "selection",
    "trace",
]

CONTACTS: list[str]
MERITS: list[str]

class InputError(ValueError): ...

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
def mean_bounds(
    values: NDArray[np.float64], least: float, greatest: float, alpha: float
) -> tuple[float, float]: ...
def mean_exceeds(
    values: NDArray[np.float64], bounds: tuple[float, float], candidate: float, alpha: float
) -> bool: ...

def read_scenario(
    file: str, text: str, overrides: list[tuple[list[str], str | float, str]]
) -> dict[str, Any]: ...
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
