"""Descriptions of the outcome columns: label, unit, group, help, when the value is known."""

import re
from typing import Literal, NamedTuple

Known = Literal["always", "clock", "at_end", "reason"]
"""When a value is known: see `Known` in `agent_economy.types.page`."""

STATED = ("declared", "given_up")
"""The events that state a risk."""


class Description(NamedTuple):
    """The description of a column.

    Attributes:
        label: Its label.
        unit: Its unit; empty without one. Values of the unit % are shares, 0 to 1.
        group: The group of columns that it belongs to.
        help: What it is, in a sentence.
        known: When its value is known.
        after: Columns of which one must be true, or above 0, before its value is known.
        time_of: The column of the event whose time it is; None for none.
        out_of: The columns whose sum is the number of all, of which it counts some.
        of_all: Whether its upper bound is the number of all, of which it counts some.
    """

    label: str
    unit: str
    group: str
    help: str
    known: Known = "always"
    after: tuple[str, ...] = ()
    time_of: str | None = None
    out_of: tuple[str, ...] = ()
    of_all: bool = False


T = Description

GENERAL: dict[str, T] = {
    "complete": T(
        "Complete",
        "",
        "Mission",
        "Whether all targets were found and all goals served, or the condition of the scenario's "
        "end was met.",
    ),
    "merit": T(
        "Merit",
        "",
        "Mission",
        "The figure of merit of the run, by the weights of the scenario; higher is better.",
        "at_end",
    ),
    "time_s": T(
        "Time",
        "s",
        "Mission",
        "Time until the run was complete; the time limit if it was not.",
        "clock",
    ),
    "paints": T(
        "Paints",
        "paints",
        "Mission",
        "The paint of the last find. A paint is a redraw of the window of the 2003 program.",
        "at_end",
    ),
    "robots": T("Robots", "", "Team", "The number of robots in the team."),
    "price": T(
        "Price",
        "",
        "Team",
        "Sum of the prices of the robots and controllers, in the currency of the scenario.",
    ),
    "robots_stopped": T(
        "Robots stopped",
        "",
        "Team",
        "Robots that could not continue: battery empty, or broken.",
        of_all=True,
    ),
    "robots_lost": T(
        "Robots lost",
        "",
        "Team",
        "Robots that items destroyed, including those removed by a change.",
        of_all=True,
    ),
    "found": T(
        "Found",
        "",
        "Finds",
        "Targets that were found, of all targets.",
        out_of=("found", "missed"),
        of_all=True,
    ),
    "missed": T("Missed", "", "Finds", "Targets that were not found.", "at_end"),
    "false_alarms": T("False alarms", "", "Finds", "Contacts of nothing, reported to robots."),
    "collisions": T(
        "Collisions",
        "",
        "Costs",
        "New contacts of two robots, or of a robot with an obstacle.",
    ),
    "energy_j": T("Energy", "J", "Costs", "Energy used by all robots."),
    "distance_m": T("Distance", "m", "Costs", "Distance travelled by all robots."),
    "messages_sent": T(
        "Messages sent", "", "Messages", "Messages that robots and controllers sent."
    ),
    "messages_dropped": T(
        "Messages dropped",
        "",
        "Messages",
        "Messages dropped because the sender or a receiver had reached its maximum in the step.",
    ),
}
"""Columns of most scenarios."""

GOALS: dict[str, T] = {
    "goals": T("Goals", "", "Goals", "The number of goals in all."),
    "served": T(
        "Served",
        "",
        "Goals",
        "Goals that a robot served before their deadline, of all goals.",
        of_all=True,
    ),
    "served_twice": T("Served twice", "", "Goals", "Goals that several robots served."),
    "expired": T("Expired", "", "Goals", "Goals that no robot served in time."),
    "issued": T(
        "Issued",
        "",
        "Goals",
        "Goals that have arrived: those that were served or have expired, and the open, reported "
        "and unknown ones.",
    ),
    "open": T("Open", "", "Goals", "Goals that may still be served."),
    "reported": T(
        "Reported", "", "Goals", "Goals of which a controller has reported why none can serve them."
    ),
    "unknown": T("Unknown", "", "Goals", "Goals that no working agent knows."),
    "done_in_error": T(
        "Done in error",
        "",
        "Goals",
        "Goals that a robot reported as served when it was elsewhere or too short there, and that "
        "none has served.",
    ),
    "waiting_s": T(
        "Waiting time",
        "s",
        "Goals",
        "Time from the issue of a goal until its robot sets out, in the mean over the goals "
        "served.",
        after=("served",),
    ),
    "travel_s": T(
        "Travel time",
        "s",
        "Goals",
        "Time of driving to a goal, in the mean over the goals served.",
        after=("served",),
    ),
    "blocked_s": T(
        "Blocked time",
        "s",
        "Goals",
        "Time of standing on the way to a goal, in the mean over the goals served.",
        after=("served",),
    ),
    "service_s": T(
        "Service time",
        "s",
        "Goals",
        "Time at a goal until it is served, in the mean over the goals served.",
        after=("served",),
    ),
    "goals_refused": T(
        "Goals refused",
        "",
        "Goals",
        "Goals that controllers refused because they owned their maximum number.",
    ),
    "leases_lapsed": T(
        "Leases lapsed",
        "",
        "Goals",
        "Leases of robots that ended because they were not renewed.",
    ),
    "awards": T("Awards", "", "Goals", "Goals awarded to robots."),
    "reallocations": T("Reallocations", "", "Goals", "Goals awarded to another robot than before."),
}
"""Columns of scenarios with goals, or with controllers that award them."""

ACTS: dict[str, T] = {
    "marked": T("Marked", "", "Acts", "Targets that robots marked.", of_all=True),
    "false_marks": T(
        "False marks",
        "",
        "Acts",
        "Places without a target that were marked; places within 2 m of each other count once.",
    ),
    "confirmed": T("Confirmed", "", "Acts", "Targets that robots confirmed.", of_all=True),
    "false_confirmations": T(
        "False confirmations",
        "",
        "Acts",
        "Places without a target that were confirmed; places within 2 m of each other count once.",
    ),
    "neutralised": T(
        "Neutralised", "", "Acts", "Targets that robots destroyed with charges.", of_all=True
    ),
    "left": T("Left", "", "Acts", "Targets that are not complete yet.", of_all=True),
    "unmarked_from_air": T(
        "Unmarked from the air",
        "",
        "Acts",
        "Targets that no flying robot marked.",
        "at_end",
        of_all=True,
    ),
    "met_unmarked": T(
        "Met unmarked",
        "",
        "Acts",
        "Targets that no flying robot marked, and that a robot on the ground detected or came too "
        "near to.",
    ),
}
"""Columns of scenarios in which robots act on items."""

LANE: dict[str, T] = {
    "declared": T(
        "Declared", "", "Lane", "Whether the controllers declared the lane clear, and when."
    ),
    "declared_s": T(
        "Declared",
        "s",
        "Lane",
        "Time until the controllers declared the lane clear.",
        time_of="declared",
    ),
    "given_up": T(
        "Given up", "", "Lane", "Whether the controllers that work gave the lane up, and when."
    ),
    "given_up_s": T(
        "Given up",
        "s",
        "Lane",
        "Time until the controllers that work gave the lane up.",
        time_of="given_up",
    ),
    "declared_clear": T(
        "Declared, and clear",
        "",
        "Lane",
        "Whether the lane was declared clear, and had no mine left then.",
        after=("declared",),
    ),
    "declared_not_clear": T(
        "Declared, not clear",
        "",
        "Lane",
        "Whether the lane was declared clear, and had a mine left then.",
        after=("declared",),
    ),
    "stated_risk": T(
        "Stated risk",
        "%",
        "Lane",
        "The risk that was stated when the lane was declared clear, or given up: the probability "
        "that a mine is left.",
        after=STATED,
    ),
    "stated_unmarked": T(
        "Stated mines without a mark",
        "",
        "Lane",
        "The mines without a mark that the controller expected when it stated the risk.",
        after=STATED,
    ),
    "stated_marked": T(
        "Stated mines at marks",
        "",
        "Lane",
        "The mines at marks that the controller expected when it stated the risk.",
        after=STATED,
    ),
    "left_unmarked": T(
        "Mines left without a mark",
        "",
        "Lane",
        "The part of the mines left at the statement that the controller expected without a mark.",
        after=STATED,
    ),
    "left_marked": T(
        "Mines left at marks",
        "",
        "Lane",
        "The part of the mines left at the statement that the controller expected at marks.",
        after=STATED,
    ),
    "interrogated_s": T(
        "Interrogated",
        "s",
        "Lane",
        "Time until all marks that may be mines had a verdict; the time limit if some had none.",
        "at_end",
    ),
    "ended_hopeless": T(
        "Ended: hopeless",
        "",
        "Mission",
        "The run ended because nothing lowered the risk for a minute.",
        "reason",
    ),
    "ended_called_off": T(
        "Ended: called off",
        "",
        "Mission",
        "The run ended because a person called the mission off.",
        "reason",
    ),
    "ended_controllers_lost": T(
        "Ended: controllers lost",
        "",
        "Mission",
        "The run ended because no controller worked any more.",
        "reason",
    ),
    "ended_robots_lost": T(
        "Ended: robots lost",
        "",
        "Mission",
        "The run ended because no robot could move any more.",
        "reason",
    ),
    "ended_time_limit": T(
        "Ended: time limit", "", "Mission", "The run ended at its time limit.", "reason"
    ),
}
"""Columns of scenarios in which controllers are to clear a lane."""

PASSED = ("vehicles_passed", "vehicles_lost")

VEHICLES: dict[str, T] = {
    "stated_first_risk": T(
        "Stated risk of the first vehicle",
        "%",
        "Vehicles",
        "The probability that a mine destroys the first vehicle, as stated; 100% without a path.",
        after=STATED,
    ),
    "stated_last_risk": T(
        "Stated risk of the last vehicle",
        "%",
        "Vehicles",
        "The probability that a mine destroys the last vehicle, as stated; 100% without a path.",
        after=STATED,
    ),
    "first_lost": T(
        "First vehicle lost", "", "Vehicles", "Whether a mine destroyed the first vehicle."
    ),
    "last_lost": T(
        "Last vehicle lost", "", "Vehicles", "Whether a mine destroyed the last vehicle."
    ),
    "vehicles_passed": T(
        "Vehicles passed", "", "Vehicles", "Vehicles that have passed the lane.", of_all=True
    ),
    "vehicles_lost": T(
        "Vehicles lost", "", "Vehicles", "Vehicles that mines destroyed.", of_all=True
    ),
    "passed_s": T(
        "Passage over",
        "s",
        "Vehicles",
        "Time until each vehicle had passed or was destroyed; the time limit if some had not.",
        "at_end",
        PASSED,
    ),
    "path_m": T(
        "Path", "m", "Vehicles", "Length of the stated path; 0 without a path.", after=STATED
    ),
    "mines_on_path": T(
        "Mines on the path",
        "",
        "Vehicles",
        "Mines within the width of the path when it was stated.",
        after=STATED,
    ),
}
"""Columns of scenarios in which vehicles pass a lane."""

COLUMNS = {**GENERAL, **GOALS, **ACTS, **LANE, **VEHICLES}
"""The columns that are not of a kind of robots or items."""

OF_KINDS: dict[str, T] = {
    "found_KIND_K_s": T(
        "Find K of KIND", "s", "Finds", "Time of the K-th find of a KIND; missing if there is none."
    ),
    "found_KIND": T(
        "Found: KIND",
        "",
        "Finds",
        "Items of the kind KIND that were found, of all.",
        out_of=("found_KIND", "missed_KIND"),
    ),
    "missed_KIND": T(
        "Missed: KIND", "", "Finds", "Items of the kind KIND that were not found.", "at_end"
    ),
    "on_station_KIND_s": T(
        "Active time of KIND",
        "s",
        "Team",
        "Time for which robots of the kind KIND were active, in the mean.",
    ),
    "charges_used_KIND": T(
        "Charges used by KIND",
        "",
        "Costs",
        "Charges that all robots of the kind KIND have used, including those that were removed.",
    ),
    "energy_KIND_j": T(
        "Energy of KIND",
        "J",
        "Costs",
        "Energy that all robots of the kind KIND have used, including those that were removed.",
    ),
    "distance_KIND_m": T(
        "Distance of KIND",
        "m",
        "Costs",
        "Distance that all robots of the kind KIND have travelled, including those that were "
        "removed.",
    ),
    "stated_clearance_KIND_low": T(
        "Stated clearance of KIND, from",
        "%",
        "Lane",
        "Lower end of the interval that contains the cleared share of KIND with a probability of "
        "at least 95%, as stated.",
        after=STATED,
    ),
    "stated_clearance_KIND_high": T(
        "Stated clearance of KIND, to",
        "%",
        "Lane",
        "Upper end of the interval that contains the cleared share of KIND with a probability of "
        "at least 95%, as stated.",
        after=STATED,
    ),
    "stated_clearance_KIND": T(
        "Stated clearance of KIND",
        "%",
        "Lane",
        "Share of the mines of the kind KIND that are cleared, as controllers state it.",
        after=STATED,
    ),
    "true_clearance_KIND": T(
        "True clearance of KIND",
        "%",
        "Lane",
        "Share of the mines of the kind KIND that were cleared at the statement, in truth.",
        after=STATED,
    ),
}
"""The columns of each kind of robots or items: KIND stands for its name, K for a number. The first
that fits a name is its own."""


def description_of(name: str) -> Description | None:
    """Return the description of a column; None if there is no such column."""
    if name in COLUMNS:
        return COLUMNS[name]
    for pattern, description in OF_KINDS.items():
        if found := re.fullmatch(expression(pattern), name):
            return for_kind(description, found.groupdict())
    return None


def expression(pattern: str) -> str:
    """Return the regular expression of the names of a pattern."""
    return pattern.replace("KIND", "(?P<KIND>.+)").replace("_K_", "_(?P<K>[0-9]+)_")


def for_kind(description: Description, names: dict[str, str]) -> Description:
    """Return the description of a column of a kind, with the name of the kind."""

    def named(words: str) -> str:
        return re.sub("KIND|K(?=-| )", lambda each: names[each[0]], words)

    return description._replace(
        label=named(description.label),
        help=named(description.help),
        out_of=tuple(map(named, description.out_of)),
    )
