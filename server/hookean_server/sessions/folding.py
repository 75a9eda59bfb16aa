"""Old edits of a session become part of its base; those that can still be taken back, or made again, stay edits."""

from __future__ import annotations

import json

from hookean.running.history import LONGEST
from hookean_server.sessions.parts import EDITS


def foldable(edits: list[bytes]) -> int:
    """How many edits from the first may become part of the base, so that what is left leads to the same history.

    Follows `running.history.History` by numbers: each entry is the number of the edit that made it. What is left must
    make all entries that are there in the end, and all that its own undos and redos use.
    """
    before: list[int] = []
    after: list[int] = []
    used: list[tuple[int, int]] = []  # an undo or redo, and the edit whose entry it uses
    gesture, joined = "", set()
    for number, body in enumerate(edits):
        edit = json.loads(body)
        word = next((word for word in EDITS if word in edit), "")
        if word in ("undo", "redo"):
            source, target = (before, after) if word == "undo" else (after, before)
            if source:
                used.append((number, source.pop()))
                target.append(number)
            gesture = ""
        elif not word:
            given = str(edit.get("gesture", ""))
            if given and given == gesture:
                joined.add(number)  # to an entry made before
            else:
                before.append(number)
                del before[:-LONGEST]
            gesture, after = given, []
    count = min([len(edits), *before, *after])
    while True:
        least = min([count, *(made for number, made in used if number >= count)])
        while least in joined:
            least -= 1
        if least == count:
            return count
        count = least
