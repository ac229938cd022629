"""The JavaScript that draws the charts of a report, bundled once per version of vl-convert."""

import contextlib
import os
import subprocess
import sys
from importlib.metadata import version
from pathlib import Path
from typing import Self

from agent_economy.study.errors import StudyError
from agent_economy.whole_file import remove_abandoned, write_whole

BUNDLE = (
    "import sys, vl_convert; "
    "sys.stdout.buffer.write(vl_convert.javascript_bundle().encode('utf-8'))"
)


class ChartScript:
    """The script, from the user's cache; where it is not there yet, from a process of its own.

    Bundling takes vl-convert two seconds or more, during which it holds the interpreter's lock. In
    a separate process it runs while the study does and cannot delay Ctrl-C. The result is kept in
    `cache_file()` for later studies, if that can be written. Use as a context manager: on exit the
    process ends.
    """

    def __init__(self) -> None:
        """Read the cached script, or start to bundle it."""
        self._text = cached()
        self._process = None if self._text else start_bundling()

    def __enter__(self) -> Self:
        """Return itself."""
        return self

    def __exit__(self, *_: object) -> None:
        """End the process if it is still running."""
        if self._process:
            self._process.kill()
            self._process.communicate()

    def text(self) -> str:
        """Return the script, after waiting until it is bundled.

        Raises:
            StudyError: If vl-convert failed; with its error output.
        """
        if self._process:
            self._text, errors = self._process.communicate()
            if self._process.returncode != 0:
                message = f"vl-convert could not bundle the chart script: {errors.strip()}"
                raise StudyError(message)
            self._process = None
            keep(self._text)
        return self._text


def start_bundling() -> "subprocess.Popen[str]":
    """Start a process that prints the script."""
    return subprocess.Popen(
        [sys.executable, "-c", BUNDLE],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        encoding="utf-8",
    )


def cache_file() -> Path:
    """Return where the script is cached: in $XDG_CACHE_HOME, by default ~/.cache.

    Raises:
        RuntimeError: If the user has no home directory.
    """
    folder = Path(os.environ.get("XDG_CACHE_HOME", ""))
    if not folder.is_absolute():
        folder = Path.home() / ".cache"
    return folder / "agent-economy" / f"charts-{version('vl-convert-python')}.js"


def cached() -> str:
    """Return the cached script; an empty string if there is none."""
    with contextlib.suppress(OSError, RuntimeError, UnicodeDecodeError):
        return cache_file().read_text(encoding="utf-8")
    return ""


def keep(script: str) -> None:
    """Cache a script if possible: it appears whole, also if several processes write it."""
    with contextlib.suppress(OSError, RuntimeError):
        path = cache_file()
        path.parent.mkdir(parents=True, exist_ok=True)
        remove_abandoned(path.parent)
        write_whole(path, script.encode())
