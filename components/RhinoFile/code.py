"""The geometry in a .3dm file, by layer and name; surfaces come as meshes, too.

Visible objects in the order of the file, in its own unit, blocks taken apart; what hookean added
is left out. The file is read again when it was saved since. Definitions need no geometry of their
own this way.

Vertex (i, j) of a mesh = S(u0 + i (u1 - u0) / U, v0 + j (v1 - v0) / V)
"""

from hookean_client import canvas_file

found = canvas_file.rhino_file(ghenv, _file, layer_, name_, _u_, _v_)
points = found.points
lines = found.lines
curves = found.curves
surfaces = found.surfaces
meshes = found.meshes
names = found.names
layers = found.layers
unit = found.unit
