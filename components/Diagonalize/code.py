"""Meshes with a face for each edge of other meshes, between the centres of the faces beside it.

Edges of two faces give quads, those at the boundary triangles, in the order of Mesh Edges. Several
meshes in one branch give a branch each.

Faces: as many as edges; vertices: the old ones, then the centres
"""

from hookean_client import canvas_remeshing as remeshing

mesh = remeshing.diagonalize(ghenv, _mesh)
