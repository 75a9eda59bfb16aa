"""The four points of the hinge at each inner edge of meshes, as Hinge takes them.

Quads are cut along their shorter diagonal, which is a hinge, too. Hinges are in the order of the
edges. Several meshes in one branch give a branch each.

Triangles start-end-tip 1 and end-start-tip 2
"""

from hookean_client import canvas_quads as quads

start, end, tip_1, tip_2 = quads.hinge_points(ghenv, _mesh)
