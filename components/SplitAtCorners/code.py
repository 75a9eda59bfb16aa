"""Polylines cut where they turn by more than an angle.

A closed polyline with corners starts at the first of them; the ends of an open one are not corners.
Several polylines in one branch give a branch each.

Angle between a piece and the next > limit
"""

from hookean_client import canvas_curves as curves

corners, parts = curves.split_at_corners(ghenv, _polyline, _angle_)
