"""A file replaced in one step or not at all, on any system."""

from __future__ import annotations

import contextlib
import hashlib
import os
import platform
import secrets
import shutil
import stat
from collections.abc import Callable
from pathlib import Path

from hookean.errors import InputError

StrPath = str | os.PathLike[str]


def check_target(target: StrPath, source: StrPath | None = None, *, folder: bool = True) -> None:
    """InputError if `target` cannot be a file to write, or is `source` itself by whatever path or link; its folder may
    be missing where `folder` is False."""
    path = Path(target)
    name = path.name or str(target)
    try:
        if source is not None and _same(target, source):
            raise InputError(name, "the input file is never overwritten; give another path.")
        if path.is_dir():
            raise InputError(name, "is a folder; give the path of the file to write.")
        if folder and not path.parent.is_dir():
            where = path.parent.as_posix()
            raise InputError(name, f"cannot be written: its folder {where} does not exist; make it first.")
    except (OSError, ValueError) as error:
        if isinstance(error, InputError):
            raise
        raise InputError(name, "is not a valid file path; check it for invalid characters.") from None


def _check_kind(path: Path) -> None:
    """InputError where a path is that of a device or a pipe; a file in its place would be it for all programs."""
    if path.exists() and not path.is_file():
        raise InputError(path.name, "is a device or a pipe, not a file; give the path of a file to write.")


def put(target: StrPath, data: bytes, check: Callable[[bytes], object]) -> None:
    """Write `data` to a file beside `target`, `check` what is read back, then put it in target's place. A link is
    written through: it stays, and the file that it leads to is replaced.

    Whatever fails, `target` stays as it was and nothing is left beside it; what a killed process has left there is
    deleted. Raises InputError if the folder cannot be written to, and what `check` raises.
    """
    path = Path(target)
    if path.is_symlink():
        path = Path(os.path.realpath(path))
    _check_kind(path)
    beside = path.with_name(f".{_process(os.getpid())}-{secrets.token_hex(8)}.hookean")
    try:
        _sweep(path.parent)
        _write(beside, data)
        back = beside.read_bytes()
        if back != data:
            raise InputError(
                path.name, "reads back differently than written; the disk may be failing, use another one."
            )
        check(back)
        if path.exists():
            shutil.copymode(path, beside)
        os.replace(beside, path)
        _sync_folder(path.parent)
    except OSError as error:
        raise InputError(
            path.name,
            f"cannot be written ({error.strerror}); check free space and permissions, and close it in other programs.",
        ) from error
    finally:
        with contextlib.suppress(OSError):
            beside.unlink()


def _process(number: int) -> str:
    """A process of this machine, as the names of unfinished files have it."""
    return f"{number}-{hashlib.sha256(platform.node().encode()).hexdigest()[:8]}"


def _sweep(folder: Path) -> None:
    """Delete unfinished files of processes of this machine that have ended; Windows has no harmless way to ask."""
    for file in folder.glob(".*.hookean") if os.name == "posix" else ():
        number = file.name[1:].partition("-")[0]
        if number.isdigit() and file.name.startswith(f".{_process(int(number))}-") and not _runs(int(number)):
            with contextlib.suppress(OSError):
                file.unlink()


def _runs(number: int) -> bool:
    try:
        os.kill(number, 0)
    except ProcessLookupError:
        return False
    except (OSError, OverflowError):
        return True
    return True


def _same(target: StrPath, source: StrPath) -> bool:
    if os.path.exists(target) and os.path.exists(source):
        return os.path.samefile(target, source)
    return os.path.normcase(os.path.realpath(target)) == os.path.normcase(os.path.realpath(source))


def _write(path: Path, data: bytes) -> None:
    with open(path, "xb") as file:
        file.write(data)
        file.flush()
        os.fsync(file.fileno())


def _sync_folder(folder: Path) -> None:
    # makes the new name itself last; Windows cannot open folders and does not need it
    with contextlib.suppress(OSError):
        handle = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)


def read_bytes(path: str | os.PathLike[str], name: str) -> bytes:
    """The bytes of a regular file; raises InputError if it does not exist or cannot be read."""
    try:
        mode = os.stat(path).st_mode
        if stat.S_ISDIR(mode):
            raise InputError(name, "is a folder; give the path of a file.")
        if not stat.S_ISREG(mode):
            raise InputError(name, "is not a regular file; give the path of one.")
        return Path(path).read_bytes()
    except FileNotFoundError:
        raise InputError(name, "no such file; check the path.") from None
    except OSError as error:
        raise InputError(name, f"cannot be read ({error.strerror}); check its permissions.") from None
    except ValueError as error:
        if isinstance(error, InputError):
            raise
        raise InputError(name, "is not a valid file path; check it for invalid characters.") from None
