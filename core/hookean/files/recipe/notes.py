"""What a person should know of how a file was read: objects left out, guesses, names that may be misspelt."""

from __future__ import annotations

import difflib

import numpy as np

from hookean.discretize.duplicates import unique_points
from hookean.files.recipe.build import Built
from hookean.files.recipe.drawing import NO_LAYER, Drawing, Item, above
from hookean.files.recipe.select import count, listed
from hookean.files.rhino.model import SEPARATOR

CLOSE = 0.8  # how alike two names must be for one to be taken for the other misspelt


def notes(seen: Drawing, built: Built, *, conventional: bool) -> list[str]:
    """A sentence for each kind of object left out for a reason, for anchors that were guessed, and for layers and user
    text keys that are nearly those of the convention."""
    found = _left(seen, built)
    held = [a.points for a in built.scene.anchors if a.points is not None and len(a.points)]
    # a floor, and what pulls to a place, hold as well
    caught = built.scene.settings.floor is not None or any(type(f).role == "support" for f in built.scene.forces)
    if not built.scene.anchors and not caught:
        found.append("nothing is held")
    elif built.guessed and held:
        kept, _ = unique_points(np.concatenate(held), built.scene.weld_tolerance)
        what = " and ".join(dict.fromkeys(anchor.name for anchor in built.scene.anchors))
        found.append(f"nothing is marked as an anchor: {what} are held ({count(len(kept), 'particle')})")
    return [*found, *_layers(seen), *_keys(seen)] if conventional else found


def _left(seen: Drawing, built: Built) -> list[str]:
    from hookean.files.recipe.convention import FLOOR
    from hookean.files.recipe.shapes import counted, short

    groups: dict[tuple[str, str], list[Item]] = {}
    for item in seen.items:
        why = short(built.left.get(item, FLOOR))  # --explain names the faces
        if item not in built.uses and why != FLOOR:
            groups.setdefault((item.layer or NO_LAYER, why), []).append(item)
    for item in seen.hidden:
        groups.setdefault((item.layer or NO_LAYER, "hidden"), []).append(item)
    return [f"{counted(items)} on layer {layer} left out: {why}" for (layer, why), items in groups.items()]


def _layers(seen: Drawing) -> list[str]:
    from hookean.files.recipe.convention import ROLES, role_of

    known = [name for names in ROLES.values() for name in names]
    tried: dict[str, str] = {}
    for item in seen.items:
        if role_of(item):
            continue
        for path in (path for layer in item.layers for path in above(layer)):
            name = path.rpartition(SEPARATOR)[2]
            tried.setdefault(name, _closest(name, known))
    return [f"layer {name} has no meaning; did you mean {meant}?" for name, meant in tried.items() if meant]


def _keys(seen: Drawing) -> list[str]:
    from hookean.files.recipe.convention import TEXTS

    owners: dict[str, list[Item]] = {}
    for item in seen.items:
        for key in item.text:
            if key not in TEXTS:
                owners.setdefault(key, []).append(item)
    return [
        f"user text {key} on layer {listed(i.layer or NO_LAYER for i in items)} has no meaning; did you mean {meant}?"
        for key, items in owners.items()
        if (meant := _closest(key, TEXTS))
    ]


def _closest(name: str, known: tuple[str, ...] | list[str]) -> str:
    return next(iter(difflib.get_close_matches(name.strip().casefold(), known, 1, CLOSE)), "")
