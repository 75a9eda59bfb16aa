"""Meshes with the direction of each quad turned by right angles.

The second side of each quad becomes the first, so many times. Triangles stay.

Corners a b c d: b c d a
"""

from hookean_client import canvas_remeshing as remeshing

mesh = remeshing.turn_quads(ghenv, _mesh, _turns_)
