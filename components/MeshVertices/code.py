"""The vertices of meshes as points, in their order.

Several meshes in one branch give a branch each.

p(i) = vertex i
"""

from hookean_client import canvas_tools as tools

points = tools.mesh_vertices(ghenv, _mesh)
