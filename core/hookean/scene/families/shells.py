"""Families of hanging models turned over: the tension that they come to rest with is the compression of the shell."""

from __future__ import annotations

import numpy as np

from hookean.discretize.meshes import edges
from hookean.forces.springs import Springs
from hookean.scene.families import parameters as of
from hookean.scene.families.shapes import disc, free_edges, held_of, loaded, net, raised, rectangle
from hookean.scene.scene import Anchor, Geometry, MeshData, Scene


def dome(
    radius: of.Radius = 5.0,
    rise: of.Rise = 4.0,
    rings: of.Rings = 8,
    rays: of.Rays = 16,
    stiffness: of.Stiffness = 10.0,
) -> Scene:
    """A hanging net of rings and rays turned over, held at the outer ring, with loads that give it its rise.

    Its springs have constant force densities k. Its rings come to rest where those of the radial net do; their heights
    are z_i = p / k ((n - i) / rays + (n (n - 1) - i (i - 1)) / 2).
    """
    outer = np.arange(1 + (rings - 1) * rays, 1 + rings * rays)
    return raised(net(disc(radius, rings, rays), outer, stiffness, 0.0), rise)


def vault(
    width: of.Width = 10.0,
    depth: of.Depth = 10.0,
    rise: of.Rise = 3.0,
    across: of.Across = 12,
    along: of.Along = 12,
    supports: of.Supports = "edges",
    stiffness: of.Stiffness = 10.0,
    edge_stiffness: of.EdgeStiffness = 100.0,
) -> Scene:
    """A hanging net over a rectangular plan turned over, with loads that give it its rise.

    Its springs have constant force densities k; heights solve k L z = p. On two edges without edge cables they are the
    parabola z_i = 4 h i (n - i) / n^2 (n even).
    """
    mesh, held = rectangle(width, depth, across, along), held_of(supports, across, along)
    return raised(net(mesh, held, stiffness, 0.0, free_edges(supports, across, along), edge_stiffness), rise)


def gridshell(
    width: of.Width = 10.0,
    depth: of.Depth = 10.0,
    slack: of.Slack = 1.15,
    across: of.Across = 12,
    along: of.Along = 12,
    supports: of.Supports = "edges",
    stiffness: of.Stiffness = 10_000.0,
    load: of.HangingLoad = 1.0,
) -> Scene:
    """A lattice of members of equal length that hangs over its plan, turned over, as the Multihalle in Mannheim was
    formed (Happold and Liddell, Timber lattice roof for the Mannheim Bundesgartenschau, 1975).

    On two edges only the members between these are longer than their plan, and each row is a chain of equal links
    under equal loads, whose slopes rise by p / H from link to link.
    """
    mesh, held = rectangle(width, depth, across, along), held_of(supports, across, along)
    pairs = edges(mesh)
    pairs = pairs[~np.isin(pairs, held).all(axis=1)]
    cross = (np.diff(pairs)[:, 0] == 1) & (supports == "two edges")  # members beside held edges keep their length
    factor = np.where(cross, 1.0, slack) if cross.any() else slack
    members = Springs(name="members", particles=pairs, stiffness=stiffness, rest_factor=factor)
    scene = Scene(
        particles=mesh.vertices,
        meshes={"skin": MeshData(vertices=mesh.vertices, faces=mesh.faces)},
        forces=[members],
        anchors=[Anchor(name="supports", particles=held)],
        geometry=[Geometry(name="skin", kind="mesh", mesh="skin")],
    )
    return loaded(scene, load)
