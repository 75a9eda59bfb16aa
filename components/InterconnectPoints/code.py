"""A line between every two points of a branch.

From each point to all later ones.

Lines: n (n - 1) / 2 of n points
"""

from hookean_client import canvas_points as points

lines = points.interconnect_points(ghenv, _points)
