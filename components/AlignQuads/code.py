"""Meshes whose quads have the same direction.

The direction of a quad is that of its first side. The first face of each part keeps its own, the
others follow over shared edges. Triangles stay.

Shared side: opposite sides of both quads
"""

from hookean_client import canvas_remeshing as remeshing

mesh = remeshing.align_quads(ghenv, _mesh, _strict_)
