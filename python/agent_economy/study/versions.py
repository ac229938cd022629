"""The versions on which results may depend."""

import platform
from importlib.metadata import version

PACKAGES = ("agent-economy", "numpy", "salib", "scipy")


def versions() -> dict[str, str]:
    """Return the version of each package, and of Python."""
    return {name: version(name) for name in PACKAGES} | {"python": platform.python_version()}
