"""Meshes with every quad and every triangle cut into four by the midpoints of their sides.

Old vertices keep their numbers. Smooth averages vertices after each level, which makes surfaces of
Catmull and Clark of quads and of Loop of triangles. Several meshes in one branch give a branch
each.

Faces: 4^level for each
"""

from hookean_client import canvas_remeshing as remeshing

mesh = remeshing.refine(ghenv, _mesh, _level_, _smooth_)
