"""The manifest: a small file beside the store that names all that is in it, so that nothing can be missing unnoticed.

Each acknowledged write adds a line before it is committed: for each session and job that it touches how many rows there
are and the exclusive or of their checksums. A second line, `done`, follows the commit. Lines carry a CRC-32. Where the
last write has no `done` and the store does not have it, it was never acknowledged.
"""

from __future__ import annotations

import io
import json
import os
import zlib
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Any

from hookean_server.keeping.schema import VERSION

Key = tuple[str, str]
"""Kind (session, job) and key of an owner of rows."""
LARGEST = 1 << 20  # bytes of lines that no longer count, before the file is written again
HALF = 16  # bytes of each checksum that go into the exclusive or


@dataclass
class Owner:
    """What belongs to one session or job: how many rows, what they are, and the number of the last write."""

    label: str = ""
    revision: int = 0
    count: int = 0
    digest: int = 0
    state: int = 0
    """Of the checkpoint, which a session can do without."""
    seq: int = 0

    def turn(self, part: str, old: bytes | None, new: bytes | None, seq: int) -> None:
        """A row was added (`old` None), changed or deleted (`new` None)."""
        change = 0
        for row in (old, new):
            change ^= 0 if row is None else int.from_bytes(row[:HALF], "big")
        if part == "state":
            self.state ^= change
        else:
            self.count += (new is not None) - (old is not None)
            self.digest ^= change
        self.seq = max(self.seq, seq)

    def same(self, other: Owner) -> bool:
        """Whether both have the same rows."""
        return (self.count, self.digest, self.state) == (other.count, other.digest, other.state)


@dataclass
class Read:
    """The contents of a manifest."""

    store: str = ""
    version: int = 0
    commit: int = 0
    owners: dict[Key, Owner] = field(default_factory=dict)
    pending: tuple[int, dict[Key, Owner | None]] | None = None
    """The last write, where nothing shows that it was committed."""
    whole: bool = False
    """Whether every line is as it was written."""

    def settled(self, commit: int) -> Read:
        """The same beside a store whose last write has this number."""
        if self.pending is None:
            return self
        number, changes = self.pending
        if commit < number:
            return replace(self, pending=None)
        found = replace(self, pending=None, commit=number, owners=dict(self.owners))
        apply(found.owners, changes)
        return found


def apply(owners: dict[Key, Owner], changes: dict[Key, Owner | None]) -> None:
    """Put changes into `owners`; None takes one out."""
    for key, owner in changes.items():
        if owner is None:
            owners.pop(key, None)
        else:
            owners[key] = owner


def place(path: Path) -> Path:
    """Where the manifest of a store is."""
    return path.with_name(path.name + ".manifest")


def read(path: Path) -> Read | None:
    """The manifest in a file; None if the file does not exist. Damaged lines are left out."""
    try:
        data = path.read_bytes()
    except FileNotFoundError:
        return None
    found = Read(whole=True)
    *lines, rest = data.split(b"\n")
    last = len(lines) - 1
    for number, line in enumerate(lines):
        value = _parsed(line)
        if value is None:
            found.whole = found.whole and number == last and not rest  # the last one may be torn
        else:
            _take(found, value)
    found.whole = found.whole and bool(found.store)
    return found


def _take(found: Read, value: dict[str, Any]) -> None:
    if "store" in value:
        found.store, found.version, found.commit = value["store"], value["version"], value["commit"]
        return
    if "kept" in value:
        found.owners.update({(kind, key): _owner(cells) for kind, key, *cells in value["kept"]})
        return
    if found.pending is not None:
        number, changes = found.pending
        if value.get("done", value.get("commit", 0) - 1) >= number:
            apply(found.owners, changes)
            found.commit = number
        found.pending = None
    if "commit" in value:
        owners: dict[Key, Owner | None] = dict.fromkeys((kind, key) for kind, key in value["gone"])
        owners.update({(kind, key): _owner(cells) for kind, key, *cells in value["owners"]})
        if value["commit"] > found.commit + 1:
            found.whole = False
        found.pending = value["commit"], owners
    elif value["done"] > found.commit:
        found.commit, found.whole = value["done"], False


def _owner(cells: list[Any]) -> Owner:
    label, revision, count, digest, state, seq = cells
    return Owner(label, revision, count, int(digest, 16), int(state, 16), seq)


def _cells(key: Key, owner: Owner) -> list[Any]:
    values = asdict(owner)
    return [*key, *(f"{v:x}" if name in ("digest", "state") else v for name, v in values.items())]


def _parsed(line: bytes) -> dict[str, Any] | None:
    with suppress(ValueError):
        if int(line[:8], 16) == zlib.crc32(line[9:]):
            value = json.loads(line[9:])
            return value if isinstance(value, dict) else None
    return None


def _line(value: dict[str, Any]) -> bytes:
    data = json.dumps(value, separators=(",", ":")).encode()
    return b"%08x %s\n" % (zlib.crc32(data), data)


class Manifest:
    """The manifest of an open store. Methods are called by the store's thread, `sync` by any."""

    def __init__(self, path: Path, store: str, commit: int, owners: dict[Key, Owner]) -> None:
        self.path, self.store, self.commit, self.owners = path, store, commit, owners
        self._file: io.FileIO | None = None
        self._size = self._live = 0
        try:
            self.rewrite()
        except OSError:  # on a full disk the file goes on as it is
            self._go_on()

    def prepare(self, changes: dict[Key, Owner | None]) -> None:
        """Write what the next commit changes. Raises OSError; nothing has changed then."""
        told = [_cells(key, owner) for key, owner in changes.items() if owner is not None]
        gone = [list(key) for key, owner in changes.items() if owner is None]
        line = _line({"commit": self.commit + 1, "owners": told, "gone": gone})
        try:
            assert self._file is not None
            if self._file.write(line) != len(line):
                raise OSError(28, "No space left on device")
        except OSError:
            self.undo()
            raise

    def undo(self) -> None:
        """The commit that was prepared has failed."""
        with suppress(OSError):
            assert self._file is not None
            self._file.truncate(self._size)

    def sync(self) -> None:
        """Put what was written on disk. Raises OSError."""
        assert self._file is not None
        os.fsync(self._file.fileno())

    def done(self, changes: dict[Key, Owner | None]) -> None:
        """The commit that was prepared has been made."""
        self.commit += 1
        apply(self.owners, changes)
        assert self._file is not None
        self._size, line = os.fstat(self._file.fileno()).st_size, _line({"done": self.commit})
        with suppress(OSError):  # without it the write counts as well: the store has it
            if self._file.write(line) == len(line):
                self._size += len(line)
            else:  # the next line would go on in this one
                self.undo()

    @property
    def grown(self) -> bool:
        """Whether most of the file no longer counts."""
        return self._size > 4 * self._live + LARGEST

    def rewrite(self) -> None:
        """Write the file again, without what no longer counts. Raises OSError; the file stays as it was then."""
        new = self.path.with_name(self.path.name + ".new")
        try:
            with _opened(new, os.O_TRUNC) as file:
                data = memoryview(b"".join(self._lines()))
                while data:
                    data = data[file.write(data) :]
                os.fsync(file.fileno())
            self.close()  # some systems replace no file that is open
            os.replace(new, self.path)
        finally:
            with suppress(OSError):
                new.unlink()
            self._file = _opened(self.path)
            self._size = os.fstat(self._file.fileno()).st_size
        self._live = self._size

    def _go_on(self) -> None:
        """Append to the existing file, after its last whole line. Raises OSError if the file does not exist."""
        data = self.path.read_bytes()
        self._size = self._live = data.rfind(b"\n") + 1
        if not data:
            self.close()
            self.path.unlink()
            raise OSError(28, "No space left on device", str(self.path))
        assert self._file is not None
        self._file.truncate(self._size)

    def _lines(self) -> Iterator[bytes]:
        yield _line({"store": self.store, "version": VERSION, "commit": self.commit})
        owners = [_cells(key, owner) for key, owner in self.owners.items()]
        for start in range(0, len(owners), 1000):
            yield _line({"kept": owners[start : start + 1000]})

    def close(self) -> None:
        """Close the file."""
        if self._file is not None:
            self._file.close()
            self._file = None


def _opened(path: Path, flags: int = 0) -> io.FileIO:
    """A file to append to, which nobody else may read."""
    return io.FileIO(path, "ab", opener=lambda name, given: os.open(name, given | flags, 0o600))
