"""The strip of each face of meshes.

Faces are in one strip where they share an edge of a family, the rungs of a ladder.

Strip: faces joined across warp, or weft
"""

from hookean_client import canvas_quads as quads

strips = quads.strips(ghenv, _mesh, _direction_)
