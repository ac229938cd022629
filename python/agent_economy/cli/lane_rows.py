"""The rows of a run's table about a lane to be cleared, and about what robots did to its mines."""

from collections.abc import Iterator, Mapping
from typing import Any

from agent_economy.shares import percent

Row = tuple[str, str]
"""A name and a value in words."""


def lane_rows(row: Mapping[str, Any]) -> Iterator[Row]:
    """Yield the rows of an outcome; none if its scenario has no lane to be cleared.

    The mines that are left are the truth, which no controller knows.
    """
    if row.get("declared") is None:
        return
    left = f"; {count(row['left'], 'mine')} left" if "left" in row else ""
    yield "lane", f"{statement(row)}{left}"
    yield from clearance_rows(row)
    if "left" in row:
        yield from act_rows(row)
    if "vehicles_passed" in row:
        yield from passage_rows(row)


def statement(row: Mapping[str, Any]) -> str:
    """Return what the controllers stated of the lane, and whether a declaration was wrong."""
    risk = row["stated_risk"]
    if row["declared"]:
        wrong = ", but it was not clear" if row["declared_not_clear"] else ""
        at = f"declared clear at {row['declared_s']:.0f} s"
        return f"{at} with a stated risk of {percent(risk)}{wrong}"
    if row["given_up"]:
        at = f"given up at {row['given_up_s']:.0f} s"
        why = (
            "a person ended the mission" if row["ended_called_off"] else "nothing lowered the risk"
        )
        return f"not declared clear: {at} with a stated risk of {percent(risk)}, as {why}"
    lost = [name for name in ("controllers", "robots") if row[f"ended_{name}_lost"]]
    why = f": all {lost[0]} were lost" if lost else ""
    return f"neither declared clear nor given up{why}"


def clearance_rows(row: Mapping[str, Any]) -> Iterator[Row]:
    """Yield the share of each kind of mines that is cleared, as stated and in truth."""
    if not (row["declared"] or row["given_up"]):
        return
    for name in row:
        kind = name.removeprefix("true_clearance_")
        if kind != name:
            stated, low, high = (
                row[f"stated_clearance_{kind}{end}"] for end in ("", "_low", "_high")
            )
            interval = f"95% interval {percent(low)} to {percent(high)}"
            truth = f"in truth {percent(row[name])}"
            yield f"clearance of {kind}", f"stated {percent(stated)} ({interval}); {truth}"


def passage_rows(row: Mapping[str, Any]) -> Iterator[Row]:
    """Yield what was stated of the passage of vehicles, and what became of them."""
    if not row["path_m"]:
        yield "passage", "no path was stated"
        return
    first, last = percent(row["stated_first_risk"]), percent(row["stated_last_risk"])
    mines = f"path of {row['path_m']:.1f} m with {count(row['mines_on_path'], 'mine')}"
    yield "passage", f"{mines}; stated risk {first} for the first vehicle, {last} for the last"
    which = " with the first" if row["first_lost"] else ""
    passed = f"{count(row['vehicles_passed'], 'vehicle')} passed"
    yield "vehicles", f"{passed}, {row['vehicles_lost']} lost{which}"


def act_rows(row: Mapping[str, Any]) -> Iterator[Row]:
    """Yield what robots did to mines, and what mines did to robots."""
    yield "mines marked", f"{row['marked']}, and {count(row['false_marks'], 'false mark')}"
    false = count(row["false_confirmations"], "false confirmation")
    yield "mines confirmed", f"{row['confirmed']}, and {false}"
    yield "mines neutralised", f"{row['neutralised']}"
    met = f"{row['met_unmarked']} of them met by ground robots"
    yield "not marked from the air", f"{row['unmarked_from_air']}, {met}"
    yield "robots lost", f"{row['robots_lost']}"


def count(number: int, noun: str) -> str:
    """Return "1 mine", "2 mines"."""
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"
