"""The Python types of the array interface of brains, from the schema of percepts and commands.

They follow the rules of `crates/py/src/columns`.
"""

import textwrap
from dataclasses import dataclass

import schema_parts as types

APART = {"time_s", "id", "team_size", "scans", "inbox", "outbox"}
"""Keys that are not in columns: the same for robots of a kind, of equal length, or messages."""

HEAD = '''
Floats: TypeAlias = NDArray[np.float64]
Integers: TypeAlias = NDArray[np.int64]
Booleans: TypeAlias = NDArray[np.bool_]


class ScanColumns(TypedDict):
    """Scans of a range ring of each robot: ages (n,), and ranges (n, rays)."""

    age_s: Floats
    ranges_m: Floats


class RowReceived(ReceivedMessage):
    """A received message, and the row of the robot that received it."""

    row: int


class RowMessage(Message):
    """A message to send, and the row of the robot that sends it."""

    row: int
'''

IMPORTS = """from collections.abc import Sequence
from typing import NotRequired, TypeAlias, TypedDict

import numpy as np
from numpy.typing import ArrayLike, NDArray

from agent_economy.types.brain import Body, Message, ReceivedMessage
"""

PERCEPTS = {
    "body": ("Body", "The body, the same for all robots and in each step."),
    "count": (
        "int",
        "Number of robots of the kind in the run, including those that do not step.",
    ),
    "time_s": ("float", "Time since the start of the mission."),
    "robots": (
        "Integers",
        "Indices of the robots that step, ascending and below `count`, shape (n,).",
    ),
    "scans": ("list[ScanColumns]", "Scans, one entry per range ring of the body."),
    "inbox": ("Sequence[RowReceived]", "Received messages, which become dicts when they are read."),
}
"""Entries of percepts besides the columns."""

COMMANDS = {"outbox": ("NotRequired[list[RowMessage]]", "Messages to send.")}
"""Entries of commands besides the columns."""


@dataclass(frozen=True)
class Family:
    """The columns of percepts, or those of commands.

    Attributes:
        suffix: End of the names of types.
        is_given: Whether arrays are given by a brain: then they may be anything like an array.
    """

    suffix: str
    is_given: bool

    def name(self, name: str) -> str:
        """Return the name of the columns of a type."""
        return f"{types.class_name(name)}{self.suffix}"

    def array(self, of: str) -> str:
        """Return the type of an array."""
        return "ArrayLike" if self.is_given else of


RECEIVED, SENT = Family("Columns", is_given=False), Family("Arrays", is_given=True)


class Columns:
    """The types of the columns of a family, each after those that it uses."""

    def __init__(self, schemas: types.Types, family: Family) -> None:
        """Start without types."""
        self.schemas, self.family = schemas, family
        self.done: dict[str, str] = {}

    def whole(self, name: str, new_name: str, extra: dict[str, tuple[str, str]]) -> None:
        """Add the columns of a type under a name of its own, with extra keys."""
        keys = [key for key in types.fields(self.schemas[name]) if key.name not in APART]
        columns = {key.name: self.column(key.schema) for key in keys}
        described = [types.Field(each, {"description": text}) for each, (_, text) in extra.items()]
        text = types.plain(self.schemas[name]["description"])
        entries = {each: kind for each, (kind, _) in extra.items()}
        optional = {
            key: f"NotRequired[{kind}]" if self.family.is_given else kind
            for key, kind in columns.items()
        }
        self.done[new_name] = self.record(
            new_name,
            f"{text} In columns, of all robots of a kind.",
            [*described, *keys],
            entries | optional,
        )

    def column(self, schema: types.Schema) -> str:
        """Return the type of a column, after adding those that it uses."""
        if parts := types.alternatives(schema):
            rest = [part for part in parts if part.get("type") != "null"]
            if len(rest) == 1:
                return self.column(rest[0])
        if target := types.reference(schema):
            return self.referred(target)
        if types.choices(schema):
            return self.family.array("Integers")
        kind = schema.get("type")
        kind = kind[0] if isinstance(kind, list) else kind
        if kind == "array":
            items = schema["prefixItems"][0] if "prefixItems" in schema else schema["items"]
            is_vector = schema.get("minItems", -1) == schema.get("maxItems")
            return self.column(items) if is_vector else self.rows(items)
        return self.family.array(
            {"integer": "Integers", "boolean": "Booleans"}.get(str(kind), "Floats")
        )

    def referred(self, target: str) -> str:
        """Return the type of the column of a named type."""
        schema = self.schemas[target]
        if types.choices(schema) or schema.get("type") not in {None, "object"}:
            return self.column(schema)
        name = self.family.name(target)
        if name not in self.done:
            self.done[name] = ""  # in work
            keys = types.fields(schema)
            text = self.table(name, schema.get("description", ""), keys)
            del self.done[name]
            self.done[name] = text
        return name

    def table(self, name: str, description: str, keys: list[types.Field]) -> str:
        """Return the type of the columns of an object."""
        columns = {key.name: self.column(key.schema) for key in keys}
        if self.family.is_given:
            columns = {
                key.name: columns[key.name]
                if key.is_required
                else f"NotRequired[{columns[key.name]}]"
                for key in keys
            }
        return self.record(name, types.plain(description), keys, columns)

    def rows(self, items: types.Schema) -> str:
        """Return the type of the columns of a list: those of its items, and their rows."""
        base = self.column(items)
        name = f"{base.removesuffix('s')}Rows"
        if name not in self.done:
            is_record = base in self.done
            keys = {"row": self.family.array("Integers")} | ({} if is_record else {"value": base})
            lines = [f"class {name}({base if is_record else 'TypedDict'}):"]
            lines.append(
                '    """The same of several entries; `row` is the one that each belongs to."""'
            )
            self.done[name] = "\n".join(
                [*lines, "", *(f"    {key}: {kind}" for key, kind in keys.items())]
            )
        return name

    def record(
        self, name: str, description: str, keys: list[types.Field], columns: dict[str, str]
    ) -> str:
        """Return a type of a dict, with the codes of its enumerations."""
        described = [types.Field(key.name, {"description": self.text(key)}) for key in keys]
        text = types.docstring(description or name, described)
        if "from" in columns:  # no name of Python
            entries = ", ".join(f'"{key}": {each}' for key, each in columns.items())
            return f'{name} = TypedDict("{name}", {{{entries}}})\n{text}'
        lines = [f"class {name}(TypedDict):", textwrap.indent(text, "    "), ""]
        return "\n".join([*lines, *(f"    {key}: {each}" for key, each in columns.items())])

    def text(self, key: types.Field) -> str:
        """Return the description of a key, with its codes."""
        target = types.reference(key.schema)
        codes = types.choices(self.schemas[target]) if target else []
        numbered = ", ".join(f"{number} {code}" for number, code in enumerate(codes))
        return f"{key.description} {numbered}." if codes else key.description


def python_arrays(schemas: types.Types, notice: str) -> str:
    """Return the module of the arrays of brains."""
    received, sent = Columns(schemas, RECEIVED), Columns(schemas, SENT)
    received.whole("Percept", "Percepts", PERCEPTS)
    sent.whole("Command", "Commands", COMMANDS)
    parts = [*received.done.values(), *sent.done.values()]
    return types.formatted([f'"""{notice}"""\n{IMPORTS}{HEAD}', *parts])
