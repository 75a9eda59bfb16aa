"""Families of cables and cable nets."""

from __future__ import annotations

import numpy as np

from hookean.forces.springs import Springs
from hookean.scene.families import parameters as of
from hookean.scene.families.shapes import disc, free_edges, held_of, loaded, net, rectangle
from hookean.scene.scene import Anchor, Scene


def cable(
    span: of.Span = 10.0,
    parts: of.Parts = 20,
    stiffness: of.Stiffness = 100.0,
    rest_factor: of.RestFactor = 1.0,
    load: of.Load = 1.0,
) -> Scene:
    """Springs in a row that hang between two supports.

    With rest_factor 0 the particles come to rest on the parabola z_i = -p i (n - i) / (2 k).
    """
    particles = np.zeros((parts + 1, 3))
    particles[:, 0] = np.linspace(0, span, parts + 1)
    pairs = np.stack([np.arange(parts), np.arange(1, parts + 1)], axis=1)
    springs = Springs(name="cable", particles=pairs, stiffness=stiffness, rest_factor=rest_factor)
    supports = Anchor(name="supports", particles=[0, parts])
    return loaded(Scene(particles=particles, forces=[springs], anchors=[supports]), -load)


def grid(
    width: of.Width = 10.0,
    depth: of.Depth = 10.0,
    across: of.Across = 10,
    along: of.Along = 10,
    held: of.Border = "corners",
    stiffness: of.Stiffness = 100.0,
    rest_factor: of.RestFactor = 1.0,
    load: of.Load = 0.1,
) -> Scene:
    """A flat net of squares that hangs from its edges or corners.

    With rest_factor 0 and held edges the heights solve the discrete Poisson equation k L z = p.
    """
    scene = net(rectangle(width, depth, across, along), held_of(held, across, along), stiffness, rest_factor)
    return loaded(scene, -load)


def saddle(
    width: of.Width = 10.0,
    depth: of.Depth = 10.0,
    rise: of.CornerRise = 3.0,
    across: of.Across = 10,
    along: of.Along = 10,
    held: of.Border = "corners",
    stiffness: of.Stiffness = 10.0,
    edge_stiffness: of.EdgeStiffness = 100.0,
    rest_factor: of.RestFactor = 0.0,
) -> Scene:
    """A stretched net between two high and two low corners (hypar), with edge cables or held edges.

    With rest_factor 0 and held edges it is at rest as the hyperbolic paraboloid z = h (u + v - 2 u v).
    """
    u, v = np.linspace(0, 1, across + 1)[:, None], np.linspace(0, 1, along + 1)[None]
    mesh = rectangle(width, depth, across, along, rise * (u + v - 2 * u * v))
    rim = free_edges(held, across, along)
    return net(mesh, held_of(held, across, along), stiffness, rest_factor, rim, edge_stiffness)


def radial_net(
    radius: of.Radius = 5.0,
    height: of.Mast = 3.0,
    rings: of.Rings = 6,
    rays: of.Rays = 16,
    stiffness: of.Stiffness = 10.0,
    rest_factor: of.RestFactor = 0.0,
) -> Scene:
    """Rings and rays about a mast, held at the outer ring.

    With rest_factor 0 its rings come to rest at r_i = R sinh(i a) / sinh(n a), cosh a = 1 + 2 sin^2(pi / rays), and at
    z_i = h (1 - i / n).
    """
    mesh = disc(radius, rings, rays)
    outer = np.arange(1 + (rings - 1) * rays, 1 + rings * rays)
    held = np.append(0, outer) if height else outer
    distance = np.append(0, np.repeat(np.arange(1, rings + 1), rays))
    mesh.vertices[:, 2] = height * (1 - distance / rings)
    return net(mesh, held, stiffness, rest_factor)
