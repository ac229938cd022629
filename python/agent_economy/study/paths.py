"""Paths of factors that are team sizes."""

TEAM = ("robots.", ".count")
"""Prefix and suffix of the path of a factor that is a team size."""


def robot_kind(path: str) -> str | None:
    """Return the robot kind whose team size a path is, if it is one."""
    start, end = TEAM
    return path[len(start) : -len(end)] if path.startswith(start) and path.endswith(end) else None
