"""A running system after an edit of what is drawn."""

from __future__ import annotations

import numpy as np

from hookean.errors import InputError
from hookean.running.drawing.adding import add
from hookean.running.drawing.deleting import delete
from hookean.running.drawing.dividing import divide, extrude
from hookean.running.drawing.edits import Draw
from hookean.running.drawing.sheet import Sheet
from hookean.running.following import taken_over
from hookean.system.state import State
from hookean.system.system import System, compile


def drawn(system: System, state: State, edit: Draw) -> tuple[System, State]:
    """The system after an edit, and its state: particles that were there go on from where they are, new ones are where
    they are drawn. Its revision is the next one. InputError names what does not fit."""
    sheet = Sheet(system, state)
    if edit.add is not None:
        add(sheet, edit.add)
    elif edit.divide is not None:
        divide(sheet, edit.divide)
    elif edit.extrude is not None:
        extrude(sheet, edit.extrude)
    elif edit.delete is not None:
        delete(sheet, edit.delete)
    following = compile(sheet.written(), empty=True)
    if following.slots.count != sheet.count:
        raise InputError("", "this leaves places of forces without their particles; delete these forces first")
    for name, mesh in sheet.meshes.items():
        if len(mesh.faces) and not np.array_equal(following.places.vertices(name), mesh.particles):
            raise InputError("", f"two particles of mesh {name!r} start at the same place; its faces need others")
    known = np.flatnonzero(sheet.same >= 0)
    begun = taken_over(system, state, following, known, sheet.same[known])
    new = np.flatnonzero(sheet.same < 0)
    begun.x[new] = sheet.now[new]
    following.hold(begun)
    following.put_outside(begun)
    return following, begun
