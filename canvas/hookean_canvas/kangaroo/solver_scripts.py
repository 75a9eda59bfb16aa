"""Scripts that use Kangaroo's solver, and what they do with it, as far as their text tells. None of it is run."""

from __future__ import annotations

import base64
import contextlib
import re

from hookean_canvas.archive import Chunk, Type

_LIBRARY = "KangarooSolver"
_ENCODED = ("S2FuZ2Fyb29Tb2x2ZX", "thbmdhcm9vU29sdmVy", "LYW5nYXJvb1NvbHZlc")
"""`KangarooSolver` in base64, at the three places it can start."""
_OWN = re.compile(r"\bclass\s+(\w+)\s*(?::|\()\s*(?:\w+\.)*(?:GoalObject|IGoal)\b")
_READY = re.compile(r"\bGoals\.(\w+)\s*\(|\bnew\s+(?:KangarooSolver\.)?Goals\.(\w+)\s*\(")
_STEPS = re.compile(r"\bPhysicalSystem\s*\(")
_MOST = 4  # names of each kind


def used_by(container: Chunk) -> str | None:
    """What a script of an object does with Kangaroo's solver, in words; None where it does not name it."""
    texts = [text for chunk in container.walk() for text in _texts(chunk)]
    found = [text for text in texts if _LIBRARY in text]
    if not found and not any(code in text for text in texts for code in _ENCODED):
        return None
    whole = "\n".join(found)
    does = []
    if own := _names(_OWN.findall(whole)):
        does.append(f"defines goals of its own ({own})")
    if ready := _names([one or other for one, other in _READY.findall(whole)]):
        does.append(f"makes goals of Kangaroo's ({ready})")
    if _STEPS.search(whole):
        does.append("runs a solver of its own")
    return "a script that uses Kangaroo's solver" + (f": it {'; '.join(does)}" if does else "")


def _texts(chunk: Chunk) -> list[str]:
    """The texts of a chunk that may be code, those in base64 decoded."""
    found = []
    for item in chunk.items:
        if item.type == Type.STRING and item.name not in ("Name", "NickName", "Description"):
            found.append(item.value)
            if any(code in item.value for code in _ENCODED):
                with contextlib.suppress(ValueError):
                    plain = base64.b64decode("".join(item.value.split()), validate=True)
                    found.append(plain.decode("utf-8", "replace"))
    return found


def _names(found: list[str]) -> str:
    names = list(dict.fromkeys(found))
    return ", ".join(names[:_MOST]) + (f" and {len(names) - _MOST} more" if len(names) > _MOST else "")
