"""Meshes as triangles of one size, their boundaries and folds kept.

Edges longer than 4/3 of the length are split, those shorter than 4/5 collapsed; diagonals are
flipped towards six neighbours; vertices move along the mesh to the middle of theirs and back onto
it. Edges at the boundary, and those that fold by more than the angle, stay lines of the mesh.
Several meshes in one branch give a branch each.

Edges: 4/5 to 4/3 of the length (Botsch and Kobbelt, 2004)
"""

from hookean_client import canvas_remeshing as remeshing

mesh = remeshing.remesh(ghenv, _mesh, _length, _angle_, _iterations_)
