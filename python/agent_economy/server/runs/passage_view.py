"""The passage of a mined lane by vehicles, as a page displays it."""

from agent_economy.runs.passage import ClearedShare, Passage, Vehicle
from agent_economy.types.page import ClearedView, PassageView, VehicleView


def cleared_view(of: ClearedShare) -> ClearedView:
    """Return the share of the mines of a kind that are cleared."""
    return {
        "kind": of.kind,
        "cleared": of.cleared,
        "left": of.left,
        "share": of.share,
        "low": of.low,
        "high": of.high,
    }


def passage_view(of: Passage) -> PassageView:
    """Return a path with the risk of the vehicles on it."""
    return {
        "path": of.path_m,
        "width_m": of.width_m,
        "length_m": of.length_m,
        "mines": of.mines,
        "risks": of.risks,
    }


def vehicle_view(of: Vehicle) -> VehicleView:
    """Return a vehicle."""
    return {"name": of.name, "at": of.at_m, "has_entered": of.has_entered, "status": of.status}
