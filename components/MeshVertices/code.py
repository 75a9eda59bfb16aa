"""The vertices of meshes as points, in their order.

Several meshes in one branch give a branch each.

p(i) = vertex i
"""

from hookean_client import canvas_meshes as meshes

points = meshes.mesh_vertices(ghenv, _mesh)
