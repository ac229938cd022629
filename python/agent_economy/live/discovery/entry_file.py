"""The file of a drive, from which other programs read its port and its token.

The folder depends on the environment and may be removed while the drive runs. Therefore a drive
writes its file again, and what looks for drives looks in every folder that a drive may have used.
"""

import fcntl
import os
import stat
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from secrets import token_hex

from agent_economy.live.discovery.running_drive import MAX_BYTES, RunningDrive, drive_of

PERIOD_S = 0.5
"""A file that is gone is written again after this time."""

LAST_S = 1.0
"""Time for which a file system may hold up the start and the end of a drive."""

_FOLDER = os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW
_FILE = os.O_NOFOLLOW | os.O_NONBLOCK


class EntryFile:
    """Writes the file of a drive, again whenever it is gone, in a thread of its own.

    File systems may block; the warden must not.
    """

    def __init__(self, drive: RunningDrive, folder: Path, report: Callable[[str], None]) -> None:
        """Create it without writing; `report` takes each reason why the file cannot be written."""
        self._drive, self._folder, self._report = drive, folder, report
        self._name = f"{drive.pid}.json"
        self._file: int | None = None
        self._reason = ""
        self._written, self._ended = threading.Event(), threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)

    def start(self) -> None:
        """Write it, and start to keep it."""
        self._thread.start()
        self._written.wait(LAST_S)

    def end(self) -> None:
        """Remove it."""
        self._ended.set()
        self._thread.join(LAST_S)

    def _run(self) -> None:
        while True:
            self._keep()
            self._written.set()
            if self._ended.wait(PERIOD_S):
                break
        if self._file is not None and self._is_there():
            with suppress(OSError):
                (self._folder / "drives" / self._name).unlink()
        self._forget()

    def _keep(self) -> None:
        reason = ""
        try:
            if not self._is_there():
                self._forget()
                self._file = _written(self._drive, self._folder)
        except OSError as error:
            reason = f"{self._folder / 'drives'}: {error.strerror or error}"
        if reason and reason != self._reason:
            self._report(reason)
        self._reason = reason

    def _is_there(self) -> bool:
        if self._file is None:
            return False
        try:
            found = (self._folder / "drives" / self._name).lstat()
        except OSError:
            return False
        return os.path.samestat(found, os.fstat(self._file))

    def _forget(self) -> None:
        if self._file is not None:
            os.close(self._file)
            self._file = None


def folder_to_write() -> Path:
    """Return the folder in which the drives of this environment are listed."""
    usual = _run_folder()
    default = usual if usual.is_dir() else _temporary_folder()
    return Path(os.environ.get("XDG_RUNTIME_DIR") or default).absolute() / _name()


def folders_to_write() -> list[Path]:
    """Return all folders that a drive writes: the usual one, and a fixed one if only files meet."""
    fixed = [] if sys.platform == "linux" else _home_folders()
    return [folder_to_write(), *fixed]


def folders_to_read() -> list[Path]:
    """Return all folders in which a drive of this user may have written its file."""
    variable = os.environ.get("XDG_RUNTIME_DIR")
    parents = [Path(variable)] if variable else []
    parents += [_run_folder(), *_run_folder().glob("snap.*")]
    parents += [_temporary_folder(), Path("/tmp")]  # noqa: S108  (its owner is checked)
    folders = [parent.absolute() / _name() for parent in parents]
    return list(dict.fromkeys([*folders, *_home_folders()]))


def read_all(folders: list[Path]) -> Iterator[RunningDrive]:
    """Return the drives that run of some folders; files that killed ones left are removed."""
    for folder in folders:
        # Another user may have filled a folder of this name.
        is_own = all(_is_own_folder(each) for each in (folder, folder / "drives"))
        for path in sorted((folder / "drives").glob("*.json")) if is_own else []:
            with suppress(OSError):
                drive = _read(path)
                if drive is not None:
                    yield drive


def _written(drive: RunningDrive, folder: Path) -> int:
    """Write a file that only this user can read; return its descriptor, which is locked."""
    with _opened(folder, None) as outer, _opened(Path("drives"), outer) as inner:
        # Drives in different containers may have the same process number.
        name, new = f"{drive.pid}.json", f".{drive.pid}-{token_hex(8)}.new"
        file = os.open(new, os.O_WRONLY | os.O_CREAT | os.O_EXCL | _FILE, 0o600, dir_fd=inner)
        try:
            # Locked for as long as the drive runs: the number of its process may be used again.
            with suppress(OSError):
                fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            os.write(file, drive.encoded())
            os.rename(new, name, src_dir_fd=inner, dst_dir_fd=inner)
        except OSError:
            os.close(file)
            with suppress(OSError):
                os.unlink(new, dir_fd=inner)
            raise
        return file


@contextmanager
def _opened(path: Path, parent: int | None) -> Iterator[int]:
    """Open a folder of this user alone, which is created if necessary; no link is followed."""
    with suppress(FileExistsError):
        os.mkdir(path, 0o700, dir_fd=parent)
    folder = os.open(path, _FOLDER, dir_fd=parent)
    try:
        status = os.fstat(folder)
        if status.st_uid != os.geteuid():
            message = "the folder belongs to another user: remove it, or set XDG_RUNTIME_DIR"
            raise PermissionError(message)
        if stat.S_IMODE(status.st_mode) != 0o700:  # noqa: PLR2004
            os.fchmod(folder, 0o700)
        yield folder
    finally:
        os.close(folder)


def _is_own_folder(path: Path) -> bool:
    try:
        status = path.lstat()
    except OSError:
        return False
    return stat.S_ISDIR(status.st_mode) and status.st_uid == os.geteuid()


def _read(path: Path) -> RunningDrive | None:
    file = os.open(path, os.O_RDONLY | _FILE)
    try:
        status = os.fstat(file)
        if status.st_uid != os.geteuid() or not stat.S_ISREG(status.st_mode):
            return None
        if not _is_locked(file):
            path.unlink(missing_ok=True)
            return None
        return drive_of(os.read(file, MAX_BYTES))
    finally:
        os.close(file)


def _is_locked(file: int) -> bool:
    """Whether the drive that wrote a file still runs, or that cannot be known."""
    try:
        fcntl.flock(file, fcntl.LOCK_SH | fcntl.LOCK_NB)
    except OSError:
        return True
    return False


def _name() -> str:
    return f"agent-economy-{os.geteuid()}"


def _run_folder() -> Path:
    return Path(f"/run/user/{os.geteuid()}")


def _temporary_folder() -> Path:
    return Path(os.environ.get("TMPDIR") or "/tmp")  # noqa: S108


def _home_folders() -> list[Path]:
    """Return the folder below the home folder, which no variable of the environment changes."""
    import pwd  # noqa: PLC0415  (only systems with users by number have it)

    try:
        return [Path(pwd.getpwuid(os.geteuid()).pw_dir).absolute() / f".{_name()}"]
    except KeyError:
        return []
