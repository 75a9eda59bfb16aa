"""Meshes with every face cut in two across one direction, such as strips along their length.

The edges of one of the two families of Warp Weft are halved. Along: in each connected part the
family with the larger share of its edges on the boundary, the rails of a strip; of equals the
longer one. Several meshes in one branch give a branch each.

Faces: 2^level for each
"""

from hookean_client import canvas_remeshing as remeshing

mesh = remeshing.refine_strips(ghenv, _mesh, _level_, _direction_)
