"""What a user gave or a user's function returned, as plain numbers, or an error with the reason.

NumPy turns much into numbers without a word: what is below a mask, a quantity without its unit, a
table in the order of its rows whatever their labels, the digits of a string, the real part of a
complex number. Here, only what can mean nothing else is a number.
"""

from array import array as buffer
from collections import deque
from collections.abc import Callable, Iterator, Mapping, Sequence
from collections.abc import Set as AbstractSet
from datetime import date, timedelta
from decimal import Decimal
from numbers import Real
from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

EXACT = 2**53
"""Whole numbers up to it have an exact floating-point value."""

MAX_DEPTH = 32
"""Maximum nesting depth; a list that contains itself is deeper."""

BARE = (np.ndarray, np.memmap, np.matrix)
"""Types of arrays that are nothing but their elements."""

LISTS = (list, tuple, range, deque)
PYTHON_NUMBERS = frozenset({bool, int, float})
LEAVES = PYTHON_NUMBERS | {str, type(None)}
CONTAINERS = frozenset({dict, list})

FIX = "use numpy.asarray(x, dtype=float) if its numbers mean what is expected"
UNIT = "use plain numbers in the unit that is expected, as in x.to(unit).value or .magnitude"
LABELS = "its labels may be in another order: sort it, and use x.to_numpy()"
DATE = "use plain numbers in the unit that is expected, as in x / numpy.timedelta64(1, 's')"
FIELD = "use the field that is meant, as in x['name']"
TEXT = "convert text to numbers, as in float(x)"
COMPLEX = "use the part that is meant, as in x.real or abs(x)"
FIXES_BY_KIND = {
    **dict.fromkeys("SUT", TEXT),
    **dict.fromkeys("Mm", DATE),
    "c": COMPLEX,
    "V": FIELD,
}
FIXES_BY_TYPE: list[tuple[type | tuple[type, ...], str]] = [
    (type(None), "use numpy.nan for what has no number"),
    ((str, bytes, bytearray), TEXT),
    (complex, COMPLEX),
    ((date, timedelta), "use plain numbers in the unit that is expected: x.total_seconds()"),
    (AbstractSet, "it has no order: use a list"),
    (Mapping, "use a list of its values, in the order that is expected"),
    (Iterator, "use list(x)"),
]


class NotPlainError(ValueError):
    """A value that is not certainly a number, or numbers.

    Attributes:
        what: What it is.
        fix: What to do about it.
        place: Where it is in the value that was given: keys and indices, such as ".motion[0]".
    """

    def __init__(self, what: str, fix: str, place: str = "") -> None:
        """State what it is, and what to do about it."""
        super().__init__(f"{what}; {fix}")
        self.what, self.fix, self.place = what, fix, place


def is_plain(given: object, deep: int = MAX_DEPTH) -> bool:
    """Return whether `plain` would change nothing of a dict or list; False in doubt."""
    if type(given) not in CONTAINERS or not deep:
        return False
    parts: Any = given.values() if type(given) is dict else given
    # All commands of brains come through here, and empty lists are frequent.
    for each in parts:
        kind = type(each)
        if kind not in LEAVES and (
            kind not in CONTAINERS or (each and not is_plain(each, deep - 1))
        ):
            return False
    return True


def plain(given: object, deep: int = MAX_DEPTH) -> Any:
    """Return dicts, lists, strings, numbers, flags and None without types of other libraries.

    Raises:
        NotPlainError: If something in it is none of these.
    """
    if type(given) in LEAVES or isinstance(given, str) or not deep:
        return given
    if isinstance(given, Mapping):
        return {
            key: each if type(each) in LEAVES else inside(f".{key}", plain, each, deep)
            for key, each in given.items()
        }
    if isinstance(given, LISTS):
        return items(plain, given, deep)
    if is_number(given):
        return int(given) if isinstance(given, int) else float(number(given))
    found = bare(given)
    if found.dtype.kind == "O":
        return plain(found.tolist(), deep - 1)
    return found.tolist() if found.dtype.kind in "biuU" else floats(found).tolist()


def floats(given: object, deep: int = MAX_DEPTH) -> Floats:
    """Return numbers as a new array of floats.

    Args:
        given: A number, an array, or lists of lists. True and False are 1 and 0. Arrays of other
            libraries are read by `__dlpack__`.
        deep: Maximum nesting depth.

    Raises:
        NotPlainError: If something in it is not certainly a number, or would change its value.
    """
    if isinstance(given, LISTS) and deep:
        return of_list(given, deep)
    if is_number(given):
        return np.array(number(given))
    found = bare(given)
    if found.dtype.kind == "O" and deep:
        return floats(found.tolist(), deep - 1)
    if found.dtype.kind not in "biuf":
        raise NotPlainError(described(found), FIXES_BY_KIND.get(found.dtype.kind, FIX))
    with np.errstate(over="ignore"):
        converted = found.astype(np.float64)
    if found.dtype.kind in "iu":
        for whole in found[abs(converted) >= EXACT].tolist():
            number(whole)
    elif found.dtype != np.float64 and np.isinf(converted).any():
        what = f"{described(found)} with infinite numbers"
        raise NotPlainError(what, "they may be too large for their type: compute with float64")
    return converted


def of_list(given: Sequence[object], deep: int) -> Floats:
    """Return the numbers of a list as `floats` does."""
    if set(map(type, given)) <= PYTHON_NUMBERS:
        return np.array([*map(number, given)], dtype=np.float64)
    rows = items(floats, given, deep)
    shapes = {row.shape for row in rows}
    if len(shapes) > 1:
        parts = " and ".join(map(str, sorted(shapes)[:2]))
        what = f"{described(given)} with parts of shapes {parts}"
        raise NotPlainError(what, "use equal lengths")
    return np.stack(rows)


def bare(given: object) -> NDArray[Any]:
    """Return an array that is nothing but its elements; not always a copy.

    Raises:
        NotPlainError: If it is more than that, or no array.
    """
    if isinstance(given, np.ma.MaskedArray):
        if hidden := np.ma.getmaskarray(given).sum():
            what = f"{described(given)} with {hidden} masked"
            raise NotPlainError(what, "fill what is masked, as in x.filled(numpy.nan)")
        return bare(given.data)
    if type(given) in BARE or isinstance(given, np.generic | memoryview | buffer):
        return np.asarray(given)
    is_array = hasattr(type(given), "__dlpack__") and not isinstance(given, np.ndarray)
    if not is_array or unit_of(given) is not None:
        raise NotPlainError(described(given), fix_of(given))
    try:
        return np.from_dlpack(given)  # type: ignore[arg-type]
    except (BufferError, RuntimeError, TypeError, ValueError) as error:
        what = f"{described(given)} ({error})"
        raise NotPlainError(what, FIX) from None


def is_number(given: object) -> bool:
    """Return whether something is a number of Python, without a unit."""
    if type(given) in PYTHON_NUMBERS:
        return True
    is_real = isinstance(given, Real | Decimal) and not isinstance(given, np.generic)
    return is_real and unit_of(given) is None


def number(given: Any) -> float:
    """Return a number of Python as a float.

    Raises:
        NotPlainError: If it is too large, or a whole number that no float is equal to.
    """
    try:
        found = float(given)
    except (OverflowError, ValueError) as error:
        what = f"{described(given)} ({error})"
        raise NotPlainError(what, "use a smaller number") from None
    if isinstance(given, int) and abs(given) > EXACT and int(found) != given:
        what = f"the whole number {given}"
        raise NotPlainError(what, "beyond 2^53, floats lose digits: use a smaller one")
    return found


def items(convert: Callable[[object, int], Any], given: Sequence[object], deep: int) -> list[Any]:
    """Convert the items of a list; an error names the one."""
    if convert is plain and set(map(type, given)) <= LEAVES:
        return [*given]
    return [inside(f"[{index}]", convert, each, deep) for index, each in enumerate(given)]


def inside(key: str, convert: Callable[[object, int], Any], given: object, deep: int) -> Any:
    """Convert a value that is inside another one; an error states its place."""
    try:
        return convert(given, deep - 1)
    except NotPlainError as error:
        raise NotPlainError(error.what, error.fix, key + error.place) from None


def described(given: object) -> str:
    """Return what a value is: its type, shape and unit, as far as it has them."""
    if given is None:
        return "None"
    kind = type(given)
    package = kind.__module__.partition(".")[0]
    name = kind.__qualname__ if package == "builtins" else f"{package}.{kind.__qualname__}"
    words = [name]
    if isinstance(shape := getattr(given, "shape", None), tuple):
        words.append(f"of shape {shape}")
    if isinstance(dtype := getattr(given, "dtype", None), np.dtype):
        words.append(f"and type {dtype}")
    if (unit := unit_of(given)) is not None:
        words.append(f"in {unit}" if str(unit) else "with a unit")
    if isinstance(given, str | bytes):
        words.append(f"({given[:20]!r})")
    return " ".join(words)


def fix_of(given: object) -> str:
    """Return what to do about a value that is not certainly numbers."""
    if hasattr(given, "iloc") or hasattr(given, "dims"):
        return LABELS
    if unit_of(given) is not None:
        return UNIT
    return next((fix for kinds, fix in FIXES_BY_TYPE if isinstance(given, kinds)), FIX)


def unit_of(given: object) -> object:
    """Return the unit of a quantity; None for what is none."""
    if hasattr(given, "iloc"):
        return None  # A table, whose columns may have any names.
    unit = getattr(given, "units", None)
    return getattr(given, "unit", None) if unit is None else unit
