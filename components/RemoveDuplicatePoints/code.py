"""Points of a branch without duplicates.

The first of each kind stays; the order of the others is kept.

Same: |a - p| at most the tolerance
"""

from hookean_client import canvas_points as points

points = points.remove_duplicate_points(ghenv, _points, _tolerance_)
