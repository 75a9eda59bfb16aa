"""Surfaces as meshes of U by V quads, at even steps of their parameters.

A side that is one point, such as the pole of a sphere, becomes one vertex with triangles round it;
a closed surface is welded along its seam. Faces of a Brep share the vertices of shared edges.
Trimmed faces are refused: mesh those in Rhino.

Vertex (i, j) = S(u0 + i (u1 - u0) / U, v0 + j (v1 - v0) / V)
"""

from hookean_client import canvas_meshes as meshes

mesh = meshes.mesh_surface(ghenv, _surface, _u_, _v_)
