"""Vertices at the boundary of meshes, and those inside.

All in the order of the vertices; those in no face are neither. Several meshes in one branch give a
branch each.

Naked: on an edge of one face only; clothed: in faces and on no such edge
"""

from hookean_client import canvas_meshes as meshes

clothed_index, naked_index, clothed_points, naked_points = meshes.naked_vertices(ghenv, _mesh)
