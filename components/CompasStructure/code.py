# r: compas>=2.4
"""Meshes and lines of Rhino as COMPAS structures.

Each mesh becomes a Mesh with the same vertices and faces; all lines together become one Graph,
whose nodes come in the order in which the ends of lines first appear.

ends within 0.001 [length] = one node
"""

from hookean_client import compas_canvas

structures = compas_canvas.structures(ghenv, _geometry)
