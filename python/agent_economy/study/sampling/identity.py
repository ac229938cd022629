"""Which sampler has computed runs: its name, its plain arguments and the hash of its source."""

import inspect
from collections.abc import Callable, Iterator
from functools import partial
from numbers import Number
from types import NoneType
from typing import Any

import numpy as np

from agent_economy.study.user_code import own_name, source_hash

PLAIN = (Number, str, NoneType, np.bool_)
"""Types of arguments whose value is part of the identity."""

NOWHERE = "builtins"
"""The module of what names none: it has no source."""


def identity(sampler: Callable[..., Any]) -> dict[str, Any]:
    """Return what distinguishes the runs of a sampler from those of others.

    Arguments of `functools.partial` are part of it if they are plain; what the sampler captures
    otherwise is not.

    Returns:
        `sampler` (MODULE:NAME), `arguments` and `source` (a hash).

    Raises:
        InputError: If a module has no source, as in an interactive session.
    """
    arguments: list[str] = []
    while isinstance(sampler, partial):
        arguments = [*words(sampler), *arguments]
        sampler = sampler.func
    modules, name = defined(sampler)
    source = source_hash("sampler", modules)
    return {"sampler": f"{own_name(modules[0])}:{name}", "arguments": arguments, "source": source}


def words(given: "partial[Any]") -> Iterator[str]:
    """Yield the arguments of a partial function in words; of what is not plain, the type."""
    named = sorted(given.keywords.items())
    for prefix, value in (*(("", each) for each in given.args), *named):
        word = repr(value) if isinstance(value, PLAIN) else type(value).__qualname__
        yield f"{prefix}={word}" if prefix else word


def defined(sampler: Callable[..., Any]) -> tuple[list[str], str]:
    """Return the modules that define a sampler, and its name in the first."""
    if inspect.ismethod(sampler):
        owner = sampler.__self__ if inspect.isclass(sampler.__self__) else type(sampler.__self__)
        name = f"{owner.__qualname__}.{sampler.__name__}"
        return [owner.__module__, sampler.__func__.__module__ or NOWHERE], name
    named = sampler if hasattr(sampler, "__qualname__") else type(sampler)
    name = named.__qualname__
    if name.endswith("<lambda>") and inspect.isfunction(sampler):
        # Others of the same source have the same name.
        name += f" in line {sampler.__code__.co_firstlineno}"
    return [named.__module__ or NOWHERE], name
