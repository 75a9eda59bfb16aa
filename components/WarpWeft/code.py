"""The edges of quad meshes in two families that cross like the threads of a cloth.

The first side of the first quad is warp. Two families exist where every vertex inside has an even
number of quads and no strip is twisted; elsewhere an error names two quads that disagree, unless
strict is False. Several meshes in one branch give a branch each.

Opposite sides of a quad: one family; neighbouring sides: the other
"""

from hookean_client import canvas_quads as quads

warp, weft, warp_naked, weft_naked = quads.warp_weft(ghenv, _mesh, _strict_)
