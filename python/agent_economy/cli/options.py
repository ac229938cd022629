"""Options that commands share, and the values of a scenario that options replace."""

import tomllib
from collections.abc import Mapping
from typing import Annotated, Any

import typer

from agent_economy._core import InputError
from agent_economy.scenario import Override, TomlValue
from agent_economy.scenario.validation import check, is_text

ScenarioArgument = typer.Argument(
    help="A scenario file (TOML), or the name of a bundled one.", show_default=False
)

Sets = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="PATH=VALUE",
        help="Replace a value of the scenario, such as clock.time_limit_s=60; may be repeated.",
        show_default=False,
    ),
]
"""The option --set of every command that takes a scenario."""

Seed = Annotated[
    int,
    typer.Option(
        "--seed", min=0, max=2**64 - 1, help="Random seed: the same seed gives the same bytes."
    ),
]
"""The option --seed of a command that runs a scenario."""


OPTION_NAMES = {"require.all": "require"}
"""Options whose names are not the last key of their path."""


def overrides(
    sets: list[str] | None,
    vary: list[str] | None = None,
    *,
    only_vary: bool = False,
    options: Mapping[str, TomlValue | None] | None = None,
) -> tuple[Override, ...]:
    """Return the values that options set, in place of the file's.

    Args:
        sets: Values of --set.
        vary: Values of --vary.
        only_vary: Whether they replace the factors of the scenario, instead of adding to them.
        options: Values of other options by the path that they replace; None for those not given.

    Raises:
        InputError: If a --set is not PATH=VALUE, a --vary is not PATH=VALUES, or one of them has a
            path twice.
    """
    changes = [assigned(text) for text in once("--set", sets or [])]
    factors = [varied(text) for text in once("--vary", vary or [])]
    if only_vary:
        check(bool(factors), "--only-vary", "", "given with --vary")
        table = {each.path[-1]: each.value for each in factors}
        factors = [Override(("study", "vary"), table, "--vary")]
    changes += factors
    changes += [
        Override(tuple(path.split(".")), value, f"--{OPTION_NAMES.get(path, path.split('.')[-1])}")
        for path, value in (options or {}).items()
        if value is not None
    ]
    return tuple(changes)


def once(option: str, given: list[str]) -> list[str]:
    """Return the values of an option that allows each path once.

    Raises:
        InputError: If a path occurs twice.
    """
    paths = [text.partition("=")[0].strip() for text in given]
    twice = next((path for path in paths if paths.count(path) > 1), None)
    if twice:
        example = f", such as {twice}=1..4,8" if option == "--vary" else ""
        message = f"{option} {twice}: occurs twice: expected once{example}"
        raise InputError(message)
    return given


def assigned(text: str) -> Override:
    """Return the override of PATH=VALUE."""
    path, value = parts("--set", text, "PATH=VALUE, such as clock.time_limit_s=60")
    return Override.at(path, parsed(value), f"--set {path}")


def varied(text: str) -> Override:
    """Return the override of PATH=VALUES."""
    path, values = parts("--vary", text, "PATH=VALUES, such as robots.wanderer.count=1..12")
    return Override(("study", "vary", path), values, "--vary")


def parts(option: str, text: str, allowed: str) -> tuple[str, str]:
    """Return the parts before and after the first equals sign."""
    path, equals, value = text.partition("=")
    check(bool(equals) and is_text(text), option, text, allowed)
    return path.strip(), value.strip()


def parsed(text: str) -> Any:
    """Return a value read as TOML, or as a string where it is not valid TOML."""
    try:
        document = tomllib.loads(f"value = {text}")
    except tomllib.TOMLDecodeError:
        return text
    return document["value"] if len(document) == 1 else text
