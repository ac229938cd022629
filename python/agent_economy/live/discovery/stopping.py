"""What the command `stop` does, without the libraries of the command line: they take time to load.

An emergency stop has to reach the robots soon, also on a slow machine.
"""

import json
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from agent_economy.live import local_socket
from agent_economy.live.discovery import entry_file
from agent_economy.live.discovery.contact import PREFIX
from agent_economy.live.discovery.search import Search, Stopped, user

NOT_STOPPED = 1

MAX_OTHERS = 10
"""Drives of other users that are named: any program can pretend to be one."""

MAX_SILENT = 10
"""Programs of one user without an answer that are named; the others are counted."""

REMAINS = "press Ctrl-C in its terminal, or use the robot's own switch"


def options_of(words: Sequence[str]) -> tuple[int | None, bool] | None:
    """Return the process and whether JSON is printed; None for words that need the command line.

    Those are mistakes, and the request for help.
    """
    process, as_json, rest = None, False, iter(words)
    for word in rest:
        name, has_value, value = word.partition("=")
        if word == "--json":
            as_json = True
        elif name == "--process":
            text = value if has_value else next(rest, "")
            if not (text.isascii() and text.isdecimal() and len(text) < 10 and int(text) > 0):  # noqa: PLR2004
                return None
            process = int(text)
        else:
            return None
    return process, as_json


@dataclass(frozen=True)
class Report:
    """How the command ends: what it prints as errors, and its exit code."""

    exit_code: int
    errors: list[str]


def stop_drives(process: int | None, output: Callable[[str], None], *, as_json: bool) -> Report:
    """Stop all drives of this user, or that of one process.

    Args:
        process: The process of the drive; None for all drives.
        output: Takes each line to print, as soon as the answer arrives.
        as_json: Whether the lines are a JSON list, after all answers.
    """

    def answered(each: Stopped) -> None:
        if each.is_stopped and not as_json:
            output(_sentence(each))

    search = Search(user(), process)
    answers = search.stop(answered)
    is_complete = answers and all(each.is_stopped for each in answers) and not search.not_requested
    exit_code = 0 if is_complete else NOT_STOPPED
    if as_json:
        output(json.dumps([_row(each) for each in answers], indent=2))
        return Report(exit_code, [])
    if not answers and not +search.not_requested:
        others = sorted(set(search.others))[:MAX_OTHERS]
        return Report(exit_code, nothing_found(user(), process, others))
    return Report(exit_code, list(_not_stopped(answers, +search.not_requested)))


def _not_stopped(answers: Sequence[Stopped], not_requested: Counter[int]) -> Iterator[str]:
    """Yield what was not stopped: of each user the first ones, and the number of the others."""
    named, others = Counter[int](), Counter(not_requested)
    for each in answers:
        if not each.is_stopped:
            named[each.uid] += 1
            if each.fleet is not None or named[each.uid] <= MAX_SILENT:
                yield _sentence(each)
            else:
                others[each.uid] += 1
    for uid, number in others.items():
        what = f"{number} more programs of user {local_socket.user_name(uid)}"
        yield f"{what} that may be drives: no answer in time; {REMAINS}"


def nothing_found(uid: int, process: int | None, others: Sequence[tuple[int, int]]) -> list[str]:
    """Return the lines for a search without a result: it cannot be known that no drive runs."""
    owner = "" if uid == 0 else f" of user {local_socket.user_name(uid)} ({uid})"
    which = "drive" if process is None else f"drive with process {process}"
    lines = [
        f"No {which}{owner} was found. Looked at: {_places(uid, entry_file.folders_to_read())}."
    ]
    lines += [
        f"Process {pid} is a drive of user {local_socket.user_name(other)} ({other}): that user "
        "stops it with `agent-economy stop`, and root with `sudo agent-economy stop`."
        for pid, other in others
    ]
    elsewhere = "A drive in another container" + ("" if uid == 0 else ", or of another user,")
    return [*lines, f"{elsewhere} is not found this way: {REMAINS}."]


def _places(uid: int, folders: Sequence[Path]) -> str:
    owner = "USER" if uid == 0 else str(uid)
    sockets = f"the sockets {PREFIX}/{owner}/... of this machine, and "
    files = ", ".join(str(folder / "drives") for folder in folders)
    return f"{sockets if local_socket.HAS_ABSTRACT else ''}the files in {files}"


def _row(each: Stopped) -> dict[str, object]:
    return {
        "pid": each.pid,
        "fleet": each.fleet,
        "is_stopped": each.is_stopped,
        "message": each.message,
    }


def _sentence(each: Stopped) -> str:
    owner = "" if each.uid == user() else f" of user {local_socket.user_name(each.uid)}"
    what = f"{each.fleet or 'A drive'} (process {each.pid}{owner}): {each.message}"
    # Another user may have written it, for the terminal of root.
    what = "".join(letter if letter.isprintable() else "?" for letter in what)
    return what if each.is_stopped else f"{what}; {REMAINS}"
