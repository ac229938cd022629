"""What a job is: a scenario, read from a TOML file and checked as a whole."""

import stat
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from agent_economy import _core, given, shipped
from agent_economy._core import InputError
from agent_economy.merit import Merit, Term, in_words

Value = str | int | float
"""A value of a factor; true and false are whole numbers to Python."""

Given = Value | Sequence[Any] | Mapping[str, Any]
"""What can be put into a scenario: a value, a list or a table."""

RECORDING = b"\x89MCAP"
"""What recordings begin with."""

VARY = "study.vary."

MAX_BYTES = 2**24
"""Of a scenario's own file: half a million corners of obstacles, and more."""

MAX_KEYS = 32
"""Of a path in a scenario: no table is so deep."""


@dataclass(frozen=True)
class Published:
    """Results of others, to show beside ours.

    Attributes:
        source: Where they stand.
        choice: The team size that they recommend.
        time_limit_s: Where they stopped; a time of this much is a failed run.
        times_s: The times of a team's runs, by team size.
    """

    source: str
    choice: int
    time_limit_s: float
    times_s: dict[int, list[float]]


@dataclass(frozen=True)
class Factor:
    """What is varied, and over what: `values`, or any number of `range`.

    Attributes:
        path: Keys from the scenario's root, with dots between.
        values: Numbers in ascending order, or names in the order given; empty for a range.
        range: The least and the greatest number; None for values.
    """

    path: str
    values: tuple[Value, ...]
    range: tuple[float, float] | None = None


@dataclass(frozen=True)
class Override:
    """A value put over what the file says; `origin` is how faults name it, such as --merit."""

    path: tuple[str, ...]
    value: Given
    origin: str

    @classmethod
    def at(cls, path: str, value: Given, origin: str) -> "Override":
        """Return a value put at keys with dots between them, from the root.

        What is varied is one key with dots of its own: study.vary.robots.wanderer.count.

        Raises:
            InputError: If the path is no text.
        """
        of_path(origin, path)
        factor = path.removeprefix(VARY)
        keys = ("study", "vary", factor) if factor != path else tuple(path.split("."))
        return cls(keys, value, origin)


@dataclass(frozen=True)
class Source:
    """What a scenario was read from, whole: nothing else is needed to read it again elsewhere.

    Attributes:
        file: How faults name the text.
        text: TOML.
        overrides: What was put over it.
        files: The files that it names, such as maps, by their names: their bytes, or why they
            cannot be read.
    """

    file: str
    text: str = field(repr=False)
    overrides: tuple[Override, ...]
    files: Mapping[str, bytes | str] = field(default_factory=dict, repr=False)

    def __post_init__(self) -> None:
        """See to it that a scenario can be read from it.

        Raises:
            InputError: If the text or its name is no text.
        """
        allowed = "a text, the name of what is read"
        given.check(given.is_text(self.file), "file", self.file, allowed)
        given.check(given.is_text(self.text), "text", self.text, "a text in TOML")

    @property
    def changes(self) -> list[tuple[list[str], Given, str]]:
        """The overrides as the compiled part takes them."""
        return [(list(each.path), each.value, each.origin) for each in self.overrides]

    def complete(self) -> "Source":
        """Return the source with all files that it names, read from beside its own."""
        source = self
        while wanted := _core.files_wanted(source):
            beside, most = Path(self.file).parent, _core.MAX_IMAGE_BYTES
            found = {name: content(beside / name, most) for name in wanted}
            source = replace(source, files={**source.files, **found})
        return source


def content(path: Path, most: int) -> bytes | str:
    """Return what is in a file, or why it cannot be read: for one, that it has too many bytes."""
    try:
        mode = path.stat().st_mode
        # A pipe or a device may never end, or never begin. To open a folder is an error of its own.
        if not (stat.S_ISREG(mode) or stat.S_ISDIR(mode)):
            return "it is a pipe or a device; write what it gives into a file, and name that"
        with path.open("rb") as stream:
            data = stream.read(most + 1)
    except OSError as error:
        return error.strerror or str(error)
    except ValueError as error:  # a name that no file can have
        return str(error)
    # Whoever is given a recording says so, however long it is.
    if len(data) > most and not data.startswith(RECORDING):
        return f"it has more than the {most:,} bytes that are allowed; make it smaller"
    return data


@dataclass(frozen=True)
class Scenario:
    """Everything that does not change in a run, and what its study does.

    Attributes:
        name: The file's name without its ending.
        source: What it was read from.
        engine: The simulator that runs it.
        summary: One line for people.
        merit: How runs are scored.
        robots: Robots in a single run, by kind.
        time_limit_s: A run that takes longer has failed, and counts as this long.
        facts: What else does not change in a run, for people: names, and texts of them.
        factors: What a study varies, if anything; in a fixed order.
        design: Which configurations it compares: "factorial", "lhs:N" or "sobol:N" (N points).
        delta: A difference of merit that is worth knowing, above 0; None if the file has none.
        confidence: How often the answer is to be right: above 0.5, below 1.
        published: Results of others, if the file has them.
    """

    name: str
    source: Source
    engine: str
    summary: str
    merit: Merit
    robots: dict[str, int]
    time_limit_s: float
    facts: tuple[tuple[str, str], ...]
    factors: tuple[Factor, ...]
    design: str
    delta: float | None
    confidence: float
    published: Published | None

    @classmethod
    def load(cls, file: str | Path, overrides: tuple[Override, ...] = ()) -> "Scenario":
        """Read a scenario from a file, or the one that ships under a name, such as "classic".

        Raises:
            InputError: If the file cannot be read or anything in it is wrong; all faults at once.
        """
        file = shipped.find(given.path("file", file))
        data = content(file, MAX_BYTES)
        if isinstance(data, str):
            message = f"{file}: cannot be read: {data}{shipped.meant(file)}"
            raise InputError(message)
        try:
            text = data.decode().replace("\r\n", "\n").replace("\r", "\n")
        except UnicodeDecodeError as error:
            raise InputError(no_text(file, error)) from None
        return cls.loads(text, file=str(file), overrides=overrides)

    @classmethod
    def loads(
        cls, text: str, file: str = "scenario.toml", overrides: tuple[Override, ...] = ()
    ) -> "Scenario":
        """Read a scenario from TOML text; `file` is how faults name it.

        Raises:
            InputError: If anything in it is wrong; all faults at once.
        """
        return cls.of(Source(file, text, all_overrides(overrides)))

    @classmethod
    def of(cls, source: Source) -> "Scenario":
        """Read a scenario from its source; files that it names and does not have are read.

        Raises:
            InputError: If anything in it is wrong; all faults at once.
        """
        given.of_kind("source", source, Source, "a Source, as Scenario.source is")
        source = source.complete()
        fields = _core.read_scenario(source)
        return cls(
            name=Path(source.file).stem.strip(".") or "scenario",
            source=source,
            merit=merit(fields.pop("merit")),
            facts=tuple(fields.pop("facts")),
            factors=tuple(map(factor, fields.pop("factors"))),
            published=published(fields.pop("published")),
            **fields,
        )

    def to_dict(self) -> dict[str, Any]:
        """Return the whole scenario as its file could have it, as nested dicts and lists."""
        return _core.read_document(self.source)

    def replace(self, path: str, value: Given) -> "Scenario":
        """Return the scenario with another value at a path, checked as a whole.

        Args:
            path: Keys from the root with dots between, such as "clock.time_limit_s", "merit" or
                "study.vary.robots.wanderer.count".
            value: A text, a number, true or false, or a list or dict of these, as the file could
                have it.

        Raises:
            InputError: If the value is not allowed there.
        """
        return self.changed((Override.at(path, value, "replace"),))

    def changed(self, overrides: tuple[Override, ...]) -> "Scenario":
        """Return the scenario with other values over its own, all checked together.

        Raises:
            InputError: If any is not allowed; all faults at once.
        """
        every = self.source.overrides + all_overrides(overrides)
        return Scenario.of(replace(self.source, overrides=every))

    def configuration(self, values: Mapping[str, Value]) -> _core.Configuration:
        """Return what is run: the scenario with a value for each path of `values`.

        Raises:
            InputError: If a path is none that can be varied, or a value is not allowed there,
                alone or with the others; all faults at once.
        """
        given.of_kind("values", values, Mapping, "a dict of values by their paths")
        for path in values:
            of_path("values", path)
        return _core.read_configuration(self.source, dict(values))

    def metric(self) -> _core.MetricScenario:
        """Return what a run of the metric engine needs.

        Raises:
            InputError: If the scenario is of another engine.
        """
        self._is_of("metric", "others have no brains; of classic runs see ClassicSimulation")
        return _core.read_metric(self.source)

    def classic(self) -> _core.ClassicScenario:
        """Return what a run of the classic engine needs.

        Raises:
            InputError: If the scenario is of another engine.
        """
        self._is_of("classic", "of metric runs see Simulation")
        return _core.read_classic(self.source)

    def _is_of(self, engine: str, else_see: str) -> None:
        if self.engine != engine:
            file = self.source.file
            message = f"{file}: engine = {self.engine!r}: must be {engine!r}: {else_see}"
            raise InputError(message)


def of_path(origin: str, path: object) -> None:
    """See to it that something can be a path in a scenario.

    Raises:
        InputError: If it is no text, or has too many keys.
    """
    allowed = f"keys from the root, as clock.time_limit_s; at most {MAX_KEYS}"
    is_path = given.is_text(path) and path.count(".") < MAX_KEYS
    given.check(is_path, f"{origin}: path", path, allowed)


def all_overrides(overrides: tuple[Override, ...]) -> tuple[Override, ...]:
    """Return the overrides of an argument.

    Raises:
        InputError: If it is something else.
    """
    allowed = "a tuple of Override"
    given.of_kind("overrides", overrides, tuple | list, allowed)
    for each in overrides:
        given.of_kind("overrides", each, Override, allowed)
    return tuple(overrides)


def loaded(scenario: Scenario | str | Path) -> Scenario:
    """Return a scenario that is given, or read the one of a file or a name, as `load` does.

    Raises:
        InputError: If it is none of these, or wrong; all faults at once.
    """
    if isinstance(scenario, Scenario):
        return scenario
    allowed = "a Scenario, a file, or the name of one that ships"
    given.of_kind("scenario", scenario, str | Path, allowed)
    return Scenario.load(scenario)


def no_text(file: Path, error: UnicodeDecodeError) -> str:
    """Return what is wrong with a file that is no text."""
    if error.object.startswith(RECORDING):
        again = f"agent-economy rerun {file}"
        return f"{file}: must be a scenario, and is a recording; to take its run again: {again}"
    return f"{file}: is not UTF-8 text: byte {error.start} is {error.object[error.start]:#x}"


def factor(fields: dict[str, Any]) -> Factor:
    """Return a factor as the compiled part read it."""
    return Factor(fields["path"], tuple(fields["values"]), fields["range"])


def merit(fields: dict[str, Any]) -> Merit:
    """Return a figure of merit as the compiled part read it."""
    terms = tuple(Term(*term) for term in fields["terms"])
    return Merit(in_words(fields["name"], terms), terms)


def published(fields: dict[str, Any] | None) -> Published | None:
    """Return published results as the compiled part read them."""
    return Published(**fields | {"times_s": dict(fields["times_s"])}) if fields else None
