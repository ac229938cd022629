"""Functions and classes that users pass to studies: their names, and the hash of their source.

Workers import them by name. The hash covers the module that defines them and what it imports that
is not installed, so that runs of changed code are never mixed with older ones.
"""

import hashlib
import importlib
import sys
import sysconfig
import traceback
from collections.abc import Iterable, Mapping
from importlib.machinery import PathFinder
from modulefinder import ModuleFinder
from pathlib import Path
from typing import Any

from agent_economy import _core
from agent_economy._core import InputError

INSTALLED = frozenset({"site-packages", "dist-packages"})
"""Folders with packages that are independent of each other."""

OWN = "agent_economy"
"""This program, whose build is known by its version."""

PACKAGE = 5
"""The type of a package, as `modulefinder` numbers them."""

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
    module = imported(subject, name, module_name)
    try:
        return found(module, path)
    except (AttributeError, KeyError):
        place = getattr(module, "__file__", None) or "of Python itself"
        message = f"{subject} = {name!r}: the module {module_name} ({place}) has no {path}"
        raise InputError(message) from None


def imported(subject: str, name: str, module: str) -> Any:
    """Import a module of a user.

    Raises:
        InputError: If there is none, or it raises an error.
    """
    try:
        return importlib.import_module(module)
    except ModuleNotFoundError as error:
        if error.name == module or module.startswith(f"{error.name}."):
            advice = ": leave out .py" if module.endswith(".py") else ""
            message = (
                f"{subject} = {name!r}: there is no module {error.name}{advice}: it must be in the "
                "working folder, in a folder of PYTHONPATH, or installed; also where workers run"
            )
            raise InputError(message) from None
        why: BaseException = error
    except (Exception, SystemExit) as error:  # noqa: BLE001  (a module may fail in any way)
        why = error
    message = f"{subject} = {name!r}: the module {module} cannot be imported: {reason(why)}"
    raise InputError(message)


def reason(error: BaseException) -> str:
    """Return an error in one line, with the last line of a user's code that led to it."""
    words = " ".join(f"{type(error).__name__}: {error}".split()).removesuffix(":")
    frames = traceback.extract_tb(error.__traceback__)
    own = [frame for frame in frames if is_of_user(frame.filename)]
    return f"{words} ({own[-1].filename}:{own[-1].lineno})" if own else words


def is_of_user(file: str) -> bool:
    """Return whether a file belongs to a user: not to this program, Python or a package."""
    path = Path(file)
    places = (Path(_core.__file__).parent, standard_library())
    is_elsewhere = any(path.is_relative_to(place) for place in places)
    return path.is_file() and not is_elsewhere and INSTALLED.isdisjoint(path.parts)


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
    """Return the hash of the source of modules, and of what they import that is not installed.

    Of an installed package, it covers that package alone. What is imported by a name that the
    program computes is not covered.

    Raises:
        InputError: If a module has no source file.
    """
    files: dict[str, Path] = {}
    for name in modules:
        files |= source_files(subject, name)
    total = hashlib.sha256()
    for name, path in sorted(files.items()):
        total.update(f"{name}\n{hashlib.sha256(path.read_bytes()).hexdigest()}\n".encode())
    return total.hexdigest()


def source_files(subject: str, name: str) -> dict[str, Path]:
    """Return the files of a module and of what it imports, by the names of modules.

    Raises:
        InputError: If it has no source file.
    """
    own, own_file = own_name(name), source_file(subject, name)
    root = own_file.parents[own.count(".") + (own_file.stem == "__init__")]
    finder = SourceFinder(path=search_path(root), excludes=independent(root, own))
    try:
        finder.import_hook(own)
    except ImportError:  # A compiled module, or a file of another name.
        return {own: own_file}
    modules: Iterable[Any] = finder.modules.values()
    files = {each.__name__: Path(each.__file__) for each in modules if each.__file__}
    return {own: own_file} | {each: file for each, file in files.items() if file.is_file()}


def search_path(root: Path) -> list[str]:
    """Return the folders in which imports are found: that of a module, and those of other users'.

    Installed packages are searched only for themselves.
    """
    if is_installed(root):
        return [str(root)]
    others = (Path(entry).resolve() for entry in sys.path)
    own = [root, *(each for each in others if each.is_dir() and not is_installed(each))]
    return [str(each) for each in dict.fromkeys(own)]


def is_installed(folder: Path) -> bool:
    """Return whether a folder contains Python's library, or packages that are installed."""
    return folder.name in INSTALLED or folder.is_relative_to(standard_library())


def standard_library() -> Path:
    """Return the folder of Python's library."""
    return Path(sysconfig.get_path("stdlib")).resolve()


def independent(root: Path, module: str) -> list[str]:
    """Return the modules that are not part of the source of one: this program, other packages."""
    if not is_installed(root):
        return [OWN]
    package = module.partition(".")[0]
    return sorted({entry.name.partition(".")[0] for entry in root.iterdir()} - {package})


class SourceFinder(ModuleFinder):
    """Finds what a module imports, in any of its functions, without running it."""

    def find_module(self, name: str, path: Any, parent: Any = None) -> Any:
        """Find a module; also a package without `__init__.py`, which the base class cannot.

        Raises:
            ImportError: If there is none.
        """
        try:
            return super().find_module(name, path, parent)
        except (TypeError, AttributeError):
            spec = PathFinder.find_spec(name, self.path if path is None else path)
            places = list(spec.submodule_search_locations or ()) if spec else []
            if not places:
                raise ImportError(name) from None
            return None, places[0], ("", "", PACKAGE)

    def load_package(self, fqname: str, pathname: str) -> Any:
        """Load a package, also one without `__init__.py`."""
        try:
            return super().load_package(fqname, pathname)
        except ImportError:
            return self.modules[fqname]


def source_file(subject: str, module: str) -> Path:
    """Return the file of a module.

    Raises:
        InputError: If it has none, or cannot be imported.
    """
    place = sys.modules.get(module) or imported(subject, module, module)
    file = getattr(place, "__file__", None)
    if file is None or not Path(file).is_file():
        message = (
            f"{subject}: is defined in {module}, which is not a file, as in an interactive "
            "session: put it in a module: the hash of its source is stored with the runs"
        )
        raise InputError(message)
    return Path(file).absolute()


def own_name(module: str) -> str:
    """Return the name by which other processes import a module, also that of the script."""
    if module not in MAIN:
        return module
    main = sys.modules["__main__"]
    spec, file = getattr(main, "__spec__", None), getattr(main, "__file__", None)
    if spec is not None:
        return str(spec.name)
    return Path(file).stem if file else module
