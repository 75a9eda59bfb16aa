"""Draws the .3dm model of the sphere that falls: a mesh sphere as Rhino's command MeshSphere makes it.

Run it from the project's root: `.venv/bin/python gh_examples/models_sphere.py`. The same version of rhino3dm writes the
same bytes.
"""

from __future__ import annotations

from math import cos, pi, sin
from pathlib import Path

import rhino3dm

from hookean.files.rhino.threedm import Additions, NewLayer, NewObject, write_new

HERE = Path(__file__).parent
RADIUS, DROP = 5.0, 5.0  # m
AROUND, ALONG = 20, 12  # faces


def sphere() -> None:
    """Section 9.7: a mesh sphere with its axis along Y, as one drawn in the Front view has it, 5 m above the floor."""
    mesh = rhino3dm.Mesh()
    mesh.Vertices.Add(0.0, -RADIUS, RADIUS + DROP)
    for j in range(1, ALONG):
        ring, y = RADIUS * sin(pi * j / ALONG), -RADIUS * cos(pi * j / ALONG)
        for i in range(AROUND):
            turn = 2.0 * pi * i / AROUND
            mesh.Vertices.Add(ring * sin(turn), y, RADIUS + DROP + ring * cos(turn))
    mesh.Vertices.Add(0.0, RADIUS, RADIUS + DROP)
    last = 1 + AROUND * (ALONG - 1)
    for i in range(AROUND):
        k = (i + 1) % AROUND
        mesh.Faces.AddFace(0, 1 + k, 1 + i)
        for j in range(ALONG - 2):
            near, far = 1 + AROUND * j, 1 + AROUND * (j + 1)
            mesh.Faces.AddFace(near + i, near + k, far + k, far + i)
        mesh.Faces.AddFace(last - AROUND + i, last - AROUND + k, last)
    mesh.Normals.ComputeNormals()
    write_new(
        HERE / "sphere" / "model.3dm",
        Additions(
            layers=(NewLayer("sphere", colour=(40, 90, 160, 255)),),
            objects=(NewObject(mesh, layer="sphere", name="sphere"),),
        ),
        own=False,
    )


if __name__ == "__main__":
    sphere()
