"""Lets other programs find a drive while it runs."""

import asyncio
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager, suppress

from agent_economy.live.discovery.entry_file import EntryFile, folders_to_write
from agent_economy.live.discovery.entry_socket import EntrySocket
from agent_economy.live.discovery.running_drive import RunningDrive
from agent_economy.live.local_socket import HAS_ABSTRACT


@contextmanager
def published(drive: RunningDrive, report: Callable[[str], None]) -> Iterator[None]:
    """List a drive while it runs; must be entered and left in the event loop.

    A drive that cannot be listed runs on: its robots can be stopped in its terminal.

    Args:
        drive: The drive.
        report: Takes each reason why it cannot be found as usual, in words, in the event loop.
    """
    loop = asyncio.get_running_loop()

    def report_file(reason: str) -> None:
        finds = "only `agent-economy stop` finds it" if HAS_ABSTRACT else "nothing finds it there"
        text = f"warning: this drive cannot be listed in {reason}; {finds}"
        with suppress(RuntimeError):  # the drive has ended meanwhile
            loop.call_soon_threadsafe(report, text)

    with ExitStack() as stack:
        if HAS_ABSTRACT:
            entry_socket = EntrySocket(drive)
            stack.callback(entry_socket.close)
            try:
                entry_socket.start()
            except OSError as error:
                report(f"warning: this drive has no socket at which it is found: {error}")
        for folder in folders_to_write():
            file = EntryFile(drive, folder, report_file)
            file.start()
            stack.callback(file.end)
        yield
