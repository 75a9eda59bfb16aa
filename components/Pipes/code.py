"""Pipes about lines that meet in nodes, as one closed mesh.

Prisms about the lines end in rings about each node, and the convex hull of the rings closes it. Free
ends have flat caps. Connect the mesh to Refine with _smooth_ for round pipes.

Ring: r / tan(a / 2) from its node, a the smallest angle there
"""

from hookean_client import canvas_lines as lines

mesh = lines.pipes(ghenv, _lines, _radius, _sides_, _tolerance_)
