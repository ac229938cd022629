"""Finds the drives that run on this machine, whatever the environment is, and stops them."""

import os
import threading
from collections import Counter
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor, as_completed
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from agent_economy.live.discovery import entry_file
from agent_economy.live.discovery.contact import (
    Contact,
    NamedSocket,
    contact,
    entry_of,
    named_sockets,
)
from agent_economy.live.discovery.running_drive import RunningDrive

MAX_THREADS, MAX_FILE_THREADS = 64, 8

MAX_PER_USER = 256
"""Programs of one user that a stop is requested from: any can pretend to be thousands of drives."""

TOTAL_S = 10.0
"""Time for all answers; what has not answered then is reported as silent."""

WAIT_S = 1.0
"""Time to wait for a place where too many connections wait."""

Named = tuple[NamedSocket, Contact]

NO_ENTRY = "no answer: it is suspended or busy"


@dataclass(frozen=True)
class Stopped:
    """A drive that has been found, and what it answered to a stop.

    Attributes:
        pid: Its process.
        uid: Its user.
        fleet: Its fleet file; None if it has not answered.
        is_stopped: Whether it has accepted the stop.
        message: The answer in words.
    """

    pid: int
    uid: int
    fleet: str | None
    is_stopped: bool
    message: str


class Search:
    """Stops the drives of a user, or all if that is root, or one.

    Each is stopped as soon as it is found: one that does not answer must not delay the others.

    Attributes:
        others: Drives of other users, which only these or root can stop, by process and user.
        not_requested: Number of programs that no stop was requested from in time, by user.
    """

    def __init__(self, uid: int, process: int | None = None) -> None:
        """Create it without looking; `process` limits it to one drive."""
        self._uid, self._process = uid, process
        self._seen: set[str] = set()
        self._guard = threading.Lock()
        self.others: list[tuple[int, int]] = []
        self.not_requested: Counter[int] = Counter()

    def stop(self, answered: Callable[[Stopped], None] = lambda _: None) -> list[Stopped]:
        """Find the drives, and stop them all at the same time.

        Args:
            answered: Takes the answer of each drive that has one, as soon as it arrives.
        """
        pools = ThreadPoolExecutor(MAX_THREADS), ThreadPoolExecutor(MAX_FILE_THREADS)
        named = {
            pools[0].submit(self._stop_named, *pair): pair
            for pair in self._in_order(self._contacts())
        }
        # Files last: their file system may not answer.
        listed = [pools[1].submit(self._stop_listed, each) for each in self._listed()]
        answers = []
        for each in self._completed([*named, *listed]):
            answers.append(each)
            if each.fleet is not None:
                answered(each)
        for request, (socket, found) in named.items():
            if not request.done() or request.cancelled():
                self.not_requested[socket.uid if found.peer is None else found.peer.uid] += 1
        for pool in pools:
            pool.shutdown(wait=False, cancel_futures=True)
        return sorted(_merged(answers), key=lambda each: (each.uid, each.pid))

    def _completed(self, requests: list[Future[Stopped | None]]) -> Iterator[Stopped]:
        """Yield the answers that arrive in time."""
        with suppress(TimeoutError):
            for request in as_completed(requests, TOTAL_S):
                answer = request.result()
                if answer is not None:
                    yield answer

    def _contacts(self) -> list[Named]:
        """Connect to what may be drives, of each user to some only."""
        found, numbers = [], Counter[int]()
        for named in named_sockets():
            each = contact(named, 0.0)
            if each is None:
                continue
            if each.peer is not None:
                numbers[each.peer.uid] += 1
                if numbers[each.peer.uid] > MAX_PER_USER:
                    _close(each)
                    self.not_requested[each.peer.uid] += self._is_ours(each.peer.uid)
                    continue
            found.append((named, each))
        return found

    def _in_order(self, found: list[Named]) -> list[Named]:
        """Return what may be a drive to stop; one user with thousands delays no drive of others.

        What has no place for a connection comes last: it may take a second.
        """
        ranks: Counter[int] = Counter()
        ranked = []
        for named, each in found:
            if each.peer is None:
                if self._is_ours(named.uid):
                    ranked.append((len(found), (named, each)))
            elif self._is_ours(each.peer.uid):
                ranks[each.peer.uid] += 1
                ranked.append((ranks[each.peer.uid], (named, each)))
            else:
                _close(each)
                self.others.append((each.peer.pid or named.pid, each.peer.uid))
        return [pair for _, pair in sorted(ranked, key=lambda pair: pair[0])]

    def _is_ours(self, uid: int) -> bool:
        return self._uid in (uid, 0)

    def _listed(self) -> Iterator[RunningDrive]:
        for drive in entry_file.read_all(entry_file.folders_to_read()):
            if self._process in (None, drive.pid):
                yield drive

    def _stop_listed(self, drive: RunningDrive) -> Stopped | None:
        return self._request(drive, drive.pid, self._uid)

    def _stop_named(self, named: NamedSocket, first: Contact) -> Stopped | None:
        found = first if first.link is not None else contact(named, WAIT_S)
        if found is None:
            return None
        if found.link is None or found.peer is None:
            is_known = _owner(named.pid) == named.uid and self._process in (None, named.pid)
            return _silent(named.pid, named.uid) if is_known else None
        pid, uid = found.peer.pid or named.pid, found.peer.uid
        if not self._is_ours(uid) or self._process not in (None, pid):
            _close(found)
            return None
        drive = entry_of(found.link)
        return _silent(pid, uid) if drive is None else self._request(drive, pid, uid)

    def _request(self, drive: RunningDrive, pid: int, uid: int) -> Stopped | None:
        """Stop a drive; None if that is done already: it may be found in several places."""
        with self._guard:
            if drive.token in self._seen:
                return None
            self._seen.add(drive.token)
        return Stopped(pid, uid, drive.fleet, *drive.request("/stop"))


def _silent(pid: int, uid: int) -> Stopped:
    return Stopped(pid, uid, None, is_stopped=False, message=NO_ENTRY)


def _close(found: Contact) -> None:
    if found.link is not None:
        found.link.close()


def _merged(answers: list[Stopped]) -> list[Stopped]:
    """Return one answer per drive: of one that sent no entry, that by its file."""
    known = {each.pid for each in answers if each.fleet is not None}
    return [each for each in answers if each.fleet is not None or each.pid not in known]


def _owner(pid: int) -> int | None:
    try:
        return Path(f"/proc/{pid}").stat().st_uid
    except OSError:
        return None


def user() -> int:
    """Return the user whose drives are stopped."""
    return os.geteuid()
