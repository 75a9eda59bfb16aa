"""Where commands write: files, folders named with a slash at their end, folders that do not exist yet."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterable, Iterator
from pathlib import Path

from hookean.errors import InputError


def place(given: str | None, source: Path, ending: str, *, many: bool = False) -> Path | None:
    """The file to write: the given one, or, in a given folder, the source's name with another ending.

    An existing folder or a path that ends in a slash is a folder. For `many` sources it must be one, and a name without
    ending is one. Raises InputError for an existing file or a name with an ending then.
    """
    if given is None:
        return None
    path = Path(given)
    if given.endswith(("/", os.sep)) or os.path.isdir(path):  # false for a path too long, where Path.is_dir raises
        return path / f"{source.stem}{ending}"
    if many and (os.path.exists(path) or path.suffix):
        raise InputError(given, "is not a folder; for several input files give one")
    return path / f"{source.stem}{ending}" if many else path


def check(targets: Iterable[Path | None], sources: Iterable[Path | None]) -> None:
    """Raises InputError if a target is an invalid path, one of the sources, or another target."""
    from hookean.atomic_write import check_target

    read, seen = [source for source in sources if source is not None], set[str]()
    for target in targets:
        if target is None:
            continue
        for source in (*read, None):
            check_target(target, source, folder=False)
        full = os.path.realpath(target)  # of a link to itself, too, where Path.resolve raises
        if full in seen:
            raise InputError(str(target), "would be written twice; give files of different names")
        seen.add(full)


@contextlib.contextmanager
def folders(targets: Iterable[Path | None]) -> Iterator[None]:
    """Makes the folders of the targets; removes those that stayed empty if the work fails."""
    made: list[Path] = []
    try:
        for target in targets:
            if target is not None:
                _make(target.parent, made)
        yield
    except BaseException:
        for folder in reversed(made):
            with contextlib.suppress(OSError):
                folder.rmdir()  # refuses where something was written
        raise


def _make(folder: Path, made: list[Path]) -> None:
    missing = [f for f in (folder, *folder.parents) if not f.is_dir()]
    try:
        for one in reversed(missing):
            one.mkdir(exist_ok=True)
            made.append(one)
    except OSError as error:
        raise InputError(str(folder), f"the folder cannot be made ({error.strerror})") from None
