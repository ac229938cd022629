"""The versions on which results may depend."""

import platform
from functools import cache
from importlib.metadata import version

PACKAGES = ("agent-economy", "numpy", "pyarrow", "scipy", "vl-convert-python")


@cache
def versions() -> dict[str, str]:
    """Return the version of each package, and of Python."""
    return {name: version(name) for name in PACKAGES} | {"python": platform.python_version()}
