"""Conditional requests on sessions: `If-Match` and `If-None-Match` as in RFC 9110, section 13.

An ETag is `"<creation>-<revision>-<rest>"`. A request that changes a session is made for a revision of one creation:
its conditions compare these two, so that an edit lands while the session plays on. A request that reads compares whole
tags. Weak tags match in `If-None-Match` only; a condition that cannot be read is not met.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Annotated

from fastapi import Depends, Header, Request

from hookean_server.problems import Problem
from hookean_server.sessions.live import Live

_TAG = r'(?:W/)?"[\x21\x23-\x7e\x80-\xff]*"'
_LIST = re.compile(rf"[ \t]*(?:,[ \t]*)*{_TAG}(?:[ \t]*,(?:[ \t]*{_TAG})?)*[ \t]*")
_MATCH = 'An ETag, a list of them, or *: only if the session has one of them; such as "0a1b2c3d4e5f6071-7-1f2e3d4c"'
_NONE_MATCH = "An ETag, a list of them, or *: only if the session has none of them"


@dataclass(frozen=True)
class Conditions:
    """The conditions of one request. None: no such header; "*": any session; else the tags of the list, of which
    there are none where the header cannot be read."""

    match: list[str] | str | None = None
    none_match: list[str] | str | None = None
    unread: bool = False  # an If-None-Match that is not a list of tags

    def check(self, live: Live | None) -> int | None:
        """Raise `stale-revision` where a change of a session, or of none, must not be made.

        Returns the revision that the change is for; None: whichever it is.
        """
        if live is None:
            if self.match is not None or self.unread:
                raise Problem("stale-revision", "There is no session with this key, so If-Match is not met.")
            return None
        now = _edition(live.etag())
        strong = [_edition(tag) for tag in self.match or [] if not tag.startswith("W/")]
        if self.match not in (None, "*") and now not in strong:
            raise stale(
                live, f"If-Match is not met; the ETag of the session is {live.etag()}. Read it and repeat the edit."
            )
        weak = [_edition(tag.removeprefix("W/")) for tag in self.none_match or []]
        if self.none_match == "*" or self.unread or now in weak:
            raise stale(live, f"If-None-Match is not met: the ETag of the session is {live.etag()}.")
        return None if self.match is None and self.none_match is None else int(live.described["revision"])

    def same(self, etag: str) -> bool:
        """Whether a reader who has `etag` of If-None-Match has what it asks for: 304. Raises `stale-revision`."""
        if self.match is not None and self.match != "*" and etag not in self.match:
            raise Problem("stale-revision", f"If-Match is not met; the ETag is {etag}.", headers={"etag": etag})
        return self.none_match == "*" or etag in [tag.removeprefix("W/") for tag in self.none_match or []]


def stale(live: Live, detail: str) -> Problem:
    """The problem of an edit for another revision than the session has."""
    return Problem("stale-revision", detail, headers={"etag": live.etag()})


async def conditions(
    request: Request,
    if_match: Annotated[str | None, Header(description=_MATCH)] = None,
    if_none_match: Annotated[str | None, Header(description=_NONE_MATCH)] = None,
) -> Conditions:
    """The conditions of a request; several headers of a name are one list."""
    match, none_match = (_read(request.headers.getlist(name)) for name in ("if-match", "if-none-match"))
    return Conditions(match, none_match, unread=none_match == [])


When = Annotated[Conditions, Depends(conditions)]


def _read(given: list[str]) -> list[str] | str | None:
    if not given:
        return None
    whole = ",".join(given).strip()
    if whole == "*":
        return "*"
    return re.findall(_TAG, whole) if _LIST.fullmatch(whole) else []


def _edition(tag: str) -> str:
    """Creation and revision of a tag; "" of one that no session had."""
    found = re.fullmatch(r'"([0-9a-f]+-\d+)-[0-9a-f]+"', tag)
    return found[1] if found else ""
