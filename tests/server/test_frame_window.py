"""Which frames are on their way to a client, whose numbers begin again with each process of the session."""

from __future__ import annotations

from typing import Any, cast

from hookean_server.sessions.frames import _Client


def window(sent: list[int], *received: int) -> list[int]:
    """Numbers of frames that are on their way after a client has reported these."""
    client = _Client(cast(Any, None), cast(Any, None), cast(Any, None), changes=False)
    client.on_their_way = sent
    for number in received:
        client._received(number)
    return client.on_their_way


def test_frames_of_an_ended_process_leave_with_a_newer_one() -> None:
    """A hidden page reports only the newest frame: those of a process before it have larger numbers and are received,
    too, or two of them would hold up every frame to come."""
    assert window([100, 1], 1) == []
    assert window([100, 101], 101) == []
    assert window([7, 7], 7) == []


def test_frames_that_were_sent_later_stay() -> None:
    assert window([100, 1], 100) == [1]
    assert window([3, 4], 3) == [4]
    assert window([3, 4], 2) == [3, 4]  # reported before
    assert window([3, 4], 2**31) == []  # a client that counts nothing
