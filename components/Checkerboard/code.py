"""The faces of meshes in two colours, no two beside each other alike.

The first face of each connected part has the first colour. Two colours are enough where no ring of
neighbours is odd; elsewhere an error names two faces, unless strict is False. Several meshes in one
branch give a branch each.

Faces that share an edge: different colours
"""

from hookean_client import canvas_quads as quads

pattern, first, second = quads.checkerboard(ghenv, _mesh, _strict_)
