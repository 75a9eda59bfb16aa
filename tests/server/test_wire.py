"""Frames as bytes: what is read is what was written, and what is no frame is refused."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hookean_server.sessions.wire import HEADER, SIZE, STATUSES, Shown, changed, changes, decode, encode
from soak import seeds


def shown(n: int = 3, m: int = 2, k: int = 1) -> Shown:
    grid = np.arange(3.0 * n).reshape(n, 3)
    return Shown(7, 5, 9, 0.25, 1e-3, "converged", True, 2.0, grid, np.arange(1.0, m + 1), np.ones((k, 3)))


@given(st.integers(1, 40), st.integers(0, 40), st.integers(0, 5), st.sampled_from(STATUSES))
def test_a_frame_is_read_as_it_was_written(n: int, m: int, k: int, status: str) -> None:
    """Header of 64 bytes, then float32: whole numbers below 2^24 come back exactly."""
    given = shown(n, m, k)
    given.status = status
    data = encode(given)
    assert HEADER.size == SIZE == 64 and len(data) == 64 + 4 * (3 * n + m + 3 * k)
    read = decode(data)
    assert (read.number, read.revision, read.iteration, read.time, read.status, read.playing) == (
        7,
        5,
        9,
        0.25,
        status,
        True,
    )
    for one, other in (
        (read.particles, given.particles),
        (read.scalars, given.scalars),
        (read.reactions, given.reactions),
    ):
        assert np.array_equal(one, other)


def test_numbers_beyond_float32_stay_finite() -> None:
    """A reader never meets a number that is not finite."""
    given = shown()
    given.particles[0, 0], given.scalars[0] = 1e300, -1e300
    read = decode(encode(given))
    assert np.isfinite(read.particles).all() and np.isfinite(read.scalars).all()


@pytest.mark.parametrize(
    "change", [(0, b"XXXX"), (4, b"\x02\x00"), (8, b"\x09\x00\x00\x00"), (48, b"\xff\xff"), (56, b"\x63")]
)
def test_other_versions_flags_and_lengths_are_refused(change: tuple[int, bytes]) -> None:
    place, new = change
    data = encode(shown())
    with pytest.raises(ValueError):
        decode(data[:place] + new + data[place + len(new) :])


@given(st.binary(max_size=200))
def test_bytes_that_are_no_frame_are_refused(data: bytes) -> None:
    with pytest.raises(ValueError):
        decode(data)


@seeds(40)
def test_a_frame_of_changes_leads_from_the_one_before_to_the_next_to_the_bit(seed: int) -> None:
    """Of some numbers that differ, 8 bytes for each behind the header; no such frame where half of all differ."""
    random = np.random.default_rng(seed)
    old, new = shown(50, 30, 4), shown(50, 30, 4)
    differ = random.permutation(50)[: random.integers(0, 40)]
    new.number, new.revision, new.particles[differ, 1] = 8, 6, random.normal(size=len(differ))
    before, now = encode(old), encode(new)
    by = changes(before, now)
    assert by is not None and len(by) == SIZE + 8 * len(differ)
    assert changed(before, by) == now
    with pytest.raises(ValueError):
        decode(by)  # by itself it is no frame
    new.particles += 1.0
    assert changes(before, encode(new)) is None


@pytest.mark.parametrize("other", [shown(4, 2, 1), shown(3, 5, 0), shown(3, 2, 0)])
def test_a_frame_with_other_numbers_has_no_changes(other: Shown) -> None:
    assert changes(encode(shown()), encode(other)) is None
