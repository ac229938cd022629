"""Arithmetic on the robots of a team, as `minimize` and `where` of a study contain it.

Names are kinds of robots and controllers, which are their numbers, `robots`, the number of all
robots, and `price`. There are numbers, + - * /, comparisons, `and`, `or`, `not` and parentheses, as
in Python.
"""

import ast
import math
import operator
from collections.abc import Callable, Mapping
from difflib import get_close_matches

from agent_economy._core import InputError
from agent_economy.scenario import Source
from agent_economy.scenario.origin import with_origin

BINARY: dict[type, Callable[[float, float], float]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
}
COMPARED: dict[type, Callable[[float, float], bool]] = {
    ast.LtE: operator.le,
    ast.GtE: operator.ge,
    ast.Lt: operator.lt,
    ast.Gt: operator.gt,
    ast.Eq: operator.eq,
    ast.NotEq: operator.ne,
}

MAX_LENGTH = 1000
"""Maximum number of characters of an expression."""

ALLOWED = (
    "numbers, kinds of robots and controllers, robots, price, + - * / and comparisons, and, or, not"
)
MUST_BE = f"must be an expression of {ALLOWED}"
SHOWN = 80
"""Characters of an expression that its error shows."""

MAX_DEPTH = 50
"""Maximum depth of nested operations; a sum of n terms has a depth of n - 1."""

TOO_LONG = f"must have at most {MAX_LENGTH} characters"
TOO_DEEP = f"must have operations that are nested at most {MAX_DEPTH} deep"
NOT_FINITE = "must not divide by zero or overflow for any team"


class Expression:
    """An expression that has been checked."""

    def __init__(
        self, path: str, text: str, names: tuple[str, ...], source: Source | None = None
    ) -> None:
        """Read an expression; errors name its `path`, and where that is in the source.

        Raises:
            InputError: If it is not an expression of these names.
        """
        self._path, self._text, self._names, self._source = path, text, names, source
        if len(text) > MAX_LENGTH:
            raise self.error(TOO_LONG)
        try:
            self._tree = ast.parse(text.strip(), mode="eval").body
        except (SyntaxError, ValueError, RecursionError, MemoryError):
            raise self.error(MUST_BE) from None
        if depth(self._tree) > MAX_DEPTH:
            raise self.error(TOO_DEEP)
        self._check(self._tree)

    @property
    def names(self) -> frozenset[str]:
        """The names that occur."""
        return frozenset(each.id for each in ast.walk(self._tree) if isinstance(each, ast.Name))

    def value(self, values: Mapping[str, float]) -> float:
        """Return its value; a comparison is 1 or 0.

        Raises:
            InputError: If it divides by zero.
        """
        try:
            return float(evaluate(self._tree, values))
        except (ZeroDivisionError, OverflowError):
            raise self.error(NOT_FINITE) from None

    def _check(self, node: ast.expr) -> None:
        match node:
            case ast.Constant(value=int() | float() as number) if is_finite_number(number):
                return
            case ast.Name(id=name):
                self._check_name(name)
            case ast.BinOp(left=left, op=op, right=right) if type(op) in BINARY:
                self._check_all(left, right)
            case ast.UnaryOp(op=ast.USub() | ast.Not(), operand=operand):
                self._check(operand)
            case ast.BoolOp(values=values):
                self._check_all(*values)
            case ast.Compare(left=left, ops=ops, comparators=others) if all(
                type(op) in COMPARED for op in ops
            ):
                self._check_all(left, *others)
            case _:
                piece = ast.get_source_segment(self._text.strip(), node) or self._text
                why = f"{piece!r} is not allowed: must be of {ALLOWED}"
                raise self.error(why)

    def _check_all(self, *nodes: ast.expr) -> None:
        for node in nodes:
            self._check(node)

    def _check_name(self, name: str) -> None:
        if name not in self._names:
            close = get_close_matches(name, self._names, 1)
            suggestion = f"; did you mean {close[0]!r}?" if close else ""
            known = ", ".join(self._names)
            why = f"{name!r} is unknown: must be one of {known}{suggestion}"
            raise self.error(why)

    def error(self, why: str) -> InputError:
        """Return the error that the expression is wrong, with the reason."""
        path, source = self._path, self._source
        place = path if source is None else with_origin(source, *path.split("."))
        return InputError(f"{place} = {shown(self._text)}: {why}")


def shown(text: str) -> str:
    """Return an expression for an error message, shortened if it is long."""
    return repr(text if len(text) <= SHOWN else f"{text[:SHOWN]}...")


def depth(tree: ast.expr) -> int:
    """Return how deep the operations of an expression are nested, without recursion."""
    deepest, waiting = 0, [(tree, 0)]
    while waiting:
        node, at = waiting.pop()
        deepest = max(deepest, at)
        inner = (each for each in ast.iter_child_nodes(node) if isinstance(each, ast.expr))
        waiting += [(each, at + 1) for each in inner]
    return deepest


def is_finite_number(value: float) -> bool:
    """Return whether a constant is a finite number: neither True nor 1e999."""
    return not isinstance(value, bool) and math.isfinite(value)


def evaluate(node: ast.expr, values: Mapping[str, float]) -> float:
    """Return the value of a checked expression."""
    match node:
        case ast.Constant(value=int() | float() as number):
            return number
        case ast.Name(id=name):
            return values[name]
        case ast.BinOp(left=left, op=op, right=right):
            return BINARY[type(op)](evaluate(left, values), evaluate(right, values))
        case ast.UnaryOp(op=op, operand=operand):
            value = evaluate(operand, values)
            return -value if isinstance(op, ast.USub) else not value
        case ast.BoolOp(op=op, values=nodes):
            each = (bool(evaluate(node, values)) for node in nodes)
            return all(each) if isinstance(op, ast.And) else any(each)
        case ast.Compare(left=left, ops=ops, comparators=others):
            numbers = [evaluate(each, values) for each in (left, *others)]
            pairs = zip(ops, numbers, numbers[1:], strict=False)
            return all(COMPARED[type(op)](one, other) for op, one, other in pairs)
        case _:
            message = f"not an expression: {node!r}"
            raise TypeError(message)
