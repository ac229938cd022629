"""A scenario: everything that does not change in a run, and what its study does."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from html import escape
from pathlib import Path
from typing import Any

from agent_economy import _core
from agent_economy._core import InputError
from agent_economy.scenario import bundled, validation
from agent_economy.scenario.merit import Merit, Term, display_name, shortest
from agent_economy.scenario.requirement import Condition, Requirement
from agent_economy.scenario.source import (
    MAX_BYTES,
    Override,
    Source,
    TomlValue,
    Value,
    check_overrides,
    check_path,
    decode,
    read_file,
)
from agent_economy.scenario.warning import ScenarioWarning, warnings

MAX_VALUES = 8
"""Maximum number of values of a factor that are printed."""


@dataclass(frozen=True)
class Published:
    """Results from the literature, displayed with those of the study.

    Attributes:
        source: Where they were published.
        choice: The team size that they recommend.
        time_limit_s: When they stopped a run; a run with this time has failed.
        times_s: The times of a team's runs, by team size.
    """

    source: str
    choice: int
    time_limit_s: float
    times_s: dict[int, list[float]]


@dataclass(frozen=True)
class Factor:
    """A factor that a study varies, with its values.

    Attributes:
        path: Dotted keys from the scenario's root.
        values: Numbers in ascending order, or names in the order of the file; empty for a range.
        range: Smallest and largest value of a continuous range; None if `values` lists them.
    """

    path: str
    values: tuple[Value, ...]
    range: tuple[float, float] | None = None

    def __str__(self) -> str:
        """Return its values in short: "1..40", "1, 2, 4", "touch, ahead"."""
        if self.range:
            return "..".join(map(shortest, self.range))
        values = self.values
        first, last = values[0], values[-1]
        is_whole = type(first) is int and type(last) is int
        if is_whole and len(values) > 1 and values == tuple(range(int(first), int(last) + 1)):
            return f"{first}..{last}"
        shown = [str(value) for value in values[:MAX_VALUES]]
        return ", ".join(shown + (["..."] if len(values) > MAX_VALUES else []))


@dataclass(frozen=True)
class Scenario:
    """Everything that does not change in a run, and what its study does.

    Attributes:
        name: The file name without its extension.
        source: Its text, overrides and files.
        engine: The simulator that runs it: "metric" or "classic".
        summary: A one-line description.
        merit: The figure of merit that scores runs.
        robots: Number of robots in a single run, by kind.
        time_limit_s: A run that takes longer has failed, and counts as this long.
        facts: Further constants of the scenario for display: pairs of a name and a string.
        factors: The factors that a study varies, in a fixed order; may be empty.
        design: Which configurations it compares: "factorial", "lhs:N" or "sobol:N" (N points).
        delta: Indifference zone: the smallest difference in merit that matters, above 0; None if
            the file has none.
        confidence: Probability with which the answer is right: from 0.5 to below 1.
        requirement: What a mission must meet, and in which share of missions; None if the file has
            no requirement.
        cost: What a study with a requirement minimises: the cost of a team, as an expression.
        where: Which combinations of values a study compares, as an expression; None for all.
        published: Results from the literature, if the file has them.
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
    requirement: Requirement | None
    cost: str
    where: str | None
    published: Published | None

    @classmethod
    def load(cls, file: str | Path, overrides: tuple[Override, ...] = ()) -> "Scenario":
        """Read a scenario from a file, or a bundled one by its name, such as "classic".

        Raises:
            InputError: If the file cannot be read or it has errors; the message lists all of them.
        """
        file = bundled.find(validation.path("file", file))
        data = read_file(file, MAX_BYTES)
        if isinstance(data, str):
            message = f"{file}: cannot be read: {data}{bundled.suggestion(file)}"
            raise InputError(message)
        try:
            text = decode(file, data)
        except ValueError as error:
            raise InputError(str(error)) from None
        return cls.loads(text, file=str(file), overrides=overrides)

    @classmethod
    def loads(
        cls, text: str, file: str = "scenario.toml", overrides: tuple[Override, ...] = ()
    ) -> "Scenario":
        """Read a scenario from TOML text; errors name it `file`.

        Raises:
            InputError: If it has errors; the message lists all of them.
        """
        return cls.of(Source(file, text, check_overrides(overrides)))

    @classmethod
    def of(cls, source: Source) -> "Scenario":
        """Read a scenario from its source, with files that the source only refers to.

        Raises:
            InputError: If it has errors; the message lists all of them.
        """
        validation.of_type("source", source, Source, "a Source, such as Scenario.source")
        source = source.complete()
        fields = _core.read_scenario(source)
        return cls(
            name=Path(source.file).stem.strip(".") or "scenario",
            source=source,
            merit=merit_of(fields.pop("merit")),
            facts=tuple(fields.pop("facts")),
            factors=tuple(map(factor_of, fields.pop("factors"))),
            requirement=requirement_of(fields.pop("requirement")),
            published=published_of(fields.pop("published")),
            **fields,
        )

    def __repr__(self) -> str:
        """Return it in one line, without its text."""
        varied = ", ".join(f"{factor.path} = {factor}" for factor in self.factors)
        return f"Scenario({self.name!r}: {self.summary} Varied: {varied or 'nothing'}.)"

    def _repr_html_(self) -> str:
        """Return it for notebooks."""
        rows = [("engine", self.engine), ("merit", self.merit.name)]
        rows += [(f"varied: {factor.path}", str(factor)) for factor in self.factors]
        if self.requirement:
            rows.append(("requirement", str(self.requirement)))
        cells = "".join(f"<tr><td>{escape(a)}</td><td>{escape(b)}</td></tr>" for a, b in rows)
        head = f"<b>{escape(self.name)}</b>: {escape(self.summary)}"
        return f"{head}<table>{cells}</table>"

    @cached_property
    def controllers(self) -> dict[str, int]:
        """Number of controllers in a single run, by kind."""
        kinds = self.to_dict().get("controllers", {})
        return {name: kind["count"] for name, kind in kinds.items()}

    @cached_property
    def warnings(self) -> tuple[ScenarioWarning, ...]:
        """Warnings about a single run, such as robots without room (see docs/scenario.md)."""
        return warnings(self.source, [{}])

    @cached_property
    def derived(self) -> tuple[tuple[str, str], ...]:
        """Quantities that follow from its values, as pairs of a name and a string.

        For each item detector and kind of item: the share that a straight pass at maximum speed
        detects, and the share that no number of passes exceeds.
        """
        return tuple(_core.derived_quantities(self.source))

    def to_dict(self) -> dict[str, Any]:
        """Return the scenario, including defaults, as nested dicts and lists like its TOML."""
        return _core.read_document(self.source)

    def replace(self, path: str, value: TomlValue) -> "Scenario":
        """Return a copy with another value at a path, checked as a whole.

        Args:
            path: Dotted keys from the root, such as "clock.time_limit_s", "merit" or
                "study.vary.robots.wanderer.count".
            value: A string, number, bool, or a list or dict of these, as in a TOML file.

        Raises:
            InputError: If the value is not allowed there.
        """
        return self.changed((Override.at(path, value, "replace"),))

    def changed(self, overrides: tuple[Override, ...]) -> "Scenario":
        """Return a copy with other values, all checked together.

        Raises:
            InputError: If any is not allowed. It lists all errors.
        """
        every = self.source.overrides + check_overrides(overrides)
        return Scenario.of(replace(self.source, overrides=every))

    def configuration(self, values: Mapping[str, Value]) -> _core.Configuration:
        """Return a configuration to run: the scenario with a value for each path of `values`.

        Raises:
            InputError: If a path cannot be varied, or a value is not allowed there, alone or in
                combination. It lists all errors.
        """
        validation.of_type("values", values, Mapping, "a dict of values by path")
        for path in values:
            check_path("values", path)
        return _core.read_configuration(self.source, validation.plain_value("values", values))

    def metric(self) -> _core.MetricScenario:
        """Return the compiled form for a run of the metric engine.

        Raises:
            InputError: If the scenario is for another engine.
        """
        self._require_engine("metric", "for classic runs use ClassicSimulation")
        return _core.read_metric(self.source)

    def classic(self) -> _core.ClassicScenario:
        """Return the compiled form for a run of the classic engine.

        Raises:
            InputError: If the scenario is for another engine.
        """
        self._require_engine("classic", "for metric runs use Simulation")
        return _core.read_classic(self.source)

    def _require_engine(self, engine: str, advice: str) -> None:
        if self.engine != engine:
            file = self.source.file
            message = f"{file}: engine = {self.engine!r}: must be {engine!r}: {advice}"
            raise InputError(message)


def as_scenario(scenario: Scenario | str | Path) -> Scenario:
    """Return a scenario as it is, or load the one of a file or a bundled name.

    Raises:
        InputError: If it is neither, or it has errors; the message lists all of them.
    """
    if isinstance(scenario, Scenario):
        return scenario
    allowed = "a Scenario, a file, or the name of a bundled scenario"
    validation.of_type("scenario", scenario, str | Path, allowed)
    return Scenario.load(scenario)


def factor_of(fields: dict[str, Any]) -> Factor:
    """Return a factor from the fields that the Rust core read."""
    return Factor(fields["path"], tuple(fields["values"]), fields["range"])


def merit_of(fields: dict[str, Any]) -> Merit:
    """Return a figure of merit from the fields that the Rust core read."""
    terms = tuple(Term(*term) for term in fields["terms"])
    return Merit(display_name(fields["name"], terms), terms)


def requirement_of(fields: Mapping[str, Any] | None) -> Requirement | None:
    """Return a requirement."""
    if fields is None:
        return None
    conditions = tuple(Condition(*each) for each in fields["conditions"])
    return Requirement(conditions, fields["probability"], fields["tolerance"])


def published_of(fields: dict[str, Any] | None) -> Published | None:
    """Return published results from the fields that the Rust core read."""
    return Published(**fields | {"times_s": dict(fields["times_s"])}) if fields else None
