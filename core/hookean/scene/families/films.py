"""Families of films and sheets."""

from __future__ import annotations

import numpy as np

from hookean.errors import InputError
from hookean.forces.membrane import Membrane
from hookean.forces.pressure import Pressure
from hookean.forces.soapfilm import SoapFilm
from hookean.scene.families import parameters as of
from hookean.scene.families.shapes import held_of, rectangle, tube
from hookean.scene.scene import Anchor, MeshData, Scene

WIDEST = 1.3254868
"""Largest height / radius of a catenoid: 2 t / cosh t for t tanh t = 1 (Goldschmidt, 1831)."""


def catenoid(
    radius: of.Radius = 5.0,
    height: of.Height = 5.0,
    rings: of.Rings = 12,
    rays: of.Rays = 32,
    tension: of.Tension = 1.0,
) -> Scene:
    """A soap film between two equal rings: r = a cosh((z - h / 2) / a), a cosh(h / (2 a)) = R.

    InputError where the rings are more than 1.325 radii apart: there is no such film.
    """
    if height > WIDEST * radius:
        said = f"{height:g} is more than 1.325 x the radius {radius:g}, where the film collapses"
        raise InputError("/height", f"{said}; give at most {np.floor(1e4 * WIDEST * radius) / 1e4:g}")
    mesh = tube(radius, height, rings, rays)
    rim = np.append(np.arange(rays), rings * rays + np.arange(rays))
    return Scene(
        particles=mesh.vertices,
        meshes={"film": MeshData(vertices=mesh.vertices, faces=mesh.faces)},
        forces=[SoapFilm(name="film", mesh="film", tension=tension)],
        anchors=[Anchor(name="rings", particles=rim)],
    )


def cushion(
    width: of.Width = 4.0,
    depth: of.Depth = 4.0,
    across: of.Across = 16,
    along: of.Along = 16,
    pressure: of.Overpressure = 0.3,
    prestress: of.Prestress = 1.0,
    stiffness: of.Sheet = 200.0,
) -> Scene:
    """The upper sheet of a cushion, held along its edges and inflated.

    At low pressure its height is that of a stretched membrane: 0.0737 p a^2 / prestress at the middle of a square of
    side a (Timoshenko and Goodier, Theory of Elasticity, art. 107).
    """
    mesh = rectangle(width, depth, across, along)
    return Scene(
        particles=mesh.vertices,
        meshes={"sheet": MeshData(vertices=mesh.vertices, faces=mesh.faces)},
        forces=[
            Membrane(name="sheet", mesh="sheet", warp_stiffness=stiffness, prestress=[prestress, prestress, 0.0]),
            Pressure(name="pressure", mesh="sheet", pressure=pressure),
        ],
        anchors=[Anchor(name="edges", particles=held_of("edges", across, along))],
    )
