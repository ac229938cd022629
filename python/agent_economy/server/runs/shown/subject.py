"""A subject that pages can show: the layers and panels that it offers, and their contents."""

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

from agent_economy.types.page import Layer, LayerOffer, Panel, PanelOffer

LINKS, FOOTPRINTS = "links", "footprints"
"""Layers that come with each frame, as bytes: see `overlay`."""


class Request(NamedTuple):
    """What a page has requested.

    Attributes:
        layers: The ids of layers.
        panels: The ids of panels.
        choices: What has been chosen in panels and with markers, by key.
        robot: The selected robot; None if none is selected.
    """

    layers: frozenset[str] = frozenset()
    panels: frozenset[str] = frozenset()
    choices: Mapping[str, str] = {}
    robot: str | None = None

    @property
    def ids(self) -> frozenset[str]:
        """The ids of layers and panels."""
        return self.layers | self.panels


class Contents(NamedTuple):
    """The layers and panels of a subject at one moment, by id, each computed when it is called."""

    layers: Mapping[str, Callable[[], Layer]]
    panels: Mapping[str, Callable[[], Panel | None]]


class Subject(NamedTuple):
    """A subject.

    Attributes:
        layers: The layers that it offers, from bottom to top.
        panels: The panels that it offers.
        is_in: Returns whether a run has it.
        contents: Returns its contents in a run at the current moment, for what a page has
            requested; None if there are none.
    """

    layers: tuple[LayerOffer, ...]
    panels: tuple[PanelOffer, ...]
    is_in: Callable[[Any], bool]
    contents: Callable[[Any, Request], Contents | None]
