"""Families of tensegrities."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hookean.forces.springs import Springs
from hookean.scene.families import parameters as of
from hookean.scene.scene import Anchor, Scene

STIFFER = 1000.0
"""Stiffness of a strut / that of a cable."""


def tensegrity(
    radius: of.Radius = 2.0,
    height: of.Height = 3.0,
    struts: of.Struts = 3,
    stiffness: of.Stiffness = 10.0,
) -> Scene:
    """A prism of struts and cables, held at its lower ring; the upper one starts untwisted and finds its twist.

    It comes to rest at the height, with equal rings that are turned by 90 deg + 180 deg / n from foot to head of a
    strut (Connelly and Terrell, Globally rigid symmetric tensegrities, 1995). Cables have constant force densities:
    k upright, k / (2 sin(180 deg / n)) around, which leaves -k for the struts.
    """
    turn = 2 * np.pi / struts
    twist = 0.5 * np.pi + 0.5 * turn
    foot = turn * np.arange(struts)
    head = foot + 0.9 * twist
    particles = np.concatenate([_ring(radius, foot, 0.0), _ring(radius, head, 0.9 * height)])
    lower, upper = np.arange(struts), np.arange(struts) + struts
    length = float(np.hypot(height, 2 * radius * np.sin(0.5 * twist)))
    density = stiffness / (2 * np.sin(0.5 * turn))
    cables = {"upright": (np.roll(lower, -1), upper, stiffness), "around": (upper, np.roll(upper, -1), density)}
    return Scene(
        particles=particles,
        forces=[
            Springs(
                name="struts",
                particles=np.stack([lower, upper], axis=1),
                stiffness=STIFFER * stiffness,
                rest_length=length * (1 + 1 / STIFFER),
            ),
            *(
                Springs(name=name, particles=np.stack([a, b], axis=1), stiffness=k, rest_factor=0.0)
                for name, (a, b, k) in cables.items()
            ),
        ],
        anchors=[Anchor(name="lower ring", particles=lower)],
    )


def _ring(radius: float, angles: NDArray[np.floating], z: float) -> NDArray[np.floating]:
    return np.stack([radius * np.cos(angles), radius * np.sin(angles), np.full(len(angles), z)], axis=1)
