"""Corners of meshes: vertices at the boundary whose angle inside the mesh is below a limit.

The inside angle is the sum of the angles of the faces that meet at the vertex. Several meshes in
one branch give a branch each.

Sum of the angles of the faces at a vertex < limit
"""

from hookean_client import canvas_meshes as meshes

corners, indices = meshes.mesh_corners(ghenv, _mesh, _angle_, _order_)
