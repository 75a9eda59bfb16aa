"""Selectors: which objects of a file a recipe means, such as `layer:cables`, `name:roof`, `naked:layer:skin`."""

from __future__ import annotations

import difflib
import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any
from uuid import UUID

from hookean.errors import InputError
from hookean.files.recipe.drawing import NO_LAYER, Drawing, Item, above, layers_of
from hookean.files.rhino.model import SEPARATOR

KEYS = ("layer", "name", "id", "text")
FEATURES = ("start", "ends", "loose", "vertices", "inner", "corners", "naked", "rim")
"""Points of a selected object that a selector may ask for in front of it."""

_START = re.compile(rf"\s*(?:(?:{'|'.join(FEATURES)})\s*:\s*)?(?:(?:{'|'.join(KEYS)})\s*:|\*\s*(?:,|$))", re.IGNORECASE)


@dataclass(frozen=True)
class Term:
    """One selector: `feature` ("" for the object itself), `key` ("" for `*`, everything that fits) and value."""

    feature: str
    key: str
    value: str

    def __str__(self) -> str:
        return (f"{self.feature}:" if self.feature else "") + (f"{self.key}:{self.value}" if self.key else "*")

    @property
    def everything(self) -> bool:
        """Whether it is the bare `*`: what fits is taken and the rest left out, rather than an error."""
        return not self.key


def terms(value: Any, pointer: str) -> list[Term]:
    """The selectors in a string (joined by commas) or a list of strings; InputError where one is not readable."""
    given = [value] if isinstance(value, str) else value
    if not isinstance(given, list | tuple) or not given or not all(isinstance(part, str) for part in given):
        raise InputError(pointer, 'give a selector such as "layer:cables", or several in a list')
    return [_term(part, pointer) for text in given for part in _split(text)]


def is_selector(value: Any) -> bool:
    """Whether a value is text or a list of texts, and so cannot be coordinates."""
    return isinstance(value, str) or (isinstance(value, list) and bool(value) and isinstance(value[0], str))


def _split(text: str) -> list[str]:
    # a comma ends a selector only where another begins, so names may have commas
    parts: list[str] = []
    for piece in text.split(","):
        rest = text[sum(len(p) + 1 for p in parts) :] if parts else text
        if parts and not _START.match(rest):
            parts[-1] += "," + piece
        else:
            parts.append(piece)
    return parts


def _term(text: str, pointer: str) -> Term:
    feature, rest = "", text.strip()
    head, colon, tail = rest.partition(":")
    if colon and head.strip().lower() in FEATURES:
        feature, rest = head.strip().lower(), tail.strip()
    if rest == "*":
        return Term(feature, "", "*")
    key, colon, value = rest.partition(":")
    key, value = key.strip().lower(), value.strip()
    if not colon or key not in KEYS or not value:
        raise InputError(
            pointer,
            f'"{text.strip()}" is not a selector; write layer:NAME, name:NAME, id:UUID, text:KEY=VALUE or *, '
            f"for points optionally with {', '.join(f + ':' for f in FEATURES)} in front",
        )
    return Term(feature, key, value)


def select(drawing: Drawing, term: Term, pointer: str) -> list[Item]:
    """Items a selector means, in file order; InputError with what the file has where there are none."""
    if term.key == "id":
        every = drawing.by_id.get(_id(term, pointer), [])
        found = [item for item in every if item in drawing.visible]
        unseen = len(every) - len(found)
    else:
        test = _test(term)
        found = [item for item in drawing.items if test(item)]
        unseen = 0 if found else sum(map(test, drawing.hidden))
    if not found and not term.everything:
        if unseen:
            raise InputError(
                pointer, f'"{term}" finds only hidden objects ({unseen}); show them in Rhino or set hidden = true'
            )
        raise InputError(pointer, f'"{term}" finds no object; {_has(drawing, term)}')
    return found


def _id(term: Term, pointer: str) -> UUID:
    try:
        return UUID(term.value)
    except ValueError:
        raise InputError(pointer, f'"{term.value}" is not an object id; copy it from Rhino\'s What command') from None


def _test(term: Term) -> Callable[[Item], bool]:
    if term.everything:
        return lambda item: True
    if term.key == "layer":
        return lambda item: any(on_layer(path, term.value) for path in item.layers)
    if term.key == "name":
        name = _pattern(term.value)
        return lambda item: any(name.fullmatch(n.casefold()) is not None for n in item.names if n)
    key, equals, value = term.value.partition("=")
    of_key, of_value = _pattern(key.strip()), _pattern(value.strip() if equals else "*")
    return lambda item: any(
        of_key.fullmatch(k.casefold()) and of_value.fullmatch(v.strip().casefold()) for k, v in item.text.items()
    )


def on_layer(path: str, wanted: str) -> bool:
    """Whether a layer path is, or lies below, a layer of this full path or name; case does not matter, `*` may stand
    for anything."""
    pattern = _pattern(wanted)
    return any(
        pattern.fullmatch(p.casefold()) or pattern.fullmatch(p.rpartition(SEPARATOR)[2].casefold()) for p in above(path)
    )


def _pattern(text: str) -> re.Pattern[str]:
    return re.compile(".*".join(re.escape(part) for part in text.casefold().split("*")), re.DOTALL)


def _has(drawing: Drawing, term: Term) -> str:
    """What the file has instead of what was looked for, and what to write."""
    front = f"{term.feature}:" if term.feature else ""
    if term.key == "layer":
        paths = layers_of(drawing.items)
        if not set(paths) - {NO_LAYER}:
            return f'its objects have no layer: select them with "{front}*", {front}name:NAME or {front}id:UUID'
        if len(paths) == 1:
            return (
                f'its only layer with visible objects is "{paths[0]}": write "{front}layer:{paths[0]}", or "{front}*"'
            )
        known = [name for path in paths for name in (path, path.rpartition(SEPARATOR)[2])]
        return f"its layers with visible objects are {listed(paths)}{_nearly(term, known)}"
    if term.key == "name":
        names = [name for item in drawing.items for name in item.names if name]
        return f"its object names are {listed(names)}{_nearly(term, names)}" if names else "its objects have no names"
    if term.key == "text":
        keys = [key for item in drawing.items for key in item.text]
        return f"its user text keys are {listed(keys)}{_nearly(term, keys)}"
    return f"the file has {count(len(drawing.items), 'visible object')}"


def _nearly(term: Term, known: Sequence[str]) -> str:
    wanted, by_case = term.value.partition("=")[0].strip().casefold(), {name.casefold(): name for name in known}
    near = difflib.get_close_matches(wanted, by_case, 1)
    front = f"{term.feature}:" if term.feature else ""
    return f"; did you mean {front}{term.key}:{by_case[near[0]]}?" if near else ""


def count(number: int, one: str, many: str = "") -> str:
    """A number with its noun, such as `1 point` and `2 points`."""
    if number != 1:
        one = many or one + ("es" if one.endswith(("sh", "s", "x")) else "s")
    return f"{number} {one}"


def listed(names: Iterable[str], most: int = 12) -> str:
    """Names once each, in order, the first few of many; `none` for none."""
    unique: Sequence[str] = list(dict.fromkeys(names))
    more = f" and {len(unique) - most} more" if len(unique) > most else ""
    return (", ".join(f'"{name}"' for name in unique[:most]) or "none") + more
