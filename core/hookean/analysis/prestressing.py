"""The elastic model of a form with its prestress times a factor."""

from __future__ import annotations

import numpy as np

from hookean.analysis.freezing import Frozen, cut_to
from hookean.forces.membrane import Membrane
from hookean.forces.sliding_cable import SlidingCable
from hookean.forces.springs import Springs
from hookean.scene.scene import Scene
from hookean.system.system import compile


def prestressed(frozen: Frozen, factor: float) -> Scene:
    """The elastic scene with the tensions of the form times a factor: lengths l stay, L0 = l EA / (EA + factor T). What
    is slack, or has a gap to close, has no tension and keeps its rest length. Cloth has factor S in the place of its
    stress S in the form, which adds (factor - 1) S to its prestress."""
    if factor == 1.0:
        return frozen.scene
    forces = list(frozen.scene.forces)
    for number, tension in frozen.tensions.items():
        force, length = forces[number], frozen.lengths[number]
        assert isinstance(force, Springs)
        own = np.broadcast_to(np.asarray(force.rest_length), tension.shape)
        ea = np.asarray(force.stiffness) * own
        kept = np.where(tension == 0.0, own, 0.0)  # there is no tension to multiply
        stiffness, rest = cut_to(ea, length, factor * tension, f"/forces/{number}", kept)
        slack = np.asarray(force.lower_cutoff) >= own
        lower = np.where(slack, rest, force.lower_cutoff)
        forces[number] = force.replaced(stiffness=stiffness, rest_length=rest, lower_cutoff=lower)
    places = compile(frozen.scene).places if frozen.cloth else None
    for number, stress in frozen.cloth.items():
        cloth = forces[number]
        assert isinstance(cloth, Membrane) and places is not None
        forces[number] = cloth.prestressed((factor - 1.0) * stress, places.faces(cloth.mesh))
    for number, (whole, strain) in frozen.slides.items():
        cable = forces[number]
        assert isinstance(cable, SlidingCable)
        forces[number] = cable.replaced(force=None, rest_length=whole / (1.0 + factor * strain))
    return frozen.scene.replaced(forces=tuple(forces))
