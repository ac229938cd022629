"""What the types of Python and TypeScript are generated from: JSON Schemas and their parts."""

import re
import subprocess
import sys
import textwrap
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

WIDTH = 100

Schema = Mapping[str, Any]
Types = dict[str, Schema]


@dataclass(frozen=True)
class Field:
    """A key of an object."""

    name: str
    schema: Schema
    is_required: bool = True

    @property
    def description(self) -> str:
        """Return its description in one line."""
        return plain(self.schema.get("description", ""))


def fields(schema: Schema) -> list[Field]:
    """Return the keys of an object."""
    required = schema.get("required", ())
    properties = schema.get("properties", {})
    return [Field(name, each, name in required) for name, each in properties.items()]


def plain(text: str) -> str:
    """Return a doc comment of Rust as plain text in one line."""
    text = re.sub(r"\[`([^`]*)`\](\([^)]*\))?", r"`\1`", text).replace("::", ".")
    return " ".join(text.split())


def reference(schema: Schema) -> str | None:
    """Return the name of the type that a schema refers to."""
    target = schema.get("$ref")
    return target.rsplit("/", 1)[-1] if target else None


def alternatives(schema: Schema) -> list[Schema]:
    """Return the alternatives of a union; none for any other type."""
    return list(schema.get("oneOf") or schema.get("anyOf") or ())


def choices(schema: Schema) -> list[str]:
    """Return the strings that an enumeration allows; none for any other type."""
    each = [str(part.get("const", "")) for part in alternatives(schema)]
    return list(schema.get("enum") or (each if all(each) else ()))


def tag(schema: Schema) -> str | None:
    """Return the value of the `type` of a message."""
    value: str | None = schema.get("properties", {}).get("type", {}).get("const")
    return value


def only_key(schema: Schema) -> Field | None:
    """Return the key of an object that has just one, and no tag."""
    keys = fields(schema)
    return keys[0] if len(keys) == 1 and keys[0].name != "type" else None


def class_name(name: str) -> str:
    """Return the name of a type: that of a Rust type, or of a message by its tag."""
    name = "".join(part[:1].upper() + part[1:] for part in name.split("_"))
    return name.replace("Double", "Number")


def docstring(description: str, keys: list[Field] | None = None) -> str:
    """Return a docstring."""
    described = [key for key in keys or () if key.description]
    # Abbreviations apart, the first sentence ends with its first full stop.
    summary, stop, rest = description.partition(". ")
    lines = textwrap.wrap(summary + stop.strip(), WIDTH - 8)
    if rest:
        lines += ["", *textwrap.wrap(rest, WIDTH - 8)]
    if described:
        lines += ["", "Attributes:"]
        for key in described:
            lines += textwrap.wrap(
                f"{key.name}: {key.description}",
                WIDTH - 8,
                initial_indent="    ",
                subsequent_indent="        ",
            )
    end = "\n" if len(lines) > 1 else ""
    return f'"""{chr(10).join(lines)}{end}"""'


def formatted(parts: list[str]) -> str:
    """Return a module as ruff formats it."""
    text = "\n\n\n".join(parts)
    for command in (["check", "--quiet", "--fix", "--select=I"], ["format", "--quiet"]):
        program = str(Path(sys.executable).with_name("ruff"))
        ruff = [program, *command, "--stdin-filename=python/types.py", "-"]
        text = subprocess.run(ruff, input=text, capture_output=True, text=True, check=True).stdout
    return text
