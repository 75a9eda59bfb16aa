# r: compas>=2.4
"""Vertices of a COMPAS Mesh or nodes of a Graph that are held exactly.

They are those of the keys given; without keys, those where one of the attributes is_support,
is_anchor or is_fixed is true.

x = X, reaction = - sum of the forces on the vertex
"""

from hookean_client import compas_canvas

anchors = compas_canvas.anchors(ghenv, _structure, vertices_, targets_, x=_x_, y=_y_, z=_z_)
