"""Functions and classes that users pass to studies: their names, and the hash of their source.

Workers import them by name. The hash covers the module that defines them and what it imports from
the same place, so that runs of changed code are never mixed with older ones.
"""

import hashlib
import importlib
import sys
import sysconfig
from collections.abc import Iterable, Mapping
from modulefinder import ModuleFinder
from pathlib import Path
from typing import Any

from agent_economy._core import InputError

INSTALLED = frozenset({"site-packages", "dist-packages"})
"""Folders with packages that are independent of each other."""

OWN = "agent_economy"
"""This program, whose build is known by its version."""

MAIN = ("__main__", "__mp_main__")
"""Names of the module of a script that runs."""


def name_of(subject: str, given: Any) -> str:
    """Return the name of a class or function at the top level of a module, MODULE:NAME.

    Raises:
        InputError: If it has no such name, or its module is not a file.
    """
    module, path = (str(getattr(given, key, "")) for key in ("__module__", "__qualname__"))
    try:
        is_named = found(sys.modules[module], path) is given
    except (AttributeError, KeyError):
        is_named = False
    if not is_named:
        message = (
            f"{subject} = {given!r}: must be a class or function at the top level of a module: "
            "workers, and a study that is resumed, import it by its name; what has parameters can "
            "be an entry of a dict that is passed by its name, 'MODULE:NAME'"
        )
        raise InputError(message)
    source_file(subject, module)
    return f"{own_name(module)}:{path}"


def load(subject: str, name: str) -> Any:
    """Return what a name stands for: MODULE:NAME, or MODULE:NAME.KEY for an entry of a dict.

    Raises:
        InputError: If the name has another form, or there is nothing of this name.
    """
    module_name, _, path = name.partition(":")
    if not (all(module_name.split(".")) and all(path.split("."))):
        message = f"{subject} = {name!r}: must be MODULE:NAME, such as my_brains:BRAINS"
        raise InputError(message)
    try:
        return found(importlib.import_module(module_name), path)
    except ModuleNotFoundError as error:
        if error.name != module_name and not module_name.startswith(f"{error.name}."):
            raise
        message = (
            f"{subject} = {name!r}: there is no module {error.name}: it must be in the working "
            "folder, in a folder of PYTHONPATH, or installed; also where workers run"
        )
        raise InputError(message) from None
    except (AttributeError, KeyError):
        message = f"{subject} = {name!r}: the module {module_name} has no {path}"
        raise InputError(message) from None


def found(place: Any, path: str) -> Any:
    """Return what a path of attributes, and of keys of dicts, leads to.

    Raises:
        AttributeError: If there is no such attribute.
        KeyError: If there is no such key.
    """
    for part in path.split("."):
        place = place[part] if isinstance(place, Mapping) else getattr(place, part)
    return place


def source_hash(subject: str, modules: Iterable[str]) -> str:
    """Return the hash of the source of modules, and of what they import from the same place.

    The same place is the folder that contains the module, or its outermost package; of an installed
    package, the package alone. What is imported from elsewhere is not covered.

    Raises:
        InputError: If a module has no source file.
    """
    places = {
        (path.relative_to(root).as_posix(), path)
        for name in modules
        for root, path in source_files(subject, name)
    }
    total = hashlib.sha256()
    for place, path in sorted(places):
        total.update(f"{place}\n{hashlib.sha256(path.read_bytes()).hexdigest()}\n".encode())
    return total.hexdigest()


def source_files(subject: str, name: str) -> list[tuple[Path, Path]]:
    """Return the files of a module and of what it imports, each with the folder of all of them.

    Raises:
        InputError: If it has no source file.
    """
    own = source_file(subject, name)
    root = own.parent
    while (root / "__init__.py").exists():
        root = root.parent
    place = own.relative_to(root).with_suffix("")
    parts = place.parent.parts if place.name == "__init__" else place.parts
    finder = SourceFinder(path=[str(root)], excludes=independent(root, parts[0]))
    try:
        finder.import_hook(".".join(parts))
    except ImportError:  # A compiled module, or a file of another name.
        return [(root, own)]
    modules: Iterable[Any] = finder.modules.values()
    imported = {Path(each.__file__).resolve() for each in modules if each.__file__}
    return [(root, path) for path in {own, *imported}]


def independent(root: Path, package: str) -> list[str]:
    """Return the modules in a folder that are not part of the source of one of its packages."""
    if root.name not in INSTALLED and root != Path(sysconfig.get_path("stdlib")).resolve():
        return [OWN]
    return sorted({entry.name.partition(".")[0] for entry in root.iterdir()} - {package})


class SourceFinder(ModuleFinder):
    """Finds what a module imports, in any of its functions, without running it."""

    def find_module(self, name: str, path: Any, parent: Any = None) -> Any:
        """Find a module.

        Raises:
            ImportError: If there is none, or a folder without `__init__.py` has its name.
        """
        try:
            return super().find_module(name, path, parent)
        except (TypeError, AttributeError):
            raise ImportError(name) from None


def source_file(subject: str, module: str) -> Path:
    """Return the file of a module.

    Raises:
        InputError: If it has none, or cannot be imported.
    """
    try:
        place = sys.modules.get(module) or importlib.import_module(module)
    except ImportError as error:
        message = f"{subject}: the module that defines it cannot be imported ({error})"
        raise InputError(message) from None
    file = getattr(place, "__file__", None)
    if file is None or not Path(file).is_file():
        message = (
            f"{subject}: is defined in {module}, which is not a file, as in an interactive "
            "session: put it in a module: the hash of its source is stored with the runs"
        )
        raise InputError(message)
    return Path(file).resolve()


def own_name(module: str) -> str:
    """Return the name by which other processes import a module, also that of the script."""
    if module not in MAIN:
        return module
    main = sys.modules["__main__"]
    spec, file = getattr(main, "__spec__", None), getattr(main, "__file__", None)
    if spec is not None:
        return str(spec.name)
    return Path(file).stem if file else module
