"""The source of a scenario: its text, the overrides, and the files that it refers to."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from agent_economy import _core
from agent_economy.regular_file import open_regular
from agent_economy.scenario import validation
from agent_economy.shell_word import shell_word

Value = str | int | float
"""A value of a factor. Booleans are integers in Python."""

TomlValue = Value | Sequence[Any] | Mapping[str, Any]
"""The content of a scenario file at a path: a value, a list or a table."""

RECORDING_MAGIC = b"\x89MCAP"
"""The first bytes of a recording."""

FILE_NAME = "a file name in UTF-8; rename the file or its folder"

VARY = "study.vary."

MAX_BYTES = 2**24
"""Maximum size of a scenario file: enough for half a million obstacle corners."""

MAX_KEYS = 32
"""Maximum depth of a path in a scenario."""


@dataclass(frozen=True)
class Override:
    """A value that replaces what the file has at a path.

    Attributes:
        path: Keys from the scenario's root.
        value: The value, as the file could have it.
        origin: Its name in errors, such as --merit.
    """

    path: tuple[str, ...]
    value: TomlValue
    origin: str

    @classmethod
    def at(cls, path: str, value: TomlValue, origin: str) -> "Override":
        """Return an override of a dotted path.

        A factor of a study is a single key with dots in it: study.vary.robots.wanderer.count.

        Raises:
            InputError: If the path is not a string or has too many keys, or the value is not plain.
        """
        check_path(origin, path)
        factor = path.removeprefix(VARY)
        keys = ("study", "vary", factor) if factor != path else tuple(path.split("."))
        return cls(keys, value, origin).plain()

    def plain(self) -> "Override":
        """Return the override with a value that a file could have.

        Raises:
            InputError: If it has another value, such as a quantity with a unit.
        """
        name = f"{self.origin}: {'.'.join(map(str, self.path))}"
        return replace(self, value=validation.plain_value(name, self.value))


@dataclass(frozen=True)
class Source:
    """Everything that is needed to read a scenario again, also on another machine.

    Attributes:
        file: Name of the text in errors.
        text: The text in TOML.
        overrides: Values that replace those of the text.
        files: The files that it refers to, such as maps, by name: their bytes, or the reason why
            they cannot be read.
    """

    file: str
    text: str = field(repr=False)
    overrides: tuple[Override, ...]
    files: Mapping[str, bytes | str] = field(default_factory=dict, repr=False)

    def __post_init__(self) -> None:
        """Check the argument types.

        Raises:
            InputError: If the text or the file name is not a string.
        """
        validation.check(validation.is_text(self.file), "file", self.file, FILE_NAME)
        validation.check(validation.is_text(self.text), "text", self.text, "a string of TOML")

    @property
    def changes(self) -> list[tuple[list[str], TomlValue, str]]:
        """The overrides in the form that the Rust core reads."""
        return [(list(each.path), each.value, each.origin) for each in self.overrides]

    def complete(self) -> "Source":
        """Return the source with all files that it names, read relative to its own folder."""
        source = self
        while wanted := _core.missing_files(source):
            folder, limit = Path(self.file).parent, _core.MAX_IMAGE_BYTES
            found = {name: read_file(folder / name, limit) for name in wanted}
            source = replace(source, files={**source.files, **found})
        return source


def read_file(path: Path, max_bytes: int) -> bytes | str:
    """Return the bytes of a file, or the reason that it cannot be read."""
    try:
        with open_regular(path) as stream:
            data = stream.read(max_bytes + 1)
    except OSError as error:
        return error.strerror or str(error)
    # A recording passed by mistake gets its own error, also if it is too large.
    if len(data) > max_bytes and not data.startswith(RECORDING_MAGIC):
        return f"it is larger than the limit of {max_bytes:,} bytes"
    return data


def check_path(origin: str, path: object) -> None:
    """Check that an argument can be a path in a scenario.

    Raises:
        InputError: If it is not a string or has too many keys.
    """
    allowed = f"keys from the root, such as clock.time_limit_s; at most {MAX_KEYS}"
    is_path = validation.is_text(path) and path.count(".") < MAX_KEYS
    validation.check(is_path, f"{origin}: path", path, allowed)


def check_overrides(overrides: tuple[Override, ...]) -> tuple[Override, ...]:
    """Return an argument `overrides` as a tuple, with plain values.

    Raises:
        InputError: If it is not a sequence of `Override`, or a value is not plain.
    """
    allowed = "a tuple of Override"
    validation.of_type("overrides", overrides, tuple | list, allowed)
    for each in overrides:
        validation.of_type("overrides", each, Override, allowed)
    return tuple(each.plain() for each in overrides)


def decode(file: Path, data: bytes) -> str:
    """Return the text of a scenario file, with line feeds as line endings.

    Raises:
        ValueError: If the bytes are not UTF-8; the message names the first invalid byte.
    """
    try:
        return data.decode().replace("\r\n", "\n").replace("\r", "\n")
    except UnicodeDecodeError as error:
        raise ValueError(not_text(file, error)) from None


def not_text(file: Path, error: UnicodeDecodeError) -> str:
    """Return the error message for a file that is not UTF-8 text."""
    if error.object.startswith(RECORDING_MAGIC):
        command = f"agent-economy replay {shell_word(file)}"
        return f"{file}: expected a scenario, got a recording; to replay it: {command}"
    return f"{file}: is not UTF-8 text: byte {error.start} is {error.object[error.start]:#x}"
