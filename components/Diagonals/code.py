"""The diagonals of the quads of meshes as lines, in the order of the faces.

Springs along them keep quads from becoming diamonds. Several meshes in one branch give a branch
each.

Quad a b c d: a-c, b-d
"""

from hookean_client import canvas_quads as quads

diagonals = quads.diagonals(ghenv, _mesh, _pattern_)
