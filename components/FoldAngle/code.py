"""Angles between pairs of triangles about their common edges, from -pi to pi.

0 where flat, positive where the tips rise to the side of (end - start) x (tip 1 - start), as for
Hinge. Lists are matched by the longest.

Angle between the triangles start-end-tip 1 and end-start-tip 2
"""

from hookean_client import canvas_points as points

angle = points.fold_angle(ghenv, _start, _end, _tip_1, _tip_2)
