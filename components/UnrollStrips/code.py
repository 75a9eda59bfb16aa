"""The strips of meshes unrolled into the plane z = 0.

Each strip begins with its first rung on the y axis and runs along x; closed ones are cut. Faces keep
their order, the lengths of their sides and of the diagonals on which quads are folded flat.

Triangles: the same lengths in the plane
"""

from hookean_client import canvas_remeshing as remeshing

mesh = remeshing.unroll_strips(ghenv, _mesh, _direction_, _gap_)
