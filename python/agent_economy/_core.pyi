from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = [
    "CONTACTS",
    "MERITS",
    "InputError",
    "exhaust",
    "random_start",
    "read_scenario",
    "replicate",
    "trace",
]

CONTACTS: list[str]
MERITS: list[str]

class InputError(ValueError): ...

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
