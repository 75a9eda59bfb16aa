# r: compas>=2.4
"""Loads on vertices of a COMPAS Mesh or nodes of a Graph.

Without a vector each vertex carries its attributes px, py and pz [force].

f = F on each vertex
"""

from hookean_client import compas_canvas

force = compas_canvas.load(ghenv, _structure, vector_, vertices=vertices_, name=name_)
