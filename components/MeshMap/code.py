"""Points near a mesh moved as the mesh is.

Each point goes with the closest triangle of the source: its barycentric coordinates in the plane of
the triangle stay, and its height over it is multiplied by the distance. The target has the vertices
and faces of the source, moved.

p = u A + v B + w C + d h n in both meshes
"""

from hookean_client import canvas_points as points

points = points.mesh_map(ghenv, _point, _source, _target, _distance_)
