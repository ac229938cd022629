"""What is in the log of a recording, so that it is not written again after a change."""

from dataclasses import dataclass, field


@dataclass(frozen=True)
class Logged:
    """What is in the log of a recording; it is kept up to date.

    Attributes:
        finds: Names of the items whose finds are in it.
        warnings: Warnings about goals and controllers, as NAME: WORDS.
    """

    finds: set[str] = field(default_factory=set)
    warnings: set[str] = field(default_factory=set)
