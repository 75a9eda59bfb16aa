"""Frames as bytes: little endian, a header of 64 bytes, then float32 values. Version 1.

| offset | type | field |
| --- | --- | --- |
| 0 | 4s | magic `HKFR` |
| 4 | u16 | version, 1 |
| 6 | u16 | bytes of the header, 64 |
| 8 | u32 | flags: 1 positions, 2 scalars, 4 reactions, 8 changes; a reader refuses others |
| 12 | u32 | number of the frame in this run of the session |
| 16 | u64 | revision: edits up to this one are in the frame |
| 24 | u64 | iteration |
| 32 | f64 | time [time unit of the scene] |
| 40 | f64 | residual [-] |
| 48 | u32 | n, particles |
| 52 | u32 | m, scalars: the force [force] of each spring, in the order of the topology |
| 56 | u8 | status, by its place in STATUSES |
| 57 | u8 | 1 while it plays |
| 58 | u16 | 0 |
| 60 | f32 | kinetic energy [force length] |
| 64 | f32[] | x y z of each particle [length]; the scalars; x y z of the reaction on each held particle [force] |

A frame of changes, which only clients get that ask for them, has fewer bytes: of the numbers from byte 64 on those that
differ from the frame before, as u32[] places, then f32[] numbers.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

MAGIC, VERSION, SIZE = b"HKFR", 1, 64
POSITIONS, SCALARS, REACTIONS, CHANGES = 1, 2, 4, 8
STATUSES = ("running", "converged", "stalled", "diverged", "max_iterations", "time_limit", "cancelled")
HEADER = struct.Struct("<4sHHIIQQddIIBBHf")


@dataclass
class Shown:
    """What a frame holds. Arrays in the scene's units; `scalars` and `reactions` may be empty."""

    number: int
    revision: int
    iteration: int
    time: float
    residual: float
    status: str
    playing: bool
    kinetic: float
    particles: NDArray[np.float64]  # (n, 3)
    scalars: NDArray[np.float64]  # (m,)
    reactions: NDArray[np.float64]  # (k, 3)


def encode(shown: Shown) -> bytes:
    """A frame as bytes. Numbers beyond float32 become its largest, so that a reader never meets one not finite."""
    parts = [shown.particles, shown.scalars, shown.reactions]
    flags = POSITIONS | (SCALARS if parts[1].size else 0) | (REACTIONS if parts[2].size else 0)
    head = HEADER.pack(
        MAGIC, VERSION, SIZE, flags, shown.number & 0xFFFFFFFF, shown.revision, shown.iteration, shown.time,
        shown.residual, len(shown.particles), len(shown.scalars), STATUSES.index(shown.status), shown.playing, 0,
        min(shown.kinetic, 3e38),
    )  # fmt: skip
    values = np.empty(sum(part.size for part in parts), "<f4")
    with np.errstate(over="ignore"):
        np.concatenate([part.ravel() for part in parts], out=values, casting="same_kind")
    largest = np.finfo(np.float32).max
    return head + np.clip(values, -largest, largest, out=values).tobytes()


def changes(before: bytes, now: bytes) -> bytes | None:
    """A frame as its changes to the one before; None where that would not be shorter, or it has others numbers."""
    (flags,) = struct.unpack_from("<I", now, 8)
    if len(before) != len(now) or before[8:12] != now[8:12] or before[48:56] != now[48:56]:
        return None
    old, new = (np.frombuffer(frame, "<u4", offset=SIZE) for frame in (before, now))  # bits: a NaN is equal to itself
    places = np.flatnonzero(old != new)
    if 2 * len(places) >= len(new):
        return None
    head = now[:8] + struct.pack("<I", flags | CHANGES) + now[12:SIZE]
    return head + places.astype("<u4").tobytes() + new[places].tobytes()


def changed(before: bytes, by: bytes) -> bytes:
    """The whole frame that `by`, its changes to the one before, stands for."""
    (flags,) = struct.unpack_from("<I", by, 8)
    whole = bytearray(before)
    whole[:SIZE] = by[:8] + struct.pack("<I", flags & ~CHANGES) + by[12:SIZE]
    count = (len(by) - SIZE) // 8
    numbers = np.frombuffer(whole, "<u4", offset=SIZE)
    numbers[np.frombuffer(by, "<u4", count, SIZE)] = np.frombuffer(by, "<u4", count, SIZE + 4 * count)
    return bytes(whole)


def decode(data: bytes) -> Shown:
    """The frame in `data`; raises ValueError if it is not of this version."""
    if len(data) < SIZE:
        raise ValueError("shorter than a header")
    magic, version, size, flags, number, revision, iteration, time, residual, n, m, status, playing, _, kinetic = (
        HEADER.unpack_from(data)
    )
    if magic != MAGIC or version != VERSION or size != SIZE:
        raise ValueError("not a frame of version 1")
    if flags & ~(POSITIONS | SCALARS | REACTIONS) or not flags & POSITIONS or status >= len(STATUSES):
        raise ValueError("unknown flags or status")
    rest, exact = divmod(len(data) - SIZE - 12 * n - 4 * m, 12)
    if exact or rest < 0 or (rest > 0) != bool(flags & REACTIONS) or (m > 0) != bool(flags & SCALARS):
        raise ValueError("its length differs from its header")
    values = np.frombuffer(data, "<f4", offset=SIZE).astype(np.float64)
    return Shown(
        number, revision, iteration, time, residual, STATUSES[status], bool(playing), kinetic,
        values[: 3 * n].reshape(-1, 3), values[3 * n : 3 * n + m], values[3 * n + m :].reshape(-1, 3),
    )  # fmt: skip
