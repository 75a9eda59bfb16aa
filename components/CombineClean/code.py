"""The meshes of a branch as one, welded, without duplicate faces and unused vertices.

Vertices nearer than the tolerance become one, the first of them. Faces that lose a side become
triangles; those without three corners go. Of faces with the same corners the first stays.

Same: |a - p| at most the tolerance
"""

from hookean_client import canvas_remeshing as remeshing

mesh = remeshing.combine_clean(ghenv, _meshes, _tolerance_)
